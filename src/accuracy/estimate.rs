//! The errors of every quantity of a run, estimated after it.

use super::companions::{Companions, Level, companions};
use super::effort::Effort;
use super::extrapolation::extrapolate;
use super::meter::work;
use super::path::{self, PathErrors};
use super::quantities::{Quantity, formal_order, quantities, value_of};
use super::runs::{Extent, Finished, Runs};
use super::unresolved::Unresolved;
use crate::analysis::left_of_search;
use crate::linalg::{Backend, smallest_pivot_ratio};
use crate::number::percent;
use crate::progress::Observer;
use crate::results::{
    Accuracy, Companion, EstimateMethod, HistoryRow, QuantityError, Results, State,
};
use crate::scene::Scene;
use std::time::Instant;

/// A run whose errors are estimated.
pub(super) struct Judged<'r> {
    pub scene: &'r Scene,
    pub results: &'r Results,
    pub extent: Extent,
    pub effort: Effort,
}

/// Estimates the errors of `results`, the results of a run of `scene` to `extent`.
/// [`Accuracy::notes`] name what could not be estimated. If another run fails, only its estimate is
/// lost, never the results. If the observer asks to stop, the estimate ends early.
pub fn estimate(
    scene: &Scene,
    backend: Backend,
    results: &Results,
    extent: Extent,
    effort: Effort,
    observer: &mut dyn Observer,
) -> Accuracy {
    let mut runs = Runs::new(backend, extent);
    let companions = match &results.incomplete {
        None => companions(scene, results, effort),
        Some(_) => Companions::default(),
    };
    let run = Judged {
        scene,
        results,
        extent,
        effort,
    };
    runs.keep(scene, results, 0.0);
    let mut out = assess(&run, companions.levels, &mut runs, observer);
    if let Some(why) = companions.why_none {
        let full = match effort {
            Effort::Quick => "; the full estimate (`--estimate full`) runs finer ones if it can",
            Effort::Full | Effort::None => "",
        };
        out.notes
            .push(format!("no other mesh was run: {why}{full}"));
    }
    out
}

/// Estimates the errors of a run from runs on other meshes of its family.
pub(super) fn assess(
    run: &Judged,
    levels: Vec<Level>,
    runs: &mut Runs,
    observer: &mut dyn Observer,
) -> Accuracy {
    let start = Instant::now();
    let &Judged {
        scene,
        results,
        extent,
        ..
    } = run;
    let mut out = Accuracy::default();
    let found = run_others(levels, runs, &mut out, observer);
    let path = if results.incomplete.is_some() {
        let why = "the run is incomplete: no error is estimated";
        out.notes.push(why.to_string());
        PathErrors::Unknown
    } else if extent == Extent::Yield || !path::matters(results) {
        PathErrors::None
    } else {
        let others = found.iter().map(|(_, other)| other);
        path_errors(run, others, runs, &mut out, observer)
    };
    let has_norm = results.states.iter().any(|s| s.energy_error.is_some());
    out.method = match found.is_empty() {
        false => EstimateMethod::CoarserMeshes,
        true if has_norm && results.incomplete.is_none() => EstimateMethod::EnergyNorm,
        _ => EstimateMethod::None,
    };
    let mut unresolved = Unresolved::of(scene, results);
    let elsewhere: Vec<(f64, &Results)> = (found.iter())
        .map(|(ratio, other)| (*ratio, &other.results))
        .collect();
    let formal = formal_order("approach", results.sizes.degree);
    unresolved.find_nearly_closed(results, &elsewhere, formal);
    out.notes.extend(unresolved.notes());
    let sources = ErrorSources {
        run,
        method: out.method,
        others: (found.iter())
            .map(|(ratio, other)| (*ratio, quantities(&other.results)))
            .collect(),
        path,
        unresolved,
    };
    let all = quantities(results);
    out.quantities = all.iter().map(|quantity| sources.of(quantity)).collect();
    if extent == Extent::Program {
        out.notes.extend(said_by_load(scene, &out.quantities));
        out.notes.extend(path::beyond_asked(scene, &out.quantities));
    }
    out.seconds = start.elapsed().as_secs_f64();
    out
}

/// Sources from which the errors of the quantities of a run follow.
struct ErrorSources<'r> {
    run: &'r Judged<'r>,
    method: EstimateMethod,
    /// Element sizes of the other meshes over that of the run, with their quantities.
    others: Vec<(f64, Vec<Quantity>)>,
    path: PathErrors,
    unresolved: Unresolved,
}

impl ErrorSources<'_> {
    /// Returns the errors of a quantity of the run.
    fn of(&self, quantity: &Quantity) -> QuantityError {
        let algebraic = algebraic_error(self.run, quantity);
        let mesh = match self.method {
            _ if self.unresolved.hides(quantity) => OfMeshes::default(),
            EstimateMethod::CoarserMeshes => {
                let degree = self.run.results.sizes.degree;
                by_other_meshes(quantity, degree, algebraic, &self.others)
            }
            EstimateMethod::EnergyNorm => OfMeshes {
                error: by_energy_norm(self.run, quantity),
                ..OfMeshes::default()
            },
            EstimateMethod::None => OfMeshes::default(),
        };
        let path = self.path.of(&quantity.path);
        let error = mesh.error.map(|e| e + path.unwrap_or(0.0) + algebraic);
        QuantityError {
            quantity: quantity.path.clone(),
            value: quantity.value,
            error,
            relative_error: error
                .filter(|_| quantity.scale > 0.0)
                .map(|e| e / quantity.scale),
            discretisation: mesh.error,
            path,
            algebraic,
            order: mesh.order,
            extrapolated: mesh.limit,
        }
    }
}

/// Estimates the error of a quantity from the energy norm of the stress error, if no other mesh was
/// run. Loads, displacements and work take the norm of the whole model. All other quantities, and
/// loads that the material or the contact decides, take the norm of the region where bodies touch
/// or yield. The estimate is no bound; `None` if a target asks for the quantity itself. The error
/// of the reading and [`Quantity::least`] are added: unlike a comparison of meshes, the norm does
/// not show how far the outermost points are from a surface.
fn by_energy_norm(run: &Judged, quantity: &Quantity) -> Option<f64> {
    let program = &run.scene.program;
    let labels = program.labels();
    let mut targets = program.targets.iter().zip(&labels);
    let of_state = |label: &str, key: &str| quantity.path == format!("states.{label}.{key}");
    let asked = targets.clone().any(|(target, label)| {
        let mut keys = target.figures().map(|(figure, _)| figure.key());
        keys.any(|key| of_state(label, key))
    });
    if asked {
        return None;
    }
    let is_found = quantity.path == "yield.load"
        || targets.any(|(target, label)| {
            (target.first_yield || target.finds_load()) && of_state(label, "load")
        });
    let is_of_all = !is_found && matches!(quantity.kind, "load" | "approach" | "plastic_work");
    let norms = run.results.states.iter().filter_map(|state| {
        let local = state.local_energy_error.filter(|_| !is_of_all);
        local.or(state.energy_error)
    });
    let norm = norms.reduce(f64::max)?;
    let per_stress = match is_found {
        true => load_per_stress(run.results),
        false => 1.0,
    };
    Some(norm * per_stress * quantity.scale + quantity.reading + quantity.least)
}

/// Relative change of the load at first yield for a small relative change of the stress under every
/// load. It is `1/m` if stresses grow with the power `m` of the load: 1/3 under a ball and 1/2
/// under a cylinder (Hertz), 1 if contact does not change. The power is that of the largest
/// pressure between first yield and the increment whose load is nearest to half of that at first
/// yield.
fn load_per_stress(results: &Results) -> f64 {
    let Some(first) = &results.first_yield else {
        return 1.0;
    };
    let before = results.history.iter().filter(|row| {
        let share = row.load / first.load;
        share > 0.0 && share < 1.0 && row.plastic_points == 0 && row.max_pressure > 0.0
    });
    let off_half = |row: &HistoryRow| (row.load / first.load - 0.5).abs();
    let nearest = before.min_by(|a, b| off_half(a).total_cmp(&off_half(b)));
    let power = nearest.map_or(1.0, |row| {
        (first.max_pressure / row.max_pressure).ln() / (first.load / row.load).ln()
    });
    match power > 0.0 && power < 1.0 {
        true => 1.0 / power,
        false => 1.0,
    }
}

/// Runs the other meshes, and returns the runs with their element sizes.
fn run_others(
    levels: Vec<Level>,
    runs: &mut Runs,
    out: &mut Accuracy,
    observer: &mut dyn Observer,
) -> Vec<(f64, Finished)> {
    let n = levels.len();
    let mut others = Vec::new();
    for (i, level) in levels.into_iter().enumerate() {
        if observer.stop_requested() {
            let why = "stopped: the estimate is incomplete";
            out.notes.push(why.to_string());
            break;
        }
        observer.phase(&format!("error estimate: mesh {} of {n}", i + 1));
        match runs.of(&level.scene, observer) {
            Ok((found, is_new)) => {
                out.work += if is_new { work(&found.results) } else { 0.0 };
                out.companions.push(Companion {
                    ratio: level.ratio,
                    freedoms: found.results.sizes.freedoms,
                    seconds: found.seconds,
                });
                others.push((level.ratio, found));
            }
            Err(error) => out.notes.push(format!(
                "the run with elements {:.3} times as large failed and does not count: {error}",
                level.ratio
            )),
        }
    }
    others
}

/// Estimates the errors of the path on the coarsest of the other runs in which everything yields
/// that yields in this run; on this run itself if there is none.
fn path_errors<'f>(
    run: &Judged,
    others: impl Iterator<Item = &'f Finished>,
    runs: &mut Runs,
    out: &mut Accuracy,
    observer: &mut dyn Observer,
) -> PathErrors {
    let yields_alike = |other: &&Finished| {
        let states = run.results.states.iter().zip(&other.results.states);
        let mut states = states.map(|(own, other)| (own.plastic_points, other.plastic_points));
        states.all(|(own, other)| own == 0 || other > 0)
    };
    let own = Finished::of(run.scene, run.results);
    let fewest = |a: &&Finished, b: &&Finished| {
        let [a, b] = [a, b].map(|run| run.results.sizes.elements);
        a.cmp(&b)
    };
    let coarsest = others.filter(yields_alike).min_by(fewest);
    let base = coarsest
        .filter(|other| fewest(other, &&own).is_lt())
        .unwrap_or(&own);
    let (found, made) = path::errors(
        base,
        runs,
        run.results,
        run.effort,
        observer,
        &mut out.notes,
    );
    out.work += made;
    found
}

/// What other meshes show about a quantity.
#[derive(Default)]
struct OfMeshes {
    error: Option<f64>,
    order: Option<f64>,
    limit: Option<f64>,
}

/// The uncertainty that the meshes leave, including that of reading the quantity on this mesh.
fn by_other_meshes(
    quantity: &Quantity,
    degree: usize,
    algebraic: f64,
    others: &[(f64, Vec<Quantity>)],
) -> OfMeshes {
    let own = std::iter::once((1.0, quantity.value));
    let there = others
        .iter()
        .filter_map(|(ratio, values)| Some((*ratio, value_of(values, &quantity.path)?)));
    let values: Vec<(f64, f64)> = own.chain(there).collect();
    let found = extrapolate(&values, formal_order(quantity.kind, degree));
    let error = found.map(|f| (f.uncertainty + quantity.reading).max(quantity.least));
    // Values that differ by no more than the error of the algebra show no order.
    let is_same = |value: &(f64, f64)| (value.1 - quantity.value).abs() <= algebraic;
    if values.len() > 1 && values.iter().all(is_same) {
        return OfMeshes {
            error,
            order: None,
            limit: None,
        };
    }
    OfMeshes {
        error,
        order: found.and_then(|f| f.order),
        limit: found.and_then(|f| f.limit),
    }
}

/// Error of the algebra: the errors of the quantity's state, but at least the round-off of a
/// factorisation. At first yield, the part of the largest stress that `gamma` leaves is added.
fn algebraic_error(run: &Judged, quantity: &Quantity) -> f64 {
    let results = run.results;
    let of_quantity = |state: &&State| Some(&state.name) == quantity.state.as_ref();
    let state = results.states.iter().find(of_quantity);
    let quality = state.map_or(results.quality, |s| s.quality);
    let worst = quality.backward_error + quality.equilibrium + quality.complementarity;
    let mut relative = worst.max(smallest_pivot_ratio(results.sizes.freedoms));
    if quantity.path.starts_with("yield.") {
        relative += left_of_search(run.scene.program.gamma);
    }
    relative * quantity.scale
}

/// Returns a note on targets that are given by half width or another figure instead of a load. Each
/// mesh reaches such a target at a load of its own, and the error of this load is in all figures of
/// this state and of the states after it.
fn said_by_load(scene: &Scene, quantities: &[QuantityError]) -> Option<String> {
    let labels = scene.program.labels();
    let targets = scene.program.targets.iter().zip(&labels);
    let mut kinds: Vec<&str> = Vec::new();
    let mut names: Vec<String> = Vec::new();
    for (target, label) in targets.filter(|(target, _)| target.finds_load()) {
        let path = format!("states.{label}.load");
        let row = quantities.iter().find(|q| q.quantity == path);
        let Some(error) = row.and_then(|row| row.relative_error) else {
            continue;
        };
        let figure = target.figures().next();
        let kind = figure.map_or("a half width", |(figure, _)| figure.key());
        if !kinds.contains(&kind) {
            kinds.push(kind);
        }
        names.push(format!("`{label}`: {}", percent(error)));
    }
    (!names.is_empty()).then(|| {
        format!(
            "{} as target is reached at another load on each mesh: the error of that load ({}) is \
             in the other figures of the state and of those after it, the dent among them unless \
             it is what was asked for; a load factor as target leaves it out",
            kinds.join(" or "),
            names.join(", ")
        )
    })
}
