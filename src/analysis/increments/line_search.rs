//! The length of a step along a Newton direction.

use crate::analysis::structure::equilibrium::Equilibrium;
use crate::analysis::structure::solver::Solver;
use crate::analysis::zone::points::Evaluation;
use crate::substructure::Trailing;

/// Largest number of trial lengths in a line search.
const BACKTRACKS: usize = 12;
/// Fraction of the slope at the start that the slope beyond a minimum may have, so that the minimum
/// is nearly reached.
const OVERSHOOT: f64 = 0.1;

/// Finds the step length along a Newton direction. The energy of the increment is convex, and its
/// slope is the negative product of the out-of-balance force and the direction. As long as the
/// slope has not changed its sign, the energy has fallen all the way. A length that overshoots is
/// cut by the secant. Returns `None` if the direction does not lower the energy; otherwise `trial`
/// holds the state at the end of the step and the force out of balance.
pub(super) fn line_search(
    solver: &mut Solver,
    (state, direction, balance): (&Equilibrium, &Equilibrium, &Trailing),
    (trial, out): &mut (Equilibrium, Trailing),
) -> Option<(f64, Evaluation)> {
    let slope = balance.dot(&direction.u);
    if slope <= 0.0 || !slope.is_finite() {
        return None;
    }
    let mut length = 1.0;
    for _ in 0..BACKTRACKS {
        trial.copy_from(state);
        trial.add(length, direction);
        let evaluation = solver.out_of_balance_at(trial, out);
        let there = out.dot(&direction.u);
        if there >= -OVERSHOOT * slope {
            return Some((length, evaluation));
        }
        // If the slope there is NaN, the step is far too long.
        let share = slope / (slope - there);
        length *= if share.is_finite() {
            share.clamp(0.01, 0.9)
        } else {
            0.01
        };
    }
    None
}
