//! Decides whether an increment that was not found shows a limit load, or only an iteration that
//! did not converge.
//!
//! The increments of associated plasticity minimise a convex energy (Simo and Hughes). If every
//! point hardens with a slope of at least `H`, the second derivative of the energy, the consistent
//! tangent `S - K_p`, is at least `H/(3G + H)` of the elastic stiffness `S`. There is then one
//! equilibrium under every load, and an iteration that does not find it has not converged. Beyond a
//! limit load there is no equilibrium: displacements grow without bound along a mechanism in which
//! the tangent has no stiffness left. The evidence of a collapse is therefore the current stiffness
//!
//! ```text
//!     d'(S - K_p) d / d'S d        (elastic: 1, hardening: at least H/(3G + H), limit load: 0)
//! ```
//!
//! at the state reached in the smallest increment, with `d` the direction in which the structure
//! moved. The current stiffness is an upper bound of the smallest eigenvalue: if the current
//! stiffness is lost, the structure has lost its stiffness in at least one direction.
//!
//! Increments beyond a limit load are given up as soon as the structure flows away along a Newton
//! direction. It flows away if the direction has no stiffness, and if the same force still drives
//! the structure after it has gone farther along the direction than any increment in equilibrium
//! would move it.
//!
//! # Source
//! P. G. Bergan, G. Horrigmoe, B. Krakeland, T. H. Soreide, *Solution techniques for non-linear
//! finite element problems* (1978), doi:10.1002/nme.1620121106 (the current stiffness parameter);
//! M. A. Crisfield, *Non-linear Finite Element Analysis of Solids and Structures*, vol. 1 (1991),
//! chapter 9; J. C. Simo, T. J. R. Hughes, *Computational Inelasticity* (1998).

use super::outcome::Attempt;
use super::step::SMALLEST_CUT;
use crate::analysis::structure::equilibrium::Equilibrium;
use crate::analysis::structure::load_point::LoadPoint;
use crate::analysis::structure::round_off::{LOOSEST, ROUND_OFF_OF_FORCES};
use crate::analysis::structure::solver::Solver;
use crate::error::{Error, ErrorKind, Result};
use crate::scene::Settings;
use crate::substructure::Trailing;

/// Fraction of the elastic stiffness below which a structure counts as collapsed: to take up the
/// smallest increment of the load, it would have to move as far as it moves elastically under the
/// whole piece of the load path.
pub(super) const LOST: f64 = SMALLEST_CUT;

/// Largest number of power iterations for the direction whose stiffness decides; each costs one
/// trailing solve. Compared with a mechanism, each iteration reduces motions that have a tenth of
/// the elastic stiffness by a tenth.
const MOST_ANSWERS: usize = 8;

/// Fraction of the driving force that must still be out of balance if the structure is to count as
/// flowing away.
const DRIVEN: f64 = 0.5;

/// The best accuracy that any iteration can reach: the round-off error in the forces of the zone's
/// elements, which are computed from the displacements `u`.
pub(super) fn round_off_of_balance(solver: &Solver, u: &Trailing) -> Result<f64> {
    let partition = &solver.structure.sub.partition;
    let mut all = vec![0.0; partition.n];
    for (freedoms, values) in [(&partition.zone, &u.zone), (&partition.contact, &u.contact)] {
        for (&freedom, value) in freedoms.iter().zip(values) {
            all[freedom] = *value;
        }
    }
    let stiffness = &solver.structure.system.stiffness;
    Ok(ROUND_OFF_OF_FORCES * stiffness.largest_terms(&all)?)
}

/// Whether a state whose forces are out of balance by the share `floor` is accurate enough:
/// relative to elastic displacements, its displacements are off by at most `floor` divided by the
/// remaining stiffness. Beyond a limit load displacements grow until their round-off hides the
/// forces out of balance; no state is accepted there.
pub(super) fn settles(solver: &mut Solver, state: &Equilibrium, floor: f64) -> bool {
    floor <= LOOSEST && floor <= LOOSEST * stiffness_left(solver, state, 1)
}

/// Whether the structure flows away along a Newton direction of an increment to `goal`. The step
/// along the direction had the full `length` 1 and led to the `trial` state with its force out of
/// balance. Returns the share of the elastic stiffness that the direction has at this state, if it
/// flows away.
///
/// The structure flows away if this stiffness is lost, and if the driving force `driven` still acts
/// after the structure has gone so far that the secant stiffness of the increment is lost, too. The
/// energy of the increment is convex and has fallen all the way, so an equilibrium, if there is
/// one, lies beyond. If a gap closes on this way, as when a tube is expanded into a sleeve, the
/// closed pair may hold the load; and if back stresses fade, the increment has no such energy. In
/// both cases the function returns `None`.
pub(super) fn flows_away(
    solver: &mut Solver,
    goal: &LoadPoint,
    direction: &Equilibrium,
    (driven, length): (&Trailing, f64),
    trial: &(Equilibrium, Trailing),
) -> Option<f64> {
    let enough = DRIVEN * driven.dot(&direction.u);
    if !solver.zone.is_symmetric() || length < 1.0 || trial.1.dot(&direction.u) < enough {
        return None;
    }
    let mut force = solver.structure.sub.zeros();
    solver.zone.softening_times(&direction.u, &mut force);
    let left = 1.0 - force.dot(&direction.u) / direction.initial.load.dot(&direction.u);
    if left.is_nan() || left > LOST {
        return None;
    }
    let initial = solver.now.initial.clone();
    let mut elastic = solver.respond(goal, initial);
    elastic.add(-1.0, &solver.now);
    let far = elastic.u.largest() / (LOST * direction.u.largest());
    let mut beyond = trial.0.clone();
    beyond.add(far.max(1.0), direction);
    let mut open = solver.tableau.open().iter().zip(&beyond.gap);
    if open.any(|(is_open, gap)| *is_open && *gap <= 0.0) {
        return None;
    }
    solver.out_of_balance_at(&beyond, &mut force);
    if force.dot(&direction.u) >= enough {
        return Some(left);
    }
    solver.out_of_balance_at(&trial.0, &mut force);
    None
}

/// The error for the smallest increment that is tried, to `goal`, if it was not found:
/// [`ErrorKind::Collapse`] if the stiffness is lost, otherwise [`ErrorKind::Analysis`] with an
/// account of the attempt.
pub(super) fn not_found(
    solver: &mut Solver,
    settings: &Settings,
    goal: &LoadPoint,
    attempt: &Attempt,
) -> Error {
    let left = match attempt.mechanism {
        Some(left) => left,
        None => stiffness_left(solver, &attempt.state, MOST_ANSWERS),
    };
    let residual = attempt.residual;
    let (held, tried) = (solver.at.alpha, goal.alpha);
    // Round-off disturbs the quotient by about its own relative size.
    if left <= LOST && attempt.round_off <= LOST {
        return Error::new(
            ErrorKind::Collapse,
            format!(
                "limit load: load factor {held:.9} is the last that was held, at {tried:.9} \
                 no equilibrium was found (out-of-balance force {residual:.1e} of the largest \
                 force; at most {:.0e} of the elastic stiffness is left)",
                left.max(f64::EPSILON)
            ),
        );
    }
    if !left.is_finite() || !residual.is_finite() {
        return Error::analysis(no_number(held, tried, attempt.iterations));
    }
    Error::analysis(format!(
        "not converged: load factor {held:.9} is the last that was held, at {tried:.9} (the \
         smallest increment, {SMALLEST_CUT:e} of the load step) the out-of-balance force was \
         {residual:.1e} of the largest force after {} iterations (analysis.max_iterations = \
         {}); analysis.tolerance asks for {:.1e}, round-off alone may leave {:.1e}. {left:.1e} \
         of the elastic stiffness is left: this shows no limit load. Raise \
         analysis.max_iterations, loosen analysis.tolerance, or use elements that are less \
         slender",
        attempt.iterations, settings.max_iterations, settings.tolerance, attempt.round_off,
    ))
}

/// Fraction of the elastic stiffness that the tangent at a state has, in the direction in which the
/// structure moves from its last state in equilibrium to this state; NaN if the iterate has
/// overflowed. The direction is improved by up to `answers` power iterations: each is the elastic
/// response to the softening forces of the direction before. In each iteration, the parts of the
/// direction that still have stiffness weigh less.
fn stiffness_left(solver: &mut Solver, state: &Equilibrium, answers: usize) -> f64 {
    let mut load = solver.structure.sub.zeros();
    solver.out_of_balance_at(state, &mut load);
    let mut moved = state.u.clone();
    moved.add(-1.0, &solver.now.u);
    solver.zone.softening_times(&moved, &mut load);
    if load.largest() == 0.0 {
        return 1.0;
    }
    let mut left = 1.0;
    for _ in 0..answers {
        let softest = solver.direction(load.clone());
        solver.zone.softening_times(&softest.u, &mut load);
        left = 1.0 - load.dot(&softest.u) / softest.initial.load.dot(&softest.u);
        if left.is_nan() || left <= LOST {
            break;
        }
    }
    left
}

/// The message for an increment that was not found because its numbers overflowed, with advice.
fn no_number(held: f64, tried: f64, iterations: usize) -> String {
    format!(
        "not converged: load factor {held:.9} is the last that was held, at {tried:.9} (the \
         smallest increment, {SMALLEST_CUT:e} of the load step) displacements or stresses grew \
         beyond what a number can hold within {iterations} iterations, so that the remaining \
         stiffness is unknown. Check loads, target and material for values that are too \
         large by far, and their units; if they are right, give more increments (program.steps, \
         or more targets on the way) or another analysis.plastic_iteration"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_beyond_all_bounds_are_told_in_words() {
        let text = no_number(0.5, 1e300, 7);
        let message = Error::analysis(text).to_string();
        assert!(message.contains("at 1e300 "), "{message}");
        assert!(message.contains("beyond what a number can hold within 7 iterations"));
        assert!(!message.contains("NaN") && message.contains("units"));
    }
}
