//! Nodes and elements of a deck, with their numbers.

use super::element_type::ElementType;
use super::instances::Instances;
use super::source::{Files, LinePlace};
use crate::error::{Error, Result};
use crate::labels::LabelIndex;
use crate::shape::Shape;
use crate::space::{Vector, difference, length};

/// Nodes of a deck, in the order of the deck.
#[derive(Debug, Clone, Default)]
pub(super) struct Nodes {
    pub(super) labels: Vec<u64>,
    /// Coordinates, three per node.
    pub(super) coordinates: Vec<f64>,
    pub(super) places: Vec<LinePlace>,
}

/// Elements of a deck, in the order of the deck.
#[derive(Debug, Clone, Default)]
pub(super) struct DeckElements {
    pub(super) labels: Vec<u64>,
    pub(super) types: Vec<ElementType>,
    /// Index in `nodes` at which each element's nodes begin, followed by the end of the last
    /// element's nodes.
    pub(super) offsets: Vec<usize>,
    /// Numbers of the nodes of all elements, one element after the other.
    pub(super) nodes: Vec<u64>,
    pub(super) places: Vec<LinePlace>,
}

impl DeckElements {
    /// Keeps only the elements that are wanted, selected by index.
    pub(super) fn retain(&mut self, wanted: impl Fn(usize) -> bool) {
        let old = std::mem::take(self);
        self.offsets.push(0);
        for element in (0..old.labels.len()).filter(|&element| wanted(element)) {
            self.labels.push(old.labels[element]);
            self.types.push(old.types[element]);
            self.places.push(old.places[element]);
            let nodes = &old.nodes[old.offsets[element]..old.offsets[element + 1]];
            self.nodes.extend_from_slice(nodes);
            self.offsets.push(self.nodes.len());
        }
    }
}

/// Nodes and elements of a deck, found by their numbers.
#[derive(Default)]
pub(crate) struct DeckMesh {
    pub(super) nodes: Nodes,
    pub(super) elements: DeckElements,
    /// Instances of parts, which determine the numbering of nodes and elements.
    pub(super) instances: Instances,
    pub(super) node_index: LabelIndex,
    pub(super) element_index: LabelIndex,
    /// Indices of the nodes of all elements, one element after the other.
    pub(super) connectivity: Vec<u32>,
}

impl DeckMesh {
    /// Builds the indices of nodes and elements by number, and the connectivity.
    pub(super) fn index(&mut self, files: &Files) -> Result<()> {
        if self.nodes.labels.len().max(self.elements.labels.len()) >= u32::MAX as usize {
            return Err(Error::input("more nodes or elements than can be numbered"));
        }
        let twice = |what: &str, labels: &[u64], places: &[LinePlace], label: u64| {
            let mut all = labels.iter().zip(places).filter(|(l, _)| **l == label);
            let place = all.nth(1).map_or(LinePlace::default(), |(_, place)| *place);
            let label = self.instances.shown(label);
            let message = format!("number {label} is given twice; number them uniquely");
            files.error(place, what, message)
        };
        let (nodes, elements) = (&self.nodes, &self.elements);
        self.node_index = LabelIndex::new(&nodes.labels)
            .map_err(|label| twice("NODE", &nodes.labels, &nodes.places, label))?;
        self.element_index = LabelIndex::new(&elements.labels)
            .map_err(|label| twice("ELEMENT", &elements.labels, &elements.places, label))?;
        let index = |label: &u64| self.node_index.get(*label);
        let found: Option<Vec<u32>> = self.elements.nodes.iter().map(index).collect();
        self.connectivity = found.ok_or_else(|| self.missing_node(files))?;
        Ok(())
    }

    /// An error for the first element that refers to an undefined node.
    fn missing_node(&self, files: &Files) -> Error {
        let elements = &self.elements;
        let is_missing = |label: &&u64| self.node_index.get(**label).is_none();
        let missing = (elements.offsets.windows(2).enumerate()).find_map(|(element, ends)| {
            let label = elements.nodes[ends[0]..ends[1]].iter().find(is_missing)?;
            Some((element, label))
        });
        let (element, label) = missing.unwrap_or((0, &0));
        let (name, label) = (self.element_name(element), self.instances.shown(*label));
        let message = format!("element {name} refers to node {label}, which is not in *NODE");
        files.error(elements.places[element], "ELEMENT", message)
    }

    /// Number of nodes of the deck.
    pub(crate) fn n_nodes(&self) -> usize {
        self.nodes.labels.len()
    }

    /// Number of elements of the deck.
    pub(crate) fn n_elements(&self) -> usize {
        self.elements.labels.len()
    }

    /// The number of a node in the deck.
    pub(crate) fn node_label(&self, node: usize) -> u64 {
        self.nodes.labels[node]
    }

    /// The number of an element in the deck.
    pub(crate) fn element_label(&self, element: usize) -> u64 {
        self.elements.labels[element]
    }

    /// The number of a node for messages; in an instance the number within the part.
    pub(super) fn node_name(&self, node: usize) -> String {
        match self.nodes.labels.get(node) {
            Some(label) => self.instances.shown(*label),
            None => "of a rotation".to_string(),
        }
    }

    /// The number of an element for messages; in an instance the number within the part.
    pub(super) fn element_name(&self, element: usize) -> String {
        self.instances.shown(self.elements.labels[element])
    }

    /// The shape of an element.
    pub(crate) fn shape(&self, element: usize) -> Shape {
        self.elements.types[element].shape
    }

    /// The coordinates of a node.
    pub(crate) fn point(&self, node: usize) -> Vector {
        let at = 3 * node;
        std::array::from_fn(|d| self.nodes.coordinates[at + d])
    }

    /// Indices of the nodes of an element.
    pub(crate) fn element_nodes(&self, element: usize) -> &[u32] {
        let offsets = &self.elements.offsets;
        &self.connectivity[offsets[element]..offsets[element + 1]]
    }

    /// Dimension of the first element, and hence of the model.
    pub(super) fn dimension(&self) -> usize {
        let first = self.elements.types.first();
        first.map_or(3, |first| first.space.dimension())
    }

    /// The diagonal of the bounding box of all nodes.
    pub(super) fn diagonal(&self) -> f64 {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for node in 0..self.n_nodes() {
            for (d, x) in self.point(node).into_iter().enumerate() {
                low[d] = low[d].min(x);
                high[d] = high[d].max(x);
            }
        }
        length(difference(high, low))
    }
}
