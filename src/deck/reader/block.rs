//! A keyword of a deck with the data lines that follow it.

use crate::deck::data::Account;
use crate::deck::fields::LineFields;
use crate::deck::keyword::Keyword;
use crate::deck::source::{DeckLines, Line, LinePlace};
use crate::error::{Error, Result};

/// A keyword whose data lines are being read, with the account of what becomes of it.
pub(super) struct BlockReader<'r, 't> {
    pub(super) keyword: &'r Keyword,
    pub(super) source: &'r mut DeckLines<'t>,
    pub(super) account: &'r mut Account,
}

/// A data line: its place and its values.
type DataRow<'a> = (LinePlace, LineFields<'a>);

impl<'r> BlockReader<'r, '_> {
    /// Counts the keyword among those that are understood.
    pub(super) fn understand(&mut self) {
        let first = || (0, self.source.files.show(self.keyword.place));
        let entry = self.account.understood.entry(self.keyword.name.clone());
        entry.or_insert_with(first).0 += 1;
    }

    /// Requires that the keyword has no parameters but known ones, named in capitals.
    pub(super) fn allow(&self, known: &str) -> Result<()> {
        let known: Vec<&str> = known.split_whitespace().collect();
        self.keyword.allow(&self.source.files, &known)
    }

    /// The value of a required parameter.
    pub(super) fn require(&self, key: &str) -> Result<&'r str> {
        self.keyword.require(&self.source.files, key)
    }

    /// The value of a parameter that is a number.
    pub(super) fn number(&self, key: &str) -> Result<Option<f64>> {
        self.keyword.number(&self.source.files, key)
    }

    /// The value of a parameter that is one of some words, by default the first of them.
    pub(super) fn choice(&self, key: &str, words: &[&'static str]) -> Result<&'static str> {
        self.keyword.choice(&self.source.files, key, words)
    }

    /// An error at the line of the keyword.
    pub(super) fn error(&self, message: impl std::fmt::Display) -> Error {
        self.keyword.error(&self.source.files, message)
    }

    /// The next data line.
    pub(super) fn row(&mut self) -> Result<Option<DataRow<'_>>> {
        let line = self.source.next_data()?;
        Ok(line.map(|line| self.values(line)))
    }

    fn values(&self, line: Line) -> DataRow<'_> {
        let at = self.keyword.at(self.source.file(line), line.place);
        (line.place, LineFields::new(self.source.bytes(line), at))
    }

    /// The next data line, which is required.
    pub(super) fn one_row(&mut self, what: &str) -> Result<DataRow<'_>> {
        match self.source.next_data()? {
            Some(line) => Ok(self.values(line)),
            None => Err(self.error(format!("a line with {what} should follow; give it"))),
        }
    }

    /// The next data line as it is written.
    pub(super) fn text(&mut self) -> Result<Option<String>> {
        let line = self.source.next_data()?;
        let text = |line| String::from_utf8_lossy(self.source.bytes(line)).into_owned();
        Ok(line.map(text))
    }

    /// Reads lines that each name a slave and a master surface; at least one line is required.
    pub(super) fn pairs(&mut self) -> Result<Vec<(LinePlace, [String; 2])>> {
        let mut pairs = Vec::new();
        while let Some((place, mut row)) = self.row()? {
            let slave = row.text("the slave surface")?;
            let master = row.text("the master surface")?;
            row.end()?;
            pairs.push((place, [slave, master]));
        }
        if pairs.is_empty() {
            let message = "a line with the slave and the master surface should follow; give it";
            return Err(self.error(message));
        }
        Ok(pairs)
    }

    /// Skips the data lines.
    pub(super) fn skip(&mut self) -> Result<()> {
        while self.source.next_data()?.is_some() {}
        Ok(())
    }

    /// Requires that no more data lines follow.
    pub(super) fn no_more(&mut self) -> Result<()> {
        match self.row()? {
            Some((_, row)) => Err(row.place.error("this line is one too many; take it out")),
            None => Ok(()),
        }
    }

    /// Remarks that the keyword is without effect here.
    pub(super) fn ignore(&mut self, why: &str) {
        let Keyword { name, place, .. } = self.keyword;
        self.account.ignore(&self.source.files, *place, name, why);
    }

    /// Remarks that the keyword asks for an effect that brinell does not have.
    pub(super) fn refuse(&mut self, why: &str) {
        self.refuse_at(self.keyword.place, why);
    }

    /// Remarks that a data line asks for an effect that brinell does not have.
    pub(super) fn refuse_at(&mut self, place: LinePlace, why: &str) {
        let name = &self.keyword.name;
        self.account.refuse(&self.source.files, place, name, why);
    }

    /// Remarks that the keyword is interpreted differently from its meaning.
    pub(super) fn take(&mut self, how: &str) {
        let Keyword { name, place, .. } = self.keyword;
        self.account.take(&self.source.files, *place, name, how);
    }
}
