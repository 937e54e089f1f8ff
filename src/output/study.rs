//! `accuracy.json` and `accuracy.csv`: a study as data.

use super::atomic::Staging;
use super::names::STUDY_FILE;
use super::write::is_result_file;
use super::{RunHeader, work_precision};
use crate::accuracy::{QuantityStudy, Study, StudyRun};
use crate::error::Result;
use serde_json::{Map, Value, json};
use std::ffi::OsStr;
use std::io::Write;
use std::path::Path;

const TABLE_FILE: &str = "accuracy.csv";
const PLOT_SUFFIX: &str = ".svg";
/// Columns of the table.
const COLUMNS: [&str; 22] = [
    "run",
    "series",
    "knob",
    "value",
    "element_size",
    "freedoms",
    "increments",
    "wall_seconds",
    "cpu_seconds",
    "peak_memory_bytes",
    "flops",
    "factor_nonzeros",
    "trailing_nonzeros",
    "factorizations",
    "trailing_solves",
    "full_solves",
    "plastic_iterations",
    "quantity",
    "computed",
    "reference",
    "relative_error",
    "work",
];
/// Writes the study to `dir`, all of it or nothing. An earlier study or result of brinell is
/// replaced, other files are kept.
///
/// # Errors
/// The errors of [`super::write()`].
pub fn write_study(dir: &Path, header: &RunHeader, study: &Study) -> Result<()> {
    finish_study(Staging::new(dir)?, header, study)
}

/// Fills a temporary directory and moves it to its final path.
pub(super) fn finish_study(staging: Staging, header: &RunHeader, study: &Study) -> Result<()> {
    staging.file(STUDY_FILE, |out| {
        serde_json::to_writer_pretty(&mut *out, &study_json(header, study))?;
        out.write_all(b"\n")
    })?;
    staging.file(TABLE_FILE, |out| table(out, study))?;
    for quantity in work_precision::plotted(study) {
        let name = plot_file(&quantity.quantity);
        let plot = work_precision::plot(study, quantity)?;
        staging.file(&name, |out| out.write_all(plot.as_bytes()))?;
    }
    staging.publish(is_study_file)
}

/// The content of `accuracy.json`. Numbers that are not finite become null.
pub fn study_json(header: &RunHeader, study: &Study) -> Value {
    json!({
        "brinell": env!("CARGO_PKG_VERSION"),
        "scene": header.scene_title,
        "scene_file": header.scene_file,
        "kind": header.kind,
        "solver": header.solver,
        "kernels": header.kernels,
        "seconds": study.seconds,
        "stopped": study.stopped,
        "runs": study.runs.iter().map(run).collect::<Vec<_>>(),
        "quantities": study.quantities.iter().map(quantity).collect::<Vec<_>>(),
        "left_out": study.left_out,
    })
}

fn run(run: &StudyRun) -> Value {
    json!({
        "series": run.series,
        "knob": run.knob.name(),
        "value": run.value,
        "element_size": run.ratio,
        "failed": run.failed,
        "freedoms": run.freedoms,
        "increments": run.increments,
        "flops": run.factor[0],
        "factor_nonzeros": run.factor[1],
        "trailing_nonzeros": run.factor[2],
        "counts": run.counts,
        "wall_seconds": run.usage.wall_seconds,
        "cpu_seconds": run.usage.cpu_seconds,
        "peak_memory_bytes": run.usage.peak_memory_bytes,
        "work": run.work,
        "timings": object(&run.timings),
        "values": object(&run.values),
    })
}

fn object(pairs: &[(String, f64)]) -> Value {
    let map: Map<String, Value> = pairs
        .iter()
        .map(|(k, v)| (k.clone(), (*v).into()))
        .collect();
    Value::Object(map)
}

fn quantity(quantity: &QuantityStudy) -> Value {
    json!({
        "quantity": quantity.quantity,
        "reference": quantity.reference,
        "relative_errors": quantity.errors,
        "orders": object(&quantity.orders),
        "pareto": quantity.pareto,
        "prices": quantity.prices,
        "words": quantity.words,
    })
}

/// A row per run and quantity.
fn table(out: &mut impl Write, study: &Study) -> std::io::Result<()> {
    let mut writer = csv::Writer::from_writer(out);
    writer.write_record(COLUMNS)?;
    for (i, run) in study.runs.iter().enumerate() {
        let optional = |value: Option<f64>| value.map_or(String::new(), |v| v.to_string());
        let mut common = vec![
            (i + 1).to_string(),
            run.series.clone(),
            run.knob.name().to_string(),
            run.value.clone(),
            run.ratio.to_string(),
            run.freedoms.to_string(),
            run.increments.to_string(),
            run.usage.wall_seconds.to_string(),
            optional(run.usage.cpu_seconds),
            run.usage
                .peak_memory_bytes
                .map_or(String::new(), |b| b.to_string()),
        ];
        common.extend(run.factor.map(|f| f.to_string()));
        let counts = &run.counts;
        common.extend(
            [
                counts.factorizations,
                counts.trailing_solves,
                counts.full_solves,
                counts.plastic_iterations,
            ]
            .map(|n| n.to_string()),
        );
        for quantity in &study.quantities {
            let (Some(reference), Some(error)) = (&quantity.reference, quantity.errors[i]) else {
                continue;
            };
            let computed = run.values.iter().find(|v| v.0 == quantity.quantity);
            let mut row = common.clone();
            row.extend([
                quantity.quantity.clone(),
                optional(computed.map(|v| v.1)),
                reference.value.to_string(),
                error.to_string(),
                run.work.to_string(),
            ]);
            writer.write_record(&row)?;
        }
    }
    writer.flush()
}

/// Returns the file name of a quantity's plot. In the path only ASCII letters, digits, `-` and `_`
/// are safe everywhere; other characters become `_`.
fn plot_file(path: &str) -> String {
    let name: String = path
        .chars()
        .map(|c| {
            if c.is_ascii_alphanumeric() || c == '-' {
                c
            } else {
                '_'
            }
        })
        .collect();
    name + PLOT_SUFFIX
}

/// Whether a file of this name in a study's directory is removed when the study is replaced.
fn is_study_file(name: &OsStr) -> bool {
    let ours = |name: &str| name == STUDY_FILE || name == TABLE_FILE || name.ends_with(PLOT_SUFFIX);
    name.to_str()
        .is_some_and(|name| ours(name) || is_result_file(OsStr::new(name)))
}
