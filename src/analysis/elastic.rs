//! Elastic pieces of the load path: contact alone changes, from event to event, on the dense matrix only.

use super::engine::{Engine, LoadPoint};
use crate::contact::{self, Change, Path, PathEnd};
use crate::error::Result;

/// Follows contact along a straight piece of the load path with the plastic strains frozen.
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
        let initial = engine.now.initial.clone();
        for (q, t) in q0.iter_mut().zip(engine.initial_forces(&initial)) {
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
        let path = Path::new(&mut engine.tableau, q0, rate, gap, force, gap_scale)
            .map_err(|u| engine.unbounded(u.pair, start.alpha))?;
        engine.counts.contact_changes += path.changes;
        Ok(ElasticPiece {
            start,
            end: end.clone(),
            path,
        })
    }

    /// Goes to the next event, at most to share `t` of the piece; the engine's gaps and forces follow.
    pub fn advance(&mut self, engine: &mut Engine, t: f64) -> PathEnd {
        let outcome = self.path.advance(&engine.tableau, t);
        self.write(engine);
        outcome
    }

    /// Goes to share `t` of the piece with the current statuses: they must hold there.
    pub fn go_back(&mut self, engine: &mut Engine, t: f64) {
        self.path.state_at(&engine.tableau, t);
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

/// A floating body with gaps all round moves rigidly under the first bit of load until it touches: the contact
/// problem is solved directly there, and the gaps of that solution are where the path starts.
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
