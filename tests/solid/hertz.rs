//! Hertz's contact of balls on quarter models.

use crate::support::build::{Build, elastic};
use crate::support::grid::{Grid, Point};
use crate::support::{either, run_built};
use brinell::mesh::Shape;
use brinell::model::{ModelBuilder, NodePair};
use brinell::results::Results;
use brinell::scene::{Contact, Direction, Kind, Load, PlaneForce};

/// Contact half axis 1 over so many even elements, then elements that grow.
fn graded(t: f64, cells: usize, fine: usize, extent: f64) -> f64 {
    // Even to 1.5 with `fine` elements over 1, then geometric.
    let h = 1.0 / fine as f64;
    let even = (1.5 * fine as f64).round();
    let k = t * cells as f64;
    if k <= even {
        return k * h;
    }
    let rest = cells as f64 - even;
    // h (q + ... + q^rest) = extent - 1.5
    let sum = |q: f64| h * q * (q.powf(rest) - 1.0) / (q - 1.0);
    let (mut low, mut high) = (1.0 + 1e-9, 10.0);
    for _ in 0..100 {
        let q = 0.5 * (low + high);
        if sum(q) < extent - even * h {
            low = q
        } else {
            high = q
        }
    }
    let q = low;
    even * h + h * q * (q.powf(k - even) - 1.0) / (q - 1.0)
}

fn ball(fine: usize, cells: usize, extent: f64, radius: f64, load: f64) -> Results {
    let n = [cells; 3];
    let g = move |t: f64| graded(t, cells, fine, extent);
    let lower = move |[x, y, z]: Point| [g(x), g(y), -g(1.0 - z)];
    let upper = move |[x, y, z]: Point| [g(x), g(y), g(z)];
    let mut builder = ModelBuilder::new(Kind::Solid);
    builder.symmetry(4);
    Grid {
        name: "lower",
        cells: n,
        shape: Shape::Hex8,
        map: &lower,
    }
    .add(&mut builder);
    Grid {
        name: "upper",
        cells: n,
        shape: Shape::Hex8,
        map: &upper,
    }
    .add(&mut builder);
    let material = elastic(1000.0, 0.3);
    builder.material("steel", material).unwrap();
    for body in ["lower", "upper"] {
        builder.of(body, "steel");
        for (axis, direction) in [("x0", Direction::X), ("y0", Direction::Y)] {
            builder.hold(format!("{body}.{axis}"), direction);
        }
    }
    builder.hold("lower.z0", Direction::Z);
    // Pairs by place.
    let model_nodes = |name: &str, builder: &ModelBuilder| builder.set_nodes(name);
    let (first, second) = (
        model_nodes("upper.z0", &builder),
        model_nodes("lower.z1", &builder),
    );
    let mut pairs = Vec::new();
    for (node, at) in second {
        if at[0] > 2.5 || at[1] > 2.5 {
            continue;
        }
        let (other, _) = first
            .iter()
            .find(|(_, x)| x[0] == at[0] && x[1] == at[1])
            .unwrap();
        pairs.push(NodePair {
            first: *other,
            second: node,
            normal: Some([0.0, 0.0, 1.0]),
            gap: Some((at[0] * at[0] + at[1] * at[1]) / (2.0 * radius)),
        });
    }
    let contact = Contact {
        first: "upper.z0".into(),
        second: "lower.z1".into(),
        ..Contact::default()
    };
    builder.contact_pairs(contact, &pairs).unwrap();
    builder.load(Load {
        on: "upper.z1".into(),
        plane_force: Some(PlaneForce {
            direction: Direction::Z,
            total: -load,
        }),
        ..Load::default()
    });
    run_built(&builder)
}

#[test]
fn a_circular_contact() {
    // a = 1: 4 E* a^3/(3 R) with E* = E/(2 (1 - nu^2)).
    let modulus = 1000.0 / (2.0 * 0.91);
    let radius = 20.0;
    let load = 4.0 * modulus / (3.0 * radius);
    let p0 = 1.5 * load / std::f64::consts::PI;
    for &fine in either(&[3, 5][..], &[4, 6, 8]) {
        let results = ball(fine, 3 * fine + 4, 30.0, radius, load);
        let state = &results.states[0];
        let patch = &state.patches[0];
        // Pressure is of order h^2, C between 0.08 and 0.11; an edge lies within a part of an
        // element.
        let (h, square) = (1.0 / fine as f64, 1.0 / (fine * fine) as f64);
        let near = |value: f64, off: f64| (value - 1.0).abs() < off;
        assert!(
            near(state.max_pressure / p0, 0.15 * square),
            "{fine}: {}",
            state.max_pressure / p0
        );
        assert!(
            near(state.pole_pressure / p0, 0.15 * square),
            "{fine}: {}",
            state.pole_pressure / p0
        );
        assert!(near(patch.force / load, 1e-9), "{fine}: {patch:?}");
        assert!(
            patch.semi_axes.iter().all(|&a| near(a, 0.1 * h)),
            "{fine}: {patch:?}"
        );
        let area = std::f64::consts::PI;
        assert!(near(patch.area / area, 0.2 * h), "{fine}: {patch:?}");
    }
}
