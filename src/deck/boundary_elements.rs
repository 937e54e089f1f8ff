//! Boundary elements of a deck, by their numbers.

use super::source::LinePlace;
use std::collections::BTreeMap;

/// Boundary elements by their numbers: lines and shells, and plane elements in a mesh with solids.
#[derive(Debug, Clone, Default)]
pub(super) struct BoundaryElements {
    /// Nodes of each boundary element, as numbered in the deck.
    pub(super) nodes: BTreeMap<u64, Vec<u64>>,
    /// Place at which each type is named first.
    pub(super) types: BTreeMap<String, LinePlace>,
}

impl BoundaryElements {
    pub(super) fn add(&mut self, label: u64, nodes: Vec<u64>) {
        self.nodes.insert(label, nodes);
    }

    pub(super) fn note_type(&mut self, name: &str, place: LinePlace) {
        self.types.entry(name.to_string()).or_insert(place);
    }

    pub(super) fn has(&self, label: u64) -> bool {
        self.nodes.contains_key(&label)
    }

    /// Whether a boundary element has a number in the range `[first, last, step]`.
    pub(super) fn any_of(&self, [first, last, step]: [u64; 3]) -> bool {
        let mut between = self.nodes.range(first..=last);
        between.any(|(label, _)| (label - first).is_multiple_of(step))
    }
}
