//! Checks that reading a scene loses nothing that the user wrote.
//!
//! serde's derived code accepts an array in place of a table (by position) and silently drops the
//! surplus entries of an array of fixed length. Therefore the scene is written out again and
//! compared with the document: every array must come back as an array of the same length, every
//! table as a table.

use super::document::join;
use super::{KeyPlaces, Scene};
use crate::error::{Error, Result};
use toml::Value;
use toml::de::{DeTable, DeValue};

/// Compares the scene with the document it was read from.
///
/// # Errors
/// `Input` with the key and place of an array that is too long, or that stands where a table
/// belongs.
pub(super) fn check(scene: &Scene, document: &DeTable<'_>, places: &KeyPlaces) -> Result<()> {
    let written = Value::try_from(scene)
        .map_err(|cause| Error::internal("a scene cannot be written as TOML").because(cause))?;
    table(document, &written, "", places)
}

fn table(document: &DeTable<'_>, written: &Value, path: &str, places: &KeyPlaces) -> Result<()> {
    for (key, value) in document {
        let key = key.get_ref();
        if let Some(written) = written.get(key.as_ref()) {
            compare(value.get_ref(), written, &join(path, key), places)?;
        }
    }
    Ok(())
}

fn compare(document: &DeValue<'_>, written: &Value, path: &str, places: &KeyPlaces) -> Result<()> {
    match (document, written) {
        (DeValue::Table(inner), _) => table(inner, written, path, places),
        (DeValue::Array(_), Value::Table(keys)) => {
            let known: Vec<&str> = keys.keys().map(String::as_str).collect();
            let error = Error::input(format!(
                "{path}: wrong type: array, expected a table with keys such as {}",
                known.join(", ")
            ));
            Err(places.in_front(path, error))
        }
        (DeValue::Array(items), Value::Array(kept)) if items.len() == kept.len() => {
            for (index, (item, kept)) in items.iter().zip(kept).enumerate() {
                compare(
                    item.get_ref(),
                    kept,
                    &join(path, &index.to_string()),
                    places,
                )?;
            }
            Ok(())
        }
        (DeValue::Array(items), Value::Array(kept)) => {
            let error = Error::input(format!(
                "{path}: wrong number of values: {}, expected {}",
                items.len(),
                kept.len()
            ));
            Err(places.in_front(path, error))
        }
        _ => Ok(()),
    }
}
