//! What a study says: the error of each run, the order of convergence, the Pareto front, and the
//! price of a digit.

use super::advice;
use super::extrapolation::extrapolate;
use super::knobs::Knob;
use super::quantities::{formal_order, is_demanded_with_all};
use super::record::StudyRun;
use crate::results::ReferenceRow;
use serde::Serialize;
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// Accuracies that are priced.
pub(super) const TARGETS: [f64; 5] = [0.1, 0.03, 0.01, 0.003, 0.001];
/// Finest meshes from which a reference is extrapolated.
const FINEST: usize = 4;
/// Error below which a difference is round-off and shows no order.
const ROUND_OFF: f64 = 1e-12;

/// What the runs are measured against.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StudyReference {
    /// The reference value.
    pub value: f64,
    /// Absolute uncertainty of the reference; 0 for a closed form.
    pub uncertainty: f64,
    /// The closed form's source, or how it was extrapolated.
    pub source: String,
    /// The value extrapolated from the meshes, where the reference is a closed form from which it
    /// differs by more than it is uncertain: what the model itself converges to.
    pub limit: Option<f64>,
}

/// The cheapest setting that reaches an accuracy.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Price {
    /// Relative accuracy.
    pub accuracy: f64,
    /// Index of the run; `None` where none reaches it.
    pub run: Option<usize>,
}

/// A quantity over all runs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct QuantityStudy {
    /// Path of the quantity; `all` stands for the worst of those that govern.
    pub quantity: String,
    /// The reference; `None` for `all`.
    pub reference: Option<StudyReference>,
    /// Error of each run relative to the largest reference of its kind; `None` where the run failed
    /// or lacks the quantity.
    pub errors: Vec<Option<f64>>,
    /// Observed order of convergence in the element size, by series of meshes.
    pub orders: Vec<(String, f64)>,
    /// Runs of which none is both faster and more accurate, by time.
    pub pareto: Vec<usize>,
    /// What accuracies cost.
    pub prices: Vec<Price>,
    /// The verdict in words, what limits, and which looser settings would do.
    pub words: Vec<String>,
}

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
        // What the program gives and no run computes has no error to speak of.
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

pub(super) fn value(run: &StudyRun, path: &str) -> Option<f64> {
    run.values.iter().find(|v| v.0 == path).map(|v| v.1)
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
    // The plain name of the element before its loose variant.
    out.sort_by_key(|name| name.len());
    out.sort_by_key(|name| runs.iter().find(|r| r.series == *name).map(|r| r.knob));
    out
}

/// The closed form that the scene names, else the extrapolation of the scene's own series of
/// meshes.
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
    // Meshes that show no order have no better value than that of the finest.
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

/// What the increments of the scene's own run lack: the two finest runs with fixed steps, on the
/// same mesh, extrapolated with the first order of the flow rule; and by how much that may be
/// wrong: the last change.
pub(super) fn path_correction(runs: &[StudyRun], path: &str) -> Option<(f64, f64)> {
    let own = runs.iter().find(|r| is_own(r))?;
    let mut stepped: Vec<(usize, f64)> = runs
        .iter()
        .filter(|r| r.knob == Knob::Stepping && r.failed.is_none() && r.value != "events")
        .filter_map(|r| Some((r.increments, value(r, path)?)))
        .collect();
    stepped.sort_unstable_by_key(|s| std::cmp::Reverse(s.0));
    let [(fine, at_fine), (coarse, at_coarse)] = stepped.get(..2)?.try_into().ok()?;
    if fine <= coarse || fine <= own.increments {
        return None;
    }
    let last = (at_fine - at_coarse) / (fine as f64 / coarse as f64 - 1.0);
    Some((at_fine + last - value(own, path)?, last.abs()))
}

/// Whether this is the scene as it stands.
pub(super) fn is_own(run: &StudyRun) -> bool {
    run.knob == Knob::Resolution && run.ratio == 1.0 && !run.series.contains(',')
}

/// The quantities a reader wants first: `all`, those at first yield, and of the states, key by key,
/// the one of the largest size.
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

/// Runs by time, each more accurate than all faster ones.
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

/// The fastest run that reaches an accuracy not by chance: in a series of meshes every finer one
/// reaches it too.
fn cheapest(runs: &[StudyRun], errors: &[Option<f64>], accuracy: f64) -> Option<usize> {
    let reaches = |i: usize| errors[i].is_some_and(|e| e <= accuracy);
    (0..runs.len())
        .filter(|&i| reaches(i))
        .filter(|&i| match runs[i].knob {
            Knob::Resolution | Knob::Element => series(runs, &runs[i].series)
                .into_iter()
                .filter(|(_, h)| *h < runs[i].ratio)
                .all(|(finer, _)| errors[finer].is_none() || reaches(finer)),
            // Turned on the scene's own mesh, a looser path is no better than the scene but by
            // chance.
            _ => runs.iter().position(is_own).is_none_or(reaches),
        })
        .min_by(|&a, &b| faster(&runs[a], &runs[b]))
}

fn faster(a: &StudyRun, b: &StudyRun) -> Ordering {
    let [a, b] = [a, b].map(|run| run.usage.undisturbed_seconds());
    a.total_cmp(&b)
}
