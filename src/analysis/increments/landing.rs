//! Repeats the last increment so that it ends where a monitored quantity is zero.

use super::acceptance::accept;
use super::step::{IncrementReport, MONITOR_ACCURACY, Monitor, SMALLEST_CUT};
use super::stepping::Stepper;
use crate::analysis::structure::equilibrium::Equilibrium;
use crate::analysis::structure::load_point::LoadPoint;
use crate::analysis::structure::state::State;
use crate::error::Result;
use crate::root::{self, RootTolerance};
use std::cell::Cell;

impl Stepper<'_, '_> {
    /// Repeats the increment that began at the state `from`, so that it ends where the monitored
    /// quantity is zero. `was` and `is` are the values of that quantity at `from` and at the
    /// current state.
    pub(super) fn land(
        &mut self,
        end: &LoadPoint,
        from: &State,
        monitor: &Monitor,
        [was, is]: [f64; 2],
        reported: &mut IncrementReport,
    ) -> Result<()> {
        let reached = from.at.share_of(&self.solver.at, end);
        let last = Cell::new(-1.0);
        // Trial increments end close together: each is predicted from the ones before.
        let mut known = vec![(0.0, from.equilibrium.clone())];
        if self.kept_statuses(from) {
            known.push((reached, self.solver.now.clone()));
        }
        let mut value_at = |t: f64| -> Result<f64> {
            self.solver.restore(from);
            self.solver.predictor.pace = None;
            let goal = from.at.towards(end, t);
            let mut ahead = (known.len() > 1).then(|| (goal.clone(), between(&mut known, t)));
            // An increment may be cut short; several increments are then needed to reach the goal.
            loop {
                let (increment, _) = self.find_increment(&goal, 1.0, SMALLEST_CUT, ahead.take())?;
                let arrived = increment.t >= 1.0;
                reported.residual = increment.residual;
                reported.iterations += increment.iterations;
                let at_once = self.solver.at == from.at;
                accept(self.solver, &goal, increment, reported);
                if arrived {
                    if at_once && self.kept_statuses(from) {
                        known.push((t, self.solver.now.clone()));
                    }
                    last.set(t);
                    return monitor(self.solver);
                }
            }
        };
        let accuracy = RootTolerance::both(MONITOR_ACCURACY);
        let t = root::try_between([(0.0, was), (reached, is)], accuracy, &mut value_at)?;
        if t != last.get() {
            value_at(t)?;
        }
        Ok(())
    }

    /// Whether the increment just taken had the same statuses as the state `from` throughout; the
    /// statuses beyond its end may differ.
    fn kept_statuses(&self, from: &State) -> bool {
        let mut open = self.solver.tableau.open().to_vec();
        for &k in &self.solver.border {
            open[k] = !open[k];
        }
        open == from.open
    }
}

/// The state at `t` on the parabola through the three nearest known states. Because their statuses
/// are equal, such a combination is again in equilibrium.
fn between(known: &mut [(f64, Equilibrium)], t: f64) -> Equilibrium {
    known.sort_by(|a, b| (a.0 - t).abs().total_cmp(&(b.0 - t).abs()));
    let nearest = &known[..known.len().min(3)];
    let weight = |i: usize| -> f64 {
        let others = (0..nearest.len()).filter(|&j| j != i);
        others
            .map(|j| (t - nearest[j].0) / (nearest[i].0 - nearest[j].0))
            .product()
    };
    let mut state = nearest[0].1.clone();
    for (i, (_, other)) in nearest.iter().enumerate().skip(1) {
        let weight = weight(i);
        state.add(weight, other);
        state.add(-weight, &nearest[0].1);
    }
    state
}
