//! The functions that a caller runs: the whole program, its rest from a checkpoint on, or up to
//! first yield.

use super::assembled::Analysis;
use super::checkpoints::CheckpointWriter;
use super::position::Purpose;
use super::run::Run;
use super::{finish, legs, restart, scout};
use crate::checkpoint::{Checkpoints, Identity, Store};
use crate::deck::words;
use crate::error::{Error, ErrorKind, Result};
use crate::number::significant;
use crate::progress::Observer;
use crate::results::Results;

/// Runs to the end, or as far as possible.
fn complete(mut run: Run) -> Result<Results> {
    let outcome = run.execute();
    finish::results(run, outcome)
}

impl Analysis {
    /// Runs the whole load program. A run that fails after increments were accepted returns the
    /// results so far, with [`Results::incomplete`] set. The observer sees every accepted
    /// increment, and may stop the run there:
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
        let results = legs::run(self, expected, observer);
        results.map_err(|error| words::of_deck(&self.model.scene, error))
    }

    /// Runs the program as [`Analysis::run`] does, and writes checkpoints on the way: if the
    /// process is killed, [`Analysis::resume`] continues from the last one. The results are those
    /// of [`Analysis::run`] to the last bit. An existing checkpoint is replaced by the first one of
    /// this run.
    ///
    /// # Errors
    /// As [`Analysis::run`]; `Input` if another run is writing to the same directory; `Io` if the
    /// directory cannot be created, locked or read. A checkpoint that cannot be written later does
    /// not end the run: it gives a warning.
    pub fn run_with_checkpoints(
        &mut self,
        checkpoints: &Checkpoints,
        observer: &mut dyn Observer,
    ) -> Result<Results> {
        self.check_single_leg()?;
        let store = self.store(checkpoints)?;
        let expected = scout::expect(self, observer);
        let mut run = Run::new(self, Purpose::Program, expected, observer)?;
        run.checkpoints = Some(CheckpointWriter::new(store, checkpoints.interval()));
        complete(run)
    }

    /// Continues from the last checkpoint and writes further ones. The results are those of an
    /// uninterrupted run, to the last bit if the factorisation is the same to the last bit
    /// (otherwise [`Results::warnings`] says so); `timings` add up. Counts are those of a single
    /// run; repeated factorisations are left out.
    ///
    /// # Errors
    /// As [`Analysis::run_with_checkpoints`]; `Input` if the checkpoint is damaged, of another
    /// version, or of another scene, mesh or backend, naming what differs; `Io` if there is no
    /// checkpoint.
    pub fn resume(
        &mut self,
        checkpoints: &Checkpoints,
        observer: &mut dyn Observer,
    ) -> Result<Results> {
        self.check_single_leg()?;
        let store = self.store(checkpoints)?;
        let every = checkpoints.interval();
        let run = restart::resume(self, observer, store, every, scout::expect)?;
        complete(run)
    }

    /// Finds the yield load only.
    ///
    /// ```
    /// use brinell::analysis::Analysis;
    /// use brinell::linalg::Backend;
    /// use brinell::model::Model;
    /// use brinell::scene::Scene;
    ///
    /// # fn main() -> brinell::Result<()> {
    /// let scene = Scene::load("data/scenes/thick_cylinder.toml")?;
    /// let mut analysis = Analysis::new(Model::new(&scene)?, Backend::default())?;
    /// let results = analysis.yield_load(&mut brinell::progress::Silent)?;
    /// let first = results.first_yield.expect("the tube yields");
    /// // Lame, von Mises at the bore in plane strain: 103.750 for a yield stress of 240.
    /// assert!((first.load / 103.750 - 1.0).abs() < 1e-3);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// As [`Analysis::run`].
    pub fn yield_load(&mut self, observer: &mut dyn Observer) -> Result<Results> {
        let results = complete(Run::new(self, Purpose::YieldLoad, None, observer)?)?;
        match (results.first_yield, self.model.end_of_leg()) {
            (Some(first), Some(end)) if first.alpha > end => Err(Error::analysis(format!(
                "no yield load up to load factor {}, at which supports change: run the program",
                significant(end, 6)
            ))),
            _ => Ok(results),
        }
    }

    /// Refuses checkpoints of a program in which supports change.
    fn check_single_leg(&self) -> Result<()> {
        match self.model.end_of_leg() {
            None => Ok(()),
            Some(end) => Err(Error::new(
                ErrorKind::Unsupported,
                format!(
                    "checkpoints are of runs with the same supports throughout; here supports \
                     change at load factor {}: run without checkpoints",
                    significant(end, 6)
                ),
            )),
        }
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
