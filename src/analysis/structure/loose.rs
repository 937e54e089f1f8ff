//! Bodies that no contact force holds: rigid motion until they touch, and weak springs.

use super::load_point::LoadPoint;
use super::solver::Solver;
use crate::contact::loose::come_to_rest;
use crate::contact::springs::Springs;
use crate::error::Result;
use nalgebra::DVector;
use std::sync::Arc;

/// Springs that bear more than this fraction of the largest force are released along the load path.
const MOVES: f64 = 1e-9;
/// Springs that bear more than this fraction of the largest force are released in a state from
/// which results are read. The fraction is of the order of round-off.
const NOTHING: f64 = 1e-14;
/// Fraction of the largest force that springs may bear in a state at rest.
const SETTLED: f64 = 1e-11;
/// A spring bears more than this fraction of the largest force only if the load drives its body on:
/// the body has then moved by a hundred times the deformation.
const DRIVEN: f64 = 1e-6;

/// Largest number of times that springs are released. If contact holds a motion with a
/// ten-thousandth of its stiffness, the force that springs bear falls by four orders of magnitude
/// each time (the springs have 1e-8 of that stiffness).
const MOST_TIMES: usize = 8;

/// Moves each body that no contact force holds, as a rigid body, until it touches: under the first
/// small part of the load towards `end`. The load path goes on from there. Springs hold the rigid
/// motions that the load does not drive.
///
/// # Errors
/// A load that drives a body away from every contact.
pub(in crate::analysis) fn move_loose_bodies(solver: &mut Solver, end: &LoadPoint) -> Result<()> {
    let_springs_go(solver, MOVES);
    let terms = solver.structure.closed_forces_size(&solver.at);
    let of_one = solver.tableau.force_tolerance(&[terms], &solver.now.gap);
    let nothing = solver.round_off_of_contact().max(of_one);
    let force = &solver.now.force;
    let is_loose = |pairs: &[usize]| pairs.iter().map(|&k| force[k]).sum::<f64>() <= nothing;
    let loose = solver.structure.sub.rigid_slips(is_loose);
    if loose.is_empty() {
        return Ok(());
    }
    let matrix = solver.structure.sub.pair_matrix();
    let [here, there] = [&solver.at, end].map(|point| solver.structure.closed_forces(point));
    let mut springs = solver.springs.to_vec();
    let mut anew: Vec<usize> = Vec::new();
    for (pairs, slips) in loose {
        let of = |value: &dyn Fn(usize) -> f64| {
            DVector::from_iterator(pairs.len(), pairs.iter().map(|&k| value(k)))
        };
        let rate = of(&|k| there[k] - here[k]);
        let terms = of(&|k| there[k].abs() + here[k].abs());
        let from = of(&|k| solver.now.gap[k]);
        let mut gap = from.clone();
        let free = come_to_rest(&slips, [&rate, &terms], &mut gap)
            .map_err(|u| solver.structure.unbounded(pairs[u.pair], solver.at.alpha))?;
        for (&k, &gap) in pairs.iter().zip(gap.iter()).filter(|_| gap != from) {
            solver.now.gap[k] = gap;
            solver.now.force[k] = 0.0;
        }
        let own = (free.ncols() > 0)
            .then(|| Springs::new(matrix, pairs, &(&slips * free), &solver.now.gap));
        let known = springs.iter().position(|other| other.pairs() == pairs);
        let as_stiff = match (known, &own) {
            (Some(at), Some(own)) => springs[at].as_stiff_as(own),
            (None, None) => true,
            _ => false,
        };
        if gap != from || !as_stiff {
            anew.extend_from_slice(pairs);
        }
        match (known, own) {
            (Some(at), Some(own)) => springs[at] = own,
            (Some(at), None) => drop(springs.remove(at)),
            (None, own) => springs.extend(own),
        }
    }
    solver.set_springs(&Arc::from(springs));
    if !anew.is_empty() {
        let mut open = solver.tableau.open().to_vec();
        anew.into_iter()
            .for_each(|k| open[k] = solver.now.gap[k] > 0.0);
        solver.tableau.reset(&open);
    }
    Ok(())
}

/// Finds the equilibrium without springs: a body that contact holds weakly, or that has not yet
/// reached the pair that stops it, moves on until the springs bear nothing.
///
/// # Errors
/// A load that drives a body away from every contact.
pub(in crate::analysis) fn settle_springs(solver: &mut Solver) -> Result<()> {
    for _ in 0..MOST_TIMES {
        let_springs_go(solver, NOTHING);
        let bear = solver.springs_bear(SETTLED);
        if !bear && !is_beyond_contact(solver) {
            break;
        }
        if bear {
            refuse_motion_without_end(solver)?;
        }
        solver.solve_contact_at(&solver.at.clone())?;
    }
    Ok(())
}

/// Whether springs exist and a gap or a contact force is negative by more than round-off.
fn is_beyond_contact(solver: &Solver) -> bool {
    let [gap, force] = [solver.scales.displacement, solver.scales.force].map(|s| -1e-10 * s);
    let least = |of: &[f64]| of.iter().copied().fold(0.0, f64::min);
    !solver.springs.is_empty() && (least(&solver.now.gap) < gap || least(&solver.now.force) < force)
}

/// Releases springs that bear more than a fraction of the largest force: makes them free of force
/// at the current gaps, so that a body that nothing drives stays where it is. A body that contact
/// holds weakly then moves on under the force that its spring has borne.
fn let_springs_go(solver: &mut Solver, share: f64) {
    for _ in 0..MOST_TIMES {
        if !solver.springs_bear(share) {
            return;
        }
        let springs = solver.springs.iter();
        solver.springs = springs.map(|own| own.moved_to(&solver.now.gap)).collect();
        solver.fresh = false;
        solver.refresh();
    }
}

/// Refuses a state in which springs stop a driven body and no pair would stop it.
///
/// # Errors
/// A load that drives a body away from every contact.
pub(in crate::analysis) fn refuse_driven_bodies(solver: &Solver) -> Result<()> {
    match solver.springs_bear(DRIVEN) {
        true => refuse_motion_without_end(solver),
        false => Ok(()),
    }
}

fn refuse_motion_without_end(solver: &Solver) -> Result<()> {
    let of_all = solver.structure.closed_forces(&solver.at);
    for (pairs, slips) in solver.structure.sub.rigid_slips(|_| true) {
        let [load, mut gap] = [&of_all, &solver.now.gap]
            .map(|of| DVector::from_iterator(pairs.len(), pairs.iter().map(|&k| of[k])));
        come_to_rest(&slips, [&load, &load], &mut gap)
            .map_err(|u| solver.structure.unbounded(pairs[u.pair], solver.at.alpha))?;
    }
    Ok(())
}
