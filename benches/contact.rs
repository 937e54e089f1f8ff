//! What contact costs: condensing on many pairs, and one change of contact among them.
//!
//! Two blocks, one node per pair, the upper one held by contact alone; gaps grow as the square of
//! the distance from one end, so that pairs close one after the other.
//! `cargo bench --bench contact` takes 50, 500 and 3,000 pairs, on blocks that are thin beside the
//! contact (20 elements: next to nothing but contact is factored) and on solid ones; `-- 500` one
//! of them, `-- 5000` a larger one. The table goes to the terminal, the figures to
//! `bench-results/contact.json`.

mod process;

use brinell::analysis::Analysis;
use brinell::linalg::cholmod::{self, blas_name, cholmod_version, solve_unconstrained};
use brinell::linalg::{Backend, Partition};
use brinell::model::Model;
use brinell::progress::Silent;
use brinell::scene::Scene;
use brinell::substructure::Substructure;
use process::{Failure, peak_memory};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::time::Instant;

const SCENE: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/data/scenes/contact_patch.toml"
);
const PAIRS: [usize; 3] = [50, 500, 3000];
/// Elements through the thickness of a thin block.
const THIN: usize = 20;
/// Elements through the thickness of a solid block: half as many as pairs, no more than fit into
/// the memory.
const SOLID: usize = 200;
/// Gap of the last pair, in lengths of an element.
const LARGEST_GAP: f64 = 1e-3;

fn main() -> Result<(), Failure> {
    let given: Vec<usize> = std::env::args()
        .skip(1)
        .filter_map(|a| a.parse().ok())
        .collect();
    rayon::ThreadPoolBuilder::new()
        .use_current_thread()
        .build_global()?;
    println!("CHOLMOD {}, {}\n", cholmod_version(), blas_name());
    println!(
        "pairs  rows  freedoms  bare factor s  condensed s  C alone s  by solves s  contact s  \
         events  ms/event  1000 events/factor  peak GB"
    );
    let mut rows = Vec::new();
    let chosen = if given.is_empty() {
        &PAIRS[..]
    } else {
        &given[..]
    };
    for &pairs in chosen {
        rows.push(measure(pairs, THIN)?);
        if PAIRS.contains(&pairs) {
            rows.push(measure(pairs, SOLID.min(pairs / 2))?);
        }
    }
    let results = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("bench-results");
    std::fs::create_dir_all(&results)?;
    let text = serde_json::to_string_pretty(&json!({
        "cholmod_version": cholmod_version(),
        "blas": blas_name(),
        "rows": rows,
    }))?;
    std::fs::write(results.join("contact.json"), text + "\n")?;
    Ok(())
}

fn model(pairs: usize, rows: usize) -> Result<Model, Failure> {
    let n = pairs - 1;
    let scene = Scene::load_with(
        Path::new(SCENE),
        &[
            format!("mesh.parts.0.block.x=[0.0,{n}.0]"),
            format!("mesh.parts.0.block.y=[0.0,{rows}.0]"),
            format!("mesh.parts.0.block.elements=[{n},{rows}]"),
            format!("mesh.parts.1.block.x=[0.0,{n}.0]"),
            format!("mesh.parts.1.block.y=[{rows}.0,{}.0]", 2 * rows),
            format!("mesh.parts.1.block.elements=[{n},{rows}]"),
            "load.0.pressure=30.0".to_string(),
        ],
    )?;
    let mut model = Model::new(&scene)?;
    for pair in &mut model.pairs {
        let at = model.continuum.mesh.point(pair.slave)[0] / n as f64;
        pair.gap = LARGEST_GAP * at * at;
    }
    Ok(model)
}

fn measure(pairs: usize, rows: usize) -> Result<Value, Failure> {
    let model = model(pairs, rows)?;
    let system = brinell::assembly::assemble(&model, Backend::Cholmod)?;
    let n = system.stiffness.n();
    let sub = Substructure::new(&model, &system, Default::default(), Backend::Cholmod)?;
    let partition: Partition = sub.partition.clone();
    drop(sub);
    // The matrix that is factored: contact freedoms of the floating block are held by their own
    // stiffness.
    let mut held = system.stiffness.whole().ok_or("elsewhere")?.clone();
    for &freedom in &partition.contact {
        if let Some(value) = held.get_mut(freedom, freedom) {
            *value *= 2.0;
        }
    }
    let bare = solve_unconstrained(&held, &vec![1.0; n])?;
    let bare_seconds = bare.analyse_seconds + bare.factor_seconds;

    let start = Instant::now();
    let condensed = cholmod::condense(&held, &partition, &[])?;
    let all = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let _ = condensed.contact_stiffness();
    let extraction = start.elapsed().as_secs_f64();
    drop(condensed);
    let by_solves = bare.solve_seconds * partition.contact.len() as f64;

    let mut analysis = Analysis::new(model, Backend::Cholmod)?;
    let results = analysis.run(&mut Silent)?;
    let seconds: f64 = results
        .timings
        .iter()
        .filter(|(phase, _)| phase == "elastic increments")
        .map(|(_, seconds)| seconds)
        .sum();
    let events = results.history.len();
    let event = seconds / events as f64;
    let peak = peak_memory()?;
    println!(
        "{pairs:5} {rows:5} {n:9} {bare_seconds:14.3} {all:12.3} {extraction:10.3} \
         {by_solves:12.1} {seconds:10.3} {events:7} {:9.3} {:18.2} {:8.2}",
        1e3 * event,
        1e3 * event / bare_seconds,
        peak / 1e9,
    );
    Ok(json!({
        "pairs": pairs,
        "rows": rows,
        "freedoms": n,
        "contact_freedoms": partition.contact.len(),
        "bare": {"analyse": bare.analyse_seconds, "factor": bare.factor_seconds,
        "solve": bare.solve_seconds,
                 "flops": bare.prediction.flops,
                 "factor_nonzeros": bare.prediction.factor_nonzeros},
        "condensed": all,
        "contact_stiffness": extraction,
        "by_solves": by_solves,
        "elastic_increments": seconds,
        "increments": events,
        "peak_bytes_so_far": peak,
        "contact_changes": results.counts.contact_changes,
        "equilibrium": results.quality.equilibrium,
    }))
}
