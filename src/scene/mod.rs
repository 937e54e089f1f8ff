//! The scene file: what the user asks for, as data.
//!
//! The types here mirror the TOML file key by key; unknown keys are errors. Units are the user's
//! own and must be consistent (for instance N, mm, MPa). [`Scene::load`] reads a file,
//! [`Scene::parse`] a string, [`Scene::load_with`] a file with overridden values
//! (`program.steps=40`).
//!
//! ```text
//!  text ─▶ document ─▶ overrides ─▶ read ─▶ validate ─▶ Scene
//!          (TOML, every  (--set)     (types,  (values,
//!           key placed)               keys)    references)
//! ```

mod accuracy;
mod boundary;
mod catalogue;
mod complete;
mod defaults;
mod direction;
mod document;
mod equation;
mod field;
mod geometry;
mod key_places;
mod listed_materials;
mod load_action;
mod local_refinement;
mod material;
mod over_temperature;
mod overrides;
mod program;
mod read;
mod reference;
mod requests;
mod rigid;
mod schema;
pub(crate) mod span;
mod spelling;
mod target;
mod tensile_test;
mod units;
mod unsupported;
mod validate;

pub use accuracy::AccuracyDemand;
pub use boundary::{
    Contact, Displacement, History, Kirsch, Load, PlaneForce, Rotation, SlaveSide, Support, Tie,
};
pub use catalogue::{Listed, Published, materials};
pub use direction::Direction;
pub use equation::{Equation, EquationTerm, Relative};
pub use field::{Field, NodalField, VectorField};
pub use geometry::{
    Block, BrickPart, CurvedBodies, CylinderOnHalfPlane, Disc, DiscInPlate, Extrusion, Formulation,
    MeshSource, Meshed, Part, Piece, Revolution, Ring, SurfaceCircle, SurfaceCylinder,
    SurfaceSphere, SurfaceTorus,
};
pub use key_places::KeyPlaces;
pub use load_action::{LoadAction, NodeAction, VolumeAction};
pub use local_refinement::LocalRefinement;
pub use material::{Body, Material, MaterialRow, Plastic};
pub use program::{
    LEAST_PATH_ERROR, PlasticIteration, Program, Settings, Stepping, Unit, YieldMethod,
};
pub(crate) use reference::PlaceQuantity;
pub use reference::{NoParameters, RadiusOnly, Reference, TwoBodies};
pub use requests::{
    ContactForce, FileRequest, LooseAxis, LooseNode, Moment, NamedSet, Print, Requests, ResultItem,
    Totals,
};
pub use rigid::{
    RigidCone, RigidCylinder, RigidHeights, RigidPlane, RigidPunch, RigidSphere, RigidSurface,
    RigidTorus,
};
pub use schema::schema;
pub(crate) use spelling::closest;
pub use target::{DisplacementTarget, Target, TargetFigure};
pub(crate) use tensile_test::beyond_yield;
pub use units::Units;

/// The kind of a scene: the name in scene files for the [`Space`] of the model.
pub use crate::space::Space as Kind;

use self::span::Span;
use crate::space::Space;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A whole scene: mesh, materials, contacts, loads and their program.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Title of the scene, one line for the reader of results.
    #[serde(default)]
    pub title: String,
    /// Plane strain, plane stress, axisymmetric or solid.
    pub kind: Space,
    /// Names of the scene's units, for reports: no number of the scene is converted.
    pub units: Option<Units>,
    /// Number of copies of the model in the whole: 1 (the default) if all of it is meshed, 2 for a
    /// half model, 4 for a quarter model, 8 for an eighth of a solid. Total forces (`force`,
    /// `plane_force`) in the scene, and loads and contact forces in the results, are those of the
    /// whole; the model carries its share of them.
    #[serde(default = "defaults::single")]
    pub symmetry: usize,
    /// The source of the mesh: a generator or a file.
    pub mesh: MeshSource,
    /// The result directory of an earlier run on the same mesh, relative to the scene file. This
    /// run begins with the plastic strains, hardening and back stresses that the earlier run left,
    /// and hence with its residual stresses. It begins without load, and contacts are open unless
    /// the residual state presses them together.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start_from: Option<PathBuf>,
    /// Materials by name. Materials from the list that `brinell materials` prints need no entry.
    #[serde(default)]
    pub materials: BTreeMap<String, Material>,
    /// Bodies by name; the names are those of the bodies of the mesh.
    pub bodies: BTreeMap<String, Body>,
    /// Rigid surfaces by name. They need no mesh; `contact`, `load` and `history` refer to them by
    /// name like surfaces of the mesh.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub rigid: BTreeMap<String, RigidSurface>,
    /// Pairs of surfaces that may touch.
    #[serde(default)]
    pub contact: Vec<Contact>,
    /// Pairs of surfaces that stay together (tied contact).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tie: Vec<Tie>,
    /// Linear equations between displacements.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub equation: Vec<Equation>,
    /// Supports of node sets and surfaces.
    #[serde(default)]
    pub support: Vec<Support>,
    /// Loads, each with its own history over the load program.
    #[serde(default)]
    pub load: Vec<Load>,
    /// The load program.
    pub program: Program,
    /// Settings of the computation; every value has a default that suits most scenes.
    #[serde(default)]
    pub analysis: Settings,
    /// How wrong the results may be, such as `"1 %"` or `"load = 0.5 %, dent = 2 %"`. The scene is
    /// run on finer and finer meshes of its family until the stated errors are within this
    /// accuracy. In Rust `accuracy::reach` does so; an `Analysis` runs on the mesh that the scene
    /// describes.
    #[serde(default)]
    pub accuracy: Option<AccuracyDemand>,
    /// Published or exact values to compare with the computed ones.
    #[serde(default)]
    pub reference: Vec<Reference>,
    /// The file from which the scene was read; relative paths in the scene are relative to it.
    #[serde(skip)]
    pub file: Option<PathBuf>,
    /// Places of the scene's keys in its file or among the overrides, for messages.
    #[serde(skip)]
    pub places: KeyPlaces,
    /// Warnings that arose while the scene was read.
    #[serde(skip)]
    pub warnings: Vec<String>,
    /// Results that are requested in the formats of CalculiX, as a deck does.
    #[serde(skip)]
    pub requests: Requests,
}

impl Scene {
    /// How the increments of the program are chosen. In plane stress `auto` means `events`, because
    /// the path of plastic flow within an increment is not followed there.
    pub fn stepping(&self) -> Stepping {
        match (self.program.stepping, self.kind) {
            (Stepping::Auto, Kind::PlaneStress) => Stepping::Events,
            (stepping, _) => stepping,
        }
    }

    /// Path of the directory that `start_from` names.
    pub(crate) fn start_folder(&self) -> Option<PathBuf> {
        Some(self.beside(self.start_from.as_ref()?))
    }

    /// Resolves a path given in the scene, which is relative to the scene's file.
    pub(crate) fn beside(&self, path: &Path) -> PathBuf {
        let folder = self.file.as_deref().and_then(Path::parent);
        folder.map_or(path.to_path_buf(), |folder| folder.join(path))
    }

    /// The material of a body at the body's temperature; `None` if the scene does not have the body
    /// or its material.
    pub fn material_of(&self, body: &str) -> Option<Cow<'_, Material>> {
        let body = self.bodies.get(body)?;
        let material = self.materials.get(&body.material)?;
        Some(match body.temperature {
            Some(temperature) if !material.over_temperature.is_empty() => {
                Cow::Owned(material.at(temperature))
            }
            _ => Cow::Borrowed(material),
        })
    }

    /// Whether this body can yield: its material has a yield stress, and the scene does not declare
    /// the body elastic. False for a body that the scene does not have.
    pub fn can_yield(&self, body: &str) -> bool {
        let of = self.bodies.get(body).zip(self.material_of(body));
        of.is_some_and(|(body, material)| {
            body.plastic != Plastic::No && material.first_yield_stress().is_some()
        })
    }

    /// Whether any body can yield.
    pub fn any_can_yield(&self) -> bool {
        self.bodies.keys().any(|body| self.can_yield(body))
    }

    /// Whether any load changes with the load factor.
    pub fn any_load_varies(&self) -> bool {
        self.load.iter().any(|load| load.history.varies())
    }

    /// Whether any body can yield, or might: a body whose material is not defined counts as able to
    /// yield. The missing material is reported elsewhere, and checks that need a yielding body must
    /// not report a second error because of it.
    fn may_yield(&self) -> bool {
        let mut bodies = self.bodies.values();
        self.any_can_yield() || bodies.any(|body| !self.materials.contains_key(&body.material))
    }

    /// The load factors at which supports or prescribed displacements begin or end, ascending.
    pub(crate) fn changes_of_support(&self) -> Vec<f64> {
        let mut changes: Vec<f64> = self.spans().flat_map(|(_, span)| span.changes()).collect();
        changes.sort_by(f64::total_cmp);
        changes.dedup();
        changes
    }

    /// The span of each support and each load, with its key in the scene.
    pub(crate) fn spans(&self) -> impl Iterator<Item = (String, Span)> + '_ {
        let supports = self.support.iter().enumerate();
        let supports = supports.map(|(index, of)| (format!("support.{index}"), of.span()));
        let loads = self.load.iter().enumerate();
        supports.chain(loads.map(|(index, of)| (format!("load.{index}"), of.span())))
    }

    /// All fields of loads and contacts, which may depend on the position.
    pub(crate) fn fields(&self) -> impl Iterator<Item = &Field> {
        let of_loads = self
            .load
            .iter()
            .flat_map(Load::fields)
            .map(|(_, field)| field);
        let of_contacts = self.contact.iter().flat_map(Contact::fields);
        of_loads.chain(of_contacts.map(|(_, field)| field))
    }

    /// The names of all sets and surfaces of the mesh that the scene refers to, and of the bodies
    /// on which volume loads act.
    pub(crate) fn set_names(&self) -> impl Iterator<Item = &str> {
        let contacts = self.contact.iter().flat_map(|c| [&c.first, &c.second]);
        let ties = self.tie.iter().flat_map(|tie| [&tie.first, &tie.second]);
        let terms = self.equation_terms();
        let targets = self.program.targets.iter();
        let of_contacts = self.contact.iter().filter_map(|c| c.nodes.as_ref());
        contacts
            .chain(of_contacts)
            .chain(ties)
            .chain(terms.map(|term| &term.on))
            .chain(self.support.iter().map(|support| &support.on))
            .chain(self.load.iter().map(|load| &load.on))
            .chain(targets.filter_map(|target| Some(&target.displacement.as_ref()?.on)))
            .chain(&self.program.history)
            .map(String::as_str)
    }

    /// The terms of all equations, and those that prescribed differences subtract.
    pub(crate) fn equation_terms(&self) -> impl Iterator<Item = &EquationTerm> {
        let relative = self.load.iter().filter_map(|load| load.relative.as_ref());
        let of_equations = self.equation.iter().flat_map(|equation| &equation.terms);
        of_equations.chain(relative.flat_map(|relative| &relative.terms))
    }

    /// An otherwise empty scene of this kind: all of the model is meshed, and the program is the
    /// default one.
    pub(crate) fn of(kind: Space) -> Self {
        Scene {
            title: String::new(),
            kind,
            units: None,
            symmetry: 1,
            mesh: MeshSource::default(),
            start_from: None,
            materials: BTreeMap::new(),
            bodies: BTreeMap::new(),
            rigid: BTreeMap::new(),
            contact: Vec::new(),
            tie: Vec::new(),
            equation: Vec::new(),
            support: Vec::new(),
            load: Vec::new(),
            program: Program::default(),
            analysis: Settings::default(),
            accuracy: None,
            reference: Vec::new(),
            file: None,
            places: KeyPlaces::default(),
            warnings: Vec::new(),
            requests: Requests::default(),
        }
    }
}
