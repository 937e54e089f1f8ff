//! What a run left, read back: its summary and a table by columns.

use crate::error::{Error, Result};
use crate::files;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The content of a summary.
///
/// # Errors
/// `Io` where it cannot be read, `Input` where it is none of brinell.
pub(crate) fn summary(path: &Path) -> Result<Value> {
    let text = files::read_text("read the results", path, None)
        .map_err(|error| error.within("no directory of results that brinell wrote"))?;
    let summary: Value = serde_json::from_str(&text).map_err(|cause| {
        Error::input(format!("{}: not valid JSON", path.display())).because(cause)
    })?;
    if summary["brinell"].is_string() {
        Ok(summary)
    } else {
        Err(Error::input(format!(
            "{}: not a summary of brinell (it has no key `brinell`)",
            path.display()
        )))
    }
}

/// A CSV file by columns.
pub(crate) struct Rows {
    path: PathBuf,
    head: csv::StringRecord,
    rows: Vec<csv::StringRecord>,
}

impl Rows {
    /// Reads a file.
    ///
    /// # Errors
    /// `Input` where it cannot be read as CSV.
    pub(crate) fn read(path: &Path) -> Result<Self> {
        let damaged = |cause: csv::Error| {
            Error::input(format!("{}: cannot be read as CSV", path.display())).because(cause)
        };
        let text = files::read("read", path, None)?;
        let mut reader = csv::Reader::from_reader(&text[..]);
        Ok(Rows {
            head: reader.headers().map_err(damaged)?.clone(),
            rows: reader
                .records()
                .collect::<std::result::Result<_, _>>()
                .map_err(damaged)?,
            path: path.to_path_buf(),
        })
    }

    /// The file, for messages.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Number of rows.
    pub(super) fn len(&self) -> usize {
        self.rows.len()
    }

    /// The text in a row and a column.
    ///
    /// # Errors
    /// A column that there is not.
    pub(super) fn text(&self, row: usize, name: &str) -> Result<&str> {
        let place = self.head.iter().position(|n| n == name).ok_or_else(|| {
            Error::input(format!(
                "{}: there is no column `{name}`",
                self.path.display()
            ))
        })?;
        Ok(self.rows[row].get(place).unwrap_or_default())
    }

    /// The number in a row and a column; an empty cell is not a number.
    ///
    /// # Errors
    /// A column that there is not, a cell that holds something else.
    pub(super) fn number(&self, row: usize, name: &str) -> Result<f64> {
        match self.text(row, name)? {
            "" => Ok(f64::NAN),
            cell => (cell.parse()).map_err(|_| self.refused(row, name, cell, "no number")),
        }
    }

    /// The count or index in a row and a column.
    ///
    /// # Errors
    /// A column that there is not, a cell that holds something else.
    pub(super) fn count(&self, row: usize, name: &str) -> Result<usize> {
        let cell = self.text(row, name)?;
        (cell.parse()).map_err(|_| self.refused(row, name, cell, "no whole number"))
    }

    /// What is wrong with a cell.
    pub(super) fn refused(&self, row: usize, name: &str, cell: &str, why: &str) -> Error {
        Error::input(format!(
            "{}: row {}: `{name}` is {cell:?}, which is {why}",
            self.path.display(),
            row + 1
        ))
    }

    /// The numbers of a column.
    ///
    /// # Errors
    /// As for each of its cells.
    #[cfg(feature = "cli")]
    pub(crate) fn column(&self, name: &str) -> Result<Vec<f64>> {
        (0..self.len()).map(|row| self.number(row, name)).collect()
    }
}
