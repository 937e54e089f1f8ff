//! Elastoplastic drives: increments that end at the next change of contact, or fixed ones.

use super::drive::{Arrival, IncrementReport, Monitor, Rules, SMALLEST_CUT, Step, crosses, is_hit};
use super::engine::Engine;
use super::load_point::LoadPoint;
use super::stretch::ElasticStretch;
use crate::error::Result;
use crate::scene::Stepping;
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;

/// Share of a piece of the load path below which what is left of it is round-off. Unloaded to zero,
/// the last pair's force is that of the load and of the iteration's imbalance: where it vanishes
/// means nothing there.
const ARRIVED: f64 = 1e-9;

/// An elastoplastic drive between two increments.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct PlasticDrive {
    /// Distance to the end at the start.
    whole: f64,
    /// Distance that the next increment is trusted with: after one that did not converge the next
    /// ones are short, and grow again while they succeed.
    trust: f64,
    /// Fixed increments that were taken on the piece.
    pub(super) taken: usize,
    /// The monitored quantity at the last increment.
    pub(super) monitored: Option<f64>,
    ahead: Ahead,
}

/// What is known of the stretch ahead.
#[derive(Debug, Clone, Serialize, Deserialize)]
enum Ahead {
    /// Nothing.
    Unknown,
    /// Nothing has yielded on it so far.
    Elastic(Box<ElasticStretch>),
    /// The material yields.
    Plastic,
}

impl PlasticDrive {
    /// Begins a drive from the current state to `end`, of whose piece `taken` fixed increments were
    /// taken already.
    ///
    /// # Errors
    /// Those of the monitor.
    pub fn begin(
        engine: &mut Engine,
        end: &LoadPoint,
        taken: usize,
        monitor: Option<&Monitor>,
    ) -> Result<ControlFlow<Step, Self>> {
        engine.refresh();
        engine.update_scales();
        if engine.force_scale == 0.0 {
            // Nothing acts yet: residuals are measured against what the end of the piece applies.
            engine.force_scale = engine.external(end).largest();
        }
        if engine.turns_back(end) {
            engine.assume_elastic();
        }
        let monitored = monitor.map(|m| m(engine)).transpose()?;
        if is_hit(monitored) {
            return Ok(ControlFlow::Break(Step::arrived(Arrival::Monitor)));
        }
        Ok(ControlFlow::Continue(PlasticDrive {
            whole: engine.at.distance(end),
            trust: f64::INFINITY,
            taken,
            monitored,
            ahead: Ahead::Unknown,
        }))
    }

    /// The next increment on the way to `end`.
    ///
    /// # Errors
    /// [`crate::ErrorKind::Collapse`] with the load factor that was held; statuses that cycle;
    /// those of the monitor and of [`Engine::accepted`].
    pub fn step(
        &mut self,
        engine: &mut Engine,
        end: &LoadPoint,
        monitor: Option<&Monitor>,
        rules: Rules,
    ) -> Result<Step> {
        let follows = matches!(self.ahead, Ahead::Elastic(_));
        if !follows && engine.at.alpha.abs() > rules.zone_until {
            return Ok(Step::arrived(Arrival::ZoneOutgrown));
        }
        let may_be_elastic = !matches!(self.ahead, Ahead::Unknown) || engine.zone.is_idle();
        if may_be_elastic && rules.stepping == Stepping::Events {
            if let Some(step) = self.follow(engine, end, monitor)? {
                return Ok(step);
            }
            if engine.at.distance(end) < ARRIVED * self.whole || engine.is_round_off(end) {
                let (from, solves) = (engine.at.alpha, engine.counts.trailing_solves);
                engine.arrive(end);
                return engine.contact_step(from, "target", solves, Some(Arrival::End));
            }
        }
        self.ahead = Ahead::Unknown;
        self.increment(engine, end, monitor, rules)
    }

    /// The next event of a stretch on which nothing yields; `None` where there is none.
    fn follow(
        &mut self,
        engine: &mut Engine,
        end: &LoadPoint,
        monitor: Option<&Monitor>,
    ) -> Result<Option<Step>> {
        let stretch = match std::mem::replace(&mut self.ahead, Ahead::Plastic) {
            Ahead::Elastic(stretch) => *stretch,
            Ahead::Plastic => return Ok(None),
            Ahead::Unknown => match ElasticStretch::begin(engine, end) {
                Some(stretch) => stretch,
                None => return Ok(None),
            },
        };
        let (step, stretch) = stretch.step(engine, end, monitor, &mut self.monitored)?;
        if let Some(stretch) = stretch {
            self.ahead = Ahead::Elastic(Box::new(stretch));
        }
        Ok(step)
    }

    /// An elastoplastic increment.
    fn increment(
        &mut self,
        engine: &mut Engine,
        end: &LoadPoint,
        monitor: Option<&Monitor>,
        rules: Rules,
    ) -> Result<Step> {
        let left = match rules.stepping {
            Stepping::Events => 1.0,
            Stepping::Steps => 1.0 / rules.steps.saturating_sub(self.taken).max(1) as f64,
        };
        let distance = engine.at.distance(end);
        let trusted = if self.trust < left * distance {
            self.trust / distance
        } else {
            left
        };
        let (from, solves) = (engine.at.alpha, engine.counts.trailing_solves);
        let (open, border) = (engine.tableau.open().to_vec(), engine.border.clone());
        // Only a search for the place of the target goes back behind an accepted increment.
        let before = monitor.map(|_| engine.state());
        let smallest = SMALLEST_CUT * self.whole / distance;
        let (increment, cut) = engine.find_increment(end, trusted, smallest, None, rules)?;
        self.trust = match (cut, trusted < left) {
            (true, _) => increment.t * distance,
            (false, true) => 2.0 * self.trust,
            (false, false) => f64::INFINITY,
        };
        if increment.guard_flows > 0 {
            engine.restore_statuses(&open, &border);
            return Ok(Step::arrived(Arrival::ZoneTooSmall));
        }
        let mut report = IncrementReport {
            iterations: increment.iterations,
            residual: increment.residual,
            ..IncrementReport::default()
        };
        let full = increment.t >= left;
        let mut at_end = increment.t >= 1.0;
        engine.accept(end, increment, &mut report);
        if !at_end && engine.at.distance(end) <= ARRIVED * self.whole {
            engine.arrive(end);
            at_end = true;
        }
        let mut arrival = at_end.then_some(Arrival::End);
        if let (Some(monitor), Some(was), Some(before)) = (monitor, self.monitored, before) {
            let is = monitor(engine)?;
            self.monitored = Some(is);
            if crosses(was, is) {
                engine.land(end, &before, rules, monitor, [was, is], &mut report)?;
                report.event = "target".to_string();
                arrival = Some(Arrival::Monitor);
            }
        }
        report.trailing_solves = engine.counts.trailing_solves - solves;
        if arrival == Some(Arrival::End) {
            engine.at = end.clone();
        }
        if report.event.is_empty() {
            let event = if at_end { "target" } else { "step" };
            report.event = event.to_string();
        }
        self.taken += usize::from(full);
        engine.accepted(from, report, arrival)
    }
}
