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

mod absent;
mod adjust;
mod assembly;
mod bodies;
mod boundary;
mod constraints;
mod conversion;
mod data;
mod element_type;
mod expansion;
mod facets;
mod fields;
mod history;
mod instances;
mod keys;
mod keyword;
mod linear;
mod load;
mod mesh;
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

pub(crate) use bodies::Bodies;
pub(crate) use conversion::Geometry;
pub use conversion::{Conversion, Options};
pub use data::{Account, Note};
pub(crate) use element_type::face_number;
pub use load::{is_deck, load, load_with};
pub(crate) use temperature::largest_changes;

use crate::error::{Error, Result};
use crate::space::Space;
use boundary::BoundaryElements;
use data::{DeckProgram, Properties, Sets};
use mesh::DeckMesh;
use sets::Lookup;
use source::{Files, LinePlace};

/// A deck that has been read.
#[derive(Default)]
pub struct Deck {
    /// Lines of the heading.
    heading: Vec<String>,
    files: Files,
    pub(crate) mesh: DeckMesh,
    /// Boundary elements, which have no stiffness: sets of them stand for faces.
    boundary: BoundaryElements,
    sets: Sets,
    properties: Properties,
    program: DeckProgram,
    account: Account,
    /// First place at which large deformation is requested.
    nlgeom: Option<LinePlace>,
    /// Place of the end of the deck.
    end: LinePlace,
}

impl Deck {
    /// The account of what was understood, interpreted differently, ignored, and refused.
    pub fn account(&self) -> &Account {
        &self.account
    }

    /// Looks up the nodes, elements and faces for which names and numbers in the deck stand.
    fn lookup(&self) -> Lookup<'_> {
        Lookup {
            mesh: &self.mesh,
            boundary: &self.boundary,
            sets: &self.sets,
            files: &self.files,
        }
    }

    /// An error at a line, for a keyword.
    fn error(&self, place: LinePlace, keyword: &str, message: impl std::fmt::Display) -> Error {
        self.files.error(place, keyword, message)
    }

    /// An error at the line of a node.
    pub(crate) fn node_error(&self, node: usize, message: impl std::fmt::Display) -> Error {
        self.error(self.mesh.nodes.places[node], "NODE", message)
    }

    /// The dimension and idealisation common to all elements.
    ///
    /// # Errors
    /// `Input` if there are no elements, or at the first element whose kind differs from that of
    /// the first one.
    pub(crate) fn space(&self) -> Result<Space> {
        let elements = &self.mesh.elements;
        let Some(first) = elements.types.first() else {
            return Err(self.error(self.end, "ELEMENT", "the deck has no elements"));
        };
        let mut types = elements.types.iter();
        match types.position(|other| other.space != first.space) {
            Some(other) => {
                let message = format!(
                    "elements {} after others {}: a model is of plane strain (CPE), of plane \
                     stress (CPS), axisymmetric (CAX) or solid (C3D): give types of one kind",
                    elements.types[other].name(),
                    first.name()
                );
                Err(self.error(elements.places[other], "ELEMENT", message))
            }
            None => Ok(first.space),
        }
    }

    /// Whether CalculiX integrates all linear elements of the deck fully, without hourglass
    /// control, incompatible modes or additional unknowns. Quadratic elements of any type are
    /// accepted.
    pub fn is_fully_integrated(&self) -> bool {
        let mut types = self.mesh.elements.types.iter();
        types.all(|of| of.shape.is_quadratic() || of.note.is_none())
    }

    /// Number of nodes of the deck.
    pub fn n_nodes(&self) -> usize {
        self.mesh.n_nodes()
    }

    /// Number of elements of the deck.
    pub fn n_elements(&self) -> usize {
        self.mesh.n_elements()
    }
}
