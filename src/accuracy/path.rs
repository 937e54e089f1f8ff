//! The error of the way through the load program: the size of its increments, the tolerance of the
//! plastic iteration and that with which changes of contact are found.
//!
//! The flow rule (implicit) is of first order in the increment: an error `c/n` for `n` increments
//! changes by `c/n - c/m` when there are `m`, twice as many, or [`FEWEST`] where there were so few
//! that first order is not to be seen yet. The changes of contact end the increments where the
//! stepping is `events`, so there is nothing to divide; the scene is then run with fixed steps.
//! Both are done on the coarsest mesh at hand on which everything yields that does in the run: the
//! error of the path hardly depends on the mesh, but for the number of increments, by whose ratio
//! it is scaled.
//!
//! Where nothing yields there is no such error: elastic contact follows its path exactly from event
//! to event, and a state depends on its load alone.
//!
//! Tolerances are changed by [`FACTOR`]: made tighter where they are loose (the difference is the
//! error), looser where they are near round-off (the difference is the error times [`FACTOR`]).

use super::meter::work;
use super::quantities::{quantities, value_of};
use super::runs::{Finished, Runs};
use crate::progress::Observer;
use crate::results::Results;
use crate::scene::{Scene, Stepping};
use std::collections::BTreeMap;

/// Increments from target to target with which a run is compared at least.
const FEWEST: usize = 8;
/// By how much tolerances are changed.
const FACTOR: f64 = 100.0;
/// Tolerances below this are made looser, not tighter: [`FACTOR`] below them lies round-off.
const TIGHT: f64 = 1e-9;

/// Errors of the path.
#[derive(Debug)]
pub(super) enum PathErrors {
    /// They were not estimated.
    Unknown,
    /// The path is exact.
    None,
    /// By quantity, absolute.
    Estimated(BTreeMap<String, f64>),
}

impl PathErrors {
    /// The error of a quantity, where it was estimated.
    pub(super) fn of(&self, path: &str) -> Option<f64> {
        match self {
            PathErrors::Unknown => None,
            PathErrors::None => Some(0.0),
            PathErrors::Estimated(errors) => errors.get(path).copied(),
        }
    }
}

/// Only beyond yield does the path have an error.
pub(super) fn matters(results: &Results) -> bool {
    results.states.iter().any(|s| s.plastic_points > 0)
}

/// Estimates the errors of the path of a run by repeating `base`, the coarsest run like it. Returns
/// them with the operations of the runs that were made for them; what failed is noted.
pub(super) fn errors(
    base: &Finished,
    runs: &mut Runs,
    results: &Results,
    observer: &mut dyn Observer,
    notes: &mut Vec<String>,
) -> (PathErrors, f64) {
    let mut out: BTreeMap<String, f64> = BTreeMap::new();
    let mut made = 0.0;
    let (tolerances, of_tolerances) = with_other_tolerances(&base.scene);
    let (increments, of_increments) = with_more_increments(&base.scene, &base.results);
    let fewer = base.results.history.len() as f64 / results.history.len().max(1) as f64;
    let repeated = [
        ("tolerances", tolerances, of_tolerances),
        ("increments", increments, of_increments * fewer.min(1.0)),
    ];
    let own = quantities(&base.results);
    for (what, scene, share) in repeated {
        if observer.stop_requested() {
            break;
        }
        observer.phase(&format!("error estimate: other {what}"));
        let found = match runs.of(&scene, observer) {
            Ok((found, is_new)) => {
                made += if is_new { work(&found.results) } else { 0.0 };
                found
            }
            Err(error) => {
                notes.push(format!(
                    "the run with other {what} failed, so that the error of the path lacks them: \
                     {error}"
                ));
                continue;
            }
        };
        let others = quantities(&found.results);
        for quantity in &own {
            if let Some(value) = value_of(&others, &quantity.path) {
                *out.entry(quantity.path.clone()).or_default() +=
                    share * (value - quantity.value).abs();
            }
        }
    }
    (PathErrors::Estimated(out), made)
}

/// The scene with other tolerances, and what share of the difference is their error.
fn with_other_tolerances(scene: &Scene) -> (Scene, f64) {
    let mut out = scene.clone();
    let loose = scene.analysis.tolerance.max(scene.program.gamma) > TIGHT * FACTOR;
    if loose {
        let tighter = |value: f64| (value / FACTOR).max(TIGHT.min(value));
        out.analysis.tolerance = tighter(out.analysis.tolerance);
        out.program.gamma = tighter(out.program.gamma);
        (out, 1.0)
    } else {
        out.analysis.tolerance *= FACTOR;
        out.program.gamma *= FACTOR;
        (out, 1.0 / (FACTOR - 1.0))
    }
}

/// The scene with more increments than its run took, and what multiple of the difference is their
/// error: the difference is that from `c/taken` to `c/steps`.
fn with_more_increments(scene: &Scene, results: &Results) -> (Scene, f64) {
    let taken = increments_taken(scene, results);
    let steps = FEWEST.max(2 * taken);
    let share = 1.0 / (1.0 - taken as f64 / steps as f64);
    (with_steps(scene, steps), share)
}

/// Increments that a run took from target to target.
pub(super) fn increments_taken(scene: &Scene, results: &Results) -> usize {
    let targets = scene.program.targets.len().max(1);
    let taken = match scene.program.stepping {
        Stepping::Steps => scene.program.steps,
        Stepping::Auto | Stepping::Events => results.history.len().div_ceil(targets),
    };
    taken.max(1)
}

/// The scene with so many fixed steps from target to target.
pub(super) fn with_steps(scene: &Scene, steps: usize) -> Scene {
    let mut out = scene.clone();
    out.program.stepping = Stepping::Steps;
    out.program.steps = steps;
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tolerances_near_round_off_are_made_looser() {
        let text = include_str!("../../data/scenes/thick_cylinder.toml");
        let mut scene = Scene::parse(text, "scene.toml").unwrap();
        (scene.analysis.tolerance, scene.program.gamma) = (1e-4, 1e-12);
        let (tight, share) = with_other_tolerances(&scene);
        assert_eq!(share, 1.0);
        let wanted = (1e-4 / FACTOR, 1e-12);
        assert_eq!((tight.analysis.tolerance, tight.program.gamma), wanted);
        scene.analysis.tolerance = 1e-10;
        let (loose, share) = with_other_tolerances(&scene);
        assert!((loose.analysis.tolerance / 1e-8 - 1.0).abs() < 1e-12);
        assert_eq!(share, 1.0 / 99.0);
    }

    /// An error `c/n`: of 3 increments, compared with 8, and of 20, compared with 40.
    #[test]
    fn increments_are_extrapolated_with_first_order() {
        let text = include_str!("../../data/scenes/thick_cylinder.toml");
        let scene = Scene::parse(text, "scene.toml").unwrap();
        for (taken, steps) in [(3, FEWEST), (20, 40)] {
            let stepped = with_steps(&scene, taken);
            let (more, share) = with_more_increments(&stepped, &Results::default());
            assert_eq!(more.program.steps, steps);
            let difference = 1.0 / taken as f64 - 1.0 / steps as f64;
            assert!((share * difference * taken as f64 - 1.0).abs() < 1e-12);
        }
    }
}
