//! Elastoplastic drives: increments that end at the next change of contact, or increments of fixed
//! length.

use super::acceptance::{accept, arrive, contact_step, rests_at, turns_back};
use super::outgrown::accepted;
use super::step::{Arrival, IncrementReport, Monitor, Rules, SMALLEST_CUT, Step, crosses, is_hit};
use super::stepping::Stepper;
use super::stretch::ElasticStretch;
use crate::analysis::structure::load_point::LoadPoint;
use crate::analysis::structure::solver::Solver;
use crate::error::Result;
use crate::scene::Stepping;
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;

/// Fraction of a piece of the load path below which the rest of the piece is round-off. When a body
/// is unloaded to zero, the last pair's force consists of the load and of the imbalance of the
/// iteration. The load at which this force vanishes then has no meaning.
const ARRIVED: f64 = 1e-9;

/// An elastoplastic drive between two increments.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct PlasticDrive {
    /// Distance from the start of the drive to its end.
    whole: f64,
    /// Longest distance that the next increment may cover. After an increment that did not
    /// converge, the next ones are short; they grow again as long as they succeed.
    trust: f64,
    /// Number of fixed increments taken on the piece so far.
    pub(in crate::analysis) taken: usize,
    /// The monitored quantity at the end of the last increment.
    pub(in crate::analysis) monitored: Option<f64>,
    ahead: Ahead,
}

/// Knowledge about the stretch of the path ahead.
#[derive(Debug, Clone, Serialize, Deserialize)]
enum Ahead {
    /// Nothing is known about the stretch ahead.
    Unknown,
    /// Nothing has yielded on the stretch so far.
    Elastic(Box<ElasticStretch>),
    /// The material yields on the stretch ahead.
    Plastic,
}

impl PlasticDrive {
    /// Begins a drive from the current state to `end`; `taken` fixed increments were already taken
    /// on the piece.
    ///
    /// # Errors
    /// Errors of the monitor and of [`super::outgrown::accepted`].
    pub fn begin(
        solver: &mut Solver,
        end: &LoadPoint,
        taken: usize,
        monitor: Option<&Monitor>,
    ) -> Result<ControlFlow<Step, Self>> {
        solver.refresh();
        solver.update_scales();
        if solver.scales.force == 0.0 {
            // No force acts yet: residuals are measured against the load at the end of the piece.
            solver.scales.force = solver.structure.external(end).largest();
        }
        if turns_back(solver, end) {
            solver.assume_elastic();
            // If there was no step before, this is the first elastoplastic increment after elastic
            // increments that watched for first yield.
            let begins = solver.predictor.last_step.iter().all(|step| *step == 0.0);
            if begins {
                solver.predictor.flow.begins(&solver.at);
            } else {
                solver.predictor.flow.turns(&solver.at);
            }
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
        Ok(ControlFlow::Continue(PlasticDrive {
            whole: solver.at.distance(end),
            trust: f64::INFINITY,
            taken,
            monitored,
            ahead: Ahead::Unknown,
        }))
    }

    /// Takes the next increment on the way to `end`.
    ///
    /// # Errors
    /// [`crate::ErrorKind::Collapse`] with the last load factor in equilibrium; statuses that
    /// cycle; errors of the monitor and of [`super::outgrown::accepted`].
    pub fn step(
        &mut self,
        solver: &mut Solver,
        end: &LoadPoint,
        monitor: Option<&Monitor>,
        rules: Rules,
    ) -> Result<Step> {
        let follows = matches!(self.ahead, Ahead::Elastic(_));
        if !follows && solver.at.alpha.abs() > rules.zone_until {
            return Ok(Step::arrived(Arrival::ZoneOutgrown));
        }
        let may_be_elastic = !matches!(self.ahead, Ahead::Unknown) || solver.zone.is_idle();
        if may_be_elastic && rules.program.stepping != Stepping::Steps {
            if let Some(step) = self.follow(solver, end, monitor)? {
                return Ok(step);
            }
            if solver.at.distance(end) < ARRIVED * self.whole || solver.is_round_off(end) {
                let (from, solves) = (solver.at.alpha, solver.cost.counts.trailing_solves);
                arrive(solver, end);
                return contact_step(solver, from, "target", solves, Some(Arrival::End));
            }
        }
        if follows {
            solver.predictor.flow.begins(&solver.at);
        }
        self.ahead = Ahead::Unknown;
        self.increment(solver, end, monitor, rules)
    }

    /// Goes to the next event of a stretch on which nothing yields; `None` if the material yields
    /// on the way.
    fn follow(
        &mut self,
        solver: &mut Solver,
        end: &LoadPoint,
        monitor: Option<&Monitor>,
    ) -> Result<Option<Step>> {
        let stretch = match std::mem::replace(&mut self.ahead, Ahead::Plastic) {
            Ahead::Elastic(stretch) => *stretch,
            Ahead::Plastic => return Ok(None),
            Ahead::Unknown => match ElasticStretch::begin(solver, end) {
                Some(stretch) => stretch,
                None => return Ok(None),
            },
        };
        let (step, stretch) = stretch.step(solver, end, monitor, &mut self.monitored)?;
        if let Some(stretch) = stretch {
            self.ahead = Ahead::Elastic(Box::new(stretch));
        }
        Ok(step)
    }

    /// Takes one elastoplastic increment.
    fn increment(
        &mut self,
        solver: &mut Solver,
        end: &LoadPoint,
        monitor: Option<&Monitor>,
        rules: Rules,
    ) -> Result<Step> {
        let left = match rules.program.stepping {
            Stepping::Events => 1.0,
            Stepping::Auto => {
                (solver.predictor.flow).share(&solver.at, end, rules.program.path_error)
            }
            Stepping::Steps => 1.0 / rules.program.steps.saturating_sub(self.taken).max(1) as f64,
        };
        let distance = solver.at.distance(end);
        let trusted = if self.trust < left * distance {
            self.trust / distance
        } else {
            left
        };
        let (from, solves) = (solver.at.alpha, solver.cost.counts.trailing_solves);
        let (open, border) = (solver.tableau.open().to_vec(), solver.border.clone());
        // The state before the increment is needed only if the increment is repeated to land on a
        // target.
        let before = monitor.map(|_| solver.state());
        let smallest = SMALLEST_CUT * self.whole / distance;
        let (increment, cut) =
            Stepper::new(solver, rules).find_increment(end, trusted, smallest, None)?;
        self.trust = match (cut, trusted < left) {
            (true, _) => increment.t * distance,
            (false, true) => 2.0 * self.trust,
            (false, false) => f64::INFINITY,
        };
        if increment.guard_yields > 0 {
            solver.restore_statuses(&open, &border);
            return Ok(Step::arrived(Arrival::ZoneTooSmall));
        }
        let mut report = IncrementReport {
            iterations: increment.iterations,
            residual: increment.residual,
            ..IncrementReport::default()
        };
        let full = increment.t >= left;
        let mut at_end = increment.t >= 1.0;
        accept(solver, end, increment, &mut report);
        if !at_end && solver.at.distance(end) <= ARRIVED * self.whole {
            arrive(solver, end);
            at_end = true;
        }
        let mut arrival = at_end.then_some(Arrival::End);
        if let (Some(monitor), Some(was), Some(before)) = (monitor, self.monitored, before) {
            let is = monitor(solver)?;
            self.monitored = Some(is);
            if crosses(was, is) {
                let mut stepper = Stepper::new(solver, rules);
                stepper.land(end, &before, monitor, [was, is], &mut report)?;
                report.event = "target".to_string();
                arrival = Some(Arrival::Monitor);
            }
        }
        report.trailing_solves = solver.cost.counts.trailing_solves - solves;
        if arrival == Some(Arrival::End) {
            solver.at = end.clone();
        }
        if report.event.is_empty() {
            let event = if at_end { "target" } else { "step" };
            report.event = event.to_string();
        }
        self.taken += usize::from(full);
        accepted(solver, from, report, arrival)
    }
}
