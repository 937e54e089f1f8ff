//! `summary.json`: the figures of a run. Keys and meanings are in [`super::SUMMARY_SCHEMA`].

use super::{RunHeader, fields};
use crate::linalg::Prediction;
use crate::results::{ContactPatch, Effect, ReferenceRow, Results, State, Status, YieldPoint};
use crate::space::Vector;
use serde_json::{Map, Value, json};
use std::path::Path;

/// The content of `summary.json`. Numbers that are not finite become null.
///
/// `timings` are the phases of [`Results::timings`] (a phase that ran more than once is summed) and
/// `total`, the wall time of the run; `peak_memory_bytes` is that of this process, null where the
/// system does not tell.
pub fn summary(header: &RunHeader, results: &Results) -> Value {
    let sizes = &results.sizes;
    let n_states = results.states.len();
    let states = results.states.iter().enumerate();
    json!({
        "brinell": env!("CARGO_PKG_VERSION"),
        "scene": scene(header),
        "scene_file": header.scene_file,
        "kind": header.kind,
        "solver": header.solver,
        "nodes": sizes.nodes,
        "elements": sizes.elements,
        "freedoms": sizes.freedoms,
        "contact_pairs": sizes.contact_pairs,
        "zone_freedoms": sizes.zone_freedoms,
        "zone_elements": sizes.zone_elements,
        "effects": effects(&results.effects),
        "timings": timings(&results.timings, header.wall_seconds),
        "peak_memory_bytes": peak_memory_bytes(),
        "counts": results.counts,
        "factor": factor(&results.factor),
        "condition": results.condition,
        "condition_estimate": results.condition_estimate,
        "quality": results.quality,
        "inaccurate": results.inaccurate,
        "yield": results.first_yield.map(|point| first_yield(header, &point)),
        "states": states.map(|(i, s)| state(header, i, n_states, s)).collect::<Vec<_>>(),
        "reference": results.reference.iter().map(reference).collect::<Vec<_>>(),
        "accuracy": results.accuracy,
        "warnings": results.warnings,
        "resumed": results.resumed,
        "incomplete": results.incomplete,
    })
}

/// What a reader calls the scene: its title, or the name of its file.
fn scene(header: &RunHeader) -> String {
    if !header.scene_title.is_empty() {
        return header.scene_title.clone();
    }
    let file = header.scene_file.as_deref().map(Path::new);
    let name = file
        .and_then(Path::file_name)
        .map(|name| name.to_string_lossy());
    name.map_or_else(|| "untitled".to_string(), |name| name.into_owned())
}

fn effects(effects: &[Effect]) -> Value {
    let by_name = effects.iter().map(|effect| {
        let entry = json!({
            "on": effect.on,
            "why": effect.why,
            "seconds": effect.seconds,
            "memory_bytes": effect.memory_bytes,
        });
        (effect.name.clone(), entry)
    });
    Value::Object(by_name.collect())
}

fn timings(phases: &[(String, f64)], total: f64) -> Value {
    let mut seconds: Vec<(&str, f64)> = Vec::new();
    for (phase, time) in phases.iter().filter(|(phase, _)| phase != "total") {
        match seconds.iter_mut().find(|(name, _)| name == phase) {
            Some((_, sum)) => *sum += time,
            None => seconds.push((phase, *time)),
        }
    }
    seconds.push(("total", total));
    let by_phase = seconds.into_iter().map(|(k, v)| (k.to_owned(), v.into()));
    Value::Object(by_phase.collect())
}

fn factor(factor: &Prediction) -> Value {
    json!({
        "ordering": factor.ordering,
        "factor_nonzeros": whole(factor.factor_nonzeros),
        "trailing_nonzeros": whole(factor.trailing_nonzeros),
        "flops": whole(factor.flops),
        "memory_bytes": whole(factor.memory_bytes),
    })
}

/// A count kept as a float, written as an integer where that is exact.
fn whole(count: f64) -> Value {
    const LARGEST_EXACT: f64 = (1u64 << f64::MANTISSA_DIGITS) as f64;
    if (0.0..=LARGEST_EXACT).contains(&count) {
        (count.round() as u64).into()
    } else {
        count.into()
    }
}

fn first_yield(header: &RunHeader, point: &YieldPoint) -> Value {
    let axes = ["x", "y", "z"].into_iter().zip(point.location);
    let mut location: Map<String, Value> = axes
        .take(header.dimension())
        .map(|(axis, x)| (axis.to_string(), x.into()))
        .collect();
    location.insert("body".to_string(), header.body(point.body).into());
    json!({
        "alpha": point.alpha,
        "load": point.load,
        "max_pressure": point.max_pressure,
        "half_width": point.half_width,
        "location": location,
    })
}

fn state(header: &RunHeader, index: usize, n_states: usize, state: &State) -> Value {
    let points = by_body(header, &state.plastic_points_by_body);
    let depths = by_body(header, &state.residual_depth_by_body);
    let closed = state.pairs.iter().filter(|p| p.status == Status::Closed);
    let file = state.fields.as_ref();
    let mut figures = json!({
        "name": state.name,
        "alpha": state.alpha,
        "load": state.load,
        "contact_force": state.contact_force,
        "closed_pairs": closed.count(),
        "max_pressure": state.max_pressure,
        "pole_pressure": state.pole_pressure,
        "half_width": state.half_width,
        "contact_arc": state.contact_arc.map(|[from, to]| json!({ "from": from, "to": to })),
        "residual_depth": state.residual_depth,
        "residual_depth_by_body": depths,
        "rim_height": state.rim_height,
        "approach": state.approach,
        "plastic_points": state.plastic_points,
        "plastic_points_by_body": points,
        "max_equivalent_plastic_strain": state.max_equivalent_plastic_strain,
        "plastic_zone_size": state.plastic_zone_size,
        "energy_error": state.energy_error,
        "quality": state.quality,
        "fields": file.map(|_| fields::file_name(index, n_states, &state.name)),
    });
    if header.dimension() == 3 {
        figures["patches"] = state.patches.iter().map(patch).collect();
    }
    figures
}

/// A patch of contact; contacts are counted from 1.
fn patch(patch: &ContactPatch) -> Value {
    let vector = |[x, y, z]: Vector| json!({ "x": x, "y": y, "z": z });
    json!({
        "contact": patch.contact + 1,
        "force": patch.force,
        "area": patch.area,
        "max_pressure": patch.max_pressure,
        "mean_pressure": patch.mean_pressure,
        "semi_axes": patch.semi_axes,
        "centroid": vector(patch.centroid),
        "direction": vector(patch.direction),
    })
}

/// A figure of each body, by its name.
fn by_body<T: Copy + Into<Value>>(header: &RunHeader, figures: &[T]) -> Map<String, Value> {
    let named = figures.iter().enumerate();
    named
        .map(|(i, &figure)| (header.body(i), figure.into()))
        .collect()
}

fn reference(row: &ReferenceRow) -> Value {
    json!({
        "quantity": row.quantity,
        "reference": row.reference,
        "computed": row.computed,
        "ratio": row.ratio,
        "published_ratio": row.published_ratio,
        "source": row.source,
    })
}

/// The most memory that this process has held so far (Linux: `VmHWM`).
fn peak_memory_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    kibibytes.checked_mul(1024)
}
