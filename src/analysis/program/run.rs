//! A structure on its way through the load program.

use super::checkpoints::CheckpointWriter;
use super::leg_targets::LegTargets;
use super::path::PathSampler;
use super::position::{Position, Purpose, Start};
use super::stopwatch::TimeRow;
use super::target_search::Goal;
use crate::analysis::choice::zone_choice::Choice;
use crate::analysis::choice::zone_fit::ZoneFit;
use crate::analysis::figures::gauges::Gauges;
use crate::analysis::increments::step::{Monitor, crosses};
use crate::analysis::structure::solver::Solver;
use crate::error::Result;
use crate::model::Model;
use crate::progress::Observer;
use crate::results::{Quality, Results};
use std::cell::Cell;
use std::rc::Rc;

/// Largest number of choices of the zone that are tried for a target, or in the search for the
/// place of first yield.
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
    pub(super) targets: LegTargets<'m>,
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
            targets: LegTargets::of(solver.structure.model),
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

    /// Sets up the gauges and columns of the history that the program asks for.
    pub(super) fn follow_sets(&mut self) {
        self.gauges = Gauges::of(self.model());
        self.results.history_columns = Gauges::columns(self.model());
    }

    /// Warns with the given text, if there is any.
    pub(super) fn warn(&mut self, text: Option<String>) {
        let Some(text) = text else { return };
        self.observer.warning(&text);
        self.results.warnings.push(text);
    }

    /// What the current target asks for.
    pub(super) fn goal(&self) -> Goal<'m> {
        let at_yield = self.position.first_yield.point;
        Goal {
            model: self.model(),
            target: self.targets.target(self.position.target),
            half_width_at_yield: at_yield.map(|y| y.half_width).filter(|b| *b > 0.0),
            unloads_outside: Rc::clone(&self.unloads_outside),
        }
    }

    /// Changes the zone; state and history are kept.
    pub(super) fn set_zone(&mut self, choice: Choice) -> Result<()> {
        if choice == self.zone.choice {
            return Ok(());
        }
        self.zone.forget_recovery();
        self.timed(TimeRow::Condensation, |run| {
            let elements = choice.elements.clone();
            run.solver.set_zone(elements, &choice.guard)
        })?;
        self.zone.choice = choice;
        Ok(())
    }

    /// Changes the zone in the middle of a drive and brings the state into equilibrium again,
    /// within the tolerance. Returns whether this alone made the monitored quantity vanish.
    pub(super) fn change_zone(&mut self, choice: Choice) -> Result<bool> {
        let measure = |run: &mut Self| match &run.monitor {
            Some(monitor) => monitor(&mut run.solver).map(Some),
            None => Ok(None),
        };
        if choice == self.zone.choice {
            return Ok(false);
        }
        let was = measure(self)?;
        self.set_zone(choice)?;
        let is = measure(self)?;
        Ok(was.zip(is).is_some_and(|(was, is)| crosses(was, is)))
    }
}
