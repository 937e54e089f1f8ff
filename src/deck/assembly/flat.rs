//! Writes the blocks of a deck with parts as those of a flat deck.

use super::keyword_block::KeywordBlock;
use super::placement::Placement;
use super::{Assembled, Item};
use crate::deck::fields::{LineFields, Where};
use crate::deck::instances::Instances;
use crate::deck::keyword::no_such;
use crate::deck::source::{Anew, DeckLines, Line};
use crate::error::Result;
use std::io::Write;

/// Allowed parameters of sets outside of parts.
const OF_SETS: [&str; 6] = [
    "NSET", "ELSET", "INSTANCE", "GENERATE", "UNSORTED", "INTERNAL",
];

/// The kind of values in a data line, as far as they depend on instances.
#[derive(Clone, Copy)]
enum LineValues {
    /// A number, followed by coordinates.
    Node,
    /// Numbers and names only.
    All,
    /// A number or name, followed by values that do not depend on instances.
    First,
    /// First number, last number, and step.
    Range,
    /// Number or name, degree of freedom and coefficient, repeated; a single value is the number of
    /// terms.
    Terms,
    /// Coordinates of two points.
    Points,
    /// Values that do not depend on instances.
    Same,
}

impl LineValues {
    fn of(block: &KeywordBlock) -> LineValues {
        match block.keyword.name.as_str() {
            "NODE" => LineValues::Node,
            "NSET" | "ELSET" if block.keyword.has("GENERATE") => LineValues::Range,
            "ELEMENT" | "NSET" | "ELSET" | "CONTACT PAIR" | "TIE" | "MODEL CHANGE" => {
                LineValues::All
            }
            "SURFACE" | "BOUNDARY" | "CLOAD" | "DLOAD" | "DSLOAD" | "TEMPERATURE"
            | "INITIAL CONDITIONS" => LineValues::First,
            "EQUATION" => LineValues::Terms,
            "TRANSFORM" => LineValues::Points,
            _ => LineValues::Same,
        }
    }
}

/// The instance and placement to which a block belongs.
#[derive(Clone, Copy)]
struct BlockScope<'m> {
    /// The instance to which sets and surfaces defined by the block belong; `None` in the assembly
    /// and the model.
    own: Option<usize>,
    /// The instance to which numbers and names in the data lines refer.
    of: Option<usize>,
    placement: Option<&'m Placement>,
}

impl Assembled {
    /// Returns the deck as a flat one.
    ///
    /// # Errors
    /// `Input` for undefined instances and numbers, or for damaged values among those that are
    /// moved.
    pub(in crate::deck) fn flat(&self, source: &DeckLines, instances: &Instances) -> Result<Anew> {
        let mut writer = Writer {
            source,
            instances,
            assembly: self.name.as_deref().unwrap_or_default(),
            out: Anew::default(),
        };
        for item in &self.items {
            match item {
                Item::Block(block) => writer.outside(block)?,
                Item::Instance(number) => {
                    let instance = &self.instances[*number];
                    let scope = BlockScope {
                        own: Some(*number),
                        of: Some(*number),
                        placement: Some(&instance.placement).filter(|place| !place.is_none()),
                    };
                    for block in self.parts[instance.part]
                        .blocks
                        .iter()
                        .chain(&instance.blocks)
                    {
                        writer.block(block, scope)?;
                    }
                }
            }
        }
        Ok(writer.out)
    }
}

struct Writer<'m, 't> {
    source: &'m DeckLines<'t>,
    instances: &'m Instances,
    assembly: &'m str,
    out: Anew,
}

impl Writer<'_, '_> {
    /// Writes a block of the assembly or the model, whose numbers may refer to an instance.
    fn outside(&mut self, block: &KeywordBlock) -> Result<()> {
        let keyword = &block.keyword;
        let mut of = None;
        let files = &self.source.files;
        if block.is(&["NSET", "ELSET"]) {
            keyword.allow(files, &OF_SETS)?;
        }
        if block.is(&["NSET", "ELSET"]) && keyword.has("INSTANCE") {
            let name = self.without_assembly(keyword.require(files, "INSTANCE")?);
            of = Some(self.instances.find(name).ok_or_else(|| {
                let names = self.instances.names().iter().map(String::as_str);
                let message = no_such("instance", name, names, "name one that stands before it");
                keyword.error(files, message)
            })?);
        }
        let (own, placement) = (None, None);
        self.block(block, BlockScope { own, of, placement })
    }

    fn block(&mut self, block: &KeywordBlock, scope: BlockScope) -> Result<()> {
        let keyword = &block.keyword;
        // A blank follows the asterisk, so that no name can turn the line into a comment.
        self.write(format_args!("* {}", keyword.name));
        for (key, value) in keyword.parameters() {
            if scope.own.is_none() && scope.of.is_some() && key == "INSTANCE" {
                continue;
            }
            let Some(value) = value else {
                self.write(format_args!(", {key}"));
                continue;
            };
            let name = match (keyword.name.as_str(), key) {
                ("NSET", "NSET") | ("ELSET", "ELSET") | ("SURFACE", "NAME") => {
                    self.qualified(value, scope.own)
                }
                (_, "NSET" | "ELSET") | ("CLEARANCE", "MASTER" | "SLAVE") => {
                    self.qualified(value, scope.of)
                }
                _ => value.to_string(),
            };
            self.write(format_args!(", {key}=\"{name}\""));
        }
        self.out.end_line(keyword.place);
        let values = LineValues::of(block);
        for &line in &block.lines {
            self.line(block, values, line, scope)?;
            self.out.end_line(line.place);
        }
        Ok(())
    }

    /// Writes a data line, changed for an instance.
    fn line(
        &mut self,
        block: &KeywordBlock,
        values: LineValues,
        line: Line,
        scope: BlockScope,
    ) -> Result<()> {
        let source = self.source;
        let mut row = block.fields(source, line);
        let mut ahead = row;
        ahead.word();
        let is_alone = ahead.is_at_end();
        match (values, scope.placement) {
            (LineValues::All, _) => return self.each(row, 1, scope),
            (LineValues::Terms, _) if !is_alone => return self.each(row, 3, scope),
            (LineValues::First, _) | (LineValues::Node, None) => self.value(&mut row, scope)?,
            (LineValues::Node, Some(placement)) => {
                self.value(&mut row, scope)?;
                let mut x = [0.0; 3];
                for (x, what) in x.iter_mut().zip(["x", "y", "z"]) {
                    *x = row.number_or(what, 0.0)?;
                }
                row.end()?;
                self.numbers(", ", &placement.point(x));
                return Ok(());
            }
            (LineValues::Range, _) => {
                let first = row.label("the first number")?;
                let last = row.label("the last number")?.min(self.instances.most());
                let first = self.number(first, scope.of, &row.place)?;
                let last = self.number(last, scope.of, &row.place)?;
                self.write(format_args!("{first}, {last}"));
            }
            (LineValues::Points, Some(placement)) => {
                let mut points = [[0.0; 3]; 2];
                for x in points.as_flattened_mut() {
                    *x = row.number_or("a coordinate", 0.0)?;
                }
                row.end()?;
                let is_axis = block.keyword.get("TYPE").unwrap_or_default();
                let moved = points.map(|x| match is_axis.eq_ignore_ascii_case("C") {
                    true => placement.point(x),
                    false => placement.vector(x),
                });
                self.numbers("", moved.as_flattened());
                return Ok(());
            }
            (LineValues::Terms | LineValues::Points | LineValues::Same, _) => {
                self.out.text().extend_from_slice(source.bytes(line));
                return Ok(());
            }
        }
        // The rest of the line is copied unchanged.
        if !row.is_at_end() {
            self.out.text().extend_from_slice(b", ");
            self.out.text().extend_from_slice(row.rest());
        } else if row.ends_with_comma() {
            self.out.text().push(b',');
        }
        Ok(())
    }

    /// Writes a line in which every `step`-th value is a number or name.
    fn each(&mut self, mut row: LineFields, step: usize, scope: BlockScope) -> Result<()> {
        for index in 0.. {
            match index % step {
                0 => self.value(&mut row, scope)?,
                _ => self.out.text().extend_from_slice(row.written()),
            }
            if row.is_at_end() {
                break;
            }
            self.out.text().extend_from_slice(b", ");
        }
        if row.ends_with_comma() {
            self.out.text().push(b',');
        }
        Ok(())
    }

    /// Writes the next value of a line, a number or a name.
    fn value(&mut self, row: &mut LineFields, scope: BlockScope) -> Result<()> {
        let mut ahead = *row;
        let written = ahead.written();
        if !written.is_empty() && written.iter().all(u8::is_ascii_digit) {
            let label = row.label("the number")?;
            let label = self.number(label, scope.of, &row.place)?;
            self.write(format_args!("{label}"));
            return Ok(());
        }
        *row = ahead;
        // A value that is neither a number nor a name is reported when the line is read later.
        let is_name = written
            .iter()
            .any(|b| b.is_ascii_alphabetic() || !b.is_ascii());
        if !is_name && !written.contains(&b'"') {
            self.out.text().extend_from_slice(written);
            return Ok(());
        }
        let name = String::from_utf8_lossy(written).replace('"', "");
        if scope.of.is_none()
            && let Some((instance, label)) = self.without_assembly(&name).rsplit_once('.')
            && let Ok(label) = label.parse::<u64>()
            && let Some(instance) = self.instances.find(instance)
        {
            let label = self.number(label, Some(instance), &row.place)?;
            self.write(format_args!("{label}"));
            return Ok(());
        }
        let name = self.qualified(&name, scope.of);
        self.write(format_args!("\"{name}\""));
        Ok(())
    }

    /// Converts a number within an instance into the number in the whole deck.
    fn number(&self, label: u64, of: Option<usize>, place: &Where) -> Result<u64> {
        let offset = of.map_or(0, |instance| self.instances.offset(instance));
        if label <= self.instances.most() {
            return Ok(offset + label);
        }
        Err(place.error(match of {
            Some(instance) => {
                let name = &self.instances.names()[instance];
                format!("instance {name} has no node or element {label}; give one that it has")
            }
            None => format!(
                "there is no node or element {label}{}",
                self.instances.hint(0)
            ),
        }))
    }

    /// Converts the name of a set or surface of an instance into the name in the whole deck.
    fn qualified(&self, name: &str, of: Option<usize>) -> String {
        match of {
            Some(instance) => format!("{}.{name}", self.instances.names()[instance]),
            None => self.without_assembly(name).to_string(),
        }
    }

    /// Removes the assembly's name, which may precede a name outside of parts.
    fn without_assembly<'n>(&self, name: &'n str) -> &'n str {
        match name.split_once('.') {
            Some((first, rest))
                if first.eq_ignore_ascii_case(self.assembly)
                    && self.instances.find(first).is_none() =>
            {
                rest
            }
            _ => name,
        }
    }

    fn numbers(&mut self, mut between: &str, numbers: &[f64]) {
        for x in numbers {
            self.write(format_args!("{between}{x:?}"));
            between = ", ";
        }
    }

    fn write(&mut self, what: std::fmt::Arguments) {
        // Writing to a vector cannot fail.
        let _ = self.out.text().write_fmt(what);
    }
}
