//! Soft contact: a pressure in proportion to the overlap.

use crate::mortar::blocks::{Cells, of_one_material, stacked, supported};
use crate::support::build::Build;
use crate::support::{load, run, run_built};
use brinell::mesh::Shape;
use brinell::model::ModelBuilder;
use brinell::scene::{Contact, Direction, Kind, Material, SlaveSide};

const MODULUS: f64 = 1000.0;
const STIFFNESS: f64 = 4000.0;

/// Two unit blocks, softly on one another.
fn blocks(kind: Kind, [lower, upper]: [Cells; 2], interference: f64) -> ModelBuilder {
    let mut builder = stacked(kind, 1.0, lower, upper, &|x| x);
    of_one_material(&mut builder, &["lower", "upper"], MODULUS, 0.0);
    let solid = kind == Kind::Solid;
    let names = match solid {
        true => ["upper.z0", "lower.z1", "lower.z0"],
        false => ["upper.bottom", "lower.top", "lower.bottom"],
    };
    builder.contact(Contact {
        first: names[0].into(),
        second: names[1].into(),
        stiffness: Some(STIFFNESS),
        interference: interference.into(),
        ..Contact::default()
    });
    let axis = if solid { Direction::Z } else { Direction::Y };
    builder.hold(names[2], axis);
    builder.reach(1.0);
    builder
}

const PAIRINGS: [(Kind, [Cells; 2]); 5] = [
    (
        Kind::PlaneStrain,
        [(Shape::Quad4, [3, 1, 2]), (Shape::Quad4, [3, 1, 2])],
    ),
    (
        Kind::PlaneStress,
        [(Shape::Quad8, [3, 1, 2]), (Shape::Tri6, [4, 1, 2])],
    ),
    (
        Kind::Axisymmetric,
        [(Shape::Quad8, [3, 1, 2]), (Shape::Quad8, [3, 1, 2])],
    ),
    (
        Kind::Solid,
        [(Shape::Hex20, [2, 2, 1]), (Shape::Hex20, [2, 2, 1])],
    ),
    (
        Kind::Solid,
        [(Shape::Hex8, [2, 2, 1]), (Shape::Tet10, [3, 2, 1])],
    ),
];

/// Springs in series: `u = p (2 h / E + 1 / k)`, and the gap is `-p / k`.
#[test]
fn blocks_and_contact_in_series() {
    for (kind, cells) in PAIRINGS {
        let mut builder = blocks(kind, cells, 0.0);
        let top = if kind == Kind::Solid {
            "upper.z1"
        } else {
            "upper.top"
        };
        builder.press(top, 10.0);
        let model = builder.build().unwrap();
        let results = run_built(&builder);
        let state = &results.states[0];
        let exact = -10.0 * (2.0 / MODULUS + 1.0 / STIFFNESS);
        let d = model.mesh.dimension;
        let u = &state.fields.as_ref().unwrap().displacement;
        for node in model.mesh.set_nodes(top).unwrap() {
            let moved = u[d * node + d - 1];
            assert!(
                (moved / exact - 1.0).abs() < 1e-10,
                "{kind:?} {cells:?}: {moved} {exact}"
            );
        }
        for pair in state.pairs.iter().filter(|pair| pair.area > 0.0) {
            assert!(
                (pair.pressure / 10.0 - 1.0).abs() < 1e-10,
                "{kind:?}: {pair:?}"
            );
            assert!(
                (pair.gap * STIFFNESS / -10.0 - 1.0).abs() < 1e-10,
                "{kind:?}: {pair:?}"
            );
        }
        let quality = &state.quality;
        assert!(
            quality.equilibrium < 1e-12 && quality.penetration < 1e-12,
            "{quality:?}"
        );
    }
}

/// Held at both ends: `p (2 h / E + 1 / k) = interference`.
#[test]
fn an_interference_is_shared() {
    for (kind, cells) in PAIRINGS {
        let mut builder = blocks(kind, cells, 0.01);
        let (top, axis) = match kind {
            Kind::Solid => ("upper.z1", Direction::Z),
            _ => ("upper.top", Direction::Y),
        };
        builder.hold(top, axis);
        builder.press(top, 0.0);
        let state = run_built(&builder).states.remove(0);
        let exact = 0.01 / (2.0 / MODULUS + 1.0 / STIFFNESS);
        for pair in state.pairs.iter().filter(|pair| pair.area > 0.0) {
            assert!(
                (pair.pressure / exact - 1.0).abs() < 1e-10,
                "{kind:?}: {pair:?}"
            );
        }
    }
}

/// As the stiffness grows what it changes falls in proportion to its inverse.
#[test]
fn hard_contact_is_the_limit() {
    let peak = |stiffness: Option<f64>| {
        let mut overrides = vec![
            "mesh.cylinder_on_half_plane.resolution=8".to_string(),
            "mesh.cylinder_on_half_plane.contact_width=12".to_string(),
            "mesh.cylinder_on_half_plane.half_width=0.155".to_string(),
            "bodies.half_plane.plastic=false".to_string(),
            "bodies.cylinder.plastic=false".to_string(),
            "reference=[]".to_string(),
            "load.0.plane_force.total=-217".to_string(),
            "program.unit=load".to_string(),
            "program.targets=[{load_factor=1}]".to_string(),
        ];
        overrides.extend(stiffness.map(|k| format!("contact.0.stiffness={k:e}")));
        let overrides: Vec<&str> = overrides.iter().map(String::as_str).collect();
        let results = run(&load("cylinder_on_half_plane", &overrides));
        results.states[0].max_pressure
    };
    let hard = peak(None);
    let off = [1e6, 1e9, 1e10, 1e11].map(|k| 1.0 - peak(Some(k)) / hard);
    println!("{hard} {off:?}");
    // A soft layer spreads the pressure.
    assert!(off[0] > 0.1, "{off:?}");
    for pair in off[1..].windows(2) {
        let ratio = pair[0] / pair[1];
        assert!((9.0..11.0).contains(&ratio), "{off:?}");
    }
}

#[test]
fn a_stiffness_is_positive() {
    for stiffness in [0.0, -1.0, f64::INFINITY] {
        let mut builder = stacked(
            Kind::PlaneStress,
            1.0,
            (Shape::Quad4, [1, 1, 1]),
            (Shape::Quad4, [1, 1, 1]),
            &|x| x,
        );
        builder.material("steel", Material::default()).unwrap();
        builder.contact(Contact {
            first: "upper.bottom".into(),
            second: "lower.top".into(),
            stiffness: Some(stiffness),
            ..Contact::default()
        });
        supported(&mut builder, SlaveSide::Auto);
        let why = builder.build().map(|_| ()).unwrap_err().to_string();
        assert!(why.contains("stiffness"), "{why}");
    }
}
