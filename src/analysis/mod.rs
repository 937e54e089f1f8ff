//! The analysis: yield load, then the load program, increment by increment.
//!
//! | file | what | paper |
//! |---|---|---|
//! | `structure`, `solver`, `equilibrium`, `response` | structure, its state under load, response to loads | 3.7, 4.1 to 4.6 |
//! | `yield_load`, `recovery`, `maximum`, `mirror` | load at first yield, the highest stress between the points | 3.11 to 3.14 |
//! | `patch_fit`, `patch`, `fitted`, `neighbours`, `layers` | the weighted polynomial around an element; recovered stresses and gradients | |
//! | `increment`, `search`, `step_length` | one elastoplastic increment that ends at the next change of contact | 4.7 to 4.23 |
//! | `zone`, `gather`, `region`, `zone_choice`, `zone_fit`, `scout` | elements that may yield, initial loads, their choice and growth | 4.1 |
//! | `tangent`, `acceleration` | acceleration of the plastic iteration | |
//! | `collapse` | limit load, or an iteration that did not converge | |
//! | `program`, `position`, `first_yield`, `targets`, `target_search`, `awaited`, `unloading`, `cycles` | the program, step by step; where it is | 5.1, 5.2 |
//! | `drive`, `elastic`, `plastic`, `flow`, `stretch`, `stepping`, `landing` | along a straight piece of the load path | 4.7 to 4.23 |
//! | `state`, `restart`, `packed` | a committed state; checkpoints, and going on from them | |
//! | `starting` | the state that an earlier run left, and that this one leaves | |
//! | `outgrown` | contact that reaches the end of its candidates | |
//! | `path` | the path between increments | |
//! | `measure`, `contact_edge`, `reading`, `dent`, `figures`, `gauges`, `approaches`, `quality` | pressure, half width, dent, quality of a state | 5 |
//! | `stress_field`, `element_stresses`, `stresses`, `point_values` | stresses of all elements, the forces they exert | |
//! | `driving_force` | the force that moves what a load displaces | |
//! | `local_yield` | yield stresses from place to place | |
//! | `piece` | the stresses of a state, computed by all ranks | |
//! | `indicator` | discretisation error of the stresses, element by element | |
//! | `deformation` | whether strains and rotations are small | |
//! | `check`, `seconds` | effects, cost and time before a run | |
//! | `stopwatch` | what the time of a run was spent on | |

mod acceleration;
mod approaches;
mod awaited;
mod check;
mod collapse;
mod contact_area;
mod contact_edge;
mod contact_patch;
mod cycles;
mod deformation;
mod dent;
mod drive;
mod driving_force;
mod elastic;
mod element_stresses;
mod equilibrium;
mod figures;
mod finish;
mod first_yield;
mod fitted;
mod flow;
mod free_strain;
mod gather;
mod gauges;
mod increment;
mod indicator;
mod landing;
mod layers;
mod line_search;
mod load_point;
mod local_yield;
mod loose;
mod maximum;
mod measure;
mod neighbours;
mod outgrown;
mod packed;
mod patch;
mod patch_fit;
mod path;
mod piece;
mod plastic;
mod point_values;
mod position;
mod program;
mod quality;
mod reactions;
mod reading;
mod recovery;
mod region;
mod response;
mod restart;
mod scout;
mod search;
mod seconds;
mod settling;
mod solver;
mod starting;
mod state;
mod step_length;
mod stepping;
mod stopwatch;
mod stress_field;
mod stresses;
mod stretch;
mod structure;
mod tangent;
mod target_search;
mod targets;
mod unloading;
mod yield_load;
mod zone;
mod zone_border;
mod zone_choice;
mod zone_fit;

#[cfg(test)]
mod tests;

pub use check::{Check, check};
pub use piece::evaluate;
pub(crate) use recovery::left_of_search;

use crate::assembly::{System, assemble};
use crate::checkpoint::{Checkpoints, Identity, Store};
use crate::deck::words;
use crate::error::Result;
use crate::linalg::Backend;
use crate::model::Model;
use crate::progress::Observer;
use crate::results::Results;
use position::Purpose;
use program::Run;
use std::time::Instant;

/// A model with its assembled system, ready to run.
pub struct Analysis {
    model: Model,
    system: System,
    backend: Backend,
    timings: Vec<(String, f64)>,
}

impl Analysis {
    /// Assembles the model.
    ///
    /// # Errors
    /// Those of [`assemble`]; `Input` where the directory that the scene starts from is missing,
    /// damaged, or of another mesh or version.
    pub fn new(mut model: Model, backend: Backend) -> Result<Self> {
        let start = Instant::now();
        model.start = starting::read(&model)?;
        let system = assemble(&model, backend);
        let system = system.map_err(|error| words::of_deck(&model.scene, error))?;
        let timings = vec![("assembly".to_string(), start.elapsed().as_secs_f64())];
        Ok(Analysis {
            model,
            system,
            backend,
            timings,
        })
    }

    /// The model.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The assembled system.
    pub fn system(&self) -> &System {
        &self.system
    }

    /// Runs the whole load program. A run that fails after increments were accepted returns what
    /// was computed, with [`Results::incomplete`] set. The observer sees every accepted increment,
    /// and may stop the run there:
    ///
    /// ```
    /// use brinell::progress::{Flow, Observer};
    /// use brinell::results::HistoryRow;
    /// use brinell::{ErrorKind, analysis::Analysis, linalg::Backend, model::Model, scene::Scene};
    ///
    /// struct UpTo(f64);
    /// impl Observer for UpTo {
    ///     fn increment(&mut self, row: &HistoryRow, _fraction: f64) -> Flow {
    ///         if row.load < self.0 { Flow::Continue } else { Flow::Stop }
    ///     }
    /// }
    ///
    /// # fn main() -> brinell::Result<()> {
    /// let scene = Scene::load("data/scenes/three_bodies.toml")?;
    /// let results = Analysis::new(Model::new(&scene)?, Backend::default())?.run(&mut UpTo(1.0))?;
    /// assert_eq!(results.ending().kind(), Some(ErrorKind::Stopped));
    /// assert!(results.history.last().is_some_and(|row| row.load >= 1.0));
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// Failures before the first state: factorisation, yield load, a body that is not held.
    pub fn run(&mut self, observer: &mut dyn Observer) -> Result<Results> {
        let expected = scout::expect(self, observer);
        let results =
            Run::new(self, Purpose::Program, expected, observer).and_then(program::complete);
        results.map_err(|error| words::of_deck(&self.model.scene, error))
    }

    /// As [`Analysis::run`], and writes checkpoints on the way: should the process be killed,
    /// [`Analysis::resume`] goes on from the last. The results are those of [`Analysis::run`] to
    /// the last bit. A checkpoint that is there already is replaced by the first.
    ///
    /// # Errors
    /// As [`Analysis::run`]; `Input` where another run is writing there; `Io` where the first
    /// checkpoint cannot be written (a later one that cannot be ends the run like any other
    /// failure).
    pub fn run_with_checkpoints(
        &mut self,
        checkpoints: &Checkpoints,
        observer: &mut dyn Observer,
    ) -> Result<Results> {
        let store = self.store(checkpoints)?;
        let expected = scout::expect(self, observer);
        let run = Run::new(self, Purpose::Program, expected, observer)?;
        program::complete(run.with_checkpoints(store, checkpoints.interval()))
    }

    /// Goes on from the last checkpoint and writes further ones. The results are those of a run
    /// that was never stopped, to the last bit where the factorisation is the same to the last bit
    /// (else [`Results::warnings`] says so); `timings` add up. Counts are those of the one run, the
    /// factorisations done again left out.
    ///
    /// # Errors
    /// As [`Analysis::run_with_checkpoints`]; `Input` where the checkpoint is damaged, of another
    /// version, or of another scene, mesh or backend, naming what differs; `Io` where there is
    /// none.
    pub fn resume(
        &mut self,
        checkpoints: &Checkpoints,
        observer: &mut dyn Observer,
    ) -> Result<Results> {
        let store = self.store(checkpoints)?;
        let every = checkpoints.interval();
        let run = Run::resume(self, observer, store, every, scout::expect)?;
        program::complete(run)
    }

    fn store(&self, checkpoints: &Checkpoints) -> Result<Store> {
        let model = &self.model;
        let identity = Identity::new(
            (&model.scene, model.start.as_ref()),
            &model.mesh,
            self.backend,
        )?;
        Store::open(checkpoints, identity)
    }

    /// The yield load only.
    ///
    /// ```
    /// use brinell::{analysis::Analysis, linalg::Backend, model::Model, progress::Silent,
    /// scene::Scene};
    ///
    /// # fn main() -> brinell::Result<()> {
    /// let scene = Scene::load("data/scenes/thick_cylinder.toml")?;
    /// let results = Analysis::new(Model::new(&scene)?, Backend::default())?.yield_load(&mut
    /// Silent)?; let first = results.first_yield.expect("the tube yields");
    /// // Lame, von Mises at the bore in plane strain: 103.750 for a yield stress of 240.
    /// assert!((first.load / 103.750 - 1.0).abs() < 1e-3);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// As [`Analysis::run`].
    pub fn yield_load(&mut self, observer: &mut dyn Observer) -> Result<Results> {
        program::complete(Run::new(self, Purpose::YieldLoad, None, observer)?)
    }
}
