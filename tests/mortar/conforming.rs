//! Curved surfaces that fit each other, with different facets: the gap is that of the true
//! surfaces.

use crate::mortar::blocks::of_one_material;
use crate::mortar::sheet::Sheet;
use crate::support::build::Build;
use crate::support::grid::{Grid, Point};
use crate::support::{either, load, run, run_built};
use brinell::mesh::Shape;
use brinell::model::ModelBuilder;
use brinell::results::State;
use brinell::scene::{Contact, Direction, Kind, SlaveSide, Target};

type Vector = [f64; 3];

/// The shaft of `shrink_fit`: `E d (b^2 - a^2) / (2 a b^2)`.
const PRESSURE: f64 = 210e3 * 0.05 * (100.0 * 100.0 - 50.0 * 50.0) / (2.0 * 50.0 * 100.0 * 100.0);

/// Mean deviation of the pressure, and the largest from the mean, as shares.
fn deviations(state: &State) -> [f64; 2] {
    let force: f64 = state.pairs.iter().map(|p| p.force).sum();
    let area: f64 = state.pairs.iter().map(|p| p.area).sum();
    let mean = force / area;
    let scatter = state.pairs.iter().map(|p| (p.pressure / mean - 1.0).abs());
    [(mean / PRESSURE - 1.0).abs(), scatter.fold(0.0, f64::max)]
}

#[test]
fn a_shaft_in_a_ring_under_interference() {
    for (shaft, ring) in [(12, 8), (8, 12), (24, 16), (12, 10)] {
        for element in ["quad4", "quad8"] {
            for slave in ["first", "second"] {
                let scene = load(
                    "shrink_fit",
                    &[
                        &format!("mesh.parts.0.disc.elements={shaft}"),
                        &format!("mesh.parts.1.ring.elements=[12,{ring}]"),
                        &format!("mesh.parts.0.element={element}"),
                        &format!("mesh.parts.1.element={element}"),
                        &format!("contact.0.slave={slave}"),
                    ],
                );
                let results = run(&scene);
                let [mean, scatter] = deviations(&results.states[0]);
                assert!(
                    mean < 0.01 && scatter < 0.02,
                    "{shaft}:{ring} {element} {slave}: {mean:.4} {scatter:.4}"
                );
            }
        }
    }
}

/// A tube in a ring, from arrays that say nothing of circles.
fn tube_in_ring(shape: Shape, cells: [usize; 2], slave: SlaveSide) -> ModelBuilder {
    let mut builder = ModelBuilder::new(Kind::PlaneStress);
    for (name, inner, outer, n) in [
        ("tube", 30.0, 50.0, cells[0]),
        ("ring", 50.0, 100.0, cells[1]),
    ] {
        let sheet = Sheet {
            name,
            cells: [12, n],
            shape,
            map: &|[r, angle]| {
                let (radius, angle) = (
                    inner + r * (outer - inner),
                    0.5 * std::f64::consts::PI * angle,
                );
                [radius * angle.cos(), radius * angle.sin()]
            },
        };
        sheet.add(&mut builder);
        builder.hold(format!("{name}.bottom"), Direction::Y);
        builder.hold(format!("{name}.top"), Direction::X);
    }
    of_one_material(&mut builder, &["tube", "ring"], 210e3, 0.3);
    builder.contact(Contact {
        first: "tube.right".into(),
        second: "ring.left".into(),
        interference: 0.05.into(),
        slave,
        ..Contact::default()
    });
    builder.target(Target {
        load_factor: Some(0.0),
        ..Target::default()
    });
    builder
}

/// Lamé: `p = E d / a (..)` of both walls, one material.
fn of_tube([inner, a, outer]: [f64; 3]) -> f64 {
    let sum = (outer * outer + a * a) / (outer * outer - a * a)
        + (a * a + inner * inner) / (a * a - inner * inner);
    210e3 * 0.05 / (a * sum)
}

#[test]
fn circles_are_recognised() {
    let exact = of_tube([30.0, 50.0, 100.0]);
    for shape in [Shape::Quad4, Shape::Quad8, Shape::Tri6] {
        for cells in [[12, 8], [8, 12]] {
            for slave in [SlaveSide::First, SlaveSide::Second] {
                let results = run_built(&tube_in_ring(shape, cells, slave));
                let [mean, scatter] = {
                    let state = &results.states[0];
                    let [mean, scatter] = deviations(state);
                    let _ = mean;
                    let force: f64 = state.pairs.iter().map(|p| p.force).sum();
                    let area: f64 = state.pairs.iter().map(|p| p.area).sum();
                    [(force / area / exact - 1.0).abs(), scatter]
                };
                assert!(
                    mean < 0.01 && scatter < 0.02,
                    "{shape:?} {cells:?} {slave:?}: {mean:.4} {scatter:.4}"
                );
            }
        }
    }
}

/// Too few nodes to tell a circle from a polygon: that the facets overlap is said.
#[test]
fn facets_that_overlap_are_noticed() {
    let builder = tube_in_ring(Shape::Quad4, [4, 3], SlaveSide::Auto);
    let why = builder.build().map(|_| ()).unwrap_err().to_string();
    assert!(why.contains("overlaps the other surface by"), "{why}");
    assert!(
        why.contains("no more than facets deviate from a curved surface"),
        "{why}"
    );
    assert!(why.contains("mesh.circles"), "{why}");
}

/// Two shells of a solid from `inner` to `middle` to `outer`, meshed with different cells across.
fn shells(
    shape: Shape,
    cells: [[usize; 2]; 2],
    slave: SlaveSide,
    [inner, middle, outer]: [f64; 3],
    place: &dyn Fn(f64, [f64; 2]) -> Point,
    sides: &[(&str, Vector)],
) -> ModelBuilder {
    let mut builder = ModelBuilder::new(Kind::Solid);
    for (name, [from, to], [m, n]) in [
        ("inside", [inner, middle], cells[0]),
        ("outside", [middle, outer], cells[1]),
    ] {
        let grid = Grid {
            name,
            cells: [m, n, 5],
            shape,
            map: &|[a, b, r]| place(from + r * (to - from), [a, b]),
        };
        grid.add(&mut builder);
        for (side, direction) in sides {
            builder.hold_along(format!("{name}.{side}"), *direction);
        }
    }
    of_one_material(&mut builder, &["inside", "outside"], 210e3, 0.3);
    builder.contact(Contact {
        first: "inside.z1".into(),
        second: "outside.z0".into(),
        interference: 0.05.into(),
        slave,
        ..Contact::default()
    });
    builder.target(Target {
        load_factor: Some(0.0),
        ..Target::default()
    });
    builder
}

/// Mean and scatter of the pressure of what nothing says is round.
fn of_shells(builder: &ModelBuilder, exact: f64) -> [f64; 2] {
    let results = run_built(builder);
    let state = &results.states[0];
    let [_, scatter] = deviations(state);
    let force: f64 = state.pairs.iter().map(|p| p.force).sum();
    let area: f64 = state.pairs.iter().map(|p| p.area).sum();
    [(force / area / exact - 1.0).abs(), scatter]
}

const SHAPES: [(Shape, SlaveSide); 5] = [
    (Shape::Hex8, SlaveSide::First),
    (Shape::Hex8, SlaveSide::Second),
    (Shape::Hex20, SlaveSide::First),
    (Shape::Hex20, SlaveSide::Second),
    (Shape::Tet10, SlaveSide::Auto),
];

/// A tube in a ring in plane strain, as solids, on an axis that is none of the model's.
#[test]
fn cylinders_are_recognised() {
    let third = |[x, y, z]: Point| {
        // Turned by 0.3 about x, then 0.5 about z.
        let [c, s] = [0.3f64.cos(), 0.3f64.sin()];
        let [y, z] = [c * y - s * z, s * y + c * z];
        let [c, s] = [0.5f64.cos(), 0.5f64.sin()];
        [c * x - s * y + 3.0, s * x + c * y - 7.0, z]
    };
    let turned = |v: Vector| {
        let [a, o] = [third(v), third([0.0; 3])];
        [0, 1, 2].map(|d| a[d] - o[d])
    };
    let place = |r: f64, [a, b]: [f64; 2]| {
        let angle = 0.5 * std::f64::consts::PI * a;
        // Counter-clockwise in (angle, axis, radius).
        third([r * angle.cos(), r * angle.sin(), 20.0 * b])
    };
    let sides = [
        ("x0", turned([0.0, 1.0, 0.0])),
        ("x1", turned([1.0, 0.0, 0.0])),
        ("y0", turned([0.0, 0.0, 1.0])),
        ("y1", turned([0.0, 0.0, 1.0])),
    ];
    // Plane strain: E / (1 - nu^2) for E, and both walls of one material.
    let exact = of_tube([30.0, 50.0, 100.0]) / 0.91;
    for (shape, slave) in SHAPES {
        let both = &[[[12, 2], [8, 3]], [[8, 3], [12, 2]]][..];
        let one = either(&both[..1], both);
        for &cells in if shape == Shape::Hex8 { both } else { one } {
            let builder = shells(shape, cells, slave, [30.0, 50.0, 100.0], &place, &sides);
            let [mean, scatter] = of_shells(&builder, exact);
            println!("cylinder {shape:?} {cells:?} {slave:?}: {mean:.4} {scatter:.4}");
            assert!(
                mean < 0.01 && scatter < 0.02,
                "{shape:?} {cells:?} {slave:?}: {mean:.4} {scatter:.4}"
            );
        }
    }
}

/// A ball in a bowl: two shells, seen through a pyramid of planes through their centre.
#[test]
fn spheres_are_recognised() {
    let half = 0.25 * std::f64::consts::PI;
    let place = |r: f64, [a, b]: [f64; 2]| {
        let [x, y] = [a, b].map(|t| ((2.0 * t - 1.0) * half).tan());
        let far = (x * x + y * y + 1.0).sqrt();
        [r * x / far, r * y / far, r / far]
    };
    let sides = [
        ("x0", [1.0, 0.0, 1.0]),
        ("x1", [1.0, 0.0, -1.0]),
        ("y0", [0.0, 1.0, 1.0]),
        ("y1", [0.0, 1.0, -1.0]),
    ];
    let [inner, middle, outer] = [30.0f64, 50.0, 100.0];
    // Displacement of a wall under its pressure: Lamé.
    let wall = |other: f64| {
        let (a, b) = (middle.powi(3), other.powi(3));
        middle / 210e3 * (0.4 * a + 0.65 * b) / (b - a).abs()
    };
    let exact = 0.05 / (wall(inner) + wall(outer));
    // Many unknowns: not all of the shapes.
    for (shape, slave) in SHAPES.into_iter().take(3) {
        let builder = shells(
            shape,
            [[12, 12], [8, 8]],
            slave,
            [inner, middle, outer],
            &place,
            &sides,
        );
        let [mean, scatter] = of_shells(&builder, exact);
        println!("sphere {shape:?} {slave:?}: {mean:.4} {scatter:.4}");
        assert!(
            mean < 0.01 && scatter < 0.02,
            "{shape:?} {slave:?}: {mean:.4} {scatter:.4}"
        );
    }
}
