//! Values at nodes from a file, by the number of the node.

use super::gmsh::node_data;
use crate::deck::{Deck, is_deck};
use crate::error::Result;
use std::path::Path;

/// Reads them: of a Gmsh file the one section `$NodeData`; of a deck, for each of its nodes, the
/// largest change of its temperature.
///
/// # Errors
/// Errors of reading the file.
pub(crate) fn read(path: &Path) -> Result<Vec<(u64, f64)>> {
    match is_deck(path) {
        true => Deck::read(path)?.node_temperatures(),
        false => node_data::read(path),
    }
}
