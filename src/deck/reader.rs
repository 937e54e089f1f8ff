//! Reads a deck, keyword by keyword.

mod amplitude;
mod contact;
mod history;
mod mesh;
mod output;
mod properties;
mod rigid;
mod volume;

use super::absent::leave_out_absent;
use super::adjust::adjust;
use super::assembly::{self, Assembled};
use super::data::{Account, Condition, Rigid};
use super::fields::LineFields;
use super::keyword::{Keyword, Use};
use super::source::{DeckLines, Line};
use super::{Deck, LinePlace};
use crate::error::Result;
use crate::files;
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
    /// As for [`Deck::read`].
    pub fn parse(text: &[u8], name: &str) -> Result<Deck> {
        Reader::new(DeckLines::new(Cow::Borrowed(text), name, None)).read()
    }
}

/// A deck that is being read.
struct Reader<'t> {
    source: DeckLines<'t>,
    deck: Deck,
    /// The material to which the next keywords belong.
    material: Option<String>,
    /// The surface interaction to which the next keywords belong.
    interaction: Option<String>,
    /// A coupling whose axes have not been read yet.
    coupling: Option<Rigid>,
    is_in_step: bool,
    /// Whether output requests are for histories (`*OUTPUT, HISTORY`).
    is_history: bool,
    /// Displacements that are given before the first step, and are reached over the first step.
    of_first_step: Vec<Condition>,
    /// Number of conditions of the first step that were given before it.
    n_before: usize,
    /// Requests at time points, with the name of the points.
    time_points_wanted: Vec<(Keyword, String)>,
}

impl<'t> Reader<'t> {
    pub(super) fn new(source: DeckLines<'t>) -> Self {
        Reader {
            source,
            deck: Deck::default(),
            material: None,
            interaction: None,
            coupling: None,
            is_in_step: false,
            is_history: false,
            of_first_step: Vec::new(),
            n_before: 0,
            time_points_wanted: Vec::new(),
        }
    }

    /// Reads the deck to its end.
    ///
    /// # Errors
    /// `Input` with file, line and keyword if the deck is damaged; `Unsupported` for elements that
    /// brinell does not have. Other effects that it does not have are listed in the account.
    pub(super) fn read(mut self) -> Result<Deck> {
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
                false => self.block(&keyword)?,
            }
        }
        self.check_time_points();
        let here = self.source.here();
        self.deck.files = self.source.files;
        self.deck.end = here;
        let deck = &mut self.deck;
        let (elements, sets) = (&mut deck.mesh.elements, &mut deck.sets.elements);
        for (name, place) in deck.boundary.take_faces_of_solids(elements, sets) {
            let how =
                format!("TYPE={name}: beside solids, without stiffness; sets of them are surfaces");
            let list = &mut deck.account.taken;
            Account::add(list, &deck.files, place, "ELEMENT", &how);
        }
        deck.mesh.index(&deck.files)?;
        leave_out_absent(deck)?;
        adjust(deck);
        Ok(self.deck)
    }

    /// Continues with the deck flattened: each instance of a part has nodes, elements, sets and
    /// surfaces of its own.
    fn flatten(&mut self, first: Keyword) -> Result<()> {
        let model = Assembled::read(&mut self.source, first)?;
        let deck = &mut self.deck;
        let labels = deck
            .mesh
            .nodes
            .labels
            .iter()
            .chain(&deck.mesh.elements.labels);
        deck.mesh.instances = model.instances(&self.source, labels.copied().max())?;
        let anew = model.flat(&self.source, &deck.mesh.instances)?;
        for part in model.unused_parts() {
            self.ignore(part, part.place, "no *INSTANCE is made of it");
        }
        for keyword in model.frame() {
            self.understand(keyword);
        }
        if let Some((keyword, how)) = model.note(&self.deck.mesh.instances) {
            self.take(keyword, keyword.place, &how);
        }
        self.source.go_on_with(anew);
        Ok(())
    }

    fn understand(&mut self, keyword: &Keyword) {
        let files = &self.source.files;
        let first = || (0, files.show(keyword.place));
        let understood = &mut self.deck.account.understood;
        let entry = understood.entry(keyword.name.clone());
        entry.or_insert_with(first).0 += 1;
    }

    fn block(&mut self, keyword: &Keyword) -> Result<()> {
        match keyword.what_for() {
            Ok(Use::Read) => {
                self.understand(keyword);
                self.read_block(keyword)
            }
            Ok(Use::Ignored(why)) => {
                self.ignore(keyword, keyword.place, why);
                self.skip()
            }
            Ok(Use::Refused(why)) => {
                self.refuse(keyword, keyword.place, why);
                self.skip()
            }
            Err(message) => Err(keyword.error(&self.source.files, message)),
        }
    }

    fn read_block(&mut self, keyword: &Keyword) -> Result<()> {
        match keyword.name.as_str() {
            "HEADING" => self.heading(keyword),
            "NODE" => self.nodes(keyword),
            "ELEMENT" => self.elements(keyword),
            "NSET" => self.set(keyword, "NSET"),
            "ELSET" => self.set(keyword, "ELSET"),
            "SURFACE" => self.surface(keyword),
            "MATERIAL" => self.material(keyword),
            "ELASTIC" => self.elastic(keyword),
            "PLASTIC" => self.plastic(keyword),
            "DENSITY" => self.density(keyword),
            "EXPANSION" => self.expansion(keyword),
            "TEMPERATURE" => self.temperature(keyword),
            "SOLID SECTION" => self.section(keyword),
            "SURFACE INTERACTION" => self.interaction(keyword),
            "SURFACE BEHAVIOR" => self.behavior(keyword),
            "FRICTION" => self.friction(keyword),
            "CONTACT PAIR" => self.contact_pair(keyword),
            "CLEARANCE" => self.clearance(keyword),
            "CONTACT INTERFERENCE" => self.contact_interference(keyword),
            "TIE" => self.tie(keyword),
            "RIGID BODY" => self.rigid_body(keyword),
            "COUPLING" => self.coupling(keyword),
            "KINEMATIC" => self.kinematic(keyword),
            "EQUATION" => self.equation(keyword),
            "TRANSFORM" => self.transform(keyword),
            "INITIAL CONDITIONS" => self.initial_conditions(keyword),
            "AMPLITUDE" => self.amplitude(keyword),
            "STEP" => self.step(keyword),
            "STATIC" => self.statics(keyword),
            "BOUNDARY" => self.boundary(keyword),
            "CLOAD" => self.cload(keyword),
            "MODEL CHANGE" => self.model_change(keyword),
            "DLOAD" => self.dload(keyword),
            "DSLOAD" => self.dsload(keyword),
            "END STEP" => self.end_step(keyword),
            "OUTPUT" => self.output(keyword),
            "TIME POINTS" => self.time_points(keyword),
            "NODE FILE" | "NODE OUTPUT" | "NODE PRINT" | "EL FILE" | "ELEMENT OUTPUT"
            | "EL PRINT" | "CONTACT FILE" | "CONTACT OUTPUT" | "CONTACT PRINT"
            | "SECTION PRINT" => self.request(keyword),
            other => Err(crate::Error::internal(format!("nothing reads *{other}"))),
        }
    }

    /// Skips the data lines of a keyword.
    fn skip(&mut self) -> Result<()> {
        while self.source.next_data()?.is_some() {}
        Ok(())
    }

    /// Requires that a keyword has no more data lines.
    fn no_more(&mut self, keyword: &Keyword) -> Result<()> {
        match self.source.next_data()? {
            Some(line) => {
                let fields = fields(&self.source, keyword, line);
                Err(fields.place.error("this line is one too many; take it out"))
            }
            None => Ok(()),
        }
    }

    fn ignore(&mut self, keyword: &Keyword, place: LinePlace, why: &str) {
        let list = &mut self.deck.account.ignored;
        Account::add(list, &self.source.files, place, &keyword.name, why);
    }

    fn refuse(&mut self, keyword: &Keyword, place: LinePlace, why: &str) {
        let list = &mut self.deck.account.refused;
        Account::add(list, &self.source.files, place, &keyword.name, why);
    }

    fn take(&mut self, keyword: &Keyword, place: LinePlace, how: &str) {
        let list = &mut self.deck.account.taken;
        Account::add(list, &self.source.files, place, &keyword.name, how);
    }

    /// Reads the next data line, which is required.
    fn one_line(&mut self, keyword: &Keyword, what: &str) -> Result<Line> {
        self.source.next_data()?.ok_or_else(|| {
            let message = format!("a line with {what} should follow; give it");
            keyword.error(&self.source.files, message)
        })
    }

    /// Reads the heading, whose first line is the title.
    fn heading(&mut self, keyword: &Keyword) -> Result<()> {
        keyword.allow(&self.source.files, &[])?;
        while let Some(line) = self.source.next_data()? {
            let text = String::from_utf8_lossy(self.source.bytes(line)).into_owned();
            self.deck.heading.push(text);
        }
        Ok(())
    }
}

/// The values of a data line.
fn fields<'a>(source: &'a DeckLines, keyword: &'a Keyword, line: Line) -> LineFields<'a> {
    LineFields::new(
        source.bytes(line),
        keyword.at(source.file(line), line.place),
    )
}
