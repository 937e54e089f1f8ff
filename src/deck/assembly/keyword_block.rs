//! A keyword of a deck with its data lines.

use crate::deck::fields::LineFields;
use crate::deck::keyword::Keyword;
use crate::deck::source::{DeckLines, Line};
use crate::error::Result;

/// A keyword with its data lines.
pub(super) struct KeywordBlock {
    pub(super) keyword: Keyword,
    pub(super) lines: Vec<Line>,
}

impl KeywordBlock {
    /// The values of one of the block's lines.
    pub(super) fn fields<'a>(&'a self, source: &'a DeckLines, line: Line) -> LineFields<'a> {
        let place = self.keyword.at(source.file(line), line.place);
        LineFields::new(source.bytes(line), place)
    }

    /// Requires the block to have no more than `n` data lines.
    pub(super) fn no_more(&self, source: &DeckLines, n: usize) -> Result<()> {
        self.lines.get(n).map_or(Ok(()), |&line| {
            let place = self.fields(source, line).place;
            Err(place.error("this line is one too many; take it out"))
        })
    }

    /// Whether the keyword is one of some names.
    pub(super) fn is(&self, names: &[&str]) -> bool {
        names.contains(&self.keyword.name.as_str())
    }
}
