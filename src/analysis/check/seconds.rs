//! Roughly how long a run will take, before it begins.

use crate::analysis::structure::flow;
use crate::linalg::{Backend, Prediction};
use crate::model::{Model, Pair};
use crate::results::Sizes;
use crate::scene::{Program, Stepping, Target, Unit};
use crate::substructure::ContactCost;

/// Floating point operations per second of large supernodes on one thread, and the same of faer:
/// those of solids of 105,000 and 311,000 freedoms (`cargo bench --features faer --bench history --
/// backends`).
const TYPICAL_FLOPS: f64 = 3.6e10;
const TYPICAL_FLOPS_OF_FAER: f64 = 5.8e10;
/// Nonzeros of the factor per second of all that does not grow with the operations: ordering,
/// analysis, and what it takes to begin each of many small supernodes, of which plane meshes have
/// most.
const TYPICAL_NONZEROS: f64 = 2.7e7;
/// Floating point operations per second of the dense matrices of contact.
const FLOPS_OF_CONTACT: f64 = 7e9;

/// What a run takes besides its factorisation, measured over the scenes of `data/scenes` and finer
/// meshes of the paper's two: seconds to start; for each freedom of making the mesh, the assembly
/// and the files; for each freedom of the zone of finding first yield; for each freedom and state.
const START: f64 = 1.5e-3;
const SETUP: f64 = 0.9e-6;
const YIELD_LOAD: f64 = 2e-6;
const STATE: f64 = 4.5e-7;
/// Seconds of the elastic path, per cube of the pairs: each change of contact goes over their
/// matrix.
const PATH: f64 = 1.5e-9;
/// Seconds of a trailing solve with its share of the plastic iteration: to begin with, and for each
/// entry of the factor's trailing columns.
const SOLVE: [f64; 2] = [2e-5, 5.5e-10];
/// Share of the pairs that change their status in an increment of their own while the load goes one
/// way: where gaps differ (the contact grows pair by pair), and where all are alike.
const CHANGES: [f64; 2] = [0.7, 0.17];
/// Trailing solves of an elastoplastic increment: where the material hardens; where it has next to
/// no stiffness left, in a contact that grows; and where all of it may yield.
const SOLVES: [f64; 3] = [6.0, 12.0, 30.0];
/// Trailing solves of an elastoplastic increment in which contact may change, for the three
/// materials of [`SOLVES`].
const SOLVES_OF_LONG: [f64; 3] = [25.0, 60.0, 60.0];
/// Plastic modulus over Youngs modulus below which material counts as soft in that sense.
const SOFT: f64 = 0.1;
/// Rough seconds of ordering, analysis and factorisation.
pub(super) fn of_factorisation(prediction: &Prediction, backend: Backend) -> f64 {
    let speed = match backend {
        Backend::Faer => TYPICAL_FLOPS_OF_FAER,
        _ => TYPICAL_FLOPS,
    };
    prediction.flops / speed + prediction.factor_nonzeros / TYPICAL_NONZEROS
}

/// Rough seconds of the dense matrices of contact.
pub(in crate::analysis) fn of_contact(contact: &ContactCost) -> f64 {
    contact.flops / FLOPS_OF_CONTACT
}

/// Rough number of trailing solves of a run.
fn solves(model: &Model) -> f64 {
    let program = &model.scene.program;
    let n_targets = program.targets.len() as f64;
    let pairs_of = |alike: bool| -> f64 {
        let contacts = model.contacts.iter().map(|c| &model.pairs[c.range.clone()]);
        let those = contacts.filter(|pairs| gaps_are_alike(pairs) == alike);
        those.map(|pairs| pairs.len() as f64).sum()
    };
    let [growing, alike] = [pairs_of(false), pairs_of(true)];
    let changes = CHANGES[0] * growing + CHANGES[1] * alike;
    let goals = goals(program);
    let ways = ways(&goals);
    let mut yielding = model.materials.iter().zip(&model.may_yield);
    let soft = yielding.any(|(material, may)| {
        let slope = material
            .hardening
            .as_ref()
            .map(|h| h.slope(0.0) + material.back_stresses.linear());
        *may && slope.is_some_and(|slope| slope < SOFT * material.youngs_modulus)
    });
    let kind = match soft {
        false => 0,
        true if growing > alike => 1,
        true => 2,
    };
    match model.scene.stepping() {
        Stepping::Events => SOLVES[kind] * (n_targets + ways * changes),
        Stepping::Steps => SOLVES_OF_LONG[kind] * program.steps as f64 * n_targets,
        // Every other way unloads, elastically for the most part: from change to change.
        Stepping::Auto => {
            let measured = program.unit == Unit::Yield;
            let loading = loading_increments(&goals, measured, program.path_error);
            let back = ways - (0.5 * ways).ceil();
            SOLVES_OF_LONG[kind] * loading + back * changes
        }
    }
}

/// Whether all pairs of a contact would close together.
pub(in crate::analysis) fn gaps_are_alike(pairs: &[Pair]) -> bool {
    let span = |of: fn(&Pair) -> f64| {
        let ends = pairs
            .iter()
            .map(of)
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
                [low.min(value), high.max(value)]
            });
        ends[1] - ends[0]
    };
    span(|pair| pair.gap) <= 1e-9 * span(|pair| pair.arc)
}

/// What the load comes to target by target, in the unit of the program or of whatever the targets
/// ask for.
fn goals(program: &Program) -> Vec<f64> {
    let mut at = 0.0f64;
    let goal = |target: &Target| {
        let displaced = target.displacement.as_ref().map(|d| d.value.abs());
        at = match (target.load_factor, target.half_width) {
            (Some(factor), _) => factor,
            // The load of a line contact depends on the square of its width.
            (_, Some(width)) => width * width,
            // A figure is looked for in loading.
            _ if target.finds_load() => at.max(1.0),
            _ => displaced.unwrap_or(1.0),
        };
        at
    };
    program.targets.iter().map(goal).collect()
}

/// Number of times that the load turns round on its way from zero to the last goal, plus one.
fn ways(goals: &[f64]) -> f64 {
    let (mut at, mut upward, mut count) = (0.0, true, 1.0);
    for &to in goals {
        if to != at && (to > at) != upward {
            (upward, count) = (!upward, count + 1.0);
        }
        at = to;
    }
    count
}

/// Increments with more load than ever before in its direction (`flow.rs`), by the load at first
/// yield where it is the `unit` of the goals.
fn loading_increments(goals: &[f64], unit: bool, path_error: f64) -> f64 {
    let (mut reached, mut count) = ([0.0f64; 2], 0.0);
    for to in goals {
        let reached = &mut reached[usize::from(*to < 0.0)];
        if to.abs() > *reached {
            let range = if unit { 1.0 } else { to.abs() };
            let [from, until] = [*reached, to.abs()].map(|load| flow::length(load / range));
            count += flow::increments(from, until, path_error).ceil();
            *reached = to.abs();
        }
    }
    count
}

/// Rough seconds of a run whose factorisation takes `factorisation`.
pub(super) fn of_run(
    model: &Model,
    sizes: &Sizes,
    prediction: &Prediction,
    factorisation: f64,
) -> f64 {
    let n = sizes.freedoms as f64;
    let states = model.scene.program.targets.len() as f64;
    let elastic = START
        + SETUP * n
        + factorisation
        + STATE * n * states
        + PATH * (sizes.contact_pairs as f64).powi(3);
    if sizes.zone_elements == 0 {
        return elastic;
    }
    elastic
        + YIELD_LOAD * sizes.zone_freedoms as f64
        + solves(model) * (SOLVE[0] + SOLVE[1] * prediction.trailing_nonzeros)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Only load beyond what was there before makes increments, the fewer the less it adds, and
    /// more far beyond the load at first yield.
    #[test]
    fn increments_are_of_equal_length_in_the_root_of_the_load() {
        for (goals, unit, count) in [
            (&[1.0][..], false, 15.0),
            (&[0.25, 1.0], false, 23.0),
            (&[1.0, 0.0, 1.0], false, 15.0),
            (&[1.0, -1.0], false, 30.0),
            (&[0.0], false, 0.0),
            (&[9.0], true, 15.0),
            (&[144.0], false, 15.0),
            (&[144.0], true, 58.0),
        ] {
            assert_eq!(loading_increments(goals, unit, 1e-3), count, "{goals:?}");
        }
        assert_eq!(ways(&[1.0, 0.5, 2.0, 0.0]), 4.0);
    }
}
