//! What a caller runs: the whole program, from a checkpoint on, or up to first yield.

use super::assembled::Analysis;
use super::position::Purpose;
use super::run::Run;
use super::scout;
use crate::checkpoint::{Checkpoints, Identity, Store};
use crate::deck::words;
use crate::error::Result;
use crate::progress::Observer;
use crate::results::{Incomplete, Results};

/// Runs to the end, or as far as it goes.
fn complete(mut run: Run) -> Result<Results> {
    let outcome = run.execute();
    let mut results = run.finish();
    match outcome {
        Ok(()) => {}
        Err(error) if results.states.is_empty() && results.history.is_empty() => return Err(error),
        Err(error) => {
            results.incomplete = Some(Incomplete {
                kind: error.kind(),
                why: error.in_full(),
            });
        }
    }
    Ok(results)
}

impl Analysis {
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
        let results = Run::new(self, Purpose::Program, expected, observer).and_then(complete);
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
        complete(run.with_checkpoints(store, checkpoints.interval()))
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
        complete(run)
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
        complete(Run::new(self, Purpose::YieldLoad, None, observer)?)
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
}
