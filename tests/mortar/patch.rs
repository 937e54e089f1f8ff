//! A uniform pressure passes through every pairing of facets.

use crate::mortar::blocks::{Cells, of_one_material, off_uniform, stacked, supported, symmetric};
use crate::support::build::Build;
use crate::support::grid::Point;
use crate::support::run_built;
use brinell::mesh::Shape;
use brinell::results::Results;
use brinell::scene::{Kind, SlaveSide};

const SIDES: [SlaveSide; 3] = [SlaveSide::First, SlaveSide::Second, SlaveSide::Auto];

fn pressed_together(
    kind: Kind,
    lower: Cells,
    upper: Cells,
    slave: SlaveSide,
    map: &dyn Fn(Point) -> Point,
    symmetry: bool,
) -> Results {
    let mut builder = stacked(kind, 1.0, lower, upper, map);
    of_one_material(&mut builder, &["lower", "upper"], 1000.0, 0.3);
    supported(&mut builder, slave);
    if symmetry {
        symmetric(&mut builder);
    }
    let top = if kind == Kind::Solid {
        "upper.z1"
    } else {
        "upper.top"
    };
    builder.press(top, 10.0);
    run_built(&builder)
}

/// Round-off: conditions of these matrices are some 1e4.
const ROUND_OFF: f64 = 1e-10;

#[test]
fn every_pairing_of_edges() {
    for kind in [Kind::PlaneStrain, Kind::PlaneStress, Kind::Axisymmetric] {
        for lower in Shape::PLANE {
            for upper in Shape::PLANE {
                for (k, slave) in SIDES.into_iter().enumerate() {
                    let cells = [[3, 1, 2], [5, 1, 3]];
                    let cells = if k == 2 { [cells[1], cells[0]] } else { cells };
                    let [a, b] = [(lower, cells[0]), (upper, cells[1])];
                    let results = pressed_together(kind, a, b, slave, &|x| x, true);
                    let state = &results.states[0];
                    let along = 1;
                    let off = off_uniform(state, 10.0, along, 4);
                    // Plane strain has a stress out of the plane.
                    let off = match kind {
                        Kind::PlaneStrain => {
                            let pairs = state.pairs.iter().map(|p| (p.pressure / 10.0 - 1.0).abs());
                            pairs.fold(0.0, f64::max)
                        }
                        _ => off,
                    };
                    assert!(
                        off < ROUND_OFF,
                        "{kind:?} {lower:?} {upper:?} {slave:?}: {off:.1e}"
                    );
                }
            }
        }
    }
}

/// Parallelograms and triangles: the inverse maps are polynomials, quadrature is exact. Nothing but
/// contact holds the upper block from sliding and turning, which nothing drives.
#[test]
fn every_pairing_of_faces() {
    let slanted = |[x, y, z]: Point| [x + 0.3 * y, y, z];
    for lower in Shape::SOLID {
        for upper in Shape::SOLID {
            for slave in [SlaveSide::First, SlaveSide::Second] {
                let [a, b] = [(lower, [3, 3, 1]), (upper, [4, 2, 1])];
                let results = pressed_together(Kind::Solid, a, b, slave, &slanted, false);
                let off = off_uniform(&results.states[0], 10.0, 2, 6);
                assert!(off < ROUND_OFF, "{lower:?} {upper:?} {slave:?}: {off:.1e}");
            }
        }
    }
}

/// Inside nodes are moved; those on the outline stay on it.
fn bent([x, y, z]: Point) -> Point {
    let inside = |t: f64| 4.0 * t * (1.0 - t);
    let wave = |a: f64, b: f64| (7.0 * a + 3.0 * b).sin();
    [
        x + 0.06 * inside(x) * wave(x, y),
        y + 0.06 * inside(y) * wave(y, x),
        z,
    ]
}

/// On distorted quadrilaterals the inverse map is rational: the error is that of the rules, of
/// degree 5 (linear facets) and 8.
#[test]
fn distorted_quadrilaterals() {
    for (lower, upper) in [
        (Shape::Hex8, Shape::Hex8),
        (Shape::Hex20, Shape::Hex20),
        (Shape::Hex20, Shape::Tet10),
    ] {
        for slave in [SlaveSide::First, SlaveSide::Second] {
            let [a, b] = [(lower, [3, 3, 1]), (upper, [4, 2, 1])];
            let results = pressed_together(Kind::Solid, a, b, slave, &bent, true);
            let off = off_uniform(&results.states[0], 10.0, 2, 6);
            println!("{lower:?} on {upper:?}, {slave:?}: {off:.1e}");
            assert!(off < 5e-6, "{lower:?} {upper:?} {slave:?}: {off:.1e}");
        }
    }
}
