//! What is accepted: increments, events of contact alone, and the end of a piece.

use super::outcome::{Increment, STRETCH};
use super::step::{Arrival, IncrementReport, Step, describe};
use crate::analysis::structure::load_point::LoadPoint;
use crate::analysis::structure::solver::{Pace, Solver};
use crate::contact::Change;
use crate::error::Result;

impl Solver<'_> {
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
    pub(in crate::analysis) fn arrive(&mut self, end: &LoadPoint) {
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
