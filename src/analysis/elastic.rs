//! Elastic pieces of the load path: contact alone changes, from event to event, on the dense matrix
//! only.

use super::drive::{Arrival, IncrementReport, MONITOR_ACCURACY, Monitor};
use super::engine::{Engine, LoadPoint};
use super::place::{Leg, PlasticLeg, Watcher};
use super::yield_load::bracketed_root;
use crate::contact::{self, Change, Path, PathEnd};
use crate::error::Result;
use serde::{Deserialize, Serialize};

/// Follows contact along a straight piece of the load path with the plastic strains frozen.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ElasticPiece {
    start: LoadPoint,
    end: LoadPoint,
    path: Path,
}

impl ElasticPiece {
    /// A piece from the engine's current state to `end`.
    ///
    /// # Errors
    /// A load that drives a body away from every contact.
    pub fn new(engine: &mut Engine, end: &LoadPoint) -> Result<Self> {
        let start = engine.at.clone();
        let mut q0 = engine.closed_forces(&start);
        let q1 = engine.closed_forces(end);
        let rate: Vec<f64> = q1.iter().zip(&q0).map(|(b, a)| b - a).collect();
        for (q, t) in q0.iter_mut().zip(&engine.now.initial.forces) {
            *q += t;
        }
        if engine.now.force.iter().all(|r| *r == 0.0) {
            close_gap_of_floating_bodies(engine, &q0, &rate)?;
        }
        let gap_scale = engine
            .delta(&start)
            .iter()
            .fold(0.0f64, |m, d| m.max(d.abs()));
        let (gap, force) = (engine.now.gap.clone(), engine.now.force.clone());
        let terms = engine.closed_forces_size(&start);
        let path = Path::new(&mut engine.tableau, q0, rate, gap, force, gap_scale, terms)
            .map_err(|u| engine.unbounded(u.pair, start.alpha))?;
        engine.counts.contact_changes += path.changes;
        Ok(ElasticPiece {
            start,
            end: end.clone(),
            path,
        })
    }

    /// Goes to the next event, at most to share `t` of the piece; the engine's gaps and forces
    /// follow.
    pub fn advance(&mut self, engine: &mut Engine, t: f64) -> PathEnd {
        let outcome = self.path.advance(&mut engine.tableau, t);
        self.write(engine);
        outcome
    }

    /// Goes to share `t` of the piece with the current statuses: they must hold there.
    pub fn go_back(&mut self, engine: &mut Engine, t: f64) {
        self.path.state_at(&mut engine.tableau, t);
        self.write(engine);
    }

    /// Settles the statuses beyond an event.
    ///
    /// # Errors
    /// A load that drives a body away from every contact.
    pub fn turn(&mut self, engine: &mut Engine) -> Result<()> {
        self.path
            .turn(&mut engine.tableau)
            .map_err(|u| engine.unbounded(u.pair, engine.at.alpha))?;
        engine.counts.contact_changes += self.path.changes;
        Ok(())
    }

    /// Share of the piece that lies behind.
    pub fn t(&self) -> f64 {
        self.path.t
    }

    fn write(&self, engine: &mut Engine) {
        engine.at = self.start.towards(&self.end, self.path.t);
        engine.now.gap.copy_from_slice(&self.path.gap);
        engine.now.force.copy_from_slice(&self.path.force);
        engine.fresh = false;
        engine.border.clear();
    }
}

/// Where [`Engine::follow_elastic`] is between two events.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Following {
    /// Where it began.
    start: LoadPoint,
    piece: ElasticPiece,
    /// Pairs of the last event.
    border: Vec<usize>,
    /// Statuses beyond it.
    open: Vec<bool>,
    /// Trailing solves that were reported.
    solves: usize,
}

impl Engine<'_> {
    /// Follows unloading (or reloading) on the dense contact matrix for as long as no point flows,
    /// event by event; `None` where the next stretch flows, with the last event before it as
    /// current state.
    ///
    /// This is the same path as that of elastoplastic increments in which nothing flows. Initial
    /// loads are constant, so the first half of a trailing solve is linear in the load factor and
    /// done once for all events; each event costs the second half and one look at all points of the
    /// zone. That look suffices: between two events strains are linear in the load factor and von
    /// Mises' stress is a convex function of them, so where both ends of a stretch lie within the
    /// yield surface all of it does.
    ///
    /// With [`PlasticLeg::following`] it goes on from there.
    ///
    /// # Errors
    /// Those of the watcher.
    pub fn follow_elastic(
        &mut self,
        end: &LoadPoint,
        monitor: Option<&Monitor>,
        leg: &mut PlasticLeg,
        watcher: &mut dyn Watcher,
    ) -> Result<Option<Arrival>> {
        let resumed = leg.following.take();
        let solves = resumed.as_ref().map(|following| following.solves);
        let begun = match resumed {
            Some(following) => Some(*following),
            None => self.begin_following(end),
        };
        let Some(Following {
            start,
            mut piece,
            mut border,
            mut open,
            ..
        }) = begun
        else {
            return Ok(None);
        };
        let n = self.now.gap.len();
        let mut forces = vec![0.0; n];
        let mut eliminated = self.external(&start);
        let mut change = self.external(end);
        change.add(-1.0, &eliminated);
        eliminated.add(1.0, &self.now.initial.load);
        self.sub.eliminate(&mut eliminated, &mut forces);
        self.sub.eliminate(&mut change, &mut forces);
        let mut balance = self.sub.zeros();
        // One that goes on has counted the two before.
        let mut solves = match solves {
            Some(solves) => solves,
            None => {
                self.count_half();
                self.count_half();
                self.counts.trailing_solves
            }
        };
        loop {
            let before = piece.t();
            let saved = (
                self.at.clone(),
                self.now.gap.clone(),
                self.now.force.clone(),
            );
            let outcome = piece.advance(self, 1.0);
            let mut u = eliminated.clone();
            u.add(piece.t(), &change);
            let delta = self.delta(&self.at);
            let (slip, _) = self.sub.split_slip(&delta, &self.now.gap);
            self.sub.recover(&mut u, &slip);
            self.count_half();
            self.zone.set_factors(&self.at.factors);
            let evaluation = self.zone.evaluate(&u, &mut balance);
            self.counts.plastic_iterations += 1;
            if evaluation.flowing > 0 {
                self.assume_elastic();
                (self.at, self.now.gap, self.now.force) = saved;
                self.set_statuses(&open, border);
                return Ok(None);
            }
            std::mem::swap(&mut self.now.u, &mut u);
            self.fresh = true;
            self.last_step = start.step_to(end);
            self.update_scales();
            balance.add(-1.0, &self.now.initial.load);
            let mut reported = IncrementReport {
                event: "target".to_string(),
                iterations: 1,
                trailing_solves: self.counts.trailing_solves - solves,
                residual: balance.largest() / self.force_scale.max(f64::MIN_POSITIVE),
            };
            solves = self.counts.trailing_solves;
            if let (Some(monitor), Some(was)) = (monitor, leg.watched) {
                let is = monitor(self)?;
                if is == 0.0 || (is > 0.0) != (was > 0.0) {
                    let (from, to) = (before, piece.t());
                    let sign = if is > was { 1.0 } else { -1.0 };
                    let accuracy = MONITOR_ACCURACY * (to - from).abs().max(f64::MIN_POSITIVE);
                    let ends = [(from, sign * was), (to, sign * is)];
                    let t = bracketed_root(ends[0], ends[1], accuracy, |t| {
                        piece.go_back(self, t);
                        monitor(self).map(|value| sign * value)
                    })?;
                    piece.go_back(self, t);
                    self.refresh();
                    self.accepted(watcher, &reported)?;
                    return Ok(Some(Arrival::Monitor));
                }
                leg.watched = Some(is);
            }
            let PathEnd::Event(changes) = outcome else {
                self.at = end.clone();
                let goes_on = self.accepted(watcher, &reported)?;
                return Ok(Some(if goes_on {
                    Arrival::End
                } else {
                    Arrival::Stopped
                }));
            };
            reported.event = describe(&changes);
            border = changes
                .iter()
                .map(|change| match *change {
                    Change::Closes(k) | Change::Opens(k) => k,
                })
                .collect();
            let before_turn = self.tableau.open().to_vec();
            if piece.turn(self).is_err() {
                // No rates beyond this event: elastoplastic increments find out why.
                self.set_statuses(&before_turn, border);
                self.accepted(watcher, &reported)?;
                return Ok(None);
            }
            open = self.tableau.open().to_vec();
            let goes_on = self.accepted(watcher, &reported)?;
            watcher.resumable(self, &|| {
                let following = Following {
                    start: start.clone(),
                    piece: piece.clone(),
                    border: border.clone(),
                    open: open.clone(),
                    solves,
                };
                Leg::Plastic(PlasticLeg {
                    following: Some(Box::new(following)),
                    ..*leg
                })
            })?;
            if !goes_on {
                return Ok(Some(Arrival::Stopped));
            }
        }
    }

    /// The begin of a stretch on which nothing flows, if there can be one.
    fn begin_following(&mut self, end: &LoadPoint) -> Option<Following> {
        if self.now.force.iter().all(|r| *r == 0.0) {
            return None;
        }
        self.refresh();
        let start = self.at.clone();
        let border = self.border.clone();
        let open = self.tableau.open().to_vec();
        let Ok(piece) = ElasticPiece::new(self, end) else {
            self.set_statuses(&open, border);
            return None;
        };
        Some(Following {
            start,
            piece,
            border,
            open,
            solves: 0,
        })
    }

    fn set_statuses(&mut self, open: &[bool], border: Vec<usize>) {
        for (k, &open) in open.iter().enumerate() {
            if self.tableau.open()[k] != open {
                self.tableau.flip(k);
            }
        }
        self.border = border;
        self.fresh = false;
        self.refresh();
    }
}

/// A floating body with gaps all round moves rigidly under the first bit of load until it touches:
/// the contact problem is solved directly there, and the gaps of that solution are where the path
/// starts.
fn close_gap_of_floating_bodies(engine: &mut Engine, q0: &[f64], rate: &[f64]) -> Result<()> {
    let n = q0.len();
    if engine.model.floating.bodies.is_empty() || (0..n).any(|k| engine.now.gap[k] <= 0.0) {
        return Ok(());
    }
    let largest = |v: &[f64]| v.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    // Small against the piece, large against the round-off of q0 (which carries the rigid motion).
    let share = 1e-9f64
        .max(1e-12 * largest(q0) / largest(rate).max(f64::MIN_POSITIVE))
        .min(1.0);
    let q: Vec<f64> = q0.iter().zip(rate).map(|(a, b)| a + share * b).collect();
    let (mut gap, mut force) = (vec![0.0; n], vec![0.0; n]);
    contact::solve(&mut engine.tableau, &q, &mut gap, &mut force)
        .map_err(|u| engine.unbounded(u.pair, engine.at.alpha))?;
    engine.now.gap = gap;
    engine.now.force.fill(0.0);
    Ok(())
}

/// What ended an increment, in words.
pub fn describe(changes: &[Change]) -> String {
    let words: Vec<String> = changes
        .iter()
        .take(4)
        .map(|c| match c {
            Change::Closes(k) => format!("closes: pair {}", k + 1),
            Change::Opens(k) => format!("opens: pair {}", k + 1),
        })
        .collect();
    let more = if changes.len() > 4 {
        format!(" and {} more", changes.len() - 4)
    } else {
        String::new()
    };
    words.join(", ") + &more
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pairs count from 1 in words, whichever way they change.
    #[test]
    fn events_name_their_pairs() {
        let one = [Change::Closes(0), Change::Opens(3)];
        assert_eq!(describe(&one), "closes: pair 1, opens: pair 4");
        let many: Vec<Change> = (0..6).map(Change::Opens).collect();
        assert_eq!(
            describe(&many),
            "opens: pair 1, opens: pair 2, opens: pair 3, opens: pair 4 and 2 more"
        );
    }
}
