//! The validated model: freedoms, contact pairs, materials and loads, resolved from scene and mesh.
//!
//! Names become indices here, and every inconsistency between scene and mesh is found. Later
//! modules work with numbers only.

mod alike;
mod body_forces;
mod builder;
mod carried;
mod contact_basis;
mod continuum;
mod depth;
mod ends;
mod equations;
mod far_boundary;
mod fitness;
mod followers;
mod frame;
mod freedoms;
mod given;
mod gram;
mod heat;
mod held;
pub(crate) mod images;
mod initial_strain;
mod loads;
pub(crate) mod mirror;
mod motions;
mod names;
mod on_mesh;
mod openings;
mod pairs;
mod plausible;
mod prescribed;
mod recipe;
mod rigid;
mod rows;
mod solved;
mod springs;
mod sums;
mod supports;
mod tractions;
mod volume_loads;
mod yield_depth;

pub use builder::ModelBuilder;
pub use contact_basis::ContactBasis;
pub use continuum::Continuum;
pub use frame::Frame;
pub use freedoms::{Freedoms, Prescribed, Slot};
pub use given::NodePair;
pub use heat::{FreeOfLoad, FreeStrain};
pub use held::{FloatingBodies, Pin, RigidMotion, Work};
pub use loads::{LoadCase, Magnitude};
pub use pairs::{AxisPoint, ContactSurface, Pair};
pub use rows::ContactRows;
pub use springs::Spring;
pub use sums::Sums;
pub use yield_depth::YieldByDepth;

use crate::deck::words;
use crate::error::{Error, Result};
use crate::material::Material;
use crate::mesh::{self, Mesh};
use crate::results::EndState;
use crate::scene::{Plastic, Scene};
use crate::space::Vector;
pub(crate) use far_boundary::volumes_of_nodes;
use given::Given;
pub(crate) use mirror::Mirror;
use names::SceneEntry;
use rayon::prelude::*;
pub(crate) use recipe::Recipe;
use std::ops::Deref;
use std::path::Path;

/// A model ready to be assembled.
#[derive(Debug, Clone)]
pub struct Model {
    /// Scene from which the model was made.
    pub scene: Scene,
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
    /// Number of the load by which results are reported: the first that varies, otherwise the
    /// first.
    pub fn leading_load(&self) -> Option<usize> {
        loads::leading(&self.scene, &self.loads)
    }

    /// Share of the interference of all contacts that is applied at a load factor.
    pub(crate) fn interference_at(&self, alpha: f64) -> f64 {
        let until = self.scene.program.interference_until;
        until.map_or(1.0, |until| (alpha / until).clamp(0.0, 1.0))
    }

    /// Load factors at which the history of a load or of the interference has a kink.
    pub(crate) fn kinks(&self) -> impl Iterator<Item = f64> + '_ {
        let of_loads = self.loads.iter().flat_map(LoadCase::kinks);
        let interferes = || self.pairs.iter().any(|pair| pair.interference != 0.0);
        let until = self.scene.program.interference_until;
        of_loads.chain(until.filter(|_| interferes()))
    }

    /// Factor of each list of loads that change alike, from the factors of all loads.
    pub fn factors_of_alike<'a>(&'a self, factors: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        self.alike.iter().map(|loads| factors[loads[0]])
    }

    /// Builds the model of a scene: makes or reads its mesh, resolves names, pairs surfaces.
    ///
    /// # Errors
    /// Input errors naming the scene entry and the node, body or set; [`crate::ErrorKind::Unheld`]
    /// if a body can move freely and the loads do work on that motion.
    pub fn new(scene: &Scene) -> Result<Self> {
        let made = build_mesh(scene).and_then(|mesh| Self::resolve(scene, mesh, Origin::Scene));
        let mut model = made.map_err(|error| words::of_deck(scene, error))?;
        for text in &mut model.warnings {
            *text = words::text_of_deck(scene, text);
        }
        Ok(model)
    }

    /// Builds the model of a scene on a given mesh (the scene's `mesh` entry is ignored).
    ///
    /// ```
    /// use brinell::{mesh::gmsh, model::Model, scene::Scene};
    /// use std::path::Path;
    ///
    /// # fn main() -> brinell::Result<()> {
    /// let mesh = gmsh::read(Path::new("data/meshes/two_blocks.msh"))?;
    /// let scene = Scene::load("data/scenes/gmsh_blocks.toml")?;
    /// let model = Model::from_mesh(&scene, mesh)?;
    /// println!("{} freedoms, {} contact pairs", model.freedoms.n, model.pairs.len());
    /// # assert!(model.freedoms.n > 0 && !model.pairs.is_empty());
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// Errors of [`Model::new`].
    pub fn from_mesh(scene: &Scene, mesh: Mesh) -> Result<Self> {
        Self::resolve(scene, mesh, Origin::Arrays(Given::default()))
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

    fn resolve(scene: &Scene, mut mesh: Mesh, origin: Origin) -> Result<Self> {
        let none = Given::default();
        let given = match &origin {
            Origin::Scene => &none,
            Origin::Arrays(given) => given,
        };
        let kind = scene.kind;
        let rigid = fitness::prepare(scene, &mut mesh, origin.mesh_file(scene))?;
        let mut warnings = scene.warnings.clone();
        warnings.extend(std::mem::take(&mut mesh.notes));
        warnings.extend(scene.beyond_rows());
        let (materials, may_yield) = resolve_bodies(scene, &mesh)?;
        warnings.extend(plausible::of_materials(scene));
        fitness::warn_of_locking(&mesh, &may_yield, &mut warnings);
        warnings.extend(mesh::warning_of_folds(&mesh));
        if kind.is_axisymmetric() {
            fitness::check_radii(&mesh)?;
        }
        let (mut pairs, mut contacts) =
            pairs::resolve(scene, &mesh, (given, &rigid), &mut warnings)?;
        let ties = pairs::ties::resolve(scene, &mesh, &contacts, &mut warnings)?;
        let basis = ContactBasis::of(&mesh, &pairs, &contacts, &ties)?;
        let equations = equations::resolve(scene, &mesh, given.carried.as_ref())?;
        let normals = pairs::mortar::master_normals(&mesh, &pairs, &contacts);
        let (mut freedoms, followers) = Freedoms::new(
            scene,
            &mesh,
            basis,
            &mut pairs,
            &normals,
            (&ties, &equations, &rigid),
            given.carried.as_ref(),
        )?;
        warnings.extend(settle(&mut mesh, &mut freedoms, &followers)?);
        freedoms.basis.restate(&mut pairs, &contacts);
        let stated = (&mut pairs[..], &contacts[..]);
        pairs::stated::at_control_points(scene, &mesh, &freedoms.basis, stated)?;
        let of_bodies = (&materials[..], &contacts[..]);
        let loads = load_cases(scene, &mesh, given, &freedoms, &pairs, of_bodies)?;
        check_targets(scene, &mesh)?;
        let (floating, rows) = held::resolve(
            kind,
            &mesh,
            &mut freedoms,
            (&pairs, &contacts),
            &loads,
            &mut warnings,
        )?;
        let loads = loads::renumber(loads, &freedoms);
        ends::find(scene, &mesh, (&pairs, &ties), &mut contacts);
        let yield_by_depth = yield_depth::resolve(scene, &mesh, &materials, &contacts)?;
        if matches!(origin, Origin::Scene) {
            warnings.extend(mesh::generate::contact_size::warning(scene));
        }
        let model = Model {
            scene: scene.clone(),
            continuum: Continuum {
                kind,
                formulation: scene.mesh.formulation,
                mesh,
                materials,
                may_yield,
                yield_by_depth,
                point_values: scene.requests.point_values,
            },
            freedoms,
            pairs,
            rows,
            contacts,
            alike: alike::alike(&loads, loads::leading(scene, &loads)),
            loads,
            floating,
            symmetry: scene.symmetry as f64,
            warnings,
            start: None,
            origin,
        };
        model.completed()
    }

    /// Adds what is found on the whole model: the mirrors of its contacts, a warning about its
    /// symmetry, and a check of the later legs of the program.
    fn completed(mut self) -> Result<Self> {
        let mirrors = Mirror::of_contacts(&self);
        for (contact, mirrors) in self.contacts.iter_mut().zip(mirrors) {
            contact.mirrors = mirrors;
        }
        let warning = plausible::of_symmetry(&self);
        self.warnings.extend(warning);
        if self.start_of_leg() == 0.0 {
            self.check_later_legs()?;
        }
        Ok(self)
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

fn build_mesh(scene: &Scene) -> Result<Mesh> {
    let folder = scene.file.as_deref().and_then(Path::parent);
    let made = mesh::generate::from_source(
        &scene.mesh,
        folder,
        |p| mesh::generate::contact_size::of(scene, p),
        |p| mesh::generate::ellipse_size::of(scene, p),
    );
    let mut mesh = made.map_err(|error| match scene.mesh.file {
        // Messages about a deck name its file and line themselves.
        Some(_) if scene.requests.is_of_deck() => error,
        Some(_) => scene.places.in_front("mesh.file", error),
        None => scene.places.in_front("mesh", error),
    })?;
    let declared = mesh::declared(&scene.mesh);
    mesh.name_parts(declared.iter().map(|(_, on, _)| *on));
    for (key, on, curve) in declared {
        mesh::lay_on(&mut mesh, on, curve).map_err(|error| {
            let error = error.within(format!("{key} (`{on}`)"));
            scene.places.in_front(&key, error)
        })?;
    }
    // The shapes that sets declare for their surfaces are needed here.
    mesh.name_parts(scene.set_names());
    let times = scene.mesh.subdivisions;
    if times > 0 {
        // Errors in the file are reported with the file's own numbers.
        mesh::validate(&mesh)?;
        mesh = mesh::subdivided(mesh, times, &scene.contact)?;
        mesh::validate(&mesh).map_err(|e| {
            e.within(
                "the subdivided mesh (does a surface that is declared round sag by more than \
                      the depth of the elements along it?)",
            )
        })?;
    }
    let (key, solid) = match (&scene.mesh.extrude, &scene.mesh.revolve) {
        (Some(extrusion), _) => ("mesh.extrude", mesh::extruded(&mesh, extrusion)),
        (_, Some(revolution)) => ("mesh.revolve", mesh::revolved(&mesh, revolution)),
        _ => return Ok(mesh),
    };
    solid.map_err(|error| scene.places.in_front(key, error.within(key)))
}

/// Load cases of the scene, of displacements carried over from an earlier leg, and of the strains
/// that bodies bring along. Masters that loads move open or close their contacts.
fn load_cases(
    scene: &Scene,
    mesh: &Mesh,
    given: &Given,
    freedoms: &Freedoms,
    pairs: &[Pair],
    (materials, contacts): (&[Material], &[ContactSurface]),
) -> Result<Vec<LoadCase>> {
    let mut loads = loads::resolve(scene, mesh, given, (freedoms, contacts))?;
    if let Some(carried) = &given.carried {
        carried.add_cases(scene, (&mut loads, freedoms));
    }
    openings::of_moved_masters(&mut loads, freedoms, (pairs, contacts));
    let of_bodies = (materials, contacts);
    loads.extend(initial_strain::resolve(scene, mesh, of_bodies, freedoms)?);
    Ok(loads)
}

/// Checks that sets named by targets and the history exist, before a run starts.
fn check_targets(scene: &Scene, mesh: &Mesh) -> Result<()> {
    for (index, target) in scene.program.targets.iter().enumerate() {
        if let Some(goal) = &target.displacement {
            SceneEntry::of_target(scene, index).nodes(mesh, &goal.on)?;
        }
    }
    for (index, name) in scene.program.history.iter().enumerate() {
        SceneEntry::of_history(scene, index).named(mesh, name)?;
    }
    Ok(())
}

fn resolve_bodies(scene: &Scene, mesh: &Mesh) -> Result<(Vec<Material>, Vec<bool>)> {
    for name in scene.bodies.keys() {
        if !mesh.bodies.contains(name) {
            let error = Error::input(format!(
                "bodies.{name}: the mesh has no body of this name; it has {}",
                mesh.bodies.join(", ")
            ));
            return Err(scene.places.in_front(&format!("bodies.{name}"), error));
        }
    }
    let mut materials: Vec<Material> = Vec::new();
    let mut may_yield = Vec::new();
    for name in &mesh.bodies {
        if scene.rigid.contains_key(name) {
            // Never strained, so any material will do; similar moduli give similar round-off.
            materials.extend(materials.first().cloned());
            may_yield.push(false);
            continue;
        }
        let body = scene.bodies.get(name).ok_or_else(|| {
            let error = Error::input(format!(
                "body `{name}` of the mesh has no [bodies.{name}] entry with its material"
            ));
            scene.places.in_front("bodies", error)
        })?;
        let data = scene.material_of(name).ok_or_else(|| {
            let error = Error::input(format!(
                "bodies.{name}: there is no material `{}`",
                body.material
            ));
            scene.places.in_front(&format!("bodies.{name}"), error)
        })?;
        let material = Material::new(&body.material, &data, scene.kind);
        may_yield.push(body.plastic != Plastic::No && material.hardening.is_some());
        materials.push(material);
    }
    Ok((materials, may_yield))
}

/// Moves tied nodes onto what they follow, unless that would damage the mesh: then they stay where
/// they are, which the returned warning says.
///
/// # Errors
/// Ties and equations that form a circle.
fn settle(
    mesh: &mut Mesh,
    freedoms: &mut Freedoms,
    followers: &followers::Followers,
) -> Result<Option<String>> {
    let before = mesh.coordinates.clone();
    if !freedoms.settle(mesh, followers)? {
        return Ok(None);
    }
    Ok(mesh::validate(mesh).err().map(|error| {
        mesh.coordinates = before;
        format!(
            "tied nodes stay where they are, and bodies that turn together strain a little: moved \
             onto what they follow, {}",
            error.message()
        )
    }))
}
