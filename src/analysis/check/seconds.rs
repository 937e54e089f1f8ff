//! Rough times: of a run before it begins, and of its phases while it runs.

use crate::analysis::structure::flow;
use crate::linalg::{Backend, Prediction};
use crate::model::{LoadProgram, Model, Pair, ProgramTarget, TargetCondition};
use crate::results::Sizes;
use crate::scene::{Stepping, Unit};
use crate::substructure::ContactCost;

/// Floating point operations per second of large supernodes on one thread, with CHOLMOD and with
/// faer ([`TYPICAL_FLOPS_OF_FAER`]): measured on solids of 105,000 and 311,000 freedoms
/// (`cargo bench --features faer --bench history -- backends`).
const TYPICAL_FLOPS: f64 = 3.6e10;
const TYPICAL_FLOPS_OF_FAER: f64 = 5.8e10;
/// Nonzeros of the factor per second, for all work that does not grow with the operations:
/// ordering, analysis, and the overhead of each of many small supernodes, of which plane meshes
/// have most.
const TYPICAL_NONZEROS: f64 = 2.7e7;
/// Floating point operations per second of the dense matrices of contact.
const FLOPS_OF_CONTACT: f64 = 7e9;

/// Seconds to start a run.
const START: f64 = 1.5e-3;
/// Seconds per freedom to make mesh and model, to assemble, and to write the files of a state; the
/// last value is per state and includes the stresses of all elements. Taken from the timings of
/// `brinell run SCENE --estimate none` for the paper's two scenes and finer meshes of them, up to
/// 1.56 million freedoms (November 2026), at the speed of [`TYPICAL_FLOPS`].
const MODEL: f64 = 6e-7;
const ASSEMBLY: f64 = 5e-7;
const FILES: f64 = 6e-7;
const STATE: f64 = 1.0e-6;
/// Seconds that the search for first yield takes per freedom of the zone; of the model as long as
/// the zone is not known.
const YIELD_LOAD: f64 = 2e-6;
/// Seconds of ordering, factorisation and condensation, as far as they can be estimated without the
/// symbolic factorisation: per freedom, per power 3/2 of the freedoms (the growth of nested
/// dissection in the plane) and per cube of the pairs (the dense matrix of the contact). Fitted to
/// the same timings as [`MODEL`].
const FACTORISATION: [f64; 3] = [2.5e-6, 2.5e-9, 5e-11];
/// Seconds of the increments per square of the pairs: each pair that closes or opens costs solves,
/// and the zone of these solves grows with the number of pairs. Fitted to the same timings as
/// [`MODEL`].
const INCREMENTS: f64 = 2e-4;
/// Seconds of the elastic path, per cube of the number of pairs: each change of contact passes over
/// the matrix of the pairs.
const PATH: f64 = 1.5e-9;
/// Seconds of a trailing solve with its share of the plastic iteration: a constant, and a time per
/// entry of the factor's trailing columns.
const SOLVE: [f64; 2] = [2e-5, 5.5e-10];
/// Fraction of the pairs that change their status in an increment of their own while the load moves
/// in one direction: first if gaps differ (the contact grows pair by pair), then if all gaps are
/// alike.
const CHANGES: [f64; 2] = [0.7, 0.17];
/// Trailing solves of an elastoplastic increment, in three cases. In the first, the material
/// hardens. In the others it has almost no stiffness left: in a contact that grows, and in a
/// contact whose gaps are alike (or without contact), where the whole body may yield at once.
const SOLVES: [f64; 3] = [6.0, 12.0, 30.0];
/// Trailing solves of an elastoplastic increment in which contact may change, for the three cases
/// of [`SOLVES`].
const SOLVES_OF_LONG: [f64; 3] = [25.0, 60.0, 60.0];
/// Ratio of plastic modulus to Young's modulus below which material counts as almost without
/// stiffness.
const SOFT: f64 = 0.1;

/// What is known of the size of a run while its phases begin.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct RunSize {
    pub freedoms: f64,
    pub pairs: f64,
    pub targets: f64,
}

impl RunSize {
    /// Rough seconds of a phase; `None` for a phase whose time does not follow from the size.
    pub(crate) fn seconds_of(&self, phase: &str) -> Option<f64> {
        let RunSize {
            freedoms: n,
            pairs,
            targets,
        } = *self;
        let increments = INCREMENTS * pairs * pairs;
        let program = increments + STATE * targets * n;
        let seconds = match phase {
            "mesh and model" => MODEL * n,
            "assembly" => ASSEMBLY * n,
            "factorisation" => {
                let [each, fill, dense] = FACTORISATION;
                each * n + fill * n.powf(1.5) + dense * pairs.powi(3)
            }
            "yield load" => YIELD_LOAD * n,
            "preload" => increments,
            "load program" => program,
            "output" => FILES * targets * n,
            going_on if going_on.starts_with("going on") => program,
            _ => return None,
        };
        Some(seconds)
    }
}

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
    let program = &model.program;
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
    match program.stepping {
        Stepping::Events => SOLVES[kind] * (n_targets + ways * changes),
        Stepping::Steps => SOLVES_OF_LONG[kind] * program.steps as f64 * n_targets,
        // The load falls along every other way, on which the material unloads elastically for the
        // most part, from one change of contact to the next.
        Stepping::Auto => {
            let measured = program.unit == Unit::Yield;
            let loading = loading_increments(&goals, measured, program.path_error);
            let back = ways - (0.5 * ways).ceil();
            SOLVES_OF_LONG[kind] * loading + back * changes
        }
    }
}

/// Whether all pairs of a contact have the same gap, so that they would close together.
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

/// The load at each target, in the unit of the program or of the quantity that the target asks for.
fn goals(program: &LoadProgram) -> Vec<f64> {
    let mut at = 0.0f64;
    let goal = |target: &ProgramTarget| {
        at = match &target.condition {
            TargetCondition::FirstYield => 1.0,
            TargetCondition::LoadFactor(factor) => *factor,
            // The load of a line contact depends on the square of its width.
            TargetCondition::HalfWidth(width) => width * width,
            // A figure is searched for with rising load.
            TargetCondition::Figure(_) => at.max(1.0),
            TargetCondition::Displacement(goal) => goal.value.abs(),
        };
        at
    };
    program.targets.iter().map(goal).collect()
}

/// Number of ways on the path from zero to the last goal, on each of which the load only rises or
/// only falls: one more than the number of load reversals.
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

/// Number of increments in which the load is larger than ever before in its direction (`flow.rs`).
/// If `unit` is set, goals are in units of the load at first yield.
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

/// Rough seconds of a run whose factorisation takes `factorisation` seconds.
pub(super) fn of_run(
    model: &Model,
    sizes: &Sizes,
    prediction: &Prediction,
    factorisation: f64,
) -> f64 {
    let n = sizes.freedoms as f64;
    let states = model.program.targets.len() as f64;
    let elastic = START
        + (MODEL + ASSEMBLY) * n
        + factorisation
        + (STATE + FILES) * n * states
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

    /// Only load beyond the largest so far takes increments: the fewer, the less load is added, and
    /// more if the load is far beyond first yield.
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
