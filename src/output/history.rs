//! `history.csv`: a row per accepted increment, with the event that ended it. Columns are the fields
//! of [`HistoryRow`].

use super::table;
use crate::results::HistoryRow;
use std::io::{self, Write};

/// Writes the history.
///
/// # Errors
/// Those of `out`.
pub(super) fn write(out: &mut impl Write, history: &[HistoryRow]) -> io::Result<()> {
    table::write(out, &HistoryRow::default(), history.iter().cloned())
}
