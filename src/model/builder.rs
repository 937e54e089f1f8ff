//! Builds a model from arrays in memory, in place of a scene and a mesh file.

mod geometry;
mod tables;

use super::given::Given;
use super::{Model, NodePair, Origin};
use crate::error::{Error, Result};
use crate::index::Index;
use crate::mesh::Mesh;
use crate::scene::{
    Body, Contact, History, Load, Material, Program, RigidSurface, Scene, Settings, Support,
    Target, Tie,
};
use crate::space::{Components, Space, Vector, in_words, length};
use std::collections::BTreeMap;

/// Builds a [`Model`] from arrays, without a scene file or a mesh file. Nodes and elements are
/// numbered from 0 in the order in which they were given, and messages name them by these numbers.
/// Contacts, loads and other entries have the types of a scene's entries ([`crate::scene`]). A
/// refused call leaves the builder unchanged.
///
/// ```
/// use brinell::analysis::Analysis;
/// use brinell::linalg::Backend;
/// use brinell::model::ModelBuilder;
/// use brinell::progress::Silent;
/// use brinell::scene::{Body, Contact, Direction, Kind, Load, Material, Support};
/// use brinell::mesh::Shape;
///
/// # fn main() -> brinell::Result<()> {
/// // Two unit squares, 0.01 apart, pressed together.
/// let mut builder = ModelBuilder::new(Kind::PlaneStrain);
/// builder
///     .nodes(&[0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0])?
///     .nodes(&[0.0, 1.01, 1.0, 1.01, 1.0, 2.01, 0.0, 2.01])?
///     .elements(Shape::Quad4, "lower", &[0, 1, 2, 3])?
///     .elements(Shape::Quad4, "upper", &[4, 5, 6, 7])?
///     .surface_of_nodes("floor", &[0, 1])?
///     .surface_of_nodes("face", &[2, 3])?
///     .surface_of_nodes("opposite", &[4, 5])?
///     .surface_of_nodes("top", &[6, 7])?
///     .node_set("left", &[0, 3, 4, 7])?
///     .material("steel", Material {
///         youngs_modulus: 210e3, poissons_ratio: 0.3, ..Material::default()
///     })?
///     .body("lower", Body { material: "steel".into(), ..Body::default() })?
///     .body("upper", Body { material: "steel".into(), ..Body::default() })?
///     .contact(Contact { first: "opposite".into(), second: "face".into(), ..Contact::default() })
///     .support(Support { on: "floor".into(), fix: vec![Direction::Y], ..Support::default() })
///     .support(Support { on: "left".into(), fix: vec![Direction::X], ..Support::default() })
///     .load(Load { on: "top".into(), pressure: Some(10.0.into()), ..Load::default() });
/// let results = Analysis::new(builder.build()?, Backend::default())?.run(&mut Silent)?;
/// assert!((results.states[0].max_pressure - 10.0).abs() < 1e-9);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct ModelBuilder {
    scene: Scene,
    mesh: Mesh,
    given: Given,
}

impl ModelBuilder {
    /// Starts an empty model: no copies by symmetry, and one target at load factor 1.
    pub fn new(kind: Space) -> Self {
        ModelBuilder {
            scene: Scene::of(kind),
            mesh: Mesh {
                dimension: kind.dimension(),
                ..Mesh::default()
            },
            given: Given::default(),
        }
    }

    /// Sets the title, one line for humans.
    pub fn title(&mut self, title: &str) -> &mut Self {
        self.scene.title = title.to_string();
        self
    }

    /// Sets how many copies of the model make the whole (see [`Scene::symmetry`]).
    pub fn symmetry(&mut self, copies: usize) -> &mut Self {
        self.scene.symmetry = copies;
        self
    }

    /// Adds a material under a name. Its values are checked by [`ModelBuilder::build`].
    ///
    /// # Errors
    /// A name that is already taken.
    pub fn material(&mut self, name: &str, material: Material) -> Result<&mut Self> {
        if self.scene.materials.contains_key(name) {
            return Err(Error::input(format!("two materials are named `{name}`")));
        }
        self.scene.materials.insert(name.to_string(), material);
        Ok(self)
    }

    /// Sets the material and further properties of a body.
    ///
    /// # Errors
    /// A body that already has a material.
    pub fn body(&mut self, name: &str, body: Body) -> Result<&mut Self> {
        if self.scene.bodies.contains_key(name) {
            return Err(Error::input(format!(
                "body `{name}` is given a material twice"
            )));
        }
        self.scene.bodies.insert(name.to_string(), body);
        Ok(self)
    }

    /// Adds a contact between two surfaces; their nodes are paired by geometry.
    pub fn contact(&mut self, contact: Contact) -> &mut Self {
        self.scene.contact.push(contact);
        self
    }

    /// Adds a rigid surface, which contacts and loads name just as they name surfaces of the mesh.
    /// Its values are checked by [`ModelBuilder::build`].
    ///
    /// # Errors
    /// A name that is already taken.
    pub fn rigid(&mut self, name: &str, surface: RigidSurface) -> Result<&mut Self> {
        if self.scene.rigid.contains_key(name) {
            return Err(Error::input(format!(
                "two rigid surfaces are named `{name}`"
            )));
        }
        self.scene.rigid.insert(name.to_string(), surface);
        Ok(self)
    }

    /// Adds a tie that holds two surfaces together.
    pub fn tie(&mut self, tie: Tie) -> &mut Self {
        self.scene.tie.push(tie);
        self
    }

    /// Adds a contact between two surfaces at the given pairs of nodes. Nodes of the surfaces
    /// without a pair take no part in the contact; `contact.normal` is not used, `contact.gap` is
    /// the gap of pairs without a gap of their own.
    ///
    /// # Errors
    /// An index of no node, a node in two pairs, a normal without direction, a gap that is negative
    /// or not finite; the message names the pair.
    pub fn contact_pairs(&mut self, contact: Contact, pairs: &[NodePair]) -> Result<&mut Self> {
        let mut pair_of = BTreeMap::new();
        for (k, pair) in pairs.iter().enumerate() {
            for node in [pair.first, pair.second] {
                self.node(|| format!("pair {k}: one"), node)?;
                if let Some(other) = pair_of.insert(node, k) {
                    return Err(Error::input(format!(
                        "pair {k}: node {node} is in pair {other} already; a node may belong to \
                         one pair"
                    )));
                }
            }
            if let Some(gap) = pair.gap.filter(|g| !(g.is_finite() && *g >= 0.0)) {
                return Err(Error::input(format!(
                    "pair {k}: the gap is {gap}; give a finite one that is not negative, and an \
                     overlap as `interference`"
                )));
            }
            if let Some(n) = pair.normal
                && !(length(n).is_finite() && n != [0.0; 3])
            {
                return Err(Error::input(format!(
                    "pair {k}: the normal {} is no direction",
                    in_words(n, self.mesh.dimension)
                )));
            }
        }
        let index = self.scene.contact.len();
        self.given.pairs.insert(index, pairs.to_vec());
        self.scene.contact.push(contact);
        Ok(self)
    }

    /// Adds a support, which holds a node set or surface.
    pub fn support(&mut self, support: Support) -> &mut Self {
        self.scene.support.push(support);
        self
    }

    /// Adds a load on a node set or surface.
    pub fn load(&mut self, load: Load) -> &mut Self {
        self.scene.load.push(load);
        self
    }

    /// Loads nodes with individual forces at factor 1, in global axes (z = 0 in the plane). The
    /// forces act on the model itself, not on the whole of a symmetric one. `name` also becomes the
    /// name of the set of these nodes.
    ///
    /// # Errors
    /// Different numbers of nodes and forces, an index of no node, a force that is not finite, a
    /// name that is already taken.
    pub fn nodal_load<I: Index>(
        &mut self,
        name: &str,
        nodes: &[I],
        forces: &[Vector],
        history: History,
    ) -> Result<&mut Self> {
        if nodes.len() != forces.len() {
            return Err(Error::input(format!(
                "load `{name}`: {} nodes have {} forces: one each is needed",
                nodes.len(),
                forces.len()
            )));
        }
        let mut sums: BTreeMap<usize, Vector> = BTreeMap::new();
        for (node, force) in self.known_nodes(name, nodes)?.into_iter().zip(forces) {
            if force.iter().any(|f| !f.is_finite()) {
                return Err(Error::input(format!(
                    "load `{name}`: the force on node {node} is {}",
                    in_words(*force, self.mesh.dimension)
                )));
            }
            let sum = sums.entry(node).or_default();
            (0..3).for_each(|d| sum[d] += force[d]);
        }
        self.node_set(name, nodes)?;
        let index = self.scene.load.len();
        self.given.forces.insert(index, sums.into_iter().collect());
        self.scene.load.push(Load {
            name: name.to_string(),
            on: name.to_string(),
            force: Some(self.components([0.0; 3])),
            history,
            ..Load::default()
        });
        Ok(self)
    }

    /// Adds a target to the load program. If no target is added, the program has a single target at
    /// load factor 1.
    pub fn target(&mut self, target: Target) -> &mut Self {
        self.scene.program.targets.push(target);
        self
    }

    /// Replaces the load program.
    pub fn program(&mut self, program: Program) -> &mut Self {
        self.scene.program = program;
        self
    }

    /// The load program set so far.
    pub fn load_program(&self) -> &Program {
        &self.scene.program
    }

    /// Replaces the settings of the analysis.
    pub fn settings(&mut self, settings: Settings) -> &mut Self {
        self.scene.analysis = settings;
        self
    }

    /// Converts a vector to as many components as the model has coordinates.
    pub(crate) fn components(&self, vector: Vector) -> Components {
        match self.mesh.dimension {
            2 => [vector[0], vector[1]].into(),
            _ => vector.into(),
        }
    }

    /// Checks all entries and builds the model.
    ///
    /// # Errors
    /// Input errors that name the entry, node, element or pair; [`crate::ErrorKind::Unheld`] if a
    /// body can move freely and the loads do work on that motion.
    pub fn build(&self) -> Result<Model> {
        let mut scene = self.scene.clone();
        for (&index, forces) in &self.given.forces {
            let sum = |s: Vector, f: &Vector| std::array::from_fn(|d| s[d] + f[d]);
            let total = forces.iter().fold([0.0; 3], |s, (_, f)| sum(s, f));
            let whole = total.map(|f| f * scene.symmetry as f64);
            scene.load[index].force = Some(self.components(whole));
        }
        if scene.program.targets.is_empty() {
            scene.program.targets.push(Target {
                load_factor: Some(1.0),
                ..Target::default()
            });
        }
        let labels = scene.program.labels();
        for (target, label) in scene.program.targets.iter_mut().zip(labels) {
            target.name = Some(label);
        }
        scene.validate_without_mesh()?;
        let mut mesh = self.mesh.clone();
        mesh.node_labels = (0..mesh.n_nodes() as u64).collect();
        mesh.element_labels = (0..mesh.n_elements() as u64).collect();
        Model::made(&scene, mesh, Origin::Arrays(self.given.clone()))
    }
}

#[cfg(test)]
mod tests;
