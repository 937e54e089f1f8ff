//! Reading the files of a run: its summary, and the rows of its tables.

use super::summary::Summary;
use crate::error::{Error, Result};
use crate::files;
use serde::de::DeserializeOwned;
use std::path::Path;

/// Reads a summary.
///
/// # Errors
/// `Io` if it cannot be read, `Input` if it is not a summary of brinell or is damaged.
pub(crate) fn summary(path: &Path) -> Result<Summary> {
    let text = files::read_text("read the results", path, None)
        .map_err(|error| error.within("no directory of results that brinell wrote"))?;
    let summary: Summary = serde_json::from_str(&text).map_err(|cause| {
        Error::input(format!("{}: no summary of brinell", path.display())).because(cause)
    })?;
    match summary.brinell {
        Some(_) => Ok(summary),
        None => Err(Error::input(format!(
            "{}: not a summary of brinell (it has no key `brinell`)",
            path.display()
        ))),
    }
}

/// Returns the rows of a CSV file whose columns are the fields of a type, and maybe others. An
/// empty cell is read as NaN.
///
/// # Errors
/// `Io` if it cannot be read; `Input` with the row, counted from 1, that is damaged or lacks a
/// column.
pub(crate) fn rows<Row: DeserializeOwned>(path: &Path) -> Result<Vec<Row>> {
    let text = files::read("read", path, None)?;
    let mut reader = csv::Reader::from_reader(&text[..]);
    let rows = reader.deserialize().enumerate();
    rows.map(|(row, read)| {
        read.map_err(|cause: csv::Error| {
            let place = format!("{}: row {}", path.display(), row + 1);
            Error::input(format!("{place} is damaged")).because(cause)
        })
    })
    .collect()
}
