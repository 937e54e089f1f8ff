//! brinell beside CalculiX on the same mesh and the same problem: line contact of a cylinder,
//! loaded to twice the yield load and let go.
//!
//! `make bench-peers` (which installs CalculiX where it is absent) or `cargo bench --bench peers`.
//! Both programs run in this one run, each in a process of its own with one thread; what is
//! compared is processor seconds, medians, and errors:
//!
//! - of the largest pressure at 0.8 of the yield load, where all is elastic, against Hertz;
//! - of the largest pressure at twice the yield load and of the residual dent, against brinell's
//!   values extrapolated from its two finest meshes, finer than any mesh compared.
//!
//! The table and the plot go to `bench-results/peers.md`, `.svg`, `.json`. `-- quick` runs
//! CalculiX's long ones once; `-- decks DIR` only writes its decks; `-- solid` takes the ball of
//! `data/peers/ball_contact.toml` in three dimensions, loaded to five times first yield and back,
//! and one elastic load (`solid.rs`; `-- quadratic` in elements of 20 nodes, `-- tamaas`
//! beside Tamaas, which it installs from PyPI into `target`); `-- hard DIR` runs three small cases
//! on which contact codes fail silently (`data/peers/README.md`); `-- unlike` compares pressures
//! where the meshes of the two bodies do not match (`unlike.rs`).

mod deck;
mod dent;
mod frd;
mod hard;
mod plot;
#[path = "../process/mod.rs"]
mod process;
mod solid;
#[path = "../../tests/support/mod.rs"]
mod support;
mod unlike;

use brinell::analytical::{HertzLine, contact_modulus};
use brinell::model::Model;
use brinell::scene::Scene;
use deck::Settings;
use frd::Frd;
use process::{Failure, TICK, children_seconds};
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/data/peers/line_contact.toml");
/// Elements over the contact half width at first yield.
const SIZES: [usize; 4] = [4, 8, 16, 32];
/// brinell's own meshes from which the reference is extrapolated.
const FINEST: [usize; 2] = [64, 96];
/// Runs of which the median counts; of those longer than `LONG` seconds.
const REPEATED: usize = 5;
const REPEATED_LONG: usize = 3;
const LONG: f64 = 10.0;
/// Ticks of the clock that are wanted in a measurement.
const TICKS: f64 = 50.0;

/// What a run says, and what it took.
#[derive(Debug, Clone, Copy)]
struct Outcome {
    seconds: f64,
    elastic: f64,
    twice: f64,
    dent: f64,
    iterations: usize,
}

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| a != "--bench")
        .collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["decks", dir] => {
            std::fs::create_dir_all(dir)?;
            for size in SIZES {
                std::fs::write(
                    Path::new(dir).join(format!("line_{size}.inp")),
                    line_deck(size)?,
                )?;
            }
            Ok(())
        }
        ["hard", dir] => hard::run(Path::new(dir)),
        ["quick"] => compare(true),
        ["solid"] => solid::compare(false),
        ["quadratic"] => solid::compare(true),
        ["tamaas"] => solid::spectral(),
        ["unlike"] => unlike::compare(),
        _ => compare(false),
    }
}

fn model(size: usize) -> Result<Model, Failure> {
    let overrides = [format!("mesh.cylinder_on_half_plane.resolution={size}")];
    Ok(Model::new(&Scene::load_with(SCENE, &overrides)?)?)
}

fn line_deck(size: usize) -> Result<String, Failure> {
    let model = model(size)?;
    let material = &model.scene.materials["steel"];
    let hertz = hertz()?;
    let element = hertz.half_width / size as f64;
    let settings = Settings {
        penalty: 1000.0 * material.youngs_modulus,
        overlap: (1.5 * element).powi(2) / (2.0 * hertz.radius),
        increments: 5,
        kind: "SURFACE TO SURFACE",
        solver: "",
    };
    Ok(deck::deck(&model, &settings, &[2.0, 0.0])?)
}

/// Closed forms of the scene.
struct Hertz {
    radius: f64,
    half_width: f64,
    pressure_elastic: f64,
}

fn hertz() -> Result<Hertz, Failure> {
    let scene = Scene::load(SCENE)?;
    let mesh = scene
        .mesh
        .cylinder_on_half_plane
        .as_ref()
        .ok_or("another mesh")?;
    let steel = &scene.materials["steel"];
    let (e, nu) = (steel.youngs_modulus, steel.poissons_ratio);
    let line = HertzLine::new(mesh.radius, contact_modulus(e, nu, e, nu))?;
    let force = scene.load[0].plane_force.ok_or("another load")?.total.abs();
    Ok(Hertz {
        radius: mesh.radius,
        half_width: line.yield_half_width(nu, steel.yield_stress.ok_or("no yield stress")?),
        pressure_elastic: line.max_pressure(0.8 * force),
    })
}

/// Processor seconds of a command: the median of several measurements, each over as many runs as
/// the clock needs.
fn measure(quick: bool, mut command: impl FnMut() -> Command) -> Result<f64, Failure> {
    let mut run = || -> Result<f64, Failure> {
        let before = children_seconds()?;
        let status = command()
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status()?;
        if !status.success() {
            return Err(format!("ended with {status}").into());
        }
        Ok(children_seconds()? - before)
    };
    let first = run()?;
    if first > LONG && quick {
        return Ok(first);
    }
    let repeated = if first > LONG {
        REPEATED_LONG
    } else {
        REPEATED
    };
    let batch = (TICKS * TICK / first.max(TICK)).ceil().max(1.0) as usize;
    let mut seconds = Vec::new();
    for _ in 0..repeated {
        let sum: f64 = (0..batch).map(|_| run()).sum::<Result<f64, _>>()?;
        seconds.push(sum / batch as f64);
    }
    seconds.sort_by(f64::total_cmp);
    Ok(seconds[repeated / 2])
}

/// brinell from the scene file to the written results.
fn brinell(size: usize, dir: &Path, measured: bool) -> Result<Outcome, Failure> {
    let out = dir.join(format!("brinell_{size}"));
    let command = || {
        let mut command = Command::new(env!("CARGO_BIN_EXE_brinell"));
        command.args([
            "run",
            SCENE,
            "--threads",
            "1",
            "--no-estimate",
            "--no-report",
            "-q",
            "--out",
        ]);
        command.arg(&out).arg("--set");
        command.arg(format!("mesh.cylinder_on_half_plane.resolution={size}"));
        command
            .env("OMP_NUM_THREADS", "1")
            .env("OPENBLAS_NUM_THREADS", "1");
        command
    };
    let seconds = match measured {
        true => measure(false, command)?,
        false => {
            command().stdout(Stdio::null()).status()?;
            f64::NAN
        }
    };
    let summary: Value = serde_json::from_str(&std::fs::read_to_string(out.join("summary.json"))?)?;
    let state = |name: &str, key: &str| -> Result<f64, Failure> {
        let states = summary["states"].as_array().ok_or("no states")?;
        let state = states
            .iter()
            .find(|s| s["name"] == name)
            .ok_or("no such state")?;
        Ok(state[key].as_f64().ok_or("no such figure")?)
    };
    Ok(Outcome {
        seconds,
        elastic: state("elastic", "max_pressure")?,
        twice: state("twice", "max_pressure")?,
        dent: dent::of_results(&out, &model(size)?)?,
        iterations: summary["counts"]["plastic_iterations"]
            .as_u64()
            .unwrap_or(0) as usize,
    })
}

/// CalculiX on the deck of the same mesh.
fn calculix(size: usize, dir: &Path, quick: bool) -> Result<Outcome, Failure> {
    let name = format!("line_{size}");
    std::fs::write(dir.join(format!("{name}.inp")), line_deck(size)?)?;
    let seconds = measure(quick, || {
        let mut command = Command::new("ccx");
        command.args(["-i", &name]).current_dir(dir);
        command
            .env("OMP_NUM_THREADS", "1")
            .env("OPENBLAS_NUM_THREADS", "1");
        command
    })?;
    let frd = Frd::parse(&std::fs::read_to_string(dir.join(format!("{name}.frd")))?);
    let largest = |time: f64| -> Result<f64, Failure> {
        let increment = frd
            .at(time)
            .ok_or_else(|| format!("{name}: no increment at {time}"))?;
        Ok(frd
            .pressures(increment)
            .iter()
            .map(|p| p[1])
            .fold(0.0, f64::max))
    };
    let iterations = std::fs::read_to_string(dir.join(format!("{name}.cvg")))?;
    let iterations = iterations
        .lines()
        .filter(|l| {
            l.split_whitespace()
                .next()
                .is_some_and(|w| w.parse::<u32>().is_ok())
        })
        .count();
    Ok(Outcome {
        seconds,
        elastic: largest(0.4)?,
        twice: largest(1.0)?,
        dent: dent_of(&frd, size)?,
        iterations,
    })
}

/// The dent of CalculiX's results.
fn dent_of(frd: &Frd, size: usize) -> Result<f64, Failure> {
    let unloaded = frd.at(2.0).ok_or("the unloading was not finished")?;
    let model = model(size)?;
    // The numbers of the output are not those of the deck: nodes are found by their place.
    let at = |node: usize, overlap: f64| -> Result<f64, Failure> {
        let [x, y] = model.mesh.in_plane(node);
        let near = frd.points.iter().find(|(_, p)| {
            (p[0] - x).abs() < 1e-4 * x.abs().max(1e-3) && (p[1] - (y - overlap)).abs() < 1e-7
        });
        let (number, _) = near.ok_or("a node is missing")?;
        Ok(unloaded.displacement.get(number).ok_or("no displacement")?[1])
    };
    let hertz = hertz()?;
    let overlap = (1.5 * hertz.half_width / size as f64).powi(2) / (2.0 * hertz.radius);
    let opened: Vec<(f64, f64)> = model
        .pairs
        .iter()
        .map(|pair| {
            Ok((
                pair.gap,
                at(pair.masters[0].0, overlap)? - at(pair.slave, 0.0)?,
            ))
        })
        .collect::<Result<_, Failure>>()?;
    Ok(dent::beside_outermost(&opened))
}

/// A quantity from two meshes whose errors go with the square of the element size.
fn extrapolated(coarse: f64, fine: f64) -> f64 {
    let ratio = (FINEST[1] as f64 / FINEST[0] as f64).powi(2);
    fine + (fine - coarse) / (ratio - 1.0)
}

fn compare(quick: bool) -> Result<(), Failure> {
    if Command::new("ccx")
        .arg("-v")
        .stdout(Stdio::null())
        .status()
        .is_err()
    {
        println!("skipped: ccx is not installed; `make bench-peers` installs it");
        return Ok(());
    }
    let folder = tempfile::tempdir()?;
    let dir = folder.path();
    let [coarse, fine] = [
        brinell(FINEST[0], dir, false)?,
        brinell(FINEST[1], dir, false)?,
    ];
    let reference = Outcome {
        elastic: hertz()?.pressure_elastic,
        twice: extrapolated(coarse.twice, fine.twice),
        dent: extrapolated(coarse.dent, fine.dent),
        ..fine
    };
    let error = |value: f64, exact: f64| (value / exact - 1.0).abs();
    let mut table = String::from(
        "| elements over b* | program | processor seconds | iterations | pressure at 0.8 P* | \
         pressure at 2 P* | dent |\n|---|---|---|---|---|---|---|\n",
    );
    let mut rows = Vec::new();
    for size in SIZES {
        let [ours, theirs] = [brinell(size, dir, true)?, calculix(size, dir, quick)?];
        for (program, o) in [("brinell", ours), ("CalculiX", theirs)] {
            let [elastic, twice, dent] = [
                error(o.elastic, reference.elastic),
                error(o.twice, reference.twice),
                error(o.dent, reference.dent),
            ];
            writeln!(
                table,
                "| {size} | {program} | {:.3} | {} | {:.2} % | {:.2} % | {:.2} % |",
                o.seconds,
                o.iterations,
                100.0 * elastic,
                100.0 * twice,
                100.0 * dent
            )?;
            rows.push(json!({
                "elements_over_half_width": size, "program": program,
                "processor_seconds": o.seconds, "iterations": o.iterations,
                "pressure_elastic": o.elastic, "pressure_twice": o.twice, "dent": o.dent,
                "error_elastic": elastic, "error_twice": twice, "error_dent": dent,
            }));
        }
        writeln!(
            table,
            "| {size} | ratio | {:.0} | | | | |",
            theirs.seconds / ours.seconds
        )?;
    }
    println!("{table}");
    let results = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("bench-results");
    std::fs::create_dir_all(&results)?;
    std::fs::write(results.join("peers.md"), &table)?;
    let document = json!({
        "reference": { "pressure_elastic": reference.elastic, "pressure_twice": reference.twice,
            "dent": reference.dent,
            "extrapolated_from": FINEST },
        "runs": rows,
    });
    std::fs::write(
        results.join("peers.json"),
        serde_json::to_string_pretty(&document)? + "\n",
    )?;
    std::fs::write(results.join("peers.svg"), plot::work_precision(&rows)?)?;
    Ok(())
}
