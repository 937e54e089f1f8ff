//! Reads a deck, keyword by keyword.

mod amplitude;
mod block;
mod contact;
mod history;
mod mesh;
mod output;
mod properties;
mod rigid;
mod volume;

use super::Deck;
use super::absent::leave_out_absent;
use super::adjust::adjust;
use super::assembly::{self, Assembled};
use super::data::{Account, Properties};
use super::keyword::{Keyword, Use};
use super::mesh::DeckMesh;
use super::source::{DeckLines, Files};
use crate::error::Result;
use crate::files;
use amplitude::amplitude;
use block::BlockReader;
use contact::InteractionReader;
use history::StepReader;
use output::RequestReader;
use properties::MaterialReader;
use rigid::RigidReader;
use std::borrow::Cow;
use std::path::Path;

impl Deck {
    /// Reads a deck and the files that it includes, whose paths are relative to the deck's
    /// directory.
    ///
    /// # Errors
    /// `Io` if a file cannot be read; `Input` with file, line and keyword if the deck is damaged or
    /// has an unknown keyword; `Unsupported` for elements that brinell does not have.
    pub fn read(path: &Path) -> Result<Deck> {
        let text = files::read("read the deck", path, None)?;
        let name = path.display().to_string();
        Reader::new(DeckLines::new(Cow::Owned(text), &name, path.parent())).read()
    }

    /// Reads a deck from the bytes of a file; `name` stands for the file in messages. Paths of
    /// included files are relative to the working directory.
    ///
    /// ```
    /// use brinell::deck::Deck;
    ///
    /// let error = Deck::parse(b"*NODE\n1, 0., zero", "block.inp").err().unwrap();
    /// let expected = "block.inp, line 2: *NODE: y is `zero`; give a finite number";
    /// assert_eq!(error.to_string(), expected);
    /// ```
    ///
    /// # Errors
    /// Errors of [`Deck::read`].
    pub fn parse(text: &[u8], name: &str) -> Result<Deck> {
        Reader::new(DeckLines::new(Cow::Borrowed(text), name, None)).read()
    }
}

/// A deck that is being read.
struct Reader<'t> {
    source: DeckLines<'t>,
    account: Account,
    contents: DeckContents,
}

/// Data that the keywords of a deck have given so far.
#[derive(Default)]
struct DeckContents {
    deck: Deck,
    materials: MaterialReader,
    interactions: InteractionReader,
    rigid: RigidReader,
    steps: StepReader,
    requests: RequestReader,
}

impl<'t> Reader<'t> {
    fn new(source: DeckLines<'t>) -> Self {
        Reader {
            source,
            account: Account::default(),
            contents: DeckContents::default(),
        }
    }

    /// Reads the deck to its end.
    ///
    /// # Errors
    /// `Input` with file, line and keyword if the deck is damaged; `Unsupported` for elements that
    /// brinell does not have. Other effects that it does not have are listed in the account.
    fn read(mut self) -> Result<Deck> {
        if let Some(line) = self.source.next_data()? {
            let place = self.source.files.show(line.place);
            return Err(crate::Error::input(format!(
                "{place}: this is not a deck of Abaqus or CalculiX: it should begin with a keyword \
                 such as *HEADING or *NODE"
            )));
        }
        while let Some(line) = self.source.next()? {
            let keyword = Keyword::read(&mut self.source, line)?;
            match assembly::frames(&keyword) {
                true => self.flatten(keyword)?,
                false => self.read_block(&keyword)?,
            }
        }
        let end = self.source.here();
        let mut deck = self.contents.finish(self.source.files, self.account);
        deck.end = end;
        take_faces_of_solids(&mut deck);
        deck.mesh.index(&deck.files)?;
        leave_out_absent(&mut deck)?;
        adjust(&mut deck);
        Ok(deck)
    }

    /// A keyword, to be read or remarked on.
    fn block<'r>(&'r mut self, keyword: &'r Keyword) -> BlockReader<'r, 't> {
        BlockReader {
            keyword,
            source: &mut self.source,
            account: &mut self.account,
        }
    }

    /// Continues with the deck flattened: each instance of a part has nodes, elements, sets and
    /// surfaces of its own.
    fn flatten(&mut self, first: Keyword) -> Result<()> {
        let model = Assembled::read(&mut self.source, first)?;
        let DeckMesh {
            nodes,
            elements,
            instances,
            ..
        } = &mut self.contents.deck.mesh;
        let labels = nodes.labels.iter().chain(&elements.labels);
        *instances = model.instances(&self.source, labels.copied().max())?;
        let anew = model.flat(&self.source, instances)?;
        let note = model.note(instances);
        for part in model.unused_parts() {
            self.block(part).ignore("no *INSTANCE is made of it");
        }
        for keyword in model.frame() {
            self.block(keyword).understand();
        }
        if let Some((keyword, how)) = note {
            self.block(keyword).take(&how);
        }
        self.source.go_on_with(anew);
        Ok(())
    }

    fn read_block(&mut self, keyword: &Keyword) -> Result<()> {
        let block = &mut BlockReader {
            keyword,
            source: &mut self.source,
            account: &mut self.account,
        };
        match keyword.what_for() {
            Ok(Use::Read) => {
                block.understand();
                self.contents.read(block)
            }
            Ok(Use::Ignored(why)) => {
                block.ignore(why);
                block.skip()
            }
            Ok(Use::Refused(why)) => {
                block.refuse(why);
                block.skip()
            }
            Err(message) => Err(block.error(message)),
        }
    }
}

impl DeckContents {
    /// The deck, before its numbers and names are looked up.
    fn finish(self, files: Files, mut account: Account) -> Deck {
        let (program, properties) = (self.steps.program, self.deck.properties);
        (self.requests).check_time_points(&program.time_points, &files, &mut account);
        Deck {
            files,
            account,
            program,
            nlgeom: self.steps.nlgeom,
            properties: Properties {
                materials: self.materials.all,
                interactions: self.interactions.all,
                rigid: self.rigid.bodies,
                ..properties
            },
            ..self.deck
        }
    }

    fn read(&mut self, block: &mut BlockReader) -> Result<()> {
        let DeckContents {
            deck,
            materials,
            interactions,
            rigid,
            steps,
            requests,
        } = self;
        let (properties, mesh, sets) = (&mut deck.properties, &mut deck.mesh, &mut deck.sets);
        match block.keyword.name.as_str() {
            "HEADING" => heading(block, &mut deck.heading),
            "NODE" => mesh::nodes(block, &mut mesh.nodes, &mut sets.nodes),
            "ELEMENT" => mesh::elements(block, mesh, &mut deck.boundary, &mut sets.elements),
            "NSET" => mesh::set(block, "NSET", sets),
            "ELSET" => mesh::set(block, "ELSET", sets),
            "SURFACE" => mesh::surface(block, &mut sets.surfaces),
            "MATERIAL" => materials.material(block),
            "ELASTIC" => materials.elastic(block),
            "PLASTIC" => materials.plastic(block),
            "DENSITY" => materials.density(block),
            "EXPANSION" => materials.expansion(block),
            "TEMPERATURE" => steps.temperature(block),
            "SOLID SECTION" => properties::section(block, &mut properties.sections),
            "SURFACE INTERACTION" => interactions.interaction(block),
            "SURFACE BEHAVIOR" => interactions.behavior(block),
            "FRICTION" => contact::friction(block),
            "CONTACT PAIR" => contact::contact_pair(block, properties),
            "CLEARANCE" => contact::clearance(block, &mut properties.clearances),
            "CONTACT INTERFERENCE" => {
                contact::contact_interference(block, steps.number(), &mut properties.resolved)
            }
            "TIE" => contact::tie(block, &mut properties.ties),
            "RIGID BODY" => rigid.rigid_body(block),
            "COUPLING" => rigid.coupling(block),
            "KINEMATIC" => rigid.kinematic(block),
            "EQUATION" => properties::equation(block, &mut properties.equations),
            "TRANSFORM" => properties::transform(block, &mut properties.transforms),
            "INITIAL CONDITIONS" => steps.initial_conditions(block),
            "AMPLITUDE" => amplitude(block, &mut steps.program.amplitudes),
            "STEP" => {
                requests.is_history = false;
                steps.step(block)
            }
            "STATIC" => steps.statics(block),
            "BOUNDARY" => steps.boundary(block),
            "CLOAD" => steps.cload(block),
            "MODEL CHANGE" => steps.model_change(block),
            "DLOAD" => steps.dload(block),
            "DSLOAD" => steps.dsload(block),
            "END STEP" => steps.end_step(block),
            "OUTPUT" => requests.output(block, steps),
            "TIME POINTS" => output::time_points(block, &mut steps.program.time_points),
            "NODE FILE" | "NODE OUTPUT" | "NODE PRINT" | "EL FILE" | "ELEMENT OUTPUT"
            | "EL PRINT" | "CONTACT FILE" | "CONTACT OUTPUT" | "CONTACT PRINT"
            | "SECTION PRINT" => requests.request(block, steps),
            other => Err(crate::Error::internal(format!("nothing reads *{other}"))),
        }
    }
}

/// Reads the heading, whose first line is the title.
fn heading(block: &mut BlockReader, heading: &mut Vec<String>) -> Result<()> {
    block.allow("")?;
    while let Some(text) = block.text()? {
        heading.push(text);
    }
    Ok(())
}

/// Turns plane elements beside solids into boundary elements, with a remark on each type.
fn take_faces_of_solids(deck: &mut Deck) {
    let (elements, sets) = (&mut deck.mesh.elements, &mut deck.sets.elements);
    for (name, place) in deck.boundary.take_faces_of_solids(elements, sets) {
        let how =
            format!("TYPE={name}: beside solids, without stiffness; sets of them are surfaces");
        deck.account.take(&deck.files, place, "ELEMENT", &how);
    }
}
