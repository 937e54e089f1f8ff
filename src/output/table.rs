//! Rows as CSV: a header, full precision, an empty cell for a number that is not finite. Texts are
//! quoted as RFC 4180 requires; control characters in them, which a terminal would obey, are
//! written out, so that a row is a line.

use crate::text::shown_in_line;
use serde::Serialize;
use serde_json::Value;
use std::io::{self, Write};

/// Writes `rows` under a header made of the keys of `Row` (taken from `sample`, so that a table
/// without rows has its header too).
///
/// # Errors
/// Errors of `out`.
pub(super) fn write<Row: Serialize>(
    out: &mut impl Write,
    sample: &Row,
    rows: impl IntoIterator<Item = Row>,
) -> io::Result<()> {
    write_with(
        out,
        sample,
        &[],
        rows.into_iter().map(|row| (row, Vec::new())),
    )
}

/// Writes a table like [`write`], with more columns of the given names after those of the rows, and
/// the numbers of these columns beside each row.
///
/// # Errors
/// Errors of `out`.
pub(super) fn write_with<Row: Serialize>(
    out: &mut impl Write,
    sample: &Row,
    columns: &[String],
    rows: impl IntoIterator<Item = (Row, Vec<f64>)>,
) -> io::Result<()> {
    let mut csv = csv::Writer::from_writer(out);
    let own = keys(sample)?;
    let names = columns.iter().map(|name| shown_in_line(name).into_owned());
    csv.write_record(own.into_iter().chain(names))?;
    for (row, numbers) in rows {
        let own = cells(&row)?.into_iter().map(|(_, cell)| cell);
        let numbers = numbers.into_iter().map(|number| cell(number.into()));
        csv.write_record(own.chain(numbers))?;
    }
    csv.flush()
}

/// Returns the names of the columns, which are the fields of a row.
///
/// # Errors
/// A row without named fields.
pub(super) fn keys(sample: &impl Serialize) -> io::Result<Vec<String>> {
    Ok(cells(sample)?.into_iter().map(|(key, _)| key).collect())
}

/// Returns the keys and cells of a row. The row is converted to JSON values, in which numbers that
/// are not finite are null.
fn cells(row: &impl Serialize) -> io::Result<Vec<(String, String)>> {
    let Value::Object(fields) = serde_json::to_value(row)? else {
        return Err(io::Error::other("a row of a table has no named columns"));
    };
    // Lists are left out: their values are in columns of their own.
    let fields = fields.into_iter().filter(|(_, value)| !value.is_array());
    Ok(fields.map(|(key, value)| (key, cell(value))).collect())
}

fn cell(value: Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => shown_in_line(&text).into_owned(),
        other => other.to_string(),
    }
}
