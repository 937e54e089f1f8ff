//! Uniform states are exact on distorted elements, within a body and across a contact.

use crate::support::build::Build;
use crate::support::grid::{Grid, Point};
use crate::support::run_model;
use brinell::linalg::Backend;
use brinell::mesh::{Integration, Shape};
use brinell::model::ModelBuilder;
use brinell::scene::{Body, Contact, Direction, Kind, Load, Material};

/// Points inside are moved; those on the faces of the box stay on them, alike on the lowest and the
/// highest.
fn bent([x, y, z]: Point) -> Point {
    let inside = |t: f64| 4.0 * t * (1.0 - t);
    let wave = |a: f64, b: f64, c: f64| (7.0 * a + 3.0 * b + 5.0 * c).sin();
    let height = inside(z);
    [
        x + 0.1 * inside(x) * wave(x, y, height),
        y + 0.1 * inside(y) * wave(y, height, x),
        z + 0.1 * inside(z) * wave(height, x, y),
    ]
}

fn steel() -> Material {
    Material {
        youngs_modulus: 1000.0,
        poissons_ratio: 0.3,
        ..Material::default()
    }
}

/// Straight sides: the middles of edges are halfway.
fn straight(shape: Shape, map: fn(Point) -> Point, cells: [usize; 3]) -> impl Fn(Point) -> Point {
    move |x: Point| {
        if !shape.is_quadratic() {
            return map(x);
        }
        let (mut low, mut high) = ([0.0; 3], [0.0; 3]);
        for d in 0..3 {
            let at = x[d] * cells[d] as f64;
            low[d] = at.floor() / cells[d] as f64;
            high[d] = at.ceil() / cells[d] as f64;
        }
        let (a, b) = (map(low), map(high));
        [0, 1, 2].map(|d| 0.5 * (a[d] + b[d]))
    }
}

/// All shapes, those of two rules with either.
fn shapes() -> Vec<(Shape, Integration)> {
    let reduced = Shape::SOLID.map(|shape| (shape, Integration::Reduced));
    let full = [Shape::Hex20, Shape::Prism15].map(|shape| (shape, Integration::Full));
    reduced.into_iter().chain(full).collect()
}

/// A block under pressure, free to widen: one stress everywhere, whatever the elements.
#[test]
fn a_block_under_pressure_is_exact() {
    for (shape, integration) in shapes() {
        let cells = [2, 2, 2];
        let map = straight(shape, bent, cells);
        let mut builder = ModelBuilder::new(Kind::Solid);
        Grid {
            name: "block",
            cells,
            shape,
            map: &map,
        }
        .add(&mut builder);
        builder.material("steel", steel()).unwrap();
        builder
            .body(
                "block",
                Body {
                    material: "steel".into(),
                    integration,
                    ..Body::default()
                },
            )
            .unwrap();
        builder.hold("block.x0", Direction::X);
        builder.hold("block.y0", Direction::Y);
        builder.hold("block.z0", Direction::Z);
        builder.press("block.z1", 10.0);
        builder.reach(1.0);
        let results = run_model(builder.build().unwrap(), Backend::Dense);
        let fields = results.states[0].fields.as_ref().unwrap();
        for stress in fields.stress.chunks_exact(6) {
            for (s, exact) in stress.iter().zip([0.0, 0.0, -10.0, 0.0, 0.0, 0.0]) {
                assert!((s - exact).abs() < 1e-10, "{shape:?} {stress:?}");
            }
        }
    }
}

/// Two blocks pressed together: the contact passes a uniform pressure.
#[test]
fn a_contact_passes_a_uniform_pressure() {
    for (shape, integration) in shapes() {
        let cells = [3, 2, 2];
        let mut builder = ModelBuilder::new(Kind::Solid);
        let lower = straight(shape, bent, cells);
        let upper = |x: Point| {
            let [a, b, c] = lower(x);
            [a, b, 1.0 + c]
        };
        Grid {
            name: "lower",
            cells,
            shape,
            map: &lower,
        }
        .add(&mut builder);
        Grid {
            name: "upper",
            cells,
            shape,
            map: &upper,
        }
        .add(&mut builder);
        builder.material("steel", steel()).unwrap();
        for body in ["lower", "upper"] {
            builder
                .body(
                    body,
                    Body {
                        material: "steel".into(),
                        integration,
                        ..Body::default()
                    },
                )
                .unwrap();
            builder.hold(format!("{body}.x0"), Direction::X);
            builder.hold(format!("{body}.y0"), Direction::Y);
        }
        builder.hold("lower.z0", Direction::Z);
        builder.contact(Contact {
            first: "upper.z0".into(),
            second: "lower.z1".into(),
            ..Contact::default()
        });
        builder.load(Load {
            on: "upper.z1".into(),
            force: Some([0.0, 0.0, -10.0].into()),
            ..Load::default()
        });
        let results = run_model(builder.build().unwrap(), Backend::Dense);
        let state = &results.states[0];
        for pair in &state.pairs {
            assert!((pair.pressure - 10.0).abs() < 1e-9, "{shape:?} {pair:?}");
        }
        let patch = &state.patches[0];
        // With its images beyond x = 0 and y = 0, where both blocks are held across.
        assert!((patch.area - 4.0).abs() < 1e-12 && (patch.force - 40.0).abs() < 1e-9);
    }
}
