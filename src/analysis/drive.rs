//! Moving along the load path: increments, elastic or elastoplastic, until a point, a measured
//! value or first yield.

use super::elastic::{ElasticPiece, describe};
use super::engine::{Engine, LoadPoint};
use super::increment::{Increment, STRETCH};
use super::place::{Leg, PlasticLeg, Watcher};
use super::recovery::{Peak, Recovery};
use super::saved::Saved;
use super::yield_load::{bracketed_root, yield_share};
use crate::contact::{Change, PathEnd};
use crate::error::{Error, ErrorKind, Result};
use crate::scene::{Settings, Stepping};
use std::cell::Cell;

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
pub type Monitor<'a> = dyn Fn(&mut Engine) -> Result<f64> + 'a;

/// How a drive ended.
#[derive(Debug, Clone, PartialEq)]
pub enum Arrival {
    /// At the end of the piece.
    End,
    /// Where the monitored quantity is zero.
    Monitor,
    /// At first yield.
    Yield(Peak),
    /// The caller stopped it.
    Stopped,
    /// A guard element flows: the zone must grow, the last increment was not taken.
    ZoneTooSmall,
    /// The load factor has left the range that the zone was chosen for.
    ZoneOutgrown,
}

/// How increments are taken.
#[derive(Clone, Copy)]
pub struct Stepper<'a> {
    /// Solver settings.
    pub settings: &'a Settings,
    /// From event to event, or fixed.
    pub stepping: Stepping,
    /// Increments per piece where fixed.
    pub steps: usize,
    /// How many of them have been taken.
    pub taken: &'a Cell<usize>,
    /// Tolerance of events.
    pub gamma: f64,
    /// Absolute load factor up to which the zone was chosen.
    pub zone_until: f64,
    /// Asked between iterations: true stops the run at the last accepted increment.
    pub stop: &'a dyn Fn() -> bool,
}

/// Accuracy with which a monitored quantity (of order 1) is hit, and relative accuracy of the
/// place.
pub(super) const MONITOR_ACCURACY: f64 = 1e-10;
/// Share of a piece of the load path below which what is left of it is round-off. Unloaded to zero,
/// the last pair's force is that of the load and of the iteration's imbalance: where it vanishes
/// means nothing there.
const ARRIVED: f64 = 1e-9;
/// Share of a piece of the load path below which increments are not cut: the load has passed the
/// limit load, which is then known to this share.
pub(super) const SMALLEST_CUT: f64 = 1e-6;

impl Engine<'_> {
    /// Elastic drive: contact changes alone. With `recovery` it stops at first yield. With `leg` it
    /// goes on from there.
    ///
    /// # Errors
    /// A load that drives a body away from every contact; those of the monitor.
    pub fn drive_elastic(
        &mut self,
        end: &LoadPoint,
        mut recovery: Option<&mut Recovery>,
        monitor: Option<&Monitor>,
        leg: Option<Leg>,
        watcher: &mut dyn Watcher,
    ) -> Result<Arrival> {
        self.reached = self.at.alpha;
        let resumed = match leg {
            Some(Leg::Elastic { piece, watched }) => Some((*piece, watched)),
            _ => None,
        };
        let mut samples = match &mut recovery {
            Some(recovery) => {
                self.refresh();
                let samples = recovery.sample(&self.now.u, &self.at.factors);
                if resumed.is_none()
                    && let Some(peak) = recovery
                        .peak(self.model, &samples)
                        .filter(|p| p.ratio > 1.0)
                {
                    return Ok(Arrival::Yield(peak));
                }
                Some(samples)
            }
            None => None,
        };
        let (mut piece, mut watched) = match resumed {
            Some(resumed) => resumed,
            None => {
                let watched = monitor.map(|m| m(self)).transpose()?;
                if is_hit(watched) {
                    return Ok(Arrival::Monitor);
                }
                if self.rests_at(end) {
                    let goes_on = self.note(watcher, "target", self.counts.trailing_solves)?;
                    return Ok(if goes_on {
                        Arrival::End
                    } else {
                        Arrival::Stopped
                    });
                }
                (ElasticPiece::new(self, end)?, watched)
            }
        };
        loop {
            let solves = self.counts.trailing_solves;
            let before = piece.t();
            let outcome = piece.advance(self, 1.0);
            if let (Some(recovery), Some(from)) = (&mut recovery, &mut samples) {
                self.refresh();
                let to = recovery.sample(&self.now.u, &self.at.factors);
                if recovery
                    .peak(self.model, &to)
                    .is_some_and(|p| p.ratio >= 1.0)
                {
                    let (share, peak) = yield_share(self, recovery, from, &to);
                    piece.go_back(self, before + share * (piece.t() - before));
                    self.refresh();
                    if let Some(peak) = peak {
                        self.note(watcher, "yield", solves)?;
                        return Ok(Arrival::Yield(peak));
                    }
                }
                *from = to;
            }
            if let (Some(monitor), Some(was)) = (monitor, watched) {
                let is = monitor(self)?;
                if is == 0.0 || (is > 0.0) != (was > 0.0) {
                    let (from, to) = (before, piece.t());
                    let sign = if is > was { 1.0 } else { -1.0 };
                    let ends = [(from, sign * was), (to, sign * is)];
                    let t = bracketed_root(ends[0], ends[1], MONITOR_ACCURACY, |t| {
                        piece.go_back(self, t);
                        monitor(self).map(|value| sign * value)
                    })?;
                    piece.go_back(self, t);
                    self.refresh();
                    self.note(watcher, "target", solves)?;
                    return Ok(Arrival::Monitor);
                }
                watched = Some(is);
            }
            match outcome {
                PathEnd::Target => {
                    self.at = end.clone();
                    return Ok(if self.note(watcher, "target", solves)? {
                        Arrival::End
                    } else {
                        Arrival::Stopped
                    });
                }
                PathEnd::Event(changes) => {
                    let goes_on = self.note(watcher, &describe(&changes), solves)?;
                    piece.turn(self)?;
                    watcher.resumable(self, &|| Leg::Elastic {
                        piece: Box::new(piece.clone()),
                        watched,
                    })?;
                    if !goes_on {
                        return Ok(Arrival::Stopped);
                    }
                }
            }
        }
    }

    fn note(
        &mut self,
        watcher: &mut dyn Watcher,
        event: &str,
        solves_before: usize,
    ) -> Result<bool> {
        self.update_scales();
        let trailing_solves = self.counts.trailing_solves - solves_before;
        self.accepted(
            watcher,
            &IncrementReport {
                event: event.to_string(),
                trailing_solves,
                ..IncrementReport::default()
            },
        )
    }

    /// Elastoplastic drive to `end`. With `leg` it goes on from there.
    ///
    /// # Errors
    /// [`ErrorKind::Collapse`] with the load factor that was held; statuses that cycle; those of
    /// the monitor.
    pub fn drive_plastic(
        &mut self,
        end: &LoadPoint,
        stepper: Stepper,
        monitor: Option<&Monitor>,
        leg: Option<Leg>,
        watcher: &mut dyn Watcher,
    ) -> Result<Arrival> {
        self.reached = self.at.alpha;
        let mut leg = match leg {
            Some(Leg::Plastic(leg)) => leg,
            _ => {
                let leg = self.begin_plastic(end, monitor)?;
                if is_hit(leg.watched) {
                    return Ok(Arrival::Monitor);
                }
                leg
            }
        };
        let smallest = SMALLEST_CUT * leg.whole;
        loop {
            if leg.following.is_none() && self.at.alpha.abs() > stepper.zone_until {
                return Ok(Arrival::ZoneOutgrown);
            }
            let left = match stepper.stepping {
                Stepping::Events => 1.0,
                Stepping::Steps => {
                    1.0 / stepper.steps.saturating_sub(stepper.taken.get()).max(1) as f64
                }
            };
            if (leg.following.is_some() || self.zone.is_idle())
                && stepper.stepping == Stepping::Events
            {
                if let Some(arrival) = self.follow_elastic(end, monitor, &mut leg, watcher)? {
                    return Ok(arrival);
                }
                if self.at.distance(end) < ARRIVED * leg.whole || self.is_round_off(end) {
                    let solves = self.counts.trailing_solves;
                    self.arrive(end);
                    return Ok(if self.note(watcher, "target", solves)? {
                        Arrival::End
                    } else {
                        Arrival::Stopped
                    });
                }
            }
            let distance = self.at.distance(end);
            let trusted = if leg.trust < left * distance {
                leg.trust / distance
            } else {
                left
            };
            let saved = Saved::of(self);
            let solves = self.counts.trailing_solves;
            let (increment, cut) =
                self.find_increment(end, trusted, smallest / distance, stepper)?;
            leg.trust = match (cut, trusted < left) {
                (true, _) => increment.t * distance,
                (false, true) => 2.0 * leg.trust,
                (false, false) => f64::INFINITY,
            };
            if increment.guard_flows > 0 {
                saved.put_back(self);
                return Ok(Arrival::ZoneTooSmall);
            }
            let mut reported = IncrementReport {
                event: String::new(),
                iterations: increment.iterations,
                trailing_solves: 0,
                residual: increment.residual,
            };
            let full = increment.t >= left;
            let mut at_end = increment.t >= 1.0;
            self.accept(end, increment, &mut reported);
            if !at_end && self.at.distance(end) <= ARRIVED * leg.whole {
                self.arrive(end);
                at_end = true;
            }
            if let (Some(monitor), Some(was)) = (monitor, leg.watched) {
                let is = monitor(self)?;
                if is == 0.0 || (is > 0.0) != (was > 0.0) {
                    self.hit(end, &saved, stepper, monitor, [was, is], &mut reported)?;
                    reported.trailing_solves = self.counts.trailing_solves - solves;
                    reported.event = "target".to_string();
                    self.accepted(watcher, &reported)?;
                    return Ok(Arrival::Monitor);
                }
                leg.watched = Some(is);
            }
            reported.trailing_solves = self.counts.trailing_solves - solves;
            if at_end {
                self.at = end.clone();
                if reported.event.is_empty() {
                    reported.event = "target".to_string();
                }
            } else if reported.event.is_empty() {
                reported.event = "step".to_string();
            }
            stepper.taken.update(|taken| taken + usize::from(full));
            let goes_on = self.accepted(watcher, &reported)?;
            if goes_on && at_end {
                return Ok(Arrival::End);
            }
            if !at_end {
                watcher.resumable(self, &|| Leg::Plastic(leg.clone()))?;
            }
            if !goes_on {
                return Ok(Arrival::Stopped);
            }
        }
    }

    /// What an elastoplastic drive begins with.
    fn begin_plastic(&mut self, end: &LoadPoint, monitor: Option<&Monitor>) -> Result<PlasticLeg> {
        self.refresh();
        self.update_scales();
        if self.force_scale == 0.0 {
            // Nothing acts yet: residuals are measured against what the end of the piece applies.
            self.force_scale = self.external(end).largest();
        }
        if self.turns_back(end) {
            self.assume_elastic();
        }
        Ok(PlasticLeg {
            watched: monitor.map(|m| m(self)).transpose()?,
            whole: self.at.distance(end),
            // After an increment that did not converge the next ones are short, and grow again
            // while they succeed.
            trust: f64::INFINITY,
            following: None,
        })
    }

    /// Goes the last bit to `end` with the statuses and plastic strains at hand.
    fn arrive(&mut self, end: &LoadPoint) {
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
        self.last_step = self.at.step_to(end);
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
        self.pace = is_known.then(|| {
            let mut pace = increment.state.initial.clone();
            pace.add(-1.0, &self.now.initial);
            pace.scale(1.0 / way);
            pace
        });
        self.at = start.towards(end, increment.t);
        self.now = increment.state;
        self.fresh = true;
        self.zone.commit();
        self.border = increment.changes;
        for k in self.border.clone() {
            if self.tableau.flip(k) {
                self.counts.contact_changes += 1;
            }
        }
        // Within gamma of its condition's border a pair may be beyond it by as much.
        for value in self.now.gap.iter_mut().chain(&mut self.now.force) {
            *value = value.max(0.0);
        }
        self.update_scales();
        reported.event = describe(&changes);
    }
}

/// Whether a drive begins where the monitored quantity is zero already: on the way it would not
/// change its sign there.
fn is_hit(watched: Option<f64>) -> bool {
    watched.is_some_and(|value| value.abs() <= MONITOR_ACCURACY)
}

/// The error of a run that its caller stopped.
pub fn stopped() -> Error {
    Error::new(ErrorKind::Stopped, "stopped on request")
}

impl Engine<'_> {
    /// Whether nothing has moved yet and nothing is to, on the way to `end`: what a solve would
    /// find there is round-off.
    fn rests_at(&self, end: &LoadPoint) -> bool {
        let still = self.now.u.largest() == 0.0 && self.now.force.iter().all(|r| *r == 0.0);
        let apart = self.now.gap.iter().all(|g| *g >= 0.0);
        self.at == *end && self.fresh && still && apart && self.now.gap == self.delta(end)
    }

    /// Whether the way to `end` leads back against the last increment: then the material unloads
    /// elastically at first.
    fn turns_back(&self, end: &LoadPoint) -> bool {
        let step = self.at.step_to(end);
        let along: f64 = step.iter().zip(&self.last_step).map(|(a, b)| a * b).sum();
        along <= 0.0
    }
}
