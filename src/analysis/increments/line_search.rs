//! How far along a Newton direction.

use crate::analysis::structure::equilibrium::Equilibrium;
use crate::analysis::structure::solver::Solver;
use crate::analysis::zone::points::Evaluation;
use crate::substructure::Trailing;

/// Cuts of a line search.
const BACKTRACKS: usize = 12;
/// Share of the slope at the start to which the slope beyond a minimum may grow: nearly the
/// minimum.
const OVERSHOOT: f64 = 0.1;

/// Length along a Newton direction. The energy of the increment is convex and the
/// out-of-balance force times the direction is the negative of its slope: while that has not
/// turned, the energy has fallen all the way. A length that overshoots is cut by the secant.
/// `None` where the direction leads nowhere; else `trial` holds the state there and the force
/// out of balance.
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
        // Not a number: far too long.
        let share = slope / (slope - there);
        length *= if share.is_finite() {
            share.clamp(0.01, 0.9)
        } else {
            0.01
        };
    }
    None
}
