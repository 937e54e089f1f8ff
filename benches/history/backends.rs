//! The sparse backends beside one another: ordering and analysis, factorisation with condensation,
//! a whole history, and peak memory, each in a process of its own, on one thread and on two.

use super::{BALL, Failure, LINE, LONG, REPEATED, SIZES, SOLID, child, peak_memory, scene};
use brinell::analysis::Analysis;
use brinell::linalg::{self, Backend, Partition};
use brinell::model::Model;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::time::Instant;

const THREADS: [usize; 2] = [1, 2];

/// Orders, analyses and factors what a run condenses first: `K` with the freedoms of all pairs as
/// contact, held by a shift.
pub fn factor(backend: Backend, changes: &str) -> Result<Value, Failure> {
    let analysis = Analysis::new(Model::new(&scene(changes)?)?, backend)?;
    let model = analysis.model();
    let stiffness = &analysis.system().stiffness;
    let matrix = stiffness.whole().ok_or("the matrix is elsewhere")?;
    let nodes = model
        .pairs
        .iter()
        .flat_map(|pair| pair.nodes().collect::<Vec<_>>());
    let contact: Vec<usize> = nodes
        .filter_map(|node| model.freedoms.normal_freedom(node))
        .collect();
    let diagonal =
        |freedom: &usize| matrix.data()[matrix.proper_indptr()[freedom + 1] as usize - 1];
    let shift: Vec<f64> = contact.iter().map(diagonal).collect();
    let partition = Partition {
        n: matrix.rows(),
        zone: Vec::new(),
        contact,
    };
    let start = Instant::now();
    let cost = linalg::predict(backend, matrix, &partition)?;
    let analysed = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let condensed = linalg::condense(backend, matrix, &partition, &shift)?;
    let all = start.elapsed().as_secs_f64();
    let start = Instant::now();
    condensed.reduce_load(&vec![1.0; partition.n])?;
    Ok(json!({
        "analyse": analysed,
        "factor": all - analysed,
        "solve": start.elapsed().as_secs_f64(),
        "seconds": all,
        "cost": cost,
        "peak_bytes": peak_memory()?,
    }))
}

pub fn measure(names: &[&str]) -> Result<(), Failure> {
    let mut all = Vec::new();
    println!(
        "| freedoms | threads | backend | order and analysis | factor | half a solve | flops | \
         nonzeros | memory | history | memory |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    let plane = SIZES.iter().map(|size| (LINE, size));
    let cases = plane.chain(SOLID.iter().map(|size| (BALL, size)));
    for (file, (name, changes)) in
        cases.filter(|(_, size)| names.is_empty() || names.contains(&size.0))
    {
        let changes = [&[file], *changes].concat().join(";");
        for threads in THREADS {
            for backend in [Backend::Cholmod, Backend::Faer] {
                let by = backend.name();
                let factor = median(&["factor-by", by, &changes], threads)?;
                let directory = tempfile::tempdir()?;
                let path = directory
                    .path()
                    .to_str()
                    .ok_or("a temporary directory with an odd name")?;
                let run = median(&["run-by", by, &changes, path], threads)?;
                report(threads, by, &factor, &run);
                all.push(json!({
                    "size": name, "threads": threads, "backend": by, "factor": factor, "run": run,
                }));
            }
        }
    }
    let results = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("bench-results");
    std::fs::create_dir_all(&results)?;
    let text = serde_json::to_string_pretty(&json!(all))?;
    std::fs::write(results.join("backends.json"), text + "\n")?;
    Ok(())
}

/// The run with the median of the seconds, of as many as their time allows.
fn median(arguments: &[&str], threads: usize) -> Result<Value, Failure> {
    let mut values: Vec<Value> = Vec::new();
    let seconds = |value: &Value| value["seconds"].as_f64().unwrap_or(f64::NAN);
    while values.len() < REPEATED && values.first().is_none_or(|v| seconds(v) < LONG) {
        values.push(serde_json::from_str(&child(arguments, Some(threads))?)?);
    }
    values.sort_by(|a, b| seconds(a).total_cmp(&seconds(b)));
    Ok(values.swap_remove(values.len() / 2))
}

fn report(threads: usize, backend: &str, factor: &Value, run: &Value) {
    let of = |value: &Value, key: &str| value[key].as_f64().unwrap_or(f64::NAN);
    println!(
        "| {} | {threads} | {backend} | {:.2} | {:.2} | {:.3} | {:.2e} | {:.2e} | {:.0} MB | {:.2} \
         | {:.0} MB |",
        run["sizes"]["freedoms"],
        of(factor, "analyse"),
        of(factor, "factor"),
        of(factor, "solve"),
        of(&factor["cost"], "flops"),
        of(&factor["cost"], "factor_nonzeros"),
        of(factor, "peak_bytes") / 1e6,
        of(run, "seconds"),
        of(run, "peak_bytes") / 1e6,
    );
}
