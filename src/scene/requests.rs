//! Results that are requested in the formats of CalculiX: `.frd` files and tables in `.dat` files.

use crate::space::Vector;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Results that are requested in the formats of CalculiX, state by state.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Requests {
    /// Whether stresses and strains at the integration points are kept for the states whose fields
    /// are written.
    pub point_values: bool,
    /// Lines that describe the model.
    pub heading: Vec<String>,
    /// Names of materials and surface interactions, in the order of the deck.
    pub materials: Vec<String>,
    /// Thickness of a plane model: forces are totals over this thickness.
    pub thickness: Option<f64>,
    /// Local axes of nodes, by node number: tables list displacements and forces of these nodes
    /// along their local axes.
    pub axes: Arc<BTreeMap<u64, [Vector; 3]>>,
    /// Nodes of a deck that belong to no element, by node number.
    pub loose: Arc<BTreeMap<u64, LooseNode>>,
    /// The place at which a deck asks for large displacements, which are computed as small ones.
    pub large: Option<String>,
    /// The moment of the deck's program that each target stands for, in the order of the targets.
    pub moments: Vec<Moment>,
}

/// A node of a deck that belongs to no element but occurs in equations, a reference node for
/// instance. Its displacement and its force are weighted sums of the displacements and forces of
/// other nodes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LooseNode {
    /// The sums along the axes of the node ([`Requests::axes`]).
    pub axes: [LooseAxis; 3],
}

/// Displacement and force of a node without elements along one axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LooseAxis {
    /// Terms of the displacement: number of a node of the mesh, number of its axis, coefficient.
    pub displacement: Vec<(u64, u8, f64)>,
    /// The part of the displacement that is prescribed: rows of time and value, between which it
    /// is linear.
    pub prescribed: Vec<[f64; 2]>,
    /// Terms of the force, which is the sum of the forces on the nodes that follow this one.
    pub force: Vec<(u64, u8, f64)>,
}

/// A moment of a deck's program, with the results that are requested there.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Moment {
    /// Number of the step, from 1.
    pub step: usize,
    /// Number of the increment within the step, from 1.
    pub increment: usize,
    /// Time since the beginning of the first step. `None` for a scene without a deck, which has no
    /// time: the load factor of the state is used instead.
    pub time: Option<f64>,
    /// Time since the beginning of the step.
    pub step_time: f64,
    /// Results for the `.frd` file, in the order of the file.
    pub file: Vec<FileRequest>,
    /// Tables for the `.dat` file, in the order in which that file lists them.
    pub prints: Vec<Print>,
}

/// A result that is requested at nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct FileRequest {
    /// The result that is written.
    pub item: ResultItem,
    /// Nodes at which the result is written; all nodes if `None`.
    pub nodes: Option<NamedSet>,
    /// Whether vectors are given along x, y, z even for nodes with local axes.
    pub is_global: bool,
}

/// A table of a result on a set of nodes or elements.
#[derive(Debug, Clone, PartialEq)]
pub struct Print {
    /// The result that is written.
    pub item: ResultItem,
    /// Set to which the table refers: nodes for displacements and forces, elements for the other
    /// results. For the force of a contact the set holds the number of the contact, counted from 0.
    pub set: NamedSet,
    /// Whether the values of the table are summed.
    pub totals: Totals,
    /// Whether vectors are given along x, y, z even for nodes with local axes.
    pub is_global: bool,
    /// Faces of the surface for a force through a surface: the number of the element and its local
    /// facet ([`crate::mesh::Facet::local`]). Empty for other results.
    pub faces: Arc<Vec<(u64, u8)>>,
}

/// A set of nodes or elements, given by their numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedSet {
    /// Name of the set.
    pub name: String,
    /// Numbers of the nodes or elements, in the order of the table.
    pub labels: Arc<Vec<u64>>,
}

/// Whether and how the values of a table are summed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Totals {
    /// The values without a sum.
    #[default]
    No,
    /// The values and their sum.
    Yes,
    /// The sum without the values.
    Only,
}

/// A result that a `.frd` or `.dat` file can contain, in the order of a `.frd` file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ResultItem {
    /// Displacements (`U`).
    Displacement,
    /// Stresses (`S`).
    Stress,
    /// Total strains (`E`).
    TotalStrain,
    /// External forces: loads and reactions (`RF`).
    Force,
    /// Equivalent plastic strain (`PEEQ`).
    PlasticStrain,
    /// Gap and pressure of contact (`CDIS`, `CSTR`).
    Contact,
    /// Recovered stresses, from a polynomial fitted around each node (`ZZS`).
    RecoveredStress,
    /// Jump of the stress between neighbouring elements (`ERR`).
    StressJump,
    /// Volumes of elements (`EVOL`), in tables only.
    Volume,
    /// Force and moment through a surface (`SOF`, `SOM`, `SOAREA`), in tables only.
    Section,
    /// Force of a contact (`CF`, `CFN`, `CFS`), in tables only.
    ContactForce(ContactForce),
}

/// A part of the force of a contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ContactForce {
    /// Total force (`CF`).
    Total,
    /// Component normal to the surfaces (`CFN`).
    Normal,
    /// Component tangential to the surfaces (`CFS`).
    Shear,
}

impl ResultItem {
    /// Results of a `.frd` file if none are named.
    pub const USUAL: [ResultItem; 6] = [
        ResultItem::Displacement,
        ResultItem::Stress,
        ResultItem::TotalStrain,
        ResultItem::Force,
        ResultItem::PlasticStrain,
        ResultItem::Contact,
    ];

    /// Whether the result is computed from values at integration points.
    pub fn needs_points(self) -> bool {
        use ResultItem::{PlasticStrain, Section, Stress, StressJump, TotalStrain};
        matches!(
            self,
            Stress | TotalStrain | PlasticStrain | StressJump | Section
        )
    }
}

impl Requests {
    /// Whether a deck asks for results in a `.frd` file.
    pub fn has_file(&self) -> bool {
        self.is_of_deck() && self.moments.iter().any(|moment| !moment.file.is_empty())
    }

    /// Whether the requests come from a deck and not from the command line alone. A deck always
    /// names a material.
    pub fn is_of_deck(&self) -> bool {
        !self.materials.is_empty()
    }

    /// Requests the usual results in each of `n_targets` states, unless the requests already have
    /// moments; without a deck each state is a step of its own.
    pub fn ask_for_usual(&mut self, n_targets: usize) {
        let request = |item| FileRequest {
            item,
            nodes: None,
            is_global: true,
        };
        let usual = || ResultItem::USUAL.map(request).to_vec();
        if self.moments.is_empty() {
            let moment = |number| Moment {
                step: number,
                increment: 1,
                step_time: 1.0,
                ..Moment::default()
            };
            self.moments = (1..=n_targets).map(moment).collect();
        }
        for moment in &mut self.moments {
            if moment.file.is_empty() {
                moment.file = usual();
            }
        }
    }
}
