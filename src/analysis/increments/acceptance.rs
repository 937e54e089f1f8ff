//! Acceptance of increments, of changes of contact alone, and of the end of a piece.

use super::outcome::{Increment, STRETCH};
use super::outgrown::accepted;
use super::step::{Arrival, IncrementReport, Step, describe};
use crate::analysis::structure::load_point::LoadPoint;
use crate::analysis::structure::solver::{InitialLoadRate, Solver};
use crate::contact::Change;
use crate::error::Result;

/// Accepts an increment in which contact alone changed. The increment before it ended at load
/// factor `from`, after `solves_before` trailing solves.
///
/// # Errors
/// Errors of [`accepted`].
pub(super) fn contact_step(
    solver: &mut Solver,
    from: f64,
    event: &str,
    solves_before: usize,
    arrival: Option<Arrival>,
) -> Result<Step> {
    solver.update_scales();
    let report = IncrementReport {
        event: event.to_string(),
        trailing_solves: solver.cost.counts.trailing_solves - solves_before,
        ..IncrementReport::default()
    };
    accepted(solver, from, report, arrival)
}

/// Covers the small rest of the way to `end` with the current statuses and plastic strains.
pub(in crate::analysis) fn arrive(solver: &mut Solver, end: &LoadPoint) {
    let initial = solver.now.initial.clone();
    solver.now = solver.respond(end, initial);
    solver.at = end.clone();
    for value in solver.now.gap.iter_mut().chain(&mut solver.now.force) {
        *value = value.max(0.0);
    }
}

/// Accepts an increment: commits history and state, and sets the statuses beyond the increment.
pub(super) fn accept(
    solver: &mut Solver,
    end: &LoadPoint,
    increment: Increment,
    reported: &mut IncrementReport,
) {
    let start = solver.at.clone();
    solver.predictor.last_step = solver.at.step_to(end);
    let changes: Vec<Change> = increment
        .changes
        .iter()
        .map(|&k| {
            if solver.tableau.open()[k] {
                Change::Closes(k)
            } else {
                Change::Opens(k)
            }
        })
        .collect();
    let way = increment.t * start.distance(end);
    // Over an increment shorter than `1 / STRETCH` of its piece, the change of state is mostly
    // round-off.
    let is_known = way > 0.0 && increment.t > 1.0 / STRETCH && !solver.zone.is_idle();
    solver.predictor.pace = is_known.then(|| {
        let mut pace = increment.state.initial.clone();
        pace.add(-1.0, &solver.now.initial);
        pace.scale(1.0 / way);
        InitialLoadRate {
            initial: pace,
            distance: way,
            stretched: increment.stretched,
        }
    });
    solver.at = start.towards(end, increment.t);
    solver.now = increment.state;
    solver.fresh = true;
    solver.zone.commit();
    solver.border = increment.changes;
    for k in solver.border.clone() {
        if solver.tableau.flip(k) {
            solver.cost.counts.contact_changes += 1;
        }
    }
    // A gap or a contact force within gamma of zero may be negative by that much.
    for value in solver.now.gap.iter_mut().chain(&mut solver.now.force) {
        *value = value.max(0.0);
    }
    solver.update_scales();
    reported.event = describe(&changes);
}

/// Whether the current state is the state at `end`, so that another solve would change only
/// round-off. A state without displacements and forces need not have been solved for: it counts
/// only if no gap is negative and the gaps are those before anything moves.
pub(super) fn rests_at(solver: &Solver, end: &LoadPoint) -> bool {
    let moved = solver.now.u.largest() != 0.0 || solver.now.force.iter().any(|r| *r != 0.0);
    let apart = solver.now.gap.iter().all(|g| *g >= 0.0);
    let solved = moved || apart && solver.now.gap == solver.structure.delta(end);
    solver.at == *end && solver.fresh && solved
}

/// Whether the way to `end` leads back against the last increment. The material then unloads
/// elastically at first.
pub(super) fn turns_back(solver: &Solver, end: &LoadPoint) -> bool {
    let step = solver.at.step_to(end);
    let along: f64 = step
        .iter()
        .zip(&solver.predictor.last_step)
        .map(|(a, b)| a * b)
        .sum();
    along <= 0.0
}
