//! What `indentation.c` does, through the Rust crate: the same lines to the last digit.
//!
//! `cargo run --release --example indentation -- SCENE`

use brinell::analysis::Analysis;
use brinell::constrained::ConstrainedStructure;
use brinell::contact::Change;
use brinell::linalg::{Backend, SymmetricCsc};
use brinell::mesh::Shape;
use brinell::model::{Model, ModelBuilder, NodePair};
use brinell::progress::{Flow, Observer, Silent};
use brinell::results::HistoryRow;
use brinell::scene::{Body, Contact, Direction, Kind, Load, Material, Scene, Support, Target};
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

/// Half of two blocks from arrays: pairs with gaps that grow from the middle, pressed together
/// until they flow, and let go.
fn blocks() -> brinell::Result<()> {
    const NX: usize = 4;
    const NY: usize = 2;
    const ROW: usize = NX + 1;
    let node = |body: usize, i: usize, j: usize| body * ROW * (NY + 1) + j * ROW + i;
    let row =
        |body: usize, j: usize| -> Vec<usize> { (0..ROW).map(|i| node(body, i, j)).collect() };
    let mut builder = ModelBuilder::new(Kind::PlaneStrain);
    builder.symmetry(2);
    let mut middle = Vec::new();
    for (body, name) in ["lower", "upper"].into_iter().enumerate() {
        let mut coordinates = Vec::new();
        let mut elements = Vec::new();
        for j in 0..=NY {
            for i in 0..=NX {
                coordinates.extend([0.5 * i as f64, body as f64 + 0.5 * j as f64]);
            }
            middle.push(node(body, 0, j));
        }
        for j in 0..NY {
            for i in 0..NX {
                elements.extend(
                    [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| node(body, i, j)),
                );
            }
        }
        let steel = Body {
            material: "steel".into(),
            ..Body::default()
        };
        builder
            .nodes(&coordinates)?
            .elements(Shape::Quad4, name, &elements)?
            .body(name, steel)?;
    }
    let (opposite, face) = (row(1, 0), row(0, NY));
    let pairs: Vec<NodePair> = (0..ROW)
        .map(|i| NodePair {
            first: opposite[i],
            second: face[i],
            normal: None,
            gap: Some(0.002 * (0.5 * i as f64) * (0.5 * i as f64)),
        })
        .collect();
    let contact = Contact {
        first: "opposite".into(),
        second: "face".into(),
        ..Contact::default()
    };
    let steel = Material {
        youngs_modulus: 210e3,
        poissons_ratio: 0.3,
        yield_stress: Some(300.0),
        plastic_modulus: Some(2100.0),
        ..Material::default()
    };
    builder
        .surface_of_nodes("floor", &row(0, 0))?
        .surface_of_nodes("face", &face)?
        .surface_of_nodes("opposite", &opposite)?
        .surface_of_nodes("top", &row(1, NY))?
        .node_set("middle", &middle)?
        .material("steel", steel)?
        .contact_pairs(contact, &pairs)?
        .support(Support {
            on: "floor".into(),
            fix: vec![Direction::Y],
            ..Support::default()
        })
        .support(Support {
            on: "middle".into(),
            fix: vec![Direction::X],
            ..Support::default()
        })
        .load(Load {
            on: "top".into(),
            pressure: Some(300.0.into()),
            ..Load::default()
        })
        .target(Target {
            load_factor: Some(1.0),
            ..Target::default()
        })
        .target(Target {
            load_factor: Some(0.0),
            ..Target::default()
        });
    let results = Analysis::new(builder.build()?, Backend::default())?.run(&mut Silent)?;
    let loaded = &results.states[0];
    println!(
        "blocks: contact force {}, largest pressure {}, points that flow {}",
        e(loaded.contact_force),
        e(loaded.max_pressure),
        loaded.plastic_points
    );
    let left: Vec<String> = results.states[1].pairs.iter().map(|p| e(p.gap)).collect();
    println!("gaps left: {}", left.join(" "));
    Ok(())
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
    let status = results.ending().kind().map_or(0, |kind| kind.exit_code());
    println!(
        "stopped with status {status} after {} increments",
        results.history.len()
    );
    if let Err(error) = Scene::parse("kind = 3", "scene") {
        println!("refused with status {}: {error}", error.kind().exit_code());
    }
    blocks()?;
    springs()?;
    Ok(())
}
