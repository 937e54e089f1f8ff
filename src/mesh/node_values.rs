//! Values at nodes read from a file, by node number.

use super::gmsh::node_data;
use crate::deck::{Deck, is_deck, largest_changes};
use crate::error::Result;
use std::path::Path;

/// Reads values at nodes: from a Gmsh file the only section `$NodeData`; from a deck the largest
/// change of temperature at each of its nodes.
///
/// # Errors
/// The errors of reading the file.
pub(crate) fn read(path: &Path) -> Result<Vec<(u64, f64)>> {
    match is_deck(path) {
        true => largest_changes(&Deck::read(path)?),
        false => node_data::read(path),
    }
}
