//! Surfaces that are tied: one stress passes through, whatever stands at their ends.

use crate::mortar::blocks::{Cells, of_one_material, stacked, supported, touching};
use crate::mortar::sheet::Sheet;
use crate::support::build::Build;
use crate::support::grid::Point;
use crate::support::run_built;
use brinell::mesh::Shape;
use brinell::model::ModelBuilder;
use brinell::results::Results;
use brinell::scene::{Direction, Kind, Load, SlaveSide, Support, Tie};

const SIDES: [SlaveSide; 3] = [SlaveSide::First, SlaveSide::Second, SlaveSide::Auto];
/// As for contact: conditions of these matrices are some 1e4.
const ROUND_OFF: f64 = 1e-10;

pub fn tied(builder: &mut ModelBuilder, first: &str, second: &str, slave: SlaveSide) {
    builder.tie(Tie {
        first: first.into(),
        second: second.into(),
        slave,
        distance: None,
    });
}

/// Holds the rigid motions that are left, at corners of the base of a body from 0 to 1.
fn pinned(builder: &mut ModelBuilder, body: &str, pins: &[([f64; 2], &[Direction])]) {
    let (base, along) = match builder.dimension() {
        3 => ("z0", [0, 1]),
        _ => ("bottom", [0, 2]),
    };
    for (k, (corner, directions)) in pins.iter().enumerate() {
        let nodes = builder.set_nodes(&format!("{body}.{base}"));
        let at = nodes.iter().find(|(_, x)| along.map(|d| x[d]) == *corner);
        let name = format!("pin{k}");
        builder.node_set(&name, &[at.unwrap().0]).unwrap();
        builder.support(Support {
            on: name,
            fix: directions.to_vec(),
            ..Support::default()
        });
    }
}

pub fn aim(builder: &mut ModelBuilder) {
    builder.reach(1.0);
}

/// A stress, `xx yy zz xy yz zx`, as tractions on the whole outline of the upper and lower block.
fn stressed(builder: &mut ModelBuilder, bodies: &[&str], stress: [f64; 6]) {
    let solid = builder.dimension() == 3;
    let [xx, yy, zz, xy, yz, zx] = stress;
    let tensor = [[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]];
    let sides: &[(&str, usize, f64)] = match solid {
        true => &[
            ("x0", 0, -1.0),
            ("x1", 0, 1.0),
            ("y0", 1, -1.0),
            ("y1", 1, 1.0),
            ("z0", 2, -1.0),
            ("z1", 2, 1.0),
        ],
        false => &[
            ("left", 0, -1.0),
            ("right", 0, 1.0),
            ("bottom", 1, -1.0),
            ("top", 1, 1.0),
        ],
    };
    let axis = if solid { 2 } else { 1 };
    for (k, body) in bodies.iter().enumerate() {
        for &(side, along, sign) in sides {
            let is_between =
                along == axis && ((sign > 0.0 && k + 1 < bodies.len()) || (sign < 0.0 && k > 0));
            if is_between {
                continue;
            }
            let t = tensor[along].map(|s| sign * s);
            builder.load(Load {
                on: format!("{body}.{side}"),
                traction: Some(match solid {
                    true => t.into(),
                    false => [t[0], t[1]].into(),
                }),
                ..Load::default()
            });
        }
    }
}

/// Largest deviation of the stress of all nodes from a uniform one, over its largest component;
/// what is out of a plane is left out.
fn off(results: &Results, stress: [f64; 6], solid: bool) -> f64 {
    let fields = results.states[0].fields.as_ref().unwrap();
    let scale = stress.iter().fold(0.0, |m: f64, s| m.max(s.abs()));
    let (each, compared): (usize, &[usize]) = match solid {
        true => (6, &[0, 1, 2, 3, 4, 5]),
        false => (4, &[0, 1, 3]),
    };
    let nodes = fields.stress.chunks_exact(each);
    let deviations = nodes.flat_map(|s| compared.iter().map(|&k| (s[k] - stress[k]).abs()));
    deviations.fold(0.0, f64::max) / scale
}

fn uniform(
    kind: Kind,
    [lower, upper]: [Cells; 2],
    slave: SlaveSide,
    stress: [f64; 6],
    map: &dyn Fn(Point) -> Point,
    holds: &[(&str, Direction)],
) -> f64 {
    let mut builder = stacked(kind, 1.0, lower, upper, map);
    of_one_material(&mut builder, &["lower", "upper"], 1000.0, 0.3);
    let solid = kind == Kind::Solid;
    match solid {
        true => tied(&mut builder, "upper.z0", "lower.z1", slave),
        false => tied(&mut builder, "upper.bottom", "lower.top", slave),
    }
    for body in ["lower", "upper"] {
        for (side, direction) in holds {
            builder.hold(format!("{body}.{side}"), *direction);
        }
    }
    use Direction::{X, Y, Z};
    let pins: &[([f64; 2], &[Direction])] = match (kind, holds.len()) {
        (Kind::Solid, 0) => &[
            ([0.0, 0.0], &[X, Y, Z]),
            ([1.0, 0.0], &[Y, Z]),
            ([0.0, 1.0], &[Z]),
        ],
        (Kind::Solid, _) => &[([0.0, 0.0], &[Z])],
        (Kind::Axisymmetric, _) => &[([0.0, 0.0], &[Y])],
        (_, 0) => &[([0.0, 0.0], &[X, Y]), ([1.0, 0.0], &[Y])],
        _ => &[([0.0, 0.0], &[Y])],
    };
    pinned(&mut builder, "lower", pins);
    stressed(&mut builder, &["lower", "upper"], stress);
    aim(&mut builder);
    off(&run_built(&builder), stress, solid)
}

/// Tension across, along and shear at once, held by nothing; then with the ends of the surfaces on
/// supports, to which the shear is pressed.
#[test]
fn every_pairing_of_edges_passes_any_stress() {
    let stress = [3.0, -10.0, 0.0, 4.0, 0.0, 0.0];
    let sheared = [0.0, 0.0, 0.0, 4.0, 0.0, 0.0];
    for kind in [Kind::PlaneStrain, Kind::PlaneStress] {
        for lower in Shape::PLANE {
            for upper in Shape::PLANE {
                for slave in SIDES {
                    let cells = [(lower, [3, 1, 2]), (upper, [5, 1, 3])];
                    for (stress, holds) in [
                        (stress, &[][..]),
                        (sheared, &[("left", Direction::X)]),
                        (sheared, &[("left", Direction::X), ("right", Direction::X)]),
                    ] {
                        let off = uniform(kind, cells, slave, stress, &|x| x, holds);
                        assert!(
                            off < ROUND_OFF,
                            "{kind:?} {lower:?} {upper:?} {slave:?} {holds:?}: {off:.1e}"
                        );
                    }
                }
            }
        }
    }
}

/// The node on the axis has no weight, or hardly any.
#[test]
fn edges_about_an_axis() {
    let stress = [-4.0, -10.0, -4.0, 0.0, 0.0, 0.0];
    for lower in Shape::PLANE {
        for upper in Shape::PLANE {
            for slave in SIDES {
                let cells = [(lower, [3, 1, 2]), (upper, [5, 1, 3])];
                let off = uniform(Kind::Axisymmetric, cells, slave, stress, &|x| x, &[]);
                assert!(off < ROUND_OFF, "{lower:?} {upper:?} {slave:?}: {off:.1e}");
            }
        }
    }
}

#[test]
fn every_pairing_of_faces_passes_any_stress() {
    let stress = [3.0, 1.0, -10.0, 2.0, 4.0, -3.0];
    for lower in Shape::SOLID {
        for upper in Shape::SOLID {
            for slave in [SlaveSide::First, SlaveSide::Second] {
                let cells = [(lower, [3, 3, 1]), (upper, [4, 2, 1])];
                let off = uniform(Kind::Solid, cells, slave, stress, &|x| x, &[]);
                assert!(off < ROUND_OFF, "{lower:?} {upper:?} {slave:?}: {off:.1e}");
            }
        }
    }
}

/// Shears that press on planes of symmetry at the surface's outline, and a corner on two of them.
#[test]
fn faces_on_supports() {
    let sheared = [0.0, 0.0, -5.0, 0.0, 4.0, -3.0];
    let holds = [("x0", Direction::X), ("y0", Direction::Y)];
    for (lower, upper) in [
        (Shape::Hex8, Shape::Hex8),
        (Shape::Hex20, Shape::Hex20),
        (Shape::Tet10, Shape::Hex20),
        (Shape::Tet10, Shape::Tet10),
    ] {
        for slave in [SlaveSide::First, SlaveSide::Second] {
            let cells = [(lower, [3, 3, 1]), (upper, [4, 2, 1])];
            let mut stress = sheared;
            let material = 0.3;
            // No strain along x and y, which are held.
            stress[0] = material / (1.0 - material) * stress[2];
            stress[1] = stress[0];
            let off = uniform(Kind::Solid, cells, slave, stress, &|x| x, &holds);
            assert!(off < ROUND_OFF, "{lower:?} {upper:?} {slave:?}: {off:.1e}");
        }
    }
}

/// Three blocks, the middle one tied below and above.
#[test]
fn three_in_a_row() {
    let stress = [3.0, -10.0, 0.0, 4.0, 0.0, 0.0];
    for below in [SlaveSide::First, SlaveSide::Second] {
        for above in [SlaveSide::First, SlaveSide::Second] {
            let mut builder = ModelBuilder::new(Kind::PlaneStress);
            let names = ["a", "b", "c"];
            for (k, (name, n)) in names.into_iter().zip([3, 5, 4]).enumerate() {
                let sheet = Sheet {
                    name,
                    cells: [n, 2],
                    shape: Shape::Quad8,
                    map: &|[x, y]| [x, y + k as f64],
                };
                sheet.add(&mut builder);
            }
            of_one_material(&mut builder, &names, 1000.0, 0.3);
            tied(&mut builder, "a.top", "b.bottom", below);
            tied(&mut builder, "b.top", "c.bottom", above);
            let pins: &[([f64; 2], &[Direction])] = &[
                ([0.0, 0.0], &[Direction::X, Direction::Y]),
                ([1.0, 0.0], &[Direction::Y]),
            ];
            pinned(&mut builder, "a", pins);
            stressed(&mut builder, &names, stress);
            aim(&mut builder);
            let off = off(&run_built(&builder), stress, false);
            assert!(off < ROUND_OFF, "{below:?} {above:?}: {off:.1e}");
        }
    }
}

/// A punch on the left half of a block that is tied to another on its right: the node at the corner
/// is in contact and tied.
#[test]
fn a_node_in_contact_that_is_tied() {
    for shape in [Shape::Quad4, Shape::Quad8] {
        for touch in [SlaveSide::First, SlaveSide::Second] {
            for slave in [SlaveSide::First, SlaveSide::Second] {
                let mut builder = ModelBuilder::new(Kind::PlaneStress);
                for (name, [x0, y0], cells) in [
                    ("inset", [0.0, 0.0], [5, 4]),
                    ("rest", [1.0, 0.0], [2, 3]),
                    ("punch", [0.0, 1.0], [3, 2]),
                ] {
                    let sheet = Sheet {
                        name,
                        cells,
                        shape,
                        map: &|[x, y]| [x + x0, y + y0],
                    };
                    sheet.add(&mut builder);
                }
                of_one_material(&mut builder, &["inset", "rest", "punch"], 1000.0, 0.3);
                touching(&mut builder, "punch.bottom", "inset.top", touch);
                tied(&mut builder, "inset.right", "rest.left", slave);
                for body in ["inset", "punch"] {
                    builder.hold(format!("{body}.left"), Direction::X);
                }
                for body in ["inset", "rest"] {
                    builder.hold(format!("{body}.bottom"), Direction::Y);
                }
                builder.press("punch.top", 10.0);
                builder.press("rest.top", 10.0);
                aim(&mut builder);
                let results = run_built(&builder);
                let off = off(&results, [0.0, -10.0, 0.0, 0.0, 0.0, 0.0], false);
                assert!(off < ROUND_OFF, "{shape:?} {touch:?} {slave:?}: {off:.1e}");
            }
        }
    }
}

/// A block tied to one that is in contact with a third: the contact sees through the tie.
#[test]
fn contact_beside_a_tie() {
    let cells = |n: usize| (Shape::Quad8, [n, 1, 2]);
    let mut builder = stacked(Kind::PlaneStress, 1.0, cells(3), cells(5), &|x| x);
    let sheet = Sheet {
        name: "top",
        cells: [4, 2],
        shape: Shape::Quad8,
        map: &|[x, y]| [x, y + 2.0],
    };
    sheet.add(&mut builder);
    of_one_material(&mut builder, &["lower", "upper", "top"], 1000.0, 0.3);
    supported(&mut builder, SlaveSide::Auto);
    for body in ["lower", "upper", "top"] {
        builder.hold(format!("{body}.left"), Direction::X);
    }
    tied(&mut builder, "top.bottom", "upper.top", SlaveSide::Auto);
    builder.press("top.top", 10.0);
    let results = run_built(&builder);
    let off = off(&results, [0.0, -10.0, 0.0, 0.0, 0.0, 0.0], false);
    assert!(off < ROUND_OFF, "{off:.1e}");
    for pair in &results.states[0].pairs {
        assert!((pair.pressure / 10.0 - 1.0).abs() < ROUND_OFF, "{pair:?}");
    }
}
