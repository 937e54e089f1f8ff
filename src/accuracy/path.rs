//! The error of the path through the load program: it depends on the size of the increments, on the
//! tolerance of the plastic iteration and on the tolerance with which changes of contact are found.
//!
//! Strains follow a straight line from one end of an increment to the other, and flow is followed
//! along this line (`material/strain_path.rs`). This leaves an error of second order in the
//! increments, and of slightly lower order while they are few ([`ORDER`]). With `n` increments the
//! error is `c/n^p`. The constant `c` follows from the difference from a run with twice as many
//! increments, with [`FEWEST`] increments if the run took few, or with half as many in a quick
//! estimate. If the stepping is `events`, increments end at changes of contact and cannot be
//! divided; the other run then has fixed steps, or in a quick estimate increments by a path error.
//! All these runs use the coarsest mesh at hand on which everything yields that yields in the run.
//! The error of the path hardly depends on the mesh except through the number of increments, and is
//! scaled by the ratio of these numbers.
//!
//! Where nothing yields there is no such error: elastic contact follows its path exactly from event
//! to event, and a state depends on its load alone.
//!
//! Tolerances are changed by [`FACTOR`]: made tighter where they are loose (the difference is the
//! error), looser where they are near round-off (the difference is the error times [`FACTOR`]).

use super::effort::Effort;
use super::meter::work;
use super::quantities::{quantities, value_of};
use super::runs::{Finished, Runs};
use crate::number::percent;
use crate::progress::Observer;
use crate::results::{QuantityError, Results};
use crate::scene::{Kind, LEAST_PATH_ERROR, Program, Scene, Stepping};
use std::collections::BTreeMap;

/// Fewest increments per target in the finer of two compared runs.
const FEWEST: usize = 8;
/// Power of the length of increments with which the error of the path falls, as observed with few
/// increments.
const ORDER: f64 = 1.5;
/// Factor by which the error of the path grows if increments are twice as long.
const TWICE_AS_LONG: f64 = 4.0;
/// Factor by which tolerances are changed.
const FACTOR: f64 = 100.0;
/// Least value to which tolerances are tightened. If all are within [`FACTOR`] of it, they are made
/// looser instead.
const TIGHT: f64 = 1e-9;

/// Figures to which `path_error` applies.
const ASKED_FOR: [&str; 2] = [".max_pressure", ".residual_depth"];

/// Errors of the path.
#[derive(Debug)]
pub(super) enum PathErrors {
    /// The errors were not estimated.
    Unknown,
    /// The path is exact.
    None,
    /// Absolute errors by quantity.
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

/// Whether the path has an error: it has one only beyond yield.
pub(super) fn matters(results: &Results) -> bool {
    results.states.iter().any(|s| s.plastic_points > 0)
}

/// Estimates the errors of the path of a run by repeating `base`, the run on the coarsest mesh on
/// which as much yields. Also returns the operations of the runs that this took; runs that fail are
/// noted.
pub(super) fn errors(
    base: &Finished,
    runs: &mut Runs,
    results: &Results,
    effort: Effort,
    observer: &mut dyn Observer,
    notes: &mut Vec<String>,
) -> (PathErrors, f64) {
    let mut out: BTreeMap<String, f64> = BTreeMap::new();
    let mut made = 0.0;
    let fewer_increments = with_fewer_increments(&base.scene, &base.results);
    let (increments, of_increments) = match (effort, fewer_increments) {
        (Effort::Quick, Some(fewer)) => fewer,
        _ => with_more_increments(&base.scene, &base.results),
    };
    let (tolerances, of_tolerances) = with_other_tolerances(&base.scene);
    let fewer = match base.scene.stepping() {
        Stepping::Events => base.results.history.len() as f64 / results.history.len().max(1) as f64,
        // These steppings take equally many increments on every mesh.
        Stepping::Auto | Stepping::Steps => 1.0,
    };
    let of_increments = of_increments * fewer.min(1.0).powf(ORDER);
    let repeated = match effort {
        Effort::Quick => vec![(
            "increments and tolerances",
            with_tolerances_of(&increments, &tolerances),
            of_increments.max(of_tolerances),
        )],
        _ => vec![
            ("tolerances", tolerances, of_tolerances),
            ("increments", increments, of_increments),
        ],
    };
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
                    "the run with other {what} failed, so that the error of the path lacks their \
                     part: {error}"
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

/// A note if, by the estimate, the path leaves more of a pressure or a dent than `path_error`
/// allows. It names the worst figure with its error.
pub(super) fn beyond_asked(scene: &Scene, quantities: &[QuantityError]) -> Option<String> {
    if scene.stepping() != Stepping::Auto {
        return None;
    }
    let of_key = |q: &&QuantityError| ASKED_FOR.iter().any(|key| q.quantity.ends_with(key));
    let share = |q: &QuantityError| {
        // The relative error is the whole error divided by the figure's scale; the path has a
        // share.
        let whole = q.error.filter(|error| *error > 0.0)?;
        Some((q.path? * q.relative_error? / whole, q.quantity.clone()))
    };
    let found = quantities.iter().filter(of_key).filter_map(share);
    let (left, quantity) = found.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let asked = scene.program.path_error;
    (left > asked).then(|| {
        format!(
            "program.path_error = {asked:e} is probably not reached: the increments leave an \
             estimated {} of {quantity}; a smaller program.path_error makes them shorter",
            percent(left)
        )
    })
}

/// The scene with other tolerances, and the share of the difference that is the present error.
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

/// The scene with more increments than its run took, and the multiple of the difference that is the
/// present error: the difference is that between `c/taken^p` and `c/steps^p`.
fn with_more_increments(scene: &Scene, results: &Results) -> (Scene, f64) {
    let share = |fewer: f64| 1.0 / (1.0 - fewer.powf(ORDER));
    if scene.stepping() == Stepping::Auto {
        let mut out = scene.clone();
        out.program.path_error /= TWICE_AS_LONG;
        return (out, share(0.5));
    }
    let taken = increments_taken(scene, results);
    let steps = FEWEST.max(2 * taken);
    (with_steps(scene, steps), share(taken as f64 / steps as f64))
}

/// A scene with the tolerances of another.
fn with_tolerances_of(scene: &Scene, other: &Scene) -> Scene {
    let mut out = scene.clone();
    out.analysis.tolerance = other.analysis.tolerance;
    out.program.gamma = other.program.gamma;
    out
}

/// The scene with half as many increments as its run took, and the multiple of the difference that
/// is the present error; `None` if increments are few already. Increments that end at changes of
/// contact are compared with half as many as the usual path error asks for, since that error is no
/// smaller than theirs.
fn with_fewer_increments(scene: &Scene, results: &Results) -> Option<(Scene, f64)> {
    let share = 1.0 / (2f64.powf(ORDER) - 1.0);
    let usual = Program::default().path_error;
    let mut out = scene.clone();
    match scene.stepping() {
        Stepping::Auto => out.program.path_error *= TWICE_AS_LONG,
        Stepping::Events if scene.kind != Kind::PlaneStress => {
            out.program.stepping = Stepping::Auto;
            out.program.path_error = TWICE_AS_LONG * usual;
        }
        Stepping::Events | Stepping::Steps => {
            let taken = increments_taken(scene, results);
            return (taken >= FEWEST).then(|| (with_steps(scene, taken / 2), share));
        }
    }
    (out.program.path_error <= TWICE_AS_LONG * usual).then_some((out, share))
}

/// The scene with so many more increments that the error of its path is divided by `fraction`, and
/// its increments in words.
pub(super) fn with_error_over(scene: &Scene, results: &Results, fraction: f64) -> (Scene, String) {
    let more = fraction.max(1.0).powf(1.0 / ORDER);
    if scene.stepping() == Stepping::Auto {
        let mut out = scene.clone();
        out.program.path_error = (out.program.path_error / (more * more)).max(LEAST_PATH_ERROR);
        let words = format!(
            "increments for a path error of {:.1e}",
            out.program.path_error
        );
        return (out, words);
    }
    let steps = (increments_taken(scene, results) as f64 * more)
        .ceil()
        .min(1e6) as usize;
    (
        with_steps(scene, steps),
        format!("{steps} increments for each target"),
    )
}

/// Increments that a run took from target to target.
fn increments_taken(scene: &Scene, results: &Results) -> usize {
    let targets = scene.program.targets.len().max(1);
    let taken = match scene.stepping() {
        Stepping::Steps => scene.program.steps,
        Stepping::Auto | Stepping::Events => results.history.len().div_ceil(targets),
    };
    taken.max(1)
}

/// The scene with so many fixed steps from target to target.
fn with_steps(scene: &Scene, steps: usize) -> Scene {
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

    /// The error is `c/n^p`: 3 increments are compared with 8, 20 with 40, and increments by a path
    /// error with twice as many.
    #[test]
    fn increments_are_extrapolated_with_their_order() {
        let text = include_str!("../../data/scenes/thick_cylinder.toml");
        let scene = Scene::parse(text, "scene.toml").unwrap();
        let error = |n: usize| (n as f64).powf(-ORDER);
        for (taken, steps) in [(3, FEWEST), (20, 40)] {
            let stepped = with_steps(&scene, taken);
            let (more, share) = with_more_increments(&stepped, &Results::default());
            assert_eq!(more.program.steps, steps);
            let difference = error(taken) - error(steps);
            assert!((share * difference / error(taken) - 1.0).abs() < 1e-12);
            let (tenth, _) = with_error_over(&stepped, &Results::default(), 10.0);
            assert!(error(tenth.program.steps) <= 0.1 * error(taken));
        }
        let mut by_error = scene;
        by_error.program.stepping = Stepping::Auto;
        let (more, share) = with_more_increments(&by_error, &Results::default());
        // Half the length corresponds to a fourth of the path error.
        assert_eq!(more.program.path_error, 0.25 * by_error.program.path_error);
        assert!((share * (error(1) - error(2)) - 1.0).abs() < 1e-12);
        let (other, _) = with_error_over(&by_error, &Results::default(), 1e30);
        assert_eq!(other.program.path_error, LEAST_PATH_ERROR);
    }

    /// Half as many increments: fixed steps are halved in number, increments by a path error get
    /// four times that error, and few increments are not halved. The errors follow with the same
    /// order.
    #[test]
    fn fewer_increments_cost_less_and_show_the_same_order() {
        let text = include_str!("../../data/scenes/thick_cylinder.toml");
        let scene = Scene::parse(text, "scene.toml").unwrap();
        let of = |scene: &Scene| with_fewer_increments(scene, &Results::default());
        let error = |n: usize| (n as f64).powf(-ORDER);
        let (fewer, share) = of(&with_steps(&scene, 20)).unwrap();
        assert_eq!(fewer.program.steps, 10);
        assert!((share * (error(10) - error(20)) / error(20) - 1.0).abs() < 1e-12);
        assert_eq!(of(&with_steps(&scene, FEWEST - 1)), None);
        for stepping in [Stepping::Auto, Stepping::Events] {
            let mut scene = scene.clone();
            scene.program.stepping = stepping;
            let (fewer, _) = of(&scene).unwrap();
            assert_eq!(fewer.stepping(), Stepping::Auto);
            assert_eq!(
                fewer.program.path_error,
                4.0 * Program::default().path_error
            );
            scene.program.path_error = 0.05;
            assert_eq!(of(&scene).is_none(), stepping == Stepping::Auto);
        }
    }
}
