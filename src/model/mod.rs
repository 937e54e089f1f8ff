//! The validated model: freedoms, contact pairs, materials and loads, resolved from scene and mesh.
//!
//! Names become indices here, and every inconsistency between scene and mesh is found. Later
//! modules work with numbers only.

mod alike;
mod body_forces;
mod builder;
mod carried;
mod carried_loads;
mod contact_basis;
mod continuum;
mod depth;
mod ends;
mod equations;
mod far_boundary;
mod fitness;
mod followers;
mod following;
mod frame;
mod freedoms;
mod given;
mod gram;
mod heat;
mod held;
pub(crate) mod images;
mod initial_strain;
mod load_case;
mod load_program;
mod loads;
mod making;
pub(crate) mod mirror;
mod motion_words;
mod motions;
mod names;
mod numbering;
mod on_mesh;
mod openings;
mod pairs;
mod plausible;
mod prescribed;
mod recipe;
mod resolve;
mod rigid;
mod rigid_motion;
mod rows;
mod smooth_surfaces;
mod solved;
mod springs;
mod sums;
mod supports;
pub(crate) mod symmetry;
mod tractions;
mod volume_loads;
mod yield_depth;

pub use builder::ModelBuilder;
pub use contact_basis::ContactBasis;
pub use continuum::Continuum;
pub use frame::Frame;
pub use freedoms::{Freedoms, Prescribed, Slot, Spring};
pub use given::NodePair;
pub use heat::{FreeOfLoad, FreeStrain};
pub use held::{FloatingBodies, Pin};
pub use load_case::{LoadCase, Magnitude};
pub use load_program::{
    DisplacementGoal, FigureGoal, LoadProgram, NodesOfSet, ProgramTarget, TargetCondition,
};
pub use pairs::{AxisPoint, ContactSurface, Pair};
pub use rigid_motion::{RigidMotion, Work};
pub use rows::ContactRows;
pub use sums::Sums;
pub use yield_depth::YieldByDepth;

use crate::results::EndState;
use crate::scene::{Scene, Settings};
use crate::space::Vector;
pub(crate) use far_boundary::volumes_of_nodes;
use given::Given;
pub(crate) use mirror::Mirror;
use rayon::prelude::*;
pub(crate) use recipe::Recipe;
use std::ops::Deref;
use std::path::Path;

/// A model ready to be assembled.
#[derive(Debug, Clone)]
pub struct Model {
    /// Scene from which the model was made.
    pub scene: Scene,
    /// Load program, with its names resolved.
    pub program: LoadProgram,
    /// Settings of the computation.
    pub settings: Settings,
    /// Mesh and materials, to which the model dereferences.
    pub continuum: Continuum,
    /// Freedom numbering, local axes and supports.
    pub freedoms: Freedoms,
    /// Contact pairs, contact by contact, ordered along each surface.
    pub pairs: Vec<Pair>,
    /// Contact rows of the pairs on the free freedoms.
    pub rows: ContactRows,
    /// Contacts of the scene, each with its range of pairs.
    pub contacts: Vec<ContactSurface>,
    /// Loads of the model, with their factors over the program.
    pub loads: Vec<LoadCase>,
    /// Loads whose factors are always equal, as lists of load numbers: each list acts on the
    /// structure as one load vector.
    pub alike: Vec<Vec<usize>>,
    /// Bodies that contact alone holds, and their rigid motions.
    pub floating: FloatingBodies,
    /// Number of copies of the model in the whole. Loads, and results named `load`, are those of
    /// the whole.
    pub symmetry: f64,
    /// Warnings for the user, found while the model was made.
    pub warnings: Vec<String>,
    /// State from which a run starts, once an [`crate::analysis::Analysis`] has read it or an
    /// earlier leg of the program has left it; `None` for a virgin state.
    pub start: Option<EndState>,
    origin: Origin,
}

/// Source of a model, from which it can be made again.
#[derive(Debug, Clone)]
enum Origin {
    /// The scene alone, which makes the model again.
    Scene,
    /// A mesh and data stated node by node, which were handed over in memory.
    Arrays(Given),
}

impl Model {
    /// Number of the load by which results are reported: the first load that varies, or the first
    /// of all if none varies; a load that acts in all legs of the program is preferred.
    pub fn leading_load(&self) -> Option<usize> {
        loads::leading(&self.scene, &self.loads)
    }

    /// The pair of which a state is shown: a contact pair, or the point of a contact on the axis of
    /// revolution that is none.
    pub(crate) fn shown_pair(&self, contact: usize, pair: usize) -> Option<&Pair> {
        let on_axis = || Some(&self.contacts.get(contact)?.axis.as_ref()?.pair);
        self.pairs.get(pair).or_else(on_axis)
    }

    /// Share of the interference of all contacts that is applied at a load factor.
    pub(crate) fn interference_at(&self, alpha: f64) -> f64 {
        let until = self.program.interference_until;
        until.map_or(1.0, |until| (alpha / until).clamp(0.0, 1.0))
    }

    /// Load factors at which the history of a load or of the interference has a kink.
    pub(crate) fn kinks(&self) -> impl Iterator<Item = f64> + '_ {
        let of_loads = self.loads.iter().flat_map(LoadCase::kinks);
        let interferes = || self.pairs.iter().any(|pair| pair.interference != 0.0);
        let until = self.program.interference_until;
        of_loads.chain(until.filter(|_| interferes()))
    }

    /// Factor of each list of loads that change alike, from the factors of all loads.
    pub fn factors_of_alike<'a>(&'a self, factors: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        self.alike.iter().map(|loads| factors[loads[0]])
    }

    /// Data given in addition to the scene.
    fn given(&self) -> Given {
        match &self.origin {
            Origin::Arrays(given) => given.clone(),
            Origin::Scene => Given::default(),
        }
    }

    /// Whether the scene alone makes this model.
    pub(crate) fn is_of_its_scene(&self) -> bool {
        matches!(self.origin, Origin::Scene)
    }

    /// For each contact freedom, whether it is the motion of a rigid surface, or of bodies that
    /// equations let move as rigid ones only. No stiffness acts on such a freedom.
    pub(crate) fn rigid_contact(&self) -> Vec<bool> {
        let of_bodies = self.floating.rigid_freedoms();
        let is_rigid = |&freedom: &usize| {
            let node = self.freedoms.owners[freedom].0 as usize;
            self.freedoms.is_rigid(node) || of_bodies.contains(&freedom)
        };
        self.rows.freedoms.iter().map(is_rigid).collect()
    }

    /// Free strains of all loads of the model.
    pub fn free_of_loads(&self) -> Vec<FreeOfLoad<'_>> {
        let loads = self.loads.iter().enumerate();
        let each = loads.flat_map(|(index, load)| {
            let strains = load.free_strain.iter();
            strains.map(move |strain| FreeOfLoad::new(index, load.body, strain))
        });
        each.collect()
    }

    /// Displacements of all nodes in global axes, from free freedoms and load factors.
    pub fn nodal(&self, u: &[f64], factors: &[f64]) -> Vec<Vector> {
        let nodes = (0..self.mesh.n_nodes()).into_par_iter();
        nodes
            .with_min_len(1 << 14)
            .map(|node| self.freedoms.displacement(node, u, factors))
            .collect()
    }
}

impl Deref for Model {
    type Target = Continuum;

    fn deref(&self) -> &Continuum {
        &self.continuum
    }
}

impl Origin {
    /// The mesh file that the scene names, unless the mesh was handed over in memory.
    fn mesh_file<'s>(&self, scene: &'s Scene) -> Option<&'s Path> {
        match self {
            Origin::Scene => scene.mesh.file.as_deref(),
            Origin::Arrays(_) => None,
        }
    }
}
