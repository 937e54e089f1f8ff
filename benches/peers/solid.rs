//! A ball in three dimensions beside CalculiX on the same mesh: C3D8 with its iterative Cholesky
//! solver and with SPOOLES, which Debian's takes where a deck names none; C3D20R. And beside
//! Tamaas, boundary elements by Fourier transforms, on grids of its own.
//!
//! Errors are those of the largest pressure at 0.8 of the yield load against Hertz, and at five
//! times the yield load and of the dent against brinell's values extrapolated from its two finest
//! meshes.

use super::deck::{self, Settings};
use super::dent;
use super::frd::Frd;
use super::process::{Failure, children_seconds};
use brinell::analytical::{HertzPoint, contact_modulus};
use brinell::model::Model;
use brinell::scene::Scene;
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/data/peers/ball_contact.toml");
/// Elements over the contact radius at first yield, their shape, and CalculiX's solvers.
const CASES: [(usize, &str, &[&str]); 2] = [
    (4, "hex8", &["ITERATIVE CHOLESKY", "SPOOLES"]),
    (6, "hex8", &["ITERATIVE CHOLESKY"]),
];
const QUADRATIC: [(usize, &str, &[&str]); 1] = [(4, "hex20", &["ITERATIVE CHOLESKY"])];
/// brinell's own meshes from which the reference is extrapolated.
const FINEST: [usize; 2] = [6, 9];
/// Load factors of the program, in the order of its states.
const LEGS: [f64; 3] = [0.8, 5.0, 0.0];

/// Largest pressures at the two loads, the dent, processor seconds.
#[derive(Debug, Clone, Copy)]
struct Outcome {
    elastic: f64,
    five: f64,
    dent: f64,
    seconds: f64,
}

/// Processor seconds of a command with one thread.
fn timed(command: &mut Command) -> Result<f64, Failure> {
    let before = children_seconds()?;
    let status = command
        .env("OMP_NUM_THREADS", "1")
        .env("OPENBLAS_NUM_THREADS", "1")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()?;
    if !status.success() {
        return Err(format!("ended with {status}").into());
    }
    Ok(children_seconds()? - before)
}

fn overrides((size, shape): (usize, &str)) -> Vec<String> {
    vec![
        format!("mesh.curved_bodies.resolution={size}"),
        format!("mesh.curved_bodies.element=\"{shape}\""),
    ]
}

fn brinell(case: (usize, &str), dir: &Path, elastic_only: bool) -> Result<Outcome, Failure> {
    let out = dir.join(format!("brinell_{}_{}", case.0, case.1));
    let mut command = Command::new(env!("CARGO_BIN_EXE_brinell"));
    command.args([
        "run",
        SCENE,
        "--threads",
        "1",
        "--no-estimate",
        "--no-report",
        "-q",
    ]);
    command.arg("--out").arg(&out);
    for change in overrides(case) {
        command.arg("--set").arg(change);
    }
    if elastic_only {
        let target = "program.targets=[{ name = \"elastic\", load_factor = 0.8, fields = false }]";
        command.arg("--set").arg(target);
    }
    let seconds = timed(&mut command)?;
    let summary: Value = serde_json::from_str(&std::fs::read_to_string(out.join("summary.json"))?)?;
    let dent = match elastic_only {
        true => f64::NAN,
        false => dent::of_results(
            &out,
            &Model::new(&Scene::load_with(SCENE, &overrides(case))?)?,
        )?,
    };
    std::fs::remove_dir_all(&out)?;
    let state = |name: &str, key: &str| -> f64 {
        let states = summary["states"].as_array().into_iter().flatten();
        let mut named = states.filter(|s| s["name"] == name);
        named
            .next()
            .and_then(|s| s[key].as_f64())
            .unwrap_or(f64::NAN)
    };
    Ok(Outcome {
        elastic: state("elastic", "max_pressure"),
        five: state("five", "max_pressure"),
        dent,
        seconds,
    })
}

fn calculix(
    case: (usize, &str),
    solver: &'static str,
    dir: &Path,
    elastic_only: bool,
) -> Result<Outcome, Failure> {
    let mut scene = Scene::load_with(SCENE, &overrides(case))?;
    if elastic_only {
        scene.materials.values_mut().for_each(|m| {
            m.yield_stress = None;
            m.plastic_modulus = None;
        });
        scene
            .mesh
            .curved_bodies
            .as_mut()
            .ok_or("another mesh")?
            .semi_axes = {
            let r = hertz()?.yield_contact_radius(0.3, 500.0);
            Some([r, r])
        };
    }
    let model = Model::new(&scene)?;
    let radius = hertz()?.yield_contact_radius(0.3, 500.0);
    let overlap = (1.5 * radius / case.0 as f64).powi(2) / (2.0 * 10.0);
    let settings = Settings {
        penalty: 1000.0 * 210e3,
        overlap,
        increments: 5,
        kind: "SURFACE TO SURFACE",
        solver,
    };
    let legs = if elastic_only { &LEGS[..1] } else { &LEGS[..] };
    let name = format!("ball_{}_{}", case.0, case.1);
    let text = deck::deck(&model, &settings, legs)?;
    std::fs::write(dir.join(format!("{name}.inp")), text)?;
    let seconds = timed(Command::new("ccx").args(["-i", &name]).current_dir(dir))?;
    let frd = Frd::parse(&std::fs::read_to_string(dir.join(format!("{name}.frd")))?);
    let largest = |time: f64| {
        let pressures = frd.at(time).map(|i| i.pressure.values().copied());
        pressures.map_or(f64::NAN, |p| p.fold(0.0, f64::max))
    };
    let dent = frd.at(3.0).map_or(f64::NAN, |unloaded| {
        let z = |node: usize| {
            unloaded
                .displacement
                .get(&(node as u64 + 1))
                .map_or(f64::NAN, |u| u[2])
        };
        let pairs = model.pairs.iter();
        let opened: Vec<(f64, f64)> = pairs
            .map(|p| (p.gap, z(p.masters[0].0) - z(p.slave)))
            .collect();
        dent::beside_outermost(&opened)
    });
    Ok(Outcome {
        elastic: largest(1.0),
        five: largest(2.0),
        dent,
        seconds,
    })
}

fn hertz() -> Result<HertzPoint, Failure> {
    let modulus = contact_modulus(210e3, 0.3, 210e3, 0.3);
    Ok(HertzPoint::new(10.0, modulus)?)
}

/// A quantity from two meshes whose errors go with the square of the element size.
fn extrapolated(coarse: f64, fine: f64) -> f64 {
    let ratio = (FINEST[1] as f64 / FINEST[0] as f64).powi(2);
    fine + (fine - coarse) / (ratio - 1.0)
}

/// brinell's values, extrapolated; Hertz's where nothing flows.
fn reference(dir: &Path) -> Result<Outcome, Failure> {
    let [coarse, fine] = [
        brinell((FINEST[0], "hex8"), dir, false)?,
        brinell((FINEST[1], "hex8"), dir, false)?,
    ];
    Ok(Outcome {
        elastic: hertz()?.max_pressure(0.8 * hertz()?.yield_load(0.3, 500.0)),
        five: extrapolated(coarse.five, fine.five),
        dent: extrapolated(coarse.dent, fine.dent),
        seconds: 0.0,
    })
}

fn percent(value: f64, exact: f64) -> f64 {
    100.0 * (value / exact - 1.0).abs()
}

/// The table goes to the terminal and to `bench-results/peers_solid.md` and `.json`.
pub fn compare(quadratic: bool) -> Result<(), Failure> {
    let folder = tempfile::tempdir()?;
    let dir = folder.path();
    let exact = reference(dir)?;
    let mut table = String::from(
        "| elements over a* | shape | program | history, s | elastic load, s | pressure at 0.8 P* \
         | at 5 P* | dent |\n|---|---|---|---|---|---|---|---|\n",
    );
    let mut rows = Vec::new();
    let cases: &[_] = if quadratic { &QUADRATIC } else { &CASES };
    for (size, shape, solvers) in cases {
        let case = (*size, *shape);
        let mut ours = None;
        for program in std::iter::once("brinell").chain(solvers.iter().copied()) {
            let run = |elastic_only| match program {
                "brinell" => brinell(case, dir, elastic_only),
                solver => calculix(case, solver, dir, elastic_only),
            };
            let (history, elastic) = (run(false)?, run(true)?);
            let [a, b, c] = [
                percent(history.elastic, exact.elastic),
                percent(history.five, exact.five),
                percent(history.dent, exact.dent),
            ];
            let seconds = [history.seconds, elastic.seconds];
            let times = |k: usize| match ours {
                Some(ours) => {
                    let ours: [f64; 2] = ours;
                    format!("{:.2} ({:.0} times)", seconds[k], seconds[k] / ours[k])
                }
                None => format!("{:.2}", seconds[k]),
            };
            let name = match program {
                "brinell" => program.to_string(),
                solver => format!("CalculiX, {}", solver.to_lowercase()),
            };
            let row = format!(
                "| {size} | {shape} | {name} | {} | {} | {a:.2} % | {b:.2} % | {c:.2} % |",
                times(0),
                times(1)
            );
            println!("{row}");
            writeln!(table, "{row}")?;
            rows.push(json!({
                "elements": size, "shape": shape, "program": name,
                "history_seconds": seconds[0], "elastic_seconds": seconds[1],
                "errors_percent": [a, b, c],
            }));
            ours = ours.or(Some(seconds));
        }
    }
    let name = if quadratic {
        "peers_quadratic"
    } else {
        "peers_solid"
    };
    keep(name, &table, &rows)
}

/// Cells over the surface of Tamaas' elastic half spaces; cells, layers and steps where it flows.
const ELASTIC: [usize; 3] = [32, 64, 128];
const PLASTIC: [[usize; 3]; 2] = [[32, 16, 4], [48, 24, 4]];

/// The same loads by Tamaas, in an environment of Python that is made for it in `target/tamaas`.
pub fn spectral() -> Result<(), Failure> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let environment = root.join("target/tamaas");
    let python = environment.join("bin/python");
    if !python.exists() {
        let mut made = Command::new("python3");
        made.args(["-m", "venv"]).arg(&environment);
        let installed = [
            "-m",
            "pip",
            "install",
            "-q",
            "tamaas==2.9.0",
            "numpy",
            "scipy",
        ];
        if !made.status()?.success() || !Command::new(&python).args(installed).status()?.success() {
            return Err("Tamaas could not be installed from PyPI".into());
        }
    }
    let folder = tempfile::tempdir()?;
    let exact = reference(folder.path())?;
    let load = hertz()?.yield_load(0.3, 500.0);
    let mut rows = Vec::new();
    for cells in ELASTIC {
        let arguments = format!("elastic {} {cells}", 0.8 * load);
        rows.push((
            format!("Tamaas, elastic, {cells} x {cells}"),
            arguments,
            exact.elastic,
        ));
    }
    for [cells, layers, steps] in PLASTIC {
        let name = format!("Tamaas, 5 P*, {cells} x {cells} x {layers}, {steps} steps");
        let arguments = format!("plastic {} {cells} {layers} {steps}", 5.0 * load);
        rows.push((name, arguments, exact.five));
    }
    let mut table = String::from("| program | seconds | pressure |\n|---|---|---|\n");
    let mut kept = Vec::new();
    let mut add = |name: &str, seconds: f64, error: f64| -> Result<(), Failure> {
        let row = format!("| {name} | {seconds:.2} | {error:.2} % |");
        println!("{row}");
        writeln!(table, "{row}")?;
        kept.push(json!({ "program": name, "seconds": seconds, "error_percent": error }));
        Ok(())
    };
    for (size, shape, _) in CASES {
        let elastic = brinell((size, shape), folder.path(), true)?;
        let error = percent(elastic.elastic, exact.elastic);
        add(
            &format!("brinell, elastic, {size} elements over a*"),
            elastic.seconds,
            error,
        )?;
    }
    for (name, arguments, exact) in rows {
        let script = root.join("benches/peers/spectral.py");
        let mut command = Command::new(&python);
        command
            .arg(script)
            .args(arguments.split(' '))
            .env("OMP_NUM_THREADS", "1");
        let printed: Value = serde_json::from_slice(&command.output()?.stdout)?;
        let [seconds, pressure] = ["seconds", "pressure"].map(|key| printed[key].as_f64());
        let pressure = pressure.ok_or("Tamaas gave no pressure")?;
        add(&name, seconds.unwrap_or(f64::NAN), percent(pressure, exact))?;
    }
    for (size, shape, _) in CASES {
        let history = brinell((size, shape), folder.path(), false)?;
        let name = format!("brinell, 0.8, 5 P* and off, {size} elements over a*");
        add(&name, history.seconds, percent(history.five, exact.five))?;
    }
    keep("peers_tamaas", &table, &kept)
}

/// Writes a table and its figures to `bench-results`.
fn keep(name: &str, table: &str, rows: &[Value]) -> Result<(), Failure> {
    println!("{table}");
    let results = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("bench-results");
    std::fs::create_dir_all(&results)?;
    std::fs::write(results.join(format!("{name}.md")), table)?;
    let text = serde_json::to_string_pretty(rows)? + "\n";
    Ok(std::fs::write(results.join(format!("{name}.json")), text)?)
}
