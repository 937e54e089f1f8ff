//! Makes models from a scene, from a scene and a mesh, and for each leg of the load program.

use super::carried::{Carried, Released};
use super::given::Given;
use super::{Model, Origin, ProgramTarget, resolve};
use crate::deck::words;
use crate::error::{Error, ErrorKind, Result};
use crate::mesh::Mesh;
use crate::number::significant;
use crate::scene::{Load, Scene, Support};
use crate::space::{Vector, along};

impl Model {
    /// Builds the model of a scene: makes or reads its mesh, resolves names, pairs surfaces.
    ///
    /// # Errors
    /// Input errors naming the scene entry and the node, body or set; [`crate::ErrorKind::Unheld`]
    /// if a body can move freely and the loads do work on that motion.
    pub fn new(scene: &Scene) -> Result<Self> {
        let made =
            resolve::build_mesh(scene).and_then(|mesh| Self::made(scene, mesh, Origin::Scene));
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
        Self::made(scene, mesh, Origin::Arrays(Given::default()))
    }

    /// Resolves a scene on a mesh, and checks the later legs of its program.
    ///
    /// # Errors
    /// Errors of [`Model::new`].
    pub(super) fn made(scene: &Scene, mesh: Mesh, origin: Origin) -> Result<Self> {
        let model = resolve::model(scene, mesh, origin)?;
        if model.start_of_leg() == 0.0 {
            model.check_later_legs()?;
        }
        Ok(model)
    }

    /// Load factor at which the model's leg of the program begins: its supports hold in this leg.
    fn start_of_leg(&self) -> f64 {
        match &self.origin {
            Origin::Arrays(given) => given.carried.as_ref().map_or(0.0, |carried| carried.at),
            Origin::Scene => 0.0,
        }
    }

    /// Load factor at which the model's leg of the program ends; `None` if it is the last leg.
    pub(crate) fn end_of_leg(&self) -> Option<f64> {
        let mut changes = self.program.support_changes.iter().copied();
        changes.find(|change| *change > self.start_of_leg())
    }

    /// Number of the program's targets that are reached by the end of the leg.
    pub(crate) fn targets_up_to_end_of_leg(&self) -> usize {
        let targets = &self.program.targets;
        let Some(end) = self.end_of_leg() else {
            return targets.len();
        };
        let factors = targets.iter().filter_map(ProgramTarget::load_factor);
        factors.filter(|factor| *factor <= end).count()
    }

    /// Builds the model of the next leg, which begins at the load factor `at`, from the
    /// displacements of all nodes, the external forces on them, and the factors of the loads.
    ///
    /// # Errors
    /// Errors of [`Model::new`], for the supports of the next leg.
    pub(crate) fn next_leg(
        &self,
        at: f64,
        (displacements, external): (Vec<Vector>, Vec<Vector>),
        factors: &[f64],
    ) -> Result<Model> {
        let mut given = self.given();
        let earlier = given.carried.take().unwrap_or_default();
        let on_supports = self.less_loads(external, factors);
        let mut released = earlier.released;
        released.retain(|released| at < released.until[1]);
        released.extend(self.ending_at(at, &on_supports));
        given.carried = Some(Carried {
            at,
            displacements,
            released,
        });
        self.of_leg(given, at)
    }

    /// Checks that the model can be built for all later legs of the program.
    ///
    /// # Errors
    /// Errors of [`Model::next_leg`].
    fn check_later_legs(&self) -> Result<()> {
        for &at in &self.program.support_changes {
            let mut given = self.given();
            given.carried = Some(Carried {
                at,
                displacements: vec![[0.0; 3]; self.mesh.n_nodes()],
                released: Vec::new(),
            });
            self.of_leg(given, at)?;
        }
        Ok(())
    }

    /// Builds the model of a later leg; fails if it has other contact nodes or additional pins.
    fn of_leg(&self, given: Given, at: f64) -> Result<Model> {
        let made = resolve::model(&self.scene, self.mesh.clone(), Origin::Arrays(given));
        let mut next = made.map_err(|error| words::of_deck(&self.scene, error))?;
        for text in &mut next.warnings {
            *text = words::text_of_deck(&self.scene, text);
        }
        let slaves = |model: &Model| -> Vec<usize> {
            let pairs = model.pairs.iter();
            pairs.map(|pair| pair.slave).collect()
        };
        let at = significant(at, 6);
        if slaves(self) != slaves(&next) {
            return Err(Error::new(
                ErrorKind::Unsupported,
                format!(
                    "with the supports from load factor {at} on, other nodes are in contact than \
                     before"
                ),
            ));
        }
        let mut pins = next.floating.pins.iter();
        match pins.find(|pin| !self.floating.pins.contains(pin)) {
            None => Ok(next),
            Some(pin) => Err(Error::new(
                ErrorKind::Unheld,
                format!(
                    "{}: nothing holds this motion from load factor {at} on, at which supports \
                     end; add a support or a contact",
                    pin.motion
                ),
            )),
        }
    }

    /// Subtracts the forces of loads from the external forces, and returns the rest on control
    /// points.
    fn less_loads(&self, mut external: Vec<Vector>, factors: &[f64]) -> Vec<Vector> {
        self.freedoms.basis.share(&mut external);
        // The forces of free strains stand for stresses, and are not external.
        let acting = self.loads.iter().zip(factors);
        for (load, &factor) in acting.filter(|(load, _)| load.free_strain.is_empty()) {
            for &(node, force) in load.nodal() {
                external[node] = along(external[node], -factor, force);
            }
        }
        external
    }

    /// Forces of supports, equations and prescribed displacements, if a support or load ends at the
    /// load factor `at`. The forces of constraints that continue are included: the same constraints
    /// bear these forces in the next leg, where the forces do no work. All nodes are taken, because
    /// a held middle of an edge also acts on the ends of the edge.
    fn ending_at(&self, at: f64, forces: &[Vector]) -> Option<Released> {
        let supports = self.scene.support.iter().map(Support::span);
        let spans = supports.chain(self.scene.load.iter().map(Load::span));
        let mut ends = spans.filter_map(|span| span.until);
        let until = ends.find(|until| until[0] == at)?;
        Some(Released {
            until,
            forces: forces.iter().copied().enumerate().collect(),
        })
    }
}
