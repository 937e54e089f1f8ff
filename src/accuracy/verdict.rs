//! Judgement of the runs of a study: the error of each run, the order of convergence, the Pareto
//! front, and the cost of each accuracy.

use super::advice;
use super::extrapolation::extrapolate;
use super::knobs::Knob;
use super::quantities::{formal_order, is_demanded_with_all};
use super::quantity_study::{Price, QuantityStudy, StudyReference};
use super::record::{StudyRun, is_own, path_correction, value};
use crate::results::ReferenceRow;
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// Accuracies whose cost is found.
pub(super) const TARGETS: [f64; 5] = [0.1, 0.03, 0.01, 0.003, 0.001];
/// Number of finest meshes from which a reference is extrapolated.
const FINEST: usize = 4;
/// Error below which a difference is round-off and shows no order.
const ROUND_OFF: f64 = 1e-12;

/// Judges the runs of a scene.
pub fn assess(runs: &[StudyRun], references: &[ReferenceRow]) -> Vec<QuantityStudy> {
    let mut paths: Vec<&str> = Vec::new();
    for (path, _) in runs.iter().flat_map(|r| &r.values) {
        if !paths.contains(&path.as_str()) {
            paths.push(path);
        }
    }
    let found: Vec<(&str, StudyReference)> = paths
        .iter()
        .filter_map(|path| Some((*path, reference(runs, references, path)?)))
        .collect();
    let key = |path: &str| path.rsplit('.').next().unwrap_or(path).to_string();
    let mut out: Vec<QuantityStudy> = Vec::new();
    let mut worst: Vec<Option<f64>> = runs.iter().map(|_| None).collect();
    for (path, reference) in &found {
        let same = found.iter().filter(|(other, _)| key(other) == key(path));
        let scale = same.fold(0.0f64, |m, (_, r)| m.max(r.value.abs()));
        if scale == 0.0 {
            continue;
        }
        let errors: Vec<Option<f64>> = runs
            .iter()
            .map(|run| value(run, path).map(|v| (v - reference.value).abs() / scale))
            .collect();
        // A quantity that the program prescribes has no error in any run.
        if errors.iter().flatten().all(|e| *e <= ROUND_OFF) {
            continue;
        }
        if is_demanded_with_all(&key(path)) {
            for (worst, error) in worst.iter_mut().zip(&errors) {
                *worst = match (*worst, *error) {
                    (Some(a), Some(b)) => Some(f64::max(a, b)),
                    (a, b) => a.or(b),
                };
            }
        }
        out.push(finished(runs, path, Some(reference.clone()), errors));
    }
    if out.len() > 1 {
        out.insert(0, finished(runs, "all", None, worst));
    }
    out
}

/// Runs of a series of meshes that have the quantity, finest first: (index, element size).
fn series<'r>(runs: &'r [StudyRun], name: &'r str) -> Vec<(usize, f64)> {
    let mut out: Vec<(usize, f64)> = runs
        .iter()
        .enumerate()
        .filter(|(_, r)| r.series == name && r.failed.is_none())
        .map(|(i, r)| (i, r.ratio))
        .collect();
    out.sort_by(|a, b| a.1.total_cmp(&b.1));
    out
}

/// The names of the series of meshes, the scene's own first.
fn mesh_series(runs: &[StudyRun]) -> Vec<&str> {
    let mut out: Vec<&str> = Vec::new();
    for knob in [Knob::Resolution, Knob::Element] {
        for run in runs.iter().filter(|r| r.knob == knob) {
            if !out.contains(&run.series.as_str()) {
                out.push(&run.series);
            }
        }
    }
    // The series of an element comes before its series with loose tolerances.
    out.sort_by_key(|name| name.len());
    out.sort_by_key(|name| runs.iter().find(|r| r.series == *name).map(|r| r.knob));
    out
}

/// The reference of a quantity: the closed form that the scene names, otherwise the extrapolation
/// of the scene's own series of meshes.
fn reference(runs: &[StudyRun], references: &[ReferenceRow], path: &str) -> Option<StudyReference> {
    let own = mesh_series(runs).first().copied()?;
    let values: Vec<(f64, f64)> = series(runs, own)
        .into_iter()
        .filter_map(|(i, h)| Some((h, value(&runs[i], path)?)))
        .take(FINEST)
        .collect();
    let degree = runs
        .iter()
        .find(|run| run.series == own)
        .map_or(1, |run| run.degree);
    let key = path.rsplit('.').next().unwrap_or(path);
    let found = extrapolate(&values, formal_order(key, degree));
    let limit = found.and_then(|found| Some((found.limit?, found.uncertainty)));
    if let Some(row) = references.iter().find(|r| r.quantity == path) {
        let other = limit.filter(|(limit, doubt)| (limit - row.reference).abs() > *doubt);
        return Some(StudyReference {
            value: row.reference,
            uncertainty: 0.0,
            source: row.source.clone(),
            limit: other.map(|(limit, _)| limit),
        });
    }
    // If the meshes show no order, no value is better than that of the finest mesh.
    let finest = || Some((values.first()?.1, found?.uncertainty));
    let (limit, doubt_of_mesh) = limit.or_else(finest)?;
    let (correction, doubt) = path_correction(runs, path).unwrap_or_default();
    let increments = if correction == 0.0 && doubt == 0.0 {
        ""
    } else {
        " and the finest increments"
    };
    Some(StudyReference {
        value: limit + correction,
        uncertainty: doubt_of_mesh + doubt,
        source: format!(
            "extrapolated from the {} finest meshes of {own}{increments}",
            values.len()
        ),
        limit: None,
    })
}

/// The quantities that a reader wants first: `all`, the quantities at first yield, and for each key
/// the largest of the quantities of states.
pub fn foremost(quantities: &[QuantityStudy]) -> Vec<&QuantityStudy> {
    let mut largest: BTreeMap<&str, (f64, usize)> = BTreeMap::new();
    let mut out: Vec<usize> = Vec::new();
    for (i, quantity) in quantities.iter().enumerate() {
        match (&quantity.reference, quantity.quantity.rsplit_once('.')) {
            (Some(reference), Some((prefix, key))) if prefix.starts_with("states") => {
                let size = reference.value.abs();
                let entry = largest.entry(key).or_insert((size, i));
                if size > entry.0 {
                    *entry = (size, i);
                }
            }
            _ => out.push(i),
        }
    }
    out.extend(largest.values().map(|(_, i)| *i));
    out.sort_unstable();
    out.into_iter().map(|i| &quantities[i]).collect()
}

fn finished(
    runs: &[StudyRun],
    path: &str,
    reference: Option<StudyReference>,
    errors: Vec<Option<f64>>,
) -> QuantityStudy {
    let orders = mesh_series(runs)
        .into_iter()
        .filter_map(|name| Some((name.to_string(), order(&series(runs, name), &errors)?)))
        .collect();
    let pareto = pareto(runs, &errors);
    let prices: Vec<Price> = TARGETS
        .iter()
        .map(|&accuracy| Price {
            accuracy,
            run: cheapest(runs, &errors, accuracy),
        })
        .collect();
    let words = advice::words(runs, path, reference.as_ref(), &prices);
    QuantityStudy {
        quantity: path.to_string(),
        reference,
        errors,
        orders,
        pareto,
        prices,
        words,
    }
}

/// Slope of the error over the element size, both logarithmic, by least squares.
fn order(levels: &[(usize, f64)], errors: &[Option<f64>]) -> Option<f64> {
    let points: Vec<(f64, f64)> = levels
        .iter()
        .filter_map(|&(i, h)| Some((h.ln(), errors[i].filter(|e| *e > ROUND_OFF)?.ln())))
        .collect();
    if points.len() < 3 {
        return None;
    }
    let n = points.len() as f64;
    let mean = |f: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>() / n;
    let (mx, my) = (mean(&|p| p.0), mean(&|p| p.1));
    Some(mean(&|p| (p.0 - mx) * (p.1 - my)) / mean(&|p| (p.0 - mx).powi(2)))
}

/// Runs in the order of their times, each of them more accurate than all faster ones.
fn pareto(runs: &[StudyRun], errors: &[Option<f64>]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..runs.len()).filter(|&i| errors[i].is_some()).collect();
    order.sort_by(|&a, &b| faster(&runs[a], &runs[b]));
    let mut best = f64::INFINITY;
    order.retain(|&i| {
        let error = errors[i].unwrap_or(f64::INFINITY);
        let better = error < best;
        best = best.min(error);
        better
    });
    order
}

/// The fastest run that reaches an accuracy, unless by chance: in a series of meshes every finer
/// mesh must reach the accuracy, too.
fn cheapest(runs: &[StudyRun], errors: &[Option<f64>], accuracy: f64) -> Option<usize> {
    let reaches = |i: usize| errors[i].is_some_and(|e| e <= accuracy);
    (0..runs.len())
        .filter(|&i| reaches(i))
        .filter(|&i| match runs[i].knob {
            Knob::Resolution | Knob::Element => series(runs, &runs[i].series)
                .into_iter()
                .filter(|(_, h)| *h < runs[i].ratio)
                .all(|(finer, _)| errors[finer].is_none() || reaches(finer)),
            // On the scene's own mesh, a run with a looser path is better than the scene's run only
            // by chance.
            _ => runs.iter().position(is_own).is_none_or(reaches),
        })
        .min_by(|&a, &b| faster(&runs[a], &runs[b]))
}

fn faster(a: &StudyRun, b: &StudyRun) -> Ordering {
    let [a, b] = [a, b].map(|run| run.usage.undisturbed_seconds());
    a.total_cmp(&b)
}
