//! Rows as CSV: a header, full precision, an empty cell where a number is not finite. Texts are
//! quoted where RFC 4180 asks for it; what a terminal would obey in them is written out, so that a
//! row is a line.

use crate::text::shown_in_line;
use serde::Serialize;
use serde_json::Value;
use std::io::{self, Write};

/// Writes `rows` under a header made of the keys of `Row` (those of `sample`, so that a table
/// without rows has its header too).
///
/// # Errors
/// Those of `out`.
pub(super) fn write<Row: Serialize>(
    out: &mut impl Write,
    sample: &Row,
    rows: impl IntoIterator<Item = Row>,
) -> io::Result<()> {
    let mut csv = csv::Writer::from_writer(out);
    csv.write_record(cells(sample)?.iter().map(|(key, _)| key))?;
    for row in rows {
        csv.write_record(cells(&row)?.iter().map(|(_, cell)| cell))?;
    }
    csv.flush()
}

/// Keys and cells of a row. By way of JSON values, where numbers that are not finite are null.
fn cells(row: &impl Serialize) -> io::Result<Vec<(String, String)>> {
    let Value::Object(fields) = serde_json::to_value(row)? else {
        return Err(io::Error::other("a row of a table has no named columns"));
    };
    Ok(fields
        .into_iter()
        .map(|(key, value)| {
            let cell = match value {
                Value::Null => String::new(),
                Value::String(text) => shown_in_line(&text).into_owned(),
                other => other.to_string(),
            };
            (key, cell)
        })
        .collect())
}
