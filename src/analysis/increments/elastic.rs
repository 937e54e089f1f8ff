//! Elastic drives: contact alone changes, from event to event, and only the dense contact matrix is
//! needed.

use super::acceptance::{contact_step, rests_at};
use super::step::{Arrival, MONITOR_ACCURACY, Monitor, Step, crosses, describe, is_hit};
use super::yield_load::yield_share;
use crate::analysis::stress::recovery::{Recovery, Samples};
use crate::analysis::structure::load_point::LoadPoint;
use crate::analysis::structure::loose::move_loose_bodies;
use crate::analysis::structure::solver::Solver;
use crate::contact::{Path, PathEnd};
use crate::error::{Error, Result};
use crate::root::{self, RootTolerance};
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;

/// Springs bear this fraction of the largest force once their body has moved by ten times the
/// deformation.
const MOVES_FAR: f64 = 1e-7;

/// Follows contact along a straight piece of the load path, with frozen plastic strains.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ElasticPath {
    start: LoadPoint,
    end: LoadPoint,
    path: Path,
}

impl ElasticPath {
    /// The piece from the solver's current state to `end`.
    ///
    /// # Errors
    /// A load that drives a body away from every contact.
    pub fn new(solver: &mut Solver, end: &LoadPoint) -> Result<Self> {
        let start = solver.at.clone();
        let mut q0 = solver.structure.closed_forces(&start);
        let q1 = solver.structure.closed_forces(end);
        let rate: Vec<f64> = q1.iter().zip(&q0).map(|(b, a)| b - a).collect();
        for (q, t) in q0.iter_mut().zip(&solver.now.initial.forces) {
            *q += t;
        }
        move_loose_bodies(solver, end)?;
        solver.add_springs(&mut q0);
        let terms = solver.structure.closed_forces_size(&start);
        let gaps = solver.structure.delta(&start);
        let gap_scale = gaps.iter().fold(0.0f64, |m, d| m.max(d.abs()));
        let (gap, force) = (solver.now.gap.clone(), solver.now.force.clone());
        let path = Path::new(&mut solver.tableau, q0, rate, gap, force, gap_scale, terms)
            .map_err(|u| solver.structure.unbounded(u.pair, start.alpha))?;
        solver.cost.counts.contact_changes += path.changes;
        Ok(ElasticPath {
            start,
            end: end.clone(),
            path,
        })
    }

    /// Goes to the next event, but not beyond share `t` of the piece. The gaps and forces of the
    /// solver are updated.
    pub fn advance(&mut self, solver: &mut Solver, t: f64) -> PathEnd {
        let outcome = self.path.advance(&mut solver.tableau, t);
        self.write(solver);
        outcome
    }

    /// Goes to share `t` of the piece with the current statuses, which must be right there.
    pub fn go_back(&mut self, solver: &mut Solver, t: f64) {
        self.path.state_at(&mut solver.tableau, t);
        self.write(solver);
    }

    /// Sets the statuses that are right beyond an event. If a body has lost its last contact or
    /// moves far against its springs, the body moves across its gaps, and a new piece begins.
    ///
    /// # Errors
    /// A load that drives a body away from every contact.
    pub fn turn(&mut self, solver: &mut Solver) -> Result<()> {
        let lost = self.path.turn(&mut solver.tableau).is_err();
        if lost || solver.springs_hold_a_body() || solver.springs_bear(MOVES_FAR) {
            *self = ElasticPath::new(solver, &self.end.clone())?;
        } else {
            solver.cost.counts.contact_changes += self.path.changes;
        }
        Ok(())
    }

    /// Goes back to the share of the piece at which the monitored quantity is zero within
    /// `accuracy`. The quantity is `was` at share `from`, and `is` at the current share.
    ///
    /// # Errors
    /// Errors of the monitor.
    pub fn land(
        &mut self,
        solver: &mut Solver,
        from: f64,
        [was, is]: [f64; 2],
        accuracy: f64,
        monitor: &Monitor,
    ) -> Result<()> {
        let ends = [(from, was), (self.t(), is)];
        let t = root::try_between(ends, RootTolerance::both(accuracy), |t| {
            self.go_back(solver, t);
            monitor(solver)
        })?;
        self.go_back(solver, t);
        solver.refresh();
        Ok(())
    }

    /// Load point at which the piece starts.
    pub fn start(&self) -> &LoadPoint {
        &self.start
    }

    /// Share of the piece that was covered so far.
    pub fn t(&self) -> f64 {
        self.path.t
    }

    fn write(&self, solver: &mut Solver) {
        solver.at = self.start.towards(&self.end, self.path.t);
        solver.now.gap.copy_from_slice(&self.path.gap);
        solver.now.force.copy_from_slice(&self.path.force);
        solver.fresh = false;
        solver.border.clear();
    }
}

/// An elastic drive between two increments.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ElasticDrive {
    path: ElasticPath,
    /// Whether first yield ends the drive.
    pub(in crate::analysis) watches_yield: bool,
    /// The monitored quantity at the end of the last increment.
    pub(in crate::analysis) monitored: Option<f64>,
    /// Whether the statuses beyond the last event are still to be set.
    at_event: bool,
    /// Stresses at the end of the last increment, if first yield is watched for; sampled again if
    /// they are not known.
    #[serde(skip)]
    samples: Option<Samples>,
}

impl ElasticDrive {
    /// Begins a drive from the current state to `end`, or to first yield if `recovery` is given.
    ///
    /// # Errors
    /// A load that drives a body away from every contact; errors of the monitor.
    pub fn begin(
        solver: &mut Solver,
        end: &LoadPoint,
        recovery: Option<&mut Recovery>,
        monitor: Option<&Monitor>,
    ) -> Result<ControlFlow<Step, Self>> {
        let watches_yield = recovery.is_some();
        let mut samples = None;
        if let Some(recovery) = recovery {
            let here = recovery.sample_here(solver);
            let peak = recovery.peak(solver.structure.model, &here);
            if let Some(peak) = peak.filter(|p| p.ratio > 1.0) {
                return Ok(ControlFlow::Break(Step::arrived(Arrival::Yield(peak))));
            }
            samples = Some(here);
        }
        let monitored = monitor.map(|m| m(solver)).transpose()?;
        if is_hit(monitored) {
            return Ok(ControlFlow::Break(Step::arrived(Arrival::Monitor)));
        }
        if rests_at(solver, end) {
            let (from, solves) = (solver.at.alpha, solver.cost.counts.trailing_solves);
            let step = contact_step(solver, from, "target", solves, Some(Arrival::End))?;
            return Ok(ControlFlow::Break(step));
        }
        Ok(ControlFlow::Continue(ElasticDrive {
            path: ElasticPath::new(solver, end)?,
            watches_yield,
            monitored,
            at_event: false,
            samples,
        }))
    }

    /// Goes to the next event on the way to `end`.
    ///
    /// # Errors
    /// A load that drives a body away from every contact; errors of the monitor and of
    /// [`super::outgrown::accepted`].
    pub fn step(
        &mut self,
        solver: &mut Solver,
        end: &LoadPoint,
        recovery: Option<&mut Recovery>,
        monitor: Option<&Monitor>,
    ) -> Result<Step> {
        let mut recovery = recovery.filter(|_| self.watches_yield);
        let samples = match (&mut recovery, self.samples.take()) {
            (Some(recovery), None) => Some(recovery.sample_here(solver)),
            (_, samples) => samples,
        };
        if std::mem::take(&mut self.at_event) {
            self.path.turn(solver)?;
        }
        let (alpha, solves) = (solver.at.alpha, solver.cost.counts.trailing_solves);
        let before = self.path.t();
        let outcome = self.path.advance(solver, 1.0);
        if let (Some(recovery), Some(from)) = (recovery, samples) {
            let to = recovery.sample_here(solver);
            let peak = recovery.peak(solver.structure.model, &to);
            if peak.is_some_and(|p| p.ratio >= 1.0) {
                let (share, peak) = yield_share(solver, recovery, &from, &to);
                let t = before + share * (self.path.t() - before);
                self.path.go_back(solver, t);
                solver.refresh();
                if let Some(peak) = peak {
                    let arrival = Some(Arrival::Yield(peak));
                    return contact_step(solver, alpha, "yield", solves, arrival);
                }
            }
            self.samples = Some(to);
        }
        if let (Some(monitor), Some(was)) = (monitor, self.monitored) {
            let is = monitor(solver)?;
            self.monitored = Some(is);
            if crosses(was, is) {
                let accuracy = MONITOR_ACCURACY;
                self.path
                    .land(solver, before, [was, is], accuracy, monitor)?;
                return contact_step(solver, alpha, "target", solves, Some(Arrival::Monitor));
            }
        }
        match outcome {
            PathEnd::Target => {
                solver.at = end.clone();
                contact_step(solver, alpha, "target", solves, Some(Arrival::End))
            }
            PathEnd::Event(changes) => {
                self.at_event = true;
                contact_step(solver, alpha, &describe(&changes), solves, None)
            }
        }
    }

    /// Goes to `end` elastically, or to first yield if `recovery` is given. The increments are not
    /// reported.
    ///
    /// # Errors
    /// Errors of [`ElasticDrive::step`].
    pub fn go(
        solver: &mut Solver,
        end: &LoadPoint,
        mut recovery: Option<&mut Recovery>,
    ) -> Result<Arrival> {
        let begun = ElasticDrive::begin(solver, end, recovery.as_deref_mut(), None)?;
        let mut drive = match begun {
            ControlFlow::Continue(drive) => drive,
            ControlFlow::Break(step) => {
                let nowhere = || Error::internal("a drive that ended nowhere");
                return step.arrival.ok_or_else(nowhere);
            }
        };
        loop {
            let step = drive.step(solver, end, recovery.as_deref_mut(), None)?;
            if let Some(arrival) = step.arrival {
                return Ok(arrival);
            }
        }
    }
}
