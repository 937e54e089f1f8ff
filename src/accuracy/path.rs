//! The error of the way through the load program: the size of its increments, the tolerance of the plastic iteration and that
//! with which changes of contact are hit.
//!
//! The rule of the flow (implicit) is of first order in the increment: an error `c/n` for `n` increments changes by half of itself
//! when there are twice as many. The changes of contact end the increments where the stepping is `events`, so there is
//! nothing to double; the scene is then run with fixed steps, twice as many as there were increments. Both are done on
//! the coarsest of the meshes of the estimate, where they cost little: the error of the path hardly depends on the
//! mesh, but for the number of increments, by whose ratio it is scaled.
//!
//! Tolerances are changed by [`FACTOR`]: made tighter where they are loose (the difference is the error), looser
//! where they are near round-off (the difference is the error times [`FACTOR`]).

use super::estimate::{Coarse, Extent, run};
use super::meter::work;
use super::quantities::{quantities, value_of};
use crate::linalg::Backend;
use crate::progress::Observer;
use crate::results::Results;
use crate::scene::{Scene, Stepping};
use std::collections::BTreeMap;

/// By how much tolerances are changed.
const FACTOR: f64 = 100.0;
/// Tolerances below this are made looser, not tighter: [`FACTOR`] below them lies round-off.
const TIGHT: f64 = 1e-9;

/// Errors of the path by quantity, and the operations they took.
#[derive(Debug, Default)]
pub(super) struct PathErrors(BTreeMap<String, f64>, f64);

impl PathErrors {
    /// The error of a quantity, where it was estimated.
    pub(super) fn of(&self, path: &str) -> Option<f64> {
        self.0.get(path).copied()
    }

    /// Floating point operations of the runs that were made for them.
    pub(super) fn work(&self) -> f64 {
        self.1
    }

    /// Adds `share` of the difference between two runs.
    fn add(&mut self, coarsest: &Coarse, other: &Results, share: f64) {
        let others = quantities(other);
        self.1 += work(other);
        for quantity in &coarsest.quantities {
            if let Some(value) = value_of(&others, &quantity.path) {
                *self.0.entry(quantity.path.clone()).or_default() +=
                    share * (value - quantity.value).abs();
            }
        }
    }
}

/// Elastic paths are followed exactly from event to event: only beyond yield does the path have an error.
pub(super) fn matters(results: &Results) -> bool {
    results.states.iter().any(|s| s.plastic_points > 0)
}

/// Estimates the errors of the path of a run from its coarsest companion.
pub(super) fn errors(
    coarsest: &Coarse,
    backend: Backend,
    results: &Results,
    observer: &mut dyn Observer,
    notes: &mut Vec<String>,
) -> PathErrors {
    let mut out = PathErrors::default();
    let tolerances = with_other_tolerances(&coarsest.scene);
    let increments = with_more_increments(&coarsest.scene, &coarsest.results);
    let grown = coarsest.results.history.len() as f64 / results.history.len().max(1) as f64;
    // The error c/n is twice its change from n to 2n.
    let halved = 2.0 * grown.min(1.0);
    for (what, scene, share) in [
        ("tolerances", tolerances.0, tolerances.1),
        ("increments", increments, halved),
    ] {
        if observer.stop_requested() {
            return out;
        }
        observer.phase(&format!("error estimate: other {what}"));
        match run(&scene, backend, Extent::Program, observer) {
            Ok(found) => out.add(coarsest, &found, share),
            Err(error) => notes.push(format!(
                "the run with other {what} failed, so that the error of the path lacks them: {error}"
            )),
        }
    }
    out
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

/// The scene with twice as many increments as its run took from target to target.
fn with_more_increments(scene: &Scene, results: &Results) -> Scene {
    let mut out = scene.clone();
    let taken = match scene.program.stepping {
        Stepping::Steps => scene.program.steps,
        Stepping::Events => results
            .history
            .len()
            .div_ceil(scene.program.targets.len().max(1)),
    };
    out.program.stepping = Stepping::Steps;
    out.program.steps = 2 * taken.max(1);
    out
}
