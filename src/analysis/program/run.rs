//! A structure on its way through the load program.

use super::checkpoints::CheckpointWriter;
use super::path::PathSampler;
use super::position::{Position, Purpose, Start};
use super::stopwatch::TimeRow;
use crate::analysis::choice::zone_fit::ZoneFit;
use crate::analysis::figures::gauges::Gauges;
use crate::analysis::increments::step::Monitor;
use crate::analysis::structure::solver::Solver;
use crate::error::Result;
use crate::model::Model;
use crate::progress::Observer;
use crate::results::{Quality, Results};
use crate::scene::Target;
use std::cell::Cell;
use std::rc::Rc;

/// Most doublings of the load in the search for first yield or for a target.
pub(super) const DOUBLINGS: usize = 60;
/// Most choices of the zone that are tried for a target, or in the search for the place of first
/// yield.
pub(super) const ZONE_ATTEMPTS: usize = 8;

/// A structure on its way through the load program.
pub(in crate::analysis) struct Run<'m, 'o> {
    pub(in crate::analysis) solver: Solver<'m>,
    pub(in crate::analysis) zone: ZoneFit,
    pub(super) position: Position,
    /// The start of the way to the current target.
    pub(super) start: Option<Start>,
    /// Function that vanishes at the current target, if the target is not a load factor.
    pub(super) monitor: Option<Box<Monitor<'m>>>,
    /// Whether the current target was searched for with a zone outside of which unloading yields.
    pub(super) unloads_outside: Rc<Cell<bool>>,
    /// Gauges for the additional columns of the history.
    pub(super) gauges: Option<Gauges>,
    /// Number of targets of the program up to the end of the leg.
    pub(super) last_target: usize,
    /// Names of the targets.
    pub(super) labels: Vec<String>,
    pub(super) observer: &'o mut dyn Observer,
    pub(super) results: Results,
    /// The path between the rows of the history.
    pub(super) path: PathSampler,
    pub(super) checkpoints: Option<CheckpointWriter>,
    pub(super) purpose: Purpose,
    /// Quality of the state at first yield, if the run looks only for first yield.
    pub(super) at_yield: Option<Quality>,
}

impl<'m, 'o> Run<'m, 'o> {
    /// A run that has done nothing yet.
    pub(super) fn of(
        solver: Solver<'m>,
        zone: ZoneFit,
        results: Results,
        observer: &'o mut dyn Observer,
    ) -> Self {
        Run {
            last_target: solver.structure.model.targets_up_to_end_of_leg(),
            labels: solver.structure.model.scene.program.labels(),
            solver,
            zone,
            position: Position::default(),
            start: None,
            monitor: None,
            unloads_outside: Rc::default(),
            gauges: None,
            observer,
            results,
            path: PathSampler::default(),
            checkpoints: None,
            purpose: Purpose::Program,
            at_yield: None,
        }
    }

    pub(super) fn model(&self) -> &'m Model {
        self.solver.structure.model
    }

    /// Does some work and counts its time in a row of the time table.
    pub(super) fn timed<T>(&mut self, row: TimeRow, work: impl FnOnce(&mut Self) -> T) -> T {
        let before = self.position.seconds.switch(row);
        let out = work(self);
        self.position.seconds.switch(before);
        out
    }

    /// Sets up the gauges and columns of the history that the scene asks for.
    pub(super) fn follow_sets(&mut self) -> Result<()> {
        self.gauges = Gauges::of(self.model())?;
        self.results.history_columns = Gauges::columns(self.model());
        Ok(())
    }

    /// Warns with the given text, if there is any.
    pub(super) fn warn(&mut self, text: Option<String>) {
        let Some(text) = text else { return };
        self.observer.warning(&text);
        self.results.warnings.push(text);
    }

    /// The program's targets up to the end of the leg.
    pub(super) fn targets_of_leg(&self) -> &'m [Target] {
        &self.model().scene.program.targets[..self.last_target]
    }

    /// The largest absolute load factor among the targets, if there is one.
    pub(super) fn largest_factor(&self) -> Option<f64> {
        self.targets_of_leg()
            .iter()
            .filter_map(|t| t.load_factor)
            .map(f64::abs)
            .reduce(f64::max)
    }
}
