//! Curved surfaces that fit each other, with different facets: the gap is that of the true
//! surfaces.

use crate::blocks::{held, of_one_material, run};
use crate::running::{load, try_run};
use crate::sheet::Sheet;
use brinell::linalg::Backend;
use brinell::mesh::Shape;
use brinell::model::ModelBuilder;
use brinell::results::State;
use brinell::scene::{Contact, Direction, Kind, SlaveSide, Target};

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
                let results = try_run(&scene, Backend::default()).unwrap();
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
        held(&mut builder, &format!("{name}.bottom"), Direction::Y);
        held(&mut builder, &format!("{name}.top"), Direction::X);
    }
    of_one_material(&mut builder, &["tube", "ring"], 210e3, 0.3);
    builder.contact(Contact {
        first: "tube.right".into(),
        second: "ring.left".into(),
        interference: 0.05,
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
                let results = run(&tube_in_ring(shape, cells, slave));
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
        why.contains("no more than flat facets deviate from a curved surface"),
        "{why}"
    );
    assert!(why.contains("mesh.circles"), "{why}");
}
