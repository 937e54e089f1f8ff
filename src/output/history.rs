//! `history.csv`: a row per accepted increment, with the event that ended it. Columns are the
//! fields of [`HistoryRow`]. `path.csv`: points between these rows, for curves. Columns are those
//! of [`PathPoint`].

use super::table;
use crate::results::{HistoryRow, PathPoint};
use std::io::{self, Write};

/// Writes the history.
///
/// # Errors
/// Those of `out`.
pub(super) fn write(out: &mut impl Write, history: &[HistoryRow]) -> io::Result<()> {
    table::write(out, &HistoryRow::default(), history.iter().cloned())
}

/// Writes the points between the rows.
///
/// # Errors
/// Those of `out`.
pub(super) fn write_path(out: &mut impl Write, points: &[PathPoint]) -> io::Result<()> {
    table::write(out, &PathPoint::default(), points.iter().copied())
}
