//! `history.csv`: a row per accepted increment, with the event that ended it. The columns are the
//! fields of [`HistoryRow`], followed by the columns that the scene asks for
//! ([`crate::scene::Program::history`]). `path.csv`: points between these rows, for curves. The
//! columns are the fields of [`PathPoint`], followed by the columns that the scene asks for,
//! interpolated linearly between the rows.

use super::rows::rows;
use super::table;
use crate::error::{Error, Result};
use crate::files;
use crate::results::{HistoryRow, PathPoint, Results};
use std::io::{self, Write};
use std::path::Path;

/// Writes the history.
///
/// # Errors
/// Errors of `out`.
pub(super) fn write(out: &mut impl Write, results: &Results) -> io::Result<()> {
    let rows = results.history.iter();
    let rows = rows.map(|row| (row.clone(), row.measured.clone()));
    table::write_with(out, &HistoryRow::default(), &results.history_columns, rows)
}

/// Writes the points between the rows.
///
/// # Errors
/// Errors of `out`.
pub(super) fn write_path(out: &mut impl Write, results: &Results) -> io::Result<()> {
    let points = results.path.iter();
    let points = points.map(|point| (*point, between(results, point)));
    table::write_with(out, &PathPoint::default(), &results.history_columns, points)
}

/// Interpolates the columns that the scene asks for at a point of the path between two rows.
fn between(results: &Results, point: &PathPoint) -> Vec<f64> {
    let row = |number: usize| results.history.get(number.checked_sub(1)?);
    let ends = point.increment.checked_sub(1).and_then(row);
    let Some((from, to)) = ends.zip(row(point.increment)) else {
        return vec![f64::NAN; results.history_columns.len()];
    };
    let share = (point.alpha - from.alpha) / (to.alpha - from.alpha);
    let values = from.measured.iter().zip(&to.measured);
    values.map(|(a, b)| a + share * (b - a)).collect()
}

/// Reads the history as it was written, and the names of the columns that the scene asked for.
///
/// # Errors
/// Errors of [`rows`]; `Input` with the row and column of a cell that is no number.
pub(super) fn read(path: &Path) -> Result<(Vec<HistoryRow>, Vec<String>)> {
    let mut history: Vec<HistoryRow> = rows(path)?;
    let text = files::read("read", path, None)?;
    let mut reader = csv::Reader::from_reader(&text[..]);
    let damaged = |row: usize, column: &str| {
        Error::input(format!(
            "{}: row {row}: {column} is damaged",
            path.display()
        ))
    };
    let own = table::keys(&HistoryRow::default()).map_err(|e| Error::io("read", path, e))?;
    let headers = reader.headers().cloned().unwrap_or_default();
    let added = (0..headers.len()).filter(|&column| !own.iter().any(|key| *key == headers[column]));
    let added: Vec<usize> = added.collect();
    if added.is_empty() {
        return Ok((history, Vec::new()));
    }
    for (index, (row, cells)) in history.iter_mut().zip(reader.records()).enumerate() {
        let cells = cells.map_err(|cause| damaged(index + 1, "the row").because(cause))?;
        for &column in &added {
            let value = match cells.get(column) {
                Some("") => Ok(f64::NAN),
                cell => cell.unwrap_or("no cell").parse(),
            };
            row.measured
                .push(value.map_err(|_| damaged(index + 1, &headers[column]))?);
        }
    }
    let columns = added.iter().map(|&column| headers[column].to_string());
    Ok((history, columns.collect()))
}
