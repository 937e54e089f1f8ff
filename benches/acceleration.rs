//! The plastic iterations on equal terms: the paper's plain one, Anderson's acceleration of it, and
//! Newton's method with the tangent solved by conjugate gradients on the factored stiffness.
//!
//! Both applications of the paper up to twice (the disc) or 1.6 times (the cylinder) the yield
//! load, in increments given in advance so that all do the same. What counts is solves with the
//! trailing factor: material evaluations are few beside them. Each case runs to a tolerance of 1e-3
//! and of 1e-11: the difference is what eight decades of the residual cost.
//! `cargo bench --bench acceleration` prints the table and writes
//! `bench-results/acceleration.json`.

mod process;

use brinell::analysis::Analysis;
use brinell::linalg::Backend;
use brinell::model::Model;
use brinell::progress::Silent;
use brinell::scene::Scene;
use process::Failure;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Name, scene, and what is changed in it.
const CASES: [(&str, &str, &[&str]); 3] = [
    (
        "cylinder, H/E = 0.6, alpha 1.6",
        "cylinder_on_half_plane",
        &[],
    ),
    (
        "cylinder, H/E = 0.05, alpha 1.6",
        "cylinder_on_half_plane",
        &["materials.steel.plastic_modulus=10500.0"],
    ),
    ("disc, perfectly plastic, alpha 2", "disc_in_plate", &[]),
];
/// Increments from one target to the next.
const STEPS: usize = 4;
const TOLERANCES: [f64; 2] = [1e-3, 1e-11];

fn main() -> Result<(), Failure> {
    rayon::ThreadPoolBuilder::new()
        .use_current_thread()
        .build_global()?;
    println!(
        "case                              iteration  solves/increment (median, most)  per decade  \
         iterations  seconds"
    );
    let mut rows = Vec::new();
    for (case, scene, changes) in CASES {
        for algorithm in ["newton", "anderson", "plain"] {
            rows.push(measure(case, scene, changes, algorithm)?);
        }
    }
    let results = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("bench-results");
    std::fs::create_dir_all(&results)?;
    let text = serde_json::to_string_pretty(&json!(rows))?;
    std::fs::write(results.join("acceleration.json"), text + "\n")?;
    Ok(())
}

/// What one run took: trailing solves of each increment in which the material flows.
struct Run {
    solves: Vec<usize>,
    iterations: usize,
    seconds: f64,
}

fn run(scene: &str, changes: &[String], tolerance: f64) -> Result<Run, brinell::Error> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("data/scenes")
        .join(format!("{scene}.toml"));
    let mut changes = changes.to_vec();
    changes.push(format!("analysis.tolerance={tolerance:e}"));
    let mut scene = Scene::load_with(&path, &changes)?;
    // Up to the largest load, in steps of the same size.
    let targets = &mut scene.program.targets;
    let factor = |t: &brinell::scene::Target| t.load_factor.unwrap_or(0.0);
    let most = (0..targets.len())
        .max_by(|&a, &b| factor(&targets[a]).total_cmp(&factor(&targets[b])))
        .unwrap_or(0);
    targets.truncate(most + 1);
    let mut analysis = Analysis::new(Model::new(&scene)?, Backend::Cholmod)?;
    let results = analysis.run(&mut Silent)?;
    let phases = results.timings.iter();
    let seconds = phases
        .filter(|(phase, _)| phase == "elastoplastic increments")
        .map(|(_, seconds)| seconds)
        .sum();
    let flowing = results.history.iter().filter(|i| i.iterations > 1);
    Ok(Run {
        solves: flowing.map(|i| i.trailing_solves).collect(),
        iterations: results.counts.plastic_iterations,
        seconds,
    })
}

fn measure(case: &str, scene: &str, changes: &[&str], algorithm: &str) -> Result<Value, Failure> {
    let mut changes: Vec<String> = changes.iter().map(|c| c.to_string()).collect();
    changes.push("program.stepping=steps".to_string());
    changes.push(format!("program.steps={STEPS}"));
    changes.push(format!("analysis.plastic_iteration={algorithm}"));
    let mut runs = Vec::new();
    for tolerance in TOLERANCES {
        match run(scene, &changes, tolerance) {
            Ok(run) => runs.push(run),
            Err(failure) if failure.kind() == brinell::ErrorKind::Analysis => {
                println!("{case:33} {algorithm:9}  not at {tolerance:e}: {failure}");
                return Ok(
                    json!({"case": case, "iteration": algorithm, "failure": failure.to_string()}),
                );
            }
            Err(failure) => return Err(failure.into()),
        }
    }
    let (coarse, fine) = (&runs[0], &runs[1]);
    let sum = |run: &Run| run.solves.iter().sum::<usize>() as f64;
    let decades = (TOLERANCES[0] / TOLERANCES[1]).log10();
    // Both run through the same increments, but where a residual of 1e-3 is met at once an
    // increment does not count as flowing.
    let per_decade = (sum(fine) - sum(coarse)) / fine.solves.len() as f64 / decades;
    let mut sorted = fine.solves.clone();
    sorted.sort_unstable();
    let (median, most) = (sorted[sorted.len() / 2], sorted[sorted.len() - 1]);
    println!(
        "{case:33} {algorithm:9} {median:8} {most:8} {per_decade:28.1} {:11} {:8.2}",
        fine.iterations, fine.seconds
    );
    Ok(json!({
        "case": case,
        "iteration": algorithm,
        "increments": fine.solves.len(),
        "solves_median": median,
        "solves_most": most,
        "solves_per_decade": per_decade,
        "solves": sum(fine),
        "plastic_iterations": fine.iterations,
        "seconds": fine.seconds,
    }))
}
