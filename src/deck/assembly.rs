//! Conversion of decks with parts and an assembly, as written by Abaqus/CAE, into flat decks.
//!
//! From the first `*PART` on, all blocks are collected and then written again. The blocks of a part
//! are written once for each of its instances, at the position of the instance: nodes and points
//! are moved, numbers are changed according to [`super::instances`], and names are prefixed with
//! the instance's name and a dot, as in references from outside a part. The readers of keywords see
//! flat decks only.
//!
//! # Source
//! *Abaqus Analysis User's Guide* 6.14, 2.10.1, "Defining an assembly".

mod flat;
mod keyword_block;
mod placement;

use super::instances::Instances;
use super::keyword::{Keyword, no_such};
use super::source::DeckLines;
use crate::error::Result;
use keyword_block::KeywordBlock;
use placement::Placement;

/// Keywords that begin and end parts, instances and assemblies.
const FRAMES: [&str; 6] = [
    "PART",
    "END PART",
    "ASSEMBLY",
    "END ASSEMBLY",
    "INSTANCE",
    "END INSTANCE",
];

/// Keywords that belong to the whole model: if one occurs within a part, the end of the part is
/// missing.
const OF_MODEL: [&str; 5] = [
    "STEP",
    "MATERIAL",
    "AMPLITUDE",
    "SURFACE INTERACTION",
    "INITIAL CONDITIONS",
];

/// Largest number of instances whose number offsets are listed in a note.
const MOST_NAMED: usize = 4;

/// Whether a keyword begins or ends a part, an instance or an assembly.
pub(super) fn frames(keyword: &Keyword) -> bool {
    FRAMES.contains(&keyword.name.as_str())
}

/// A part with its blocks.
struct PartBlocks {
    keyword: Keyword,
    name: String,
    blocks: Vec<KeywordBlock>,
}

/// An instance of a part with its placement, and the blocks that belong to this instance alone.
struct Instance {
    keyword: Keyword,
    name: String,
    part: usize,
    placement: Placement,
    blocks: Vec<KeywordBlock>,
}

/// An item outside of parts, in the order of the deck.
enum Item {
    Instance(usize),
    Block(KeywordBlock),
}

/// The rest of a deck, from its first part on.
#[derive(Default)]
pub(super) struct Assembled {
    parts: Vec<PartBlocks>,
    instances: Vec<Instance>,
    items: Vec<Item>,
    /// The name of the assembly.
    name: Option<String>,
    /// Keywords that begin and end parts, instances and the assembly.
    frame: Vec<Keyword>,
}

impl Assembled {
    /// Reads from the first keyword of parts or assemblies to the end of the deck.
    ///
    /// # Errors
    /// `Input` for parts, instances and assemblies that begin or end at a wrong place, share a
    /// name, or are not defined.
    pub(super) fn read(source: &mut DeckLines, first: Keyword) -> Result<Assembled> {
        let mut out = Assembled::default();
        let mut open = Vec::new();
        let mut next = Some(first);
        while let Some(keyword) = next {
            let mut lines = Vec::new();
            while let Some(line) = source.next_data()? {
                lines.push(line);
            }
            out.take(source, &mut open, KeywordBlock { keyword, lines })?;
            next = match source.next()? {
                Some(line) => Some(Keyword::read(source, line)?),
                None => None,
            };
        }
        if let Some(keyword) = open.last() {
            let message = format!(
                "it has no *END {}; put it behind its last line",
                keyword.name
            );
            return Err(keyword.error(&source.files, message));
        }
        if let (true, Some(keyword)) = (out.instances.is_empty(), out.frame.first()) {
            let message = "the deck has no *INSTANCE; put one of each part into an *ASSEMBLY";
            return Err(keyword.error(&source.files, message));
        }
        Ok(out)
    }

    /// Assigns a block to the part or instance it belongs to; `open` holds the keywords whose end
    /// is still to come.
    fn take(
        &mut self,
        source: &DeckLines,
        open: &mut Vec<Keyword>,
        block: KeywordBlock,
    ) -> Result<()> {
        let files = &source.files;
        let keyword = &block.keyword;
        let inside = open.last().map_or("", |keyword| keyword.name.as_str());
        match (keyword.name.as_str(), inside) {
            ("PART", "") => self.begin_part(source, &block)?,
            ("ASSEMBLY", "") => self.begin_assembly(source, &block)?,
            ("INSTANCE", "ASSEMBLY") => self.begin_instance(source, &block)?,
            ("END PART", "PART") | ("END INSTANCE", "INSTANCE") | ("END ASSEMBLY", "ASSEMBLY") => {
                keyword.allow(files, &[])?;
                block.no_more(source, 0)?;
                open.pop();
                self.frame.push(block.keyword);
                return Ok(());
            }
            ("END PART" | "END INSTANCE" | "END ASSEMBLY", "") => {
                let begin = keyword.name.trim_start_matches("END ");
                let message = format!("there is no *{begin} that it ends; take it out");
                return Err(keyword.error(files, message));
            }
            ("INSTANCE", "") => {
                let message = "it stands in no *ASSEMBLY; put it in one, behind all parts";
                return Err(keyword.error(files, message));
            }
            (name, _)
                if FRAMES.contains(&name) && !inside.is_empty()
                    || OF_MODEL.contains(&name) && ["PART", "INSTANCE"].contains(&inside)
                    || name == "STEP" && inside == "ASSEMBLY" =>
            {
                let begun = open.last().map_or(String::new(), |of| files.show(of.place));
                let message = format!(
                    "the *{inside} of {begun} has no *END {inside}; put it in front of this line"
                );
                return Err(keyword.error(files, message));
            }
            _ => {
                let blocks = match inside {
                    "PART" => self.parts.last_mut().map(|part| &mut part.blocks),
                    "INSTANCE" => self.instances.last_mut().map(|of| &mut of.blocks),
                    _ => None,
                };
                match blocks {
                    Some(blocks) => blocks.push(block),
                    None => self.items.push(Item::Block(block)),
                }
                return Ok(());
            }
        }
        self.frame.push(block.keyword.clone());
        open.push(block.keyword);
        Ok(())
    }

    fn begin_part(&mut self, source: &DeckLines, block: &KeywordBlock) -> Result<()> {
        let (keyword, files) = (&block.keyword, &source.files);
        keyword.allow(files, &["NAME"])?;
        let name = keyword.require(files, "NAME")?.to_string();
        if self.part(&name).is_some() {
            let message = format!("a second part {name}; rename one of them");
            return Err(keyword.error(files, message));
        }
        block.no_more(source, 0)?;
        self.parts.push(PartBlocks {
            keyword: keyword.clone(),
            name,
            blocks: Vec::new(),
        });
        Ok(())
    }

    fn begin_assembly(&mut self, source: &DeckLines, block: &KeywordBlock) -> Result<()> {
        let (keyword, files) = (&block.keyword, &source.files);
        keyword.allow(files, &["NAME"])?;
        if self.name.is_some() {
            let message = "a second assembly; put all instances into one";
            return Err(keyword.error(files, message));
        }
        self.name = Some(keyword.get("NAME").unwrap_or_default().to_string());
        block.no_more(source, 0)
    }

    fn begin_instance(&mut self, source: &DeckLines, block: &KeywordBlock) -> Result<()> {
        let (keyword, files) = (&block.keyword, &source.files);
        keyword.allow(files, &["NAME", "PART"])?;
        let name = keyword.require(files, "NAME")?.to_string();
        let is_same = |other: &Instance| other.name.to_uppercase() == name.to_uppercase();
        if self.instances.iter().any(is_same) {
            let message = format!("a second instance {name}; rename one of them");
            return Err(keyword.error(files, message));
        }
        let of = keyword.require(files, "PART")?;
        let part = self.part(of).ok_or_else(|| {
            let names = self.parts.iter().map(|part| part.name.as_str());
            keyword.error(
                files,
                no_such("part", of, names, "name one that stands before it"),
            )
        })?;
        self.items.push(Item::Instance(self.instances.len()));
        self.instances.push(Instance {
            keyword: keyword.clone(),
            name,
            part,
            placement: Placement::read(source, block)?,
            blocks: Vec::new(),
        });
        Ok(())
    }

    fn part(&self, name: &str) -> Option<usize> {
        let name = name.to_uppercase();
        let mut parts = self.parts.iter();
        parts.position(|part| part.name.to_uppercase() == name)
    }

    /// The instances and their numbering; `before` is the largest number read before the first
    /// part.
    ///
    /// # Errors
    /// `Input` if numbers have too many digits to be offset.
    pub(super) fn instances(&self, source: &DeckLines, before: Option<u64>) -> Result<Instances> {
        let of_parts = self.parts.iter().flat_map(|part| &part.blocks);
        let of_instances = self.instances.iter().flat_map(|of| &of.blocks);
        let outside = self.items.iter().filter_map(|item| match item {
            Item::Block(block) => Some(block),
            Item::Instance(_) => None,
        });
        let mut largest = before.unwrap_or(0);
        let all = of_parts.chain(of_instances).chain(outside);
        for block in all.filter(|block| block.is(&["NODE", "ELEMENT"])) {
            for &line in &block.lines {
                // A value that is not a number is reported when the line is read later.
                let label = block.fields(source, line).label("the number");
                largest = largest.max(label.unwrap_or(0));
            }
        }
        let names = self.instances.iter().map(|of| of.name.clone()).collect();
        Instances::new(names, largest).ok_or_else(|| {
            let message = format!(
                "nodes or elements have numbers up to {largest}, too many digits for several \
                 instances; number them from 1"
            );
            match self.instances.first() {
                Some(first) => first.keyword.error(&source.files, message),
                None => crate::Error::input(message),
            }
        })
    }

    /// Keywords of parts, instances and the assembly, all of which have been processed.
    pub(super) fn frame(&self) -> &[Keyword] {
        &self.frame
    }

    /// Parts of which there is no instance.
    pub(super) fn unused_parts(&self) -> impl Iterator<Item = &Keyword> {
        let is_used = |index: usize| self.instances.iter().any(|of| of.part == index);
        let parts = self.parts.iter().enumerate();
        parts
            .filter(move |(index, _)| !is_used(*index))
            .map(|(_, part)| &part.keyword)
    }

    /// A note about the numbering of instances, and the keyword to which it refers.
    pub(super) fn note(&self, instances: &Instances) -> Option<(&Keyword, String)> {
        let first = self.instances.first()?;
        let names = instances.names().iter().take(MOST_NAMED).enumerate();
        let each = names.map(|(number, name)| format!("{} in {name}", instances.offset(number)));
        let mut all = each.collect::<Vec<_>>().join(", ");
        if instances.names().len() > MOST_NAMED {
            all.push_str(", and so on");
        }
        let how = format!("numbers of nodes and elements are those of the part plus {all}");
        Some((&first.keyword, how))
    }
}
