//! The error of the way through the load program: the size of its increments, the tolerance of the plastic iteration and that
//! with which changes of contact are hit.
//!
//! The rule of the flow (implicit) is of first order in the increment: an error `c/n` for `n` increments changes by `c/n - c/m` when
//! there are `m`, twice as many, or [`FEWEST`] where there were so few that first order is not to be seen yet. The changes of contact
//! end the increments where the stepping is `events`, so there is nothing to divide; the scene is then run with fixed steps. Both are
//! done on the coarsest mesh so far on which everything flows that does in the run, where they cost little: the error of the path hardly depends on the
//! mesh, but for the number of increments, by whose ratio it is scaled. A mesh from a file that is too large to be subdivided in passing
//! has no coarser one: the run itself is repeated, with half as many increments where those are enough to show first order. The sign of the change tells the
//! value with infinitely many increments, too, which a demand reports (`limit`).
//!
//! Where nothing flows there is no such error: elastic contact follows its path exactly from event to event, and a state depends
//! on its load alone.
//!
//! Tolerances are changed by [`FACTOR`]: made tighter where they are loose (the difference is the error), looser
//! where they are near round-off (the difference is the error times [`FACTOR`]).

use super::estimate::Extent;
use super::ladder::Ladder;
use super::quantities::{Quantity, quantities, value_of, with_loads};
use crate::linalg::Backend;
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

/// What is changed.
const TOLERANCES: &str = "tolerances";
const INCREMENTS: &str = "increments";

/// Errors of the path.
#[derive(Debug)]
pub(super) enum PathErrors {
    /// They were not estimated.
    Unknown,
    /// The path is exact.
    None,
    /// By quantity, and the floating point operations of the runs that were made for them.
    Estimated(BTreeMap<String, PathError>, f64),
}

/// The error that the path leaves in a quantity, or in what goes with a load.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct PathError {
    /// That of the tolerances, not negative.
    pub tolerances: f64,
    /// What infinitely many increments would add.
    pub increments: f64,
}

impl PathErrors {
    /// The error of a quantity, where it was estimated.
    pub(super) fn of(&self, path: &str) -> Option<PathError> {
        match self {
            PathErrors::Unknown => None,
            PathErrors::None => Some(PathError::default()),
            PathErrors::Estimated(errors, _) => errors.get(path).copied(),
        }
    }

    /// Floating point operations of the runs that were made for them.
    pub(super) fn work(&self) -> f64 {
        match self {
            PathErrors::Estimated(_, work) => *work,
            _ => 0.0,
        }
    }
}

impl PathError {
    /// Both together.
    pub(super) fn total(&self) -> f64 {
        self.tolerances + self.increments.abs()
    }
}

/// A finished run that is repeated with another path.
#[derive(Clone, Copy)]
pub(super) struct Base<'r> {
    pub scene: &'r Scene,
    pub results: &'r Results,
    pub quantities: &'r [Quantity],
    /// Whether there is no other mesh, so that the run itself has to be repeated, however large.
    pub alone: bool,
}

impl Base<'_> {
    /// The differences to another run, of quantities and of what goes with loads.
    fn differences(&self, other: &Results) -> impl Iterator<Item = (String, f64)> {
        let others = quantities(other);
        let values = self.quantities.iter().filter_map(move |quantity| {
            let value = value_of(&others, &quantity.path)?;
            Some((quantity.path.clone(), value - quantity.value))
        });
        let with_loads_of_other = with_loads(other);
        let own = with_loads(self.results).into_iter();
        values.chain(own.filter_map(move |(path, value)| {
            let other = with_loads_of_other.get(&path)?;
            Some((path, other - value))
        }))
    }
}

/// Only beyond yield does the path have an error.
pub(super) fn matters(results: &Results) -> bool {
    results.states.iter().any(|s| s.plastic_points > 0)
}

/// Estimates the errors of the path of a run from `base`, its coarsest companion or the run itself.
pub(super) fn errors(
    base: &Base,
    ladder: &mut Ladder,
    backend: Backend,
    results: &Results,
    observer: &mut dyn Observer,
    notes: &mut Vec<String>,
) -> PathErrors {
    let mut out: BTreeMap<String, PathError> = BTreeMap::new();
    let mut spent = 0.0;
    let tolerances = with_other_tolerances(base.scene);
    let increments = match base.alone {
        true => with_fewer_increments(base.scene, base.results),
        false => None,
    };
    let increments = increments.unwrap_or_else(|| with_more_increments(base.scene, base.results));
    let grown = base.results.history.len() as f64 / results.history.len().max(1) as f64;
    let changed = increments.1 * grown.min(1.0);
    let scenes = [tolerances.0.clone(), increments.0.clone()];
    spent += ladder.run_ahead(&scenes, backend, Extent::Program, observer);
    for (what, scene, share) in [
        (TOLERANCES, tolerances.0, tolerances.1),
        (INCREMENTS, increments.0, changed),
    ] {
        if observer.stop_requested() {
            break;
        }
        observer.phase(&format!("error estimate: other {what}"));
        let found = match ladder.step(&scene, backend, Extent::Program, observer) {
            Ok((found, operations)) => {
                spent += operations;
                found
            }
            Err(error) => {
                notes.push(format!(
                    "the run with other {what} failed, so that the error of the path lacks them: {error}"
                ));
                continue;
            }
        };
        for (path, difference) in base.differences(&found.results) {
            let error = out.entry(path).or_default();
            match what {
                TOLERANCES => error.tolerances = share * difference.abs(),
                _ => error.increments = share * difference,
            }
        }
    }
    PathErrors::Estimated(out, spent)
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

/// Increments that a run took from target to target.
fn taken(scene: &Scene, results: &Results) -> usize {
    let taken = match scene.program.stepping {
        Stepping::Steps => scene.program.steps,
        Stepping::Events => results
            .history
            .len()
            .div_ceil(scene.program.targets.len().max(1)),
    };
    taken.max(1)
}

/// The scene with `steps` increments from target to target instead of `taken`, and what multiple of the difference those taken are off: the difference
/// is that from `c/taken` to `c/steps`.
fn with_increments(scene: &Scene, taken: usize, steps: usize) -> (Scene, f64) {
    let mut out = scene.clone();
    out.program.stepping = Stepping::Steps;
    out.program.steps = steps;
    (out, 1.0 / (1.0 - taken as f64 / steps as f64))
}

/// The scene with more increments than its run took, and what multiple of the difference is their error.
fn with_more_increments(scene: &Scene, results: &Results) -> (Scene, f64) {
    let taken = taken(scene, results);
    with_increments(scene, taken, FEWEST.max(2 * taken))
}

/// The same with half as many, at half the price; `None` where those would be too few to show first order.
fn with_fewer_increments(scene: &Scene, results: &Results) -> Option<(Scene, f64)> {
    let taken = taken(scene, results);
    (taken >= 2 * FEWEST).then(|| with_increments(scene, taken, taken.div_ceil(2)))
}
