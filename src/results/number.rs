//! Numbers of files that may not be finite.

use serde::{Deserialize, Deserializer};

/// Reads a number that was written as null, or as an empty cell, if it was not finite.
pub(crate) fn number<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    // Checkpoints are binary and can hold every number.
    if !from.is_human_readable() {
        return f64::deserialize(from);
    }
    Ok(Option::<f64>::deserialize(from)?.unwrap_or(f64::NAN))
}
