//! Line contact where the two bodies are meshed with elements of different size, elastic: the
//! largest pressure against Hertz's and the scatter of the pressures about his ellipse.

use super::deck::{self, Settings};
use super::frd::Frd;
use super::support::meshes::joined;
use super::{Failure, SCENE, hertz};
use brinell::analysis::Analysis;
use brinell::analytical::{HertzLine, contact_modulus};
use brinell::linalg::Backend;
use brinell::model::Model;
use brinell::progress::Silent;
use brinell::scene::Scene;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Elements over the half width at first yield: of the cylinder, and of the half plane.
const CASES: [[usize; 2]; 6] = [[8, 8], [8, 12], [12, 8], [4, 6], [6, 4], [8, 24]];
/// Load over the yield load.
const LOAD: f64 = 0.8;
/// Share of the half width over which pressures are compared: beyond it the ellipse is steep.
const INNER: f64 = 0.9;

/// A pressure and its distance from the centre of the contact.
type Pressures = Vec<[f64; 2]>;

/// The scene with slaves on the first body, which CalculiX is given as well, and its model.
fn model([first, second]: [usize; 2]) -> Result<Model, Failure> {
    let scene = |resolution: usize| {
        let overrides = [
            format!("mesh.cylinder_on_half_plane.resolution={resolution}"),
            "contact.0.slave=first".to_string(),
            format!("program.targets=[{{load_factor={LOAD}}}]"),
        ];
        Scene::load_with(SCENE, &overrides)
    };
    let meshes = [
        Model::new(&scene(first)?)?.continuum.mesh,
        Model::new(&scene(second)?)?.continuum.mesh,
    ];
    Ok(Model::from_mesh(
        &scene(first)?,
        joined(&meshes[0], &meshes[1]),
    )?)
}

fn ours(model: &Model) -> Result<Pressures, Failure> {
    let results = Analysis::new(model.clone(), Backend::default())?.run(&mut Silent)?;
    let state = results.states.first().ok_or("no state")?;
    let pairs = state.pairs.iter();
    Ok(pairs
        .map(|pair| [pair.position[0], pair.pressure])
        .collect())
}

fn theirs(model: &Model, cells: [usize; 2], dir: &Path) -> Result<Pressures, Failure> {
    let hertz = hertz()?;
    let element = hertz.half_width / cells[0].min(cells[1]) as f64;
    let settings = Settings {
        penalty: 1000.0 * model.scene.materials["steel"].youngs_modulus,
        overlap: (1.5 * element).powi(2) / (2.0 * hertz.radius),
        increments: 5,
        kind: "SURFACE TO SURFACE",
        solver: "",
    };
    let name = format!("unlike_{}_{}", cells[0], cells[1]);
    std::fs::write(
        dir.join(format!("{name}.inp")),
        deck::deck(model, &settings, &[LOAD])?,
    )?;
    let mut command = Command::new("ccx");
    command.args(["-i", &name]).current_dir(dir);
    let status = command
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()?;
    if !status.success() {
        return Err(format!("ccx ended with {status}").into());
    }
    let frd = Frd::parse(&std::fs::read_to_string(dir.join(format!("{name}.frd")))?);
    let increment = frd.at(1.0).ok_or("no result at the end of the step")?;
    // Nodes of the master surface are listed too, with no pressure.
    let slaves = model
        .mesh
        .set_nodes("cylinder.contact")
        .ok_or("no slaves")?;
    let of = |node: &usize| {
        let pressure = increment.pressure.get(&(*node as u64 + 1))?;
        Some([model.mesh.point(*node)[0], *pressure])
    };
    Ok(slaves.iter().filter_map(of).collect())
}

/// Largest pressure less Hertz's, and the root of the mean square deviation from his ellipse.
fn deviations(pressures: &Pressures) -> Result<[f64; 2], Failure> {
    let scene = Scene::load(SCENE)?;
    let force = LOAD * scene.load[0].plane_force.ok_or("another load")?.total.abs();
    let modulus = contact_modulus(210e3, 0.3, 210e3, 0.3);
    let line = HertzLine::new(hertz()?.radius, modulus)?;
    let (b, p0) = (line.half_width(force), line.max_pressure(force));
    let inner = pressures.iter().filter(|[x, _]| x.abs() <= INNER * b);
    let squares: Vec<f64> = inner
        .map(|[x, p]| (p / p0 - (1.0 - (x / b).powi(2)).sqrt()).powi(2))
        .collect();
    let rms = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
    let largest = pressures.iter().fold(0.0, |m: f64, p| m.max(p[1]));
    Ok([largest / p0 - 1.0, rms])
}

/// The table goes to the terminal and to `bench-results/peers_unlike.md`.
pub fn compare() -> Result<(), Failure> {
    let folder = tempfile::tempdir()?;
    let mut table = String::from(
        "| elements over b: cylinder, half plane | program | largest pressure | scatter |\n\
         |---|---|---|---|\n",
    );
    for cells in CASES {
        let model = model(cells)?;
        let of_calculix = theirs(&model, cells, folder.path());
        for (program, pressures) in [("brinell", ours(&model)), ("CalculiX", of_calculix)] {
            let row = match pressures.and_then(|p| deviations(&p)) {
                Ok([peak, scatter]) => {
                    format!("{:+.1} % | {:.1} %", 100.0 * peak, 100.0 * scatter)
                }
                Err(error) => format!("{error} | -"),
            };
            writeln!(table, "| {}, {} | {program} | {row} |", cells[0], cells[1])?;
        }
    }
    println!("{table}");
    let results = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("bench-results");
    std::fs::create_dir_all(&results)?;
    Ok(std::fs::write(results.join("peers_unlike.md"), &table)?)
}
