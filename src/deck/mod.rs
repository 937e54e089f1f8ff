//! Decks of Abaqus and CalculiX (`.inp`): a model with its steps, converted into a scene and a
//! mesh.
//!
//! ```text
//!  text ─▶ source ─▶ reader ─▶ Deck ─▶ resolve ─▶ history ─▶ conversion ─▶ Scene
//!          (lines,    (a reader  (what it  (sets,     (steps,    (supports, loads,
//!           places,    per        says)     bodies,    series     targets; sets they
//!           INCLUDE)   keyword)             faces)     in time)   are on)          ─▶ mesh::inp
//! ```
//!
//! Decks with parts and an assembly are flattened before they are read (`assembly`).
//!
//! All data that are read have a place, and errors name it: file, line, keyword, value, what to do.
//! Keywords for effects that brinell does not have are either ignored, if they change nothing here,
//! or refused; [`Deck::account`] lists both, with the reason. Names are not case-sensitive.
//!
//! Each step becomes a target (`step-1`, ...). Load factors are multiples of the loads if
//! everything that changes does so in proportion, step by step; otherwise load factors are the
//! time.
//!
//! # Source
//! G. Dhondt, *CalculiX CrunchiX User's Manual* 2.20, chapters 6 (elements, loads) and 7
//! (keywords); *Abaqus Keywords Reference Guide*.

mod adjust;
mod assembly;
mod bodies;
mod boundary;
mod boundary_elements;
mod constraints;
mod conversion;
mod data;
mod element_type;
mod expansion;
mod facets;
mod fields;
mod history;
mod instances;
mod keyword;
mod linear;
mod load;
mod node_slaves;
mod reader;
mod rigid;
mod series;
mod sets;
mod source;
mod temperature;
#[cfg(test)]
mod tests;
pub(crate) mod words;

pub use conversion::{Conversion, Options};
pub use data::{Account, Note};
pub(crate) use element_type::face_number;
pub use load::{is_deck, load, load_with};

use crate::error::{Error, Result};
use crate::labels::LabelIndex;
use crate::shape::Shape;
use crate::space::Vector;
use boundary_elements::BoundaryElements;
use data::{DeckElements, DeckProgram, Nodes, Properties, Sets};
use instances::Instances;
use source::{Files, LinePlace};

/// A deck that has been read.
#[derive(Default)]
pub struct Deck {
    /// Lines of the heading.
    heading: Vec<String>,
    files: Files,
    nodes: Nodes,
    elements: DeckElements,
    /// Boundary elements, which have no stiffness: sets of them stand for faces.
    boundary: BoundaryElements,
    sets: Sets,
    properties: Properties,
    program: DeckProgram,
    account: Account,
    /// Instances of parts, which determine the numbering of nodes and elements.
    instances: Instances,
    /// First place at which large deformation is requested.
    nlgeom: Option<LinePlace>,
    /// Place of the end of the deck.
    end: LinePlace,
    node_index: LabelIndex,
    element_index: LabelIndex,
    /// Indices of the nodes of all elements, one element after the other.
    connectivity: Vec<u32>,
}

impl Deck {
    /// The account of what was understood, interpreted differently, ignored, and refused.
    pub fn account(&self) -> &Account {
        &self.account
    }

    /// Builds the indices of nodes and elements by number, and the connectivity.
    fn index(&mut self) -> Result<()> {
        if self.nodes.labels.len().max(self.elements.labels.len()) >= u32::MAX as usize {
            return Err(Error::input("more nodes or elements than can be numbered"));
        }
        let twice = |what: &str, labels: &[u64], places: &[LinePlace], label: u64| {
            let mut all = labels.iter().zip(places).filter(|(l, _)| **l == label);
            let place = all.nth(1).map_or(LinePlace::default(), |(_, place)| *place);
            let place = self.files.show(place);
            let label = self.instances.shown(label);
            Error::input(format!(
                "{place}: *{what}: number {label} is given twice; number them uniquely"
            ))
        };
        let (nodes, elements) = (&self.nodes, &self.elements);
        self.node_index = LabelIndex::new(&nodes.labels)
            .map_err(|label| twice("NODE", &nodes.labels, &nodes.places, label))?;
        self.element_index = LabelIndex::new(&elements.labels)
            .map_err(|label| twice("ELEMENT", &elements.labels, &elements.places, label))?;
        let index = |label: &u64| self.node_index.get(*label);
        let found: Option<Vec<u32>> = self.elements.nodes.iter().map(index).collect();
        self.connectivity = found.ok_or_else(|| self.missing_node())?;
        Ok(())
    }

    /// An error for the first element that refers to an undefined node.
    fn missing_node(&self) -> Error {
        let elements = &self.elements;
        let is_missing = |label: &&u64| self.node_index.get(**label).is_none();
        let missing = (elements.offsets.windows(2).enumerate()).find_map(|(element, ends)| {
            let label = elements.nodes[ends[0]..ends[1]].iter().find(is_missing)?;
            Some((element, label))
        });
        let (element, label) = missing.unwrap_or((0, &0));
        let (name, label) = (self.element_name(element), self.instances.shown(*label));
        let message = format!("element {name} refers to node {label}, which is not in *NODE");
        self.error(elements.places[element], "ELEMENT", message)
    }

    /// An error at a line, for a keyword.
    fn error(&self, place: LinePlace, keyword: &str, message: impl std::fmt::Display) -> Error {
        let place = self.files.show(place);
        Error::input(format!("{place}: *{keyword}: {message}"))
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
    fn node_name(&self, node: usize) -> String {
        match self.nodes.labels.get(node) {
            Some(label) => self.instances.shown(*label),
            None => "of a rotation".to_string(),
        }
    }

    /// The number of an element for messages; in an instance the number within the part.
    fn element_name(&self, element: usize) -> String {
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

    /// An error at the line of a node.
    pub(crate) fn node_error(&self, node: usize, message: impl std::fmt::Display) -> Error {
        self.error(self.nodes.places[node], "NODE", message)
    }

    /// Whether no element has a type that CalculiX integrates in another way than fully, or for
    /// quadratic elements reduced. Other ways are one point with hourglass control and incompatible
    /// modes.
    pub fn is_fully_integrated(&self) -> bool {
        let mut types = self.elements.types.iter();
        types.all(|of| of.shape.is_quadratic() || of.note.is_none())
    }

    /// Number of nodes of the deck.
    pub fn n_nodes(&self) -> usize {
        self.nodes.labels.len()
    }

    /// Number of elements of the deck.
    pub fn n_elements(&self) -> usize {
        self.elements.labels.len()
    }
}
