//! How time and memory grow with the mesh: similar meshes from ten thousand to three million
//! freedoms, phase by phase, on one thread and on two.
//!
//! In the plane a factor of n freedoms takes n^1.5 operations and n log n nonzeros (George 1973,
//! doi:10.1137/0710032), assembly and states n, and a mesh twice as fine has twice as many changes
//! of contact. The exponents are fitted to the larger half of the sizes. Beside the measured
//! factorisation stands what `brinell check` predicts from the symbolic analysis.

use super::{Failure, LINE, child, scene};
use brinell::analysis;
use brinell::linalg::Backend;
use brinell::model::Model;
use serde_json::{Value, json};
use std::path::PathBuf;

/// Elements over b*; sizes grow so much more slowly away from the contact that the meshes are
/// similar.
const RESOLUTIONS: [f64; 6] = [8.0, 16.0, 32.0, 56.0, 80.0, 112.0];
const THREADS: [usize; 2] = [1, 2];

fn changes(resolution: f64) -> String {
    const MESH: &str = "mesh.cylinder_on_half_plane";
    format!(
        "{LINE};{MESH}.resolution={resolution};{MESH}.growth={}",
        1.0 + 2.0 / resolution
    )
}

/// What `brinell check` says.
pub fn prediction(changes: &str) -> Result<Value, Failure> {
    let check = analysis::check(&Model::new(&scene(changes)?)?, Backend::Cholmod)?;
    Ok(json!({
        "seconds": check.predicted_seconds,
        "factor": check.prediction,
    }))
}

pub fn measure() -> Result<(), Failure> {
    let mut all = Vec::new();
    for threads in THREADS {
        let mut runs = Vec::new();
        for resolution in RESOLUTIONS {
            let directory = tempfile::tempdir()?;
            let path = directory
                .path()
                .to_str()
                .ok_or("a temporary directory with an odd name")?;
            let changes = changes(resolution);
            let mut run: Value =
                serde_json::from_str(&child(&["run", &changes, path], Some(threads))?)?;
            run["predicted"] = serde_json::from_str(&child(&["check", &changes], Some(threads))?)?;
            runs.push(run);
        }
        report(threads, &runs);
        all.push(json!({"threads": threads, "runs": runs}));
    }
    let results = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("bench-results");
    std::fs::create_dir_all(&results)?;
    let text = serde_json::to_string_pretty(&json!(all))?;
    std::fs::write(results.join("scaling.json"), text + "\n")?;
    Ok(())
}

fn report(threads: usize, runs: &[Value]) {
    let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    let freedoms: Vec<f64> = runs
        .iter()
        .map(|run| number(&run["sizes"]["freedoms"]))
        .collect();
    let row = |what: &str, values: Vec<f64>, theory: &str| {
        print!("{what:33}");
        for value in &values {
            print!(" {value:10.4}");
        }
        println!("  n^{:.2}  {theory}", exponent(&freedoms, &values));
    };
    println!("\n{threads} threads");
    row(
        "freedoms, M",
        freedoms.iter().map(|n| n / 1e6).collect(),
        "",
    );
    let factor = |key: &'static str, scale: f64| {
        let values = runs.iter().map(|run| number(&run["factor"][key]) / scale);
        values.collect::<Vec<f64>>()
    };
    row("flops of the factor, G", factor("flops", 1e9), "n^1.5");
    row(
        "nonzeros of the factor, M",
        factor("factor_nonzeros", 1e6),
        "n log n",
    );
    let phases = runs[0]["phases"].as_array().map_or(0, Vec::len);
    for phase in 0..phases {
        let name = runs[0]["phases"][phase][0].as_str().unwrap_or("?");
        let seconds = runs.iter().map(|run| number(&run["phases"][phase][1]));
        let theory = match name {
            "factorisation and condensation" => "n^1.5 flops, n log n order",
            "mesh and model" | "assembly" | "states" | "stresses" | "output" => "n",
            _ => "",
        };
        row(&format!("{name}, s"), seconds.collect(), theory);
    }
    let of = |key: &'static str, scale: f64| {
        let values = runs.iter().map(|run| number(&run[key]) / scale);
        values.collect::<Vec<f64>>()
    };
    row("total, s", of("seconds", 1.0), "");
    row("peak memory, GB", of("peak_bytes", 1e9), "n log n");
    row("increments", of("increments", 1.0), "n^0.5");
    let solves = runs
        .iter()
        .map(|run| number(&run["counts"]["trailing_solves"]));
    row("trailing solves", solves.collect(), "");
    let predicted: Vec<f64> = runs
        .iter()
        .map(|run| number(&run["predicted"]["seconds"]))
        .collect();
    row("predicted factorisation, s", predicted, "");
    let bytes = runs
        .iter()
        .map(|run| number(&run["predicted"]["factor"]["memory_bytes"]) / 1e9);
    row("predicted memory, GB", bytes.collect(), "");
    for run in runs {
        let name = |value: &Value| value["ordering"].as_str().unwrap_or("?").to_string();
        print!("  {}", name(&run["factor"]));
        let off =
            number(&run["predicted"]["factor"]["flops"]) / number(&run["factor"]["flops"]) - 1.0;
        print!(" (predicted flops {:+.1} %)", 100.0 * off);
    }
    println!();
}

/// Slope of log(value) over log(n), fitted to the larger half.
fn exponent(n: &[f64], values: &[f64]) -> f64 {
    let points: Vec<(f64, f64)> = n
        .iter()
        .zip(values)
        .skip(n.len() / 2 - 1)
        .map(|(n, v)| (n.ln(), v.ln()))
        .collect();
    let mean =
        |f: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>() / points.len() as f64;
    let (x, y) = (mean(&|p| p.0), mean(&|p| p.1));
    mean(&|p| (p.0 - x) * (p.1 - y)) / mean(&|p| (p.0 - x) * (p.0 - x))
}
