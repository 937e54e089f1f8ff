//! What `indentation.c` does, through the Rust crate: the same lines to the last digit.
//!
//! `cargo run --release --example indentation -- SCENE`

use brinell::analysis::Analysis;
use brinell::constrained::ConstrainedStructure;
use brinell::contact::Change;
use brinell::linalg::{Backend, SymmetricCsc};
use brinell::model::Model;
use brinell::progress::{Flow, Observer, Silent};
use brinell::results::HistoryRow;
use brinell::scene::Scene;
use std::error::Error;

/// A number as C prints it with `%.15e`.
fn e(value: f64) -> String {
    let text = format!("{value:.15e}");
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let sign = if exponent < 0 { '-' } else { '+' };
    format!("{digits}e{sign}{:02}", exponent.abs())
}

struct StopAtThird;
impl Observer for StopAtThird {
    fn increment(&mut self, row: &HistoryRow, _: f64) -> Flow {
        if row.increment >= 3 {
            Flow::Stop
        } else {
            Flow::Continue
        }
    }
}

fn analyse(path: &str) -> brinell::Result<String> {
    let overrides = ["mesh.cylinder_on_half_plane.resolution=6".to_string()];
    let scene = Scene::load_with(path, &overrides)?;
    let results = Analysis::new(Model::new(&scene)?, Backend::default())?.run(&mut Silent)?;
    let pressures = results.history.iter().map(|row| row.max_pressure);
    let last = results.states.last();
    let fields = last.and_then(|s| s.fields.as_ref());
    Ok(format!(
        "increments {}, states {}, yield load {}, largest pressure {}, dent {}, displacement {}",
        results.history.len(),
        results.states.len(),
        e(results.first_yield.map_or(f64::NAN, |y| y.load)),
        e(pressures.fold(0.0, f64::max)),
        e(last.map_or(f64::NAN, |s| s.residual_depth)),
        e(fields.map_or(f64::NAN, |f| f
            .displacement
            .iter()
            .fold(0.0, |sum, u| sum + u * u))),
    ))
}

fn springs() -> brinell::Result<()> {
    let stiffness = SymmetricCsc::new_csc(
        (3, 3),
        vec![0, 1, 3, 5],
        vec![0, 0, 1, 1, 2],
        vec![2.0, -1.0, 2.0, -1.0, 1.0],
    );
    let rows = [vec![(2, 1.0)]];
    let mut structure = ConstrainedStructure::new(Backend::default(), &stiffness, &rows, &[1.0])?;
    let condensed = structure.condensed_stiffness();
    let n = condensed.nrows();
    println!("condensed stiffness {n} x {n}: {}", e(condensed[(0, 0)]));
    structure.start(&[0.0, 0.0, 1.0])?;
    let event = structure.step(2.0)?;
    for change in &event.changes {
        let (row, what) = match change {
            Change::Closes(row) => (row, "closes"),
            Change::Opens(row) => (row, "opens"),
        };
        println!("row {row} {what} at t = {}", e(event.t));
    }
    let event = structure.step(2.0)?;
    println!("force at t = {}: {}", e(event.t), e(structure.forces()[0]));
    let mut u = [0.0; 3];
    structure.displacements(&mut u)?;
    println!(
        "displacements {} {} {}, closed {}",
        e(u[0]),
        e(u[1]),
        e(u[2]),
        i32::from(!structure.open()[0])
    );
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("usage: indentation SCENE")?;
    let (one, other) = rayon::join(|| analyse(&path), || analyse(&path));
    println!("{}\n{}", one?, other?);
    let scene = Scene::load(&path)?;
    let results = Analysis::new(Model::new(&scene)?, Backend::default())?.run(&mut StopAtThird)?;
    let status = results.incomplete_kind.map_or(0, |kind| kind.exit_code());
    println!(
        "stopped with status {status} after {} increments",
        results.history.len()
    );
    if let Err(error) = Scene::parse("kind = 3", "scene") {
        println!("refused with status {}: {error}", error.kind().exit_code());
    }
    springs()?;
    Ok(())
}
