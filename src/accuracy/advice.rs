//! The sentences of a study on a quantity: what accuracies cost, what limits them, and which looser
//! settings would do.

use super::knobs::Knob;
use super::quantity_study::{Price, StudyReference};
use super::record::{StudyRun, is_own, path_correction, value};
use crate::number::{duration, percent};
use std::cmp::Ordering;

/// Fraction of the mesh's error below which the error of a looser setting does not matter.
const HIDDEN: f64 = 0.1;

/// Returns the sentences of a study on a quantity.
pub(super) fn words(
    runs: &[StudyRun],
    path: &str,
    reference: Option<&StudyReference>,
    prices: &[Price],
) -> Vec<String> {
    let mut out = vec![costs(runs, prices)];
    let Some(reference) = reference else {
        return out;
    };
    if let Some(limit) = reference.limit {
        let off = percent((limit / reference.value - 1.0).abs());
        out.push(format!(
            "the meshes converge to a value that differs by {off} from the closed form: finer \
             meshes do not reduce the error below that"
        ));
    }
    if let Some(own) = runs.iter().find(|run| is_own(run))
        && let Some(own) = value(own, path)
    {
        out.extend(limits(runs, path, reference.value, own));
    }
    out
}

/// States the cheapest setting for each accuracy.
fn costs(runs: &[StudyRun], prices: &[Price]) -> String {
    let cost = |price: &Price| {
        let accuracy = percent(price.accuracy);
        match price.run.map(|i| &runs[i]) {
            Some(run) => {
                let seconds = duration(run.usage.undisturbed_seconds());
                format!("{accuracy} costs {seconds} ({}, {})", run.series, run.value)
            }
            None => format!("{accuracy} is reached by no setting tried"),
        }
    };
    // Every other accuracy: 10, 1 and 0.1 %.
    let prices = prices.iter().step_by(2);
    prices.map(cost).collect::<Vec<_>>().join("; ")
}

/// States whether the mesh or the increments limit the scene as it stands, and which looser
/// settings the mesh hides. The two errors may cancel, so each is found separately: the error of
/// the increments is the distance from many more increments on the same mesh, the error of the mesh
/// is the rest of the distance to the reference.
fn limits(runs: &[StudyRun], path: &str, reference: f64, own: f64) -> Vec<String> {
    let many = path_correction(runs, path).map(|(correction, _)| correction);
    let mesh = (own + many.unwrap_or(0.0) - reference).abs();
    let share = |error: f64| percent((error / reference).abs());
    let first = match many {
        Some(error) if error.abs() > mesh => format!(
            "the increments limit the scene as it stands: {}, its mesh {}; more steps gain more \
             than a finer mesh",
            share(error),
            share(mesh)
        ),
        Some(error) => format!(
            "the mesh limits the scene as it stands: {}, its increments {}; a finer mesh gains \
             more than more steps",
            share(mesh),
            share(error)
        ),
        None => format!("the mesh limits the scene as it stands: {}", share(mesh)),
    };
    let loosest: Vec<String> = [Knob::Tolerance, Knob::Gamma, Knob::Stepping]
        .into_iter()
        .filter_map(|knob| {
            // Fixed steps are compared with many increments, tolerances with the scene's own run.
            let many = many.filter(|_| knob == Knob::Stepping).unwrap_or(0.0);
            let is_hidden = |run: &&StudyRun| {
                let error = value(run, path).map(|value| (value - own - many).abs());
                error.is_some_and(|error| error <= HIDDEN * mesh)
            };
            let turned = runs.iter().filter(|run| run.knob == knob);
            let run = turned.filter(is_hidden).max_by(|a, b| looser(a, b))?;
            Some(format!("{} {}", knob.name(), run.value))
        })
        .collect();
    let second = (!loosest.is_empty()).then(|| {
        let all = loosest.join(", ");
        format!(
            "{all} would be accurate enough: the error of the mesh is larger than the difference"
        )
    });
    std::iter::once(first).chain(second).collect()
}

/// Orders two runs by tolerance, or by the number of increments.
fn looser(a: &StudyRun, b: &StudyRun) -> Ordering {
    let [of_a, of_b] = [a, b].map(|run| run.value.parse::<f64>().unwrap_or(0.0));
    of_a.total_cmp(&of_b).then(b.increments.cmp(&a.increments))
}
