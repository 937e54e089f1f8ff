//! Moving along a straight piece of the load path, one increment at a time, until its end, a
//! measured value or first yield.

use super::elastic::{ElasticDrive, describe};
use super::increment::{Increment, STRETCH};
use super::load_point::LoadPoint;
use super::plastic::PlasticDrive;
use super::recovery::{Peak, Recovery};
use super::solver::{Pace, Solver};
use crate::contact::Change;
use crate::error::{Error, ErrorKind, Result};
use crate::scene::{Program, Settings, Stepping};
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;

/// An accepted increment.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct IncrementReport {
    /// What ended it.
    pub event: String,
    /// Material evaluations.
    pub iterations: usize,
    /// Trailing solves.
    pub trailing_solves: usize,
    /// Relative out-of-balance force.
    pub residual: f64,
}

/// A measured quantity that ends a drive when it changes sign.
pub type Monitor<'a> = dyn Fn(&mut Solver) -> Result<f64> + 'a;

/// How a drive ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Arrival {
    /// At the end of the piece.
    End,
    /// Where the monitored quantity is zero.
    Monitor,
    /// At first yield.
    Yield(Peak),
    /// A guard element yields: the zone must grow, the last increment was not taken.
    ZoneTooSmall,
    /// The load factor has left the range that the zone was chosen for.
    ZoneOutgrown,
}

/// What a step of a drive came to.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Step {
    /// The increment that was accepted, if one was.
    pub increment: Option<IncrementReport>,
    /// How the drive ended, if it did.
    pub arrival: Option<Arrival>,
}

impl Step {
    /// The end of a drive without a further increment.
    pub fn arrived(arrival: Arrival) -> Self {
        Step {
            increment: None,
            arrival: Some(arrival),
        }
    }
}

/// How increments are taken.
#[derive(Clone, Copy)]
pub struct Rules<'a> {
    /// Solver settings.
    pub settings: &'a Settings,
    /// How increments are chosen.
    pub stepping: Stepping,
    /// The program: the tolerances and numbers of increments.
    pub program: &'a Program,
    /// Absolute load factor up to which the zone was chosen.
    pub zone_until: f64,
    /// Asked between iterations: true stops the run at the last accepted increment.
    pub stop: &'a dyn Fn() -> bool,
}

/// A drive along a straight piece of the load path, between two increments.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub enum Drive {
    /// Contact changes alone.
    Elastic(Box<ElasticDrive>),
    /// The material may yield.
    Plastic(PlasticDrive),
}

impl Drive {
    /// The next increment, or the end of the drive. `recovery` is looked at for first yield where
    /// the drive is watched for that.
    ///
    /// # Errors
    /// Those of [`ElasticDrive::step`] and [`PlasticDrive::step`].
    pub fn step(
        &mut self,
        solver: &mut Solver,
        end: &LoadPoint,
        recovery: Option<&mut Recovery>,
        monitor: Option<&Monitor>,
        rules: Rules,
    ) -> Result<Step> {
        match self {
            Drive::Elastic(drive) => drive.step(solver, end, recovery, monitor),
            Drive::Plastic(drive) => drive.step(solver, end, monitor, rules),
        }
    }

    /// Whether first yield ends it.
    pub fn watches_yield(&self) -> bool {
        matches!(self, Drive::Elastic(drive) if drive.watches_yield)
    }

    /// Fixed increments that were taken on the piece.
    pub fn taken(&self) -> usize {
        match self {
            Drive::Elastic(_) => 0,
            Drive::Plastic(drive) => drive.taken,
        }
    }

    /// The monitored quantity at the last increment.
    pub fn monitored(&self) -> Option<f64> {
        match self {
            Drive::Elastic(drive) => drive.monitored,
            Drive::Plastic(drive) => drive.monitored,
        }
    }
}

/// Accuracy with which a monitored quantity (of order 1) is landed on, and relative accuracy of the
/// place.
pub(super) const MONITOR_ACCURACY: f64 = 1e-10;
/// Share of a piece of the load path below which increments are not cut: the load has passed the
/// limit load, which is then known to this share.
pub(super) const SMALLEST_CUT: f64 = 1e-6;

/// Whether a drive begins where the monitored quantity is zero already: on the way it would not
/// change its sign there.
pub(super) fn is_hit(monitored: Option<f64>) -> bool {
    monitored.is_some_and(|value| value.abs() <= MONITOR_ACCURACY)
}

/// Whether a monitored quantity is zero or has changed its sign.
pub(super) fn crosses(was: f64, is: f64) -> bool {
    is == 0.0 || (is > 0.0) != (was > 0.0)
}

/// The error of a run that its caller stopped.
pub fn stopped() -> Error {
    Error::new(ErrorKind::Stopped, "stopped on request")
}

impl Solver<'_> {
    /// Goes to `end` elastically, or to first yield with `recovery`; nobody is notified of the
    /// increments.
    ///
    /// # Errors
    /// Those of [`ElasticDrive::step`].
    pub fn drive_elastic(
        &mut self,
        end: &LoadPoint,
        mut recovery: Option<&mut Recovery>,
    ) -> Result<Arrival> {
        let begun = ElasticDrive::begin(self, end, recovery.as_deref_mut(), None)?;
        let mut drive = match begun {
            ControlFlow::Continue(drive) => drive,
            ControlFlow::Break(step) => {
                let nowhere = || Error::internal("a drive that ended nowhere");
                return step.arrival.ok_or_else(nowhere);
            }
        };
        loop {
            let step = drive.step(self, end, recovery.as_deref_mut(), None)?;
            if let Some(arrival) = step.arrival {
                return Ok(arrival);
            }
        }
    }

    /// An increment in which contact alone changed was accepted; the one before it ended at load
    /// factor `from`, and after `solves_before` trailing solves.
    ///
    /// # Errors
    /// Those of [`Solver::accepted`].
    pub(super) fn contact_step(
        &mut self,
        from: f64,
        event: &str,
        solves_before: usize,
        arrival: Option<Arrival>,
    ) -> Result<Step> {
        self.update_scales();
        let report = IncrementReport {
            event: event.to_string(),
            trailing_solves: self.cost.counts.trailing_solves - solves_before,
            ..IncrementReport::default()
        };
        self.accepted(from, report, arrival)
    }

    /// Goes the last bit to `end` with the statuses and plastic strains at hand.
    pub(super) fn arrive(&mut self, end: &LoadPoint) {
        let initial = self.now.initial.clone();
        self.now = self.respond(end, initial);
        self.at = end.clone();
        for value in self.now.gap.iter_mut().chain(&mut self.now.force) {
            *value = value.max(0.0);
        }
    }

    /// Takes a found increment: history, state, and the statuses beyond it.
    pub(super) fn accept(
        &mut self,
        end: &LoadPoint,
        increment: Increment,
        reported: &mut IncrementReport,
    ) {
        let start = self.at.clone();
        self.predictor.last_step = self.at.step_to(end);
        let changes: Vec<Change> = increment
            .changes
            .iter()
            .map(|&k| {
                if self.tableau.open()[k] {
                    Change::Closes(k)
                } else {
                    Change::Opens(k)
                }
            })
            .collect();
        let way = increment.t * start.distance(end);
        // What a far shorter increment leaves is mostly its round-off.
        let is_known = way > 0.0 && increment.t > 1.0 / STRETCH && !self.zone.is_idle();
        self.predictor.pace = is_known.then(|| {
            let mut pace = increment.state.initial.clone();
            pace.add(-1.0, &self.now.initial);
            pace.scale(1.0 / way);
            Pace {
                initial: pace,
                distance: way,
                stretched: increment.stretched,
            }
        });
        self.at = start.towards(end, increment.t);
        self.now = increment.state;
        self.fresh = true;
        self.zone.commit();
        self.border = increment.changes;
        for k in self.border.clone() {
            if self.tableau.flip(k) {
                self.cost.counts.contact_changes += 1;
            }
        }
        // Within gamma of its condition's border a pair may be beyond it by as much.
        for value in self.now.gap.iter_mut().chain(&mut self.now.force) {
            *value = value.max(0.0);
        }
        self.update_scales();
        reported.event = describe(&changes);
    }
    /// Whether the current state is that of `end`: what another solve would change is round-off. A
    /// state in which nothing has moved yet must be apart; any other was solved for.
    pub(super) fn rests_at(&self, end: &LoadPoint) -> bool {
        let moved = self.now.u.largest() != 0.0 || self.now.force.iter().any(|r| *r != 0.0);
        let apart = self.now.gap.iter().all(|g| *g >= 0.0);
        let solved = moved || apart && self.now.gap == self.structure.delta(end);
        self.at == *end && self.fresh && solved
    }

    /// Whether the way to `end` leads back against the last increment: then the material unloads
    /// elastically at first.
    pub(super) fn turns_back(&self, end: &LoadPoint) -> bool {
        let step = self.at.step_to(end);
        let along: f64 = step
            .iter()
            .zip(&self.predictor.last_step)
            .map(|(a, b)| a * b)
            .sum();
        along <= 0.0
    }
}
