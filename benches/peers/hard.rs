//! Three small cases on which contact codes fail silently, as both programs see them.

use crate::Failure;
use crate::deck::{self, Settings};
use crate::frd::Frd;
use brinell::analysis::Analysis;
use brinell::linalg::Backend;
use brinell::model::Model;
use brinell::progress::Silent;
use brinell::scene::Scene;
use std::path::Path;
use std::process::{Command, Stdio};

/// A case: name of the scene in `data/peers`, and what CalculiX is told.
struct Case {
    name: &'static str,
    kind: &'static str,
    /// Load factors of the steps.
    legs: &'static [f64],
    /// Overlap at the beginning.
    overlap: f64,
}

const CASES: [Case; 3] = [
    Case {
        name: "single_node",
        kind: "SURFACE TO SURFACE",
        legs: &[2.0, 0.0],
        overlap: 0.0,
    },
    // Node to surface it gives up at once. One and a half elements (0.2 / 8) wide: (1.5 h)^2 / 2 R.
    Case {
        name: "axis_node",
        kind: "SURFACE TO SURFACE",
        legs: &[1.0],
        overlap: 7e-5,
    },
    Case {
        name: "conforming_disc",
        kind: "SURFACE TO SURFACE",
        legs: &[1.0],
        overlap: 0.0,
    },
];

/// Writes the decks to a folder, runs both programs and prints what came out.
pub fn run(dir: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(dir)?;
    println!(
        "| case | program | largest pressure | at the pole and the next two pairs | remarks \
         |\n|---|---|---|---|---|"
    );
    for Case {
        name,
        kind,
        legs,
        overlap,
    } in CASES
    {
        let scene = format!("{}/data/peers/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let model = Model::new(&Scene::load(&scene)?)?;
        let stiffness = model.scene.materials["steel"].youngs_modulus;
        let settings = Settings {
            penalty: 1000.0 * stiffness,
            overlap,
            increments: 5,
            kind,
            solver: "",
        };
        std::fs::write(
            dir.join(format!("{name}.inp")),
            deck::deck(&model, &settings, legs)?,
        )?;
        let results = Analysis::new(model, Backend::default())?.run(&mut Silent)?;
        let top = results
            .states
            .iter()
            .max_by(|a, b| a.max_pressure.total_cmp(&b.max_pressure));
        let mut pressures: Vec<f64> = top
            .ok_or("no state")?
            .pairs
            .iter()
            .map(|p| p.pressure)
            .collect();
        pressures.sort_by(|a, b| b.total_cmp(a));
        let done = format!("{} increments, done", results.history.len());
        row(name, "brinell", &pressures, &done);
        theirs(dir, name, legs.len())?;
    }
    Ok(())
}

fn row(case: &str, program: &str, pressures: &[f64], remarks: &str) {
    let say = |pressure: Option<f64>| pressure.map_or("-".to_string(), |p| format!("{p:.1}"));
    let [a, b, c] = [0, 1, 2].map(|k| say(pressures.get(k).copied()));
    let largest = say(pressures.iter().copied().reduce(f64::max));
    println!("| {case} | {program} | {largest} | {a}, {b}, {c} | {remarks} |");
}

/// CalculiX on the deck: the pressures at the end of the first step, and how it went.
fn theirs(dir: &Path, name: &str, steps: usize) -> Result<(), Failure> {
    let output = Command::new("ccx")
        .args(["-i", name])
        .current_dir(dir)
        .env("OMP_NUM_THREADS", "1")
        .stdin(Stdio::null())
        .output();
    let Ok(output) = output else {
        row(name, "CalculiX", &[], "not installed");
        return Ok(());
    };
    let log = String::from_utf8_lossy(&output.stdout).into_owned();
    let frd =
        std::fs::read_to_string(dir.join(format!("{name}.frd"))).map(|text| Frd::parse(&text));
    let frd = frd.unwrap_or_default();
    let increment = frd
        .at(1.0)
        .or(frd.increments.last())
        .cloned()
        .unwrap_or_default();
    let pressures: Vec<f64> = frd.pressures(&increment).iter().map(|p| p[1]).collect();
    let reached = frd.increments.last().map_or(0.0, |i| i.time);
    let remarks = format!(
        "{} at total time {reached:.3} of {steps}, {} increments, {} divergences, {} warnings in \
         the log",
        if log.contains("Job finished") {
            "finished"
        } else {
            "gave up"
        },
        frd.increments.len(),
        log.matches("divergence").count(),
        log.matches("*WARNING").count(),
    );
    row(name, "CalculiX", &pressures, &remarks);
    Ok(())
}
