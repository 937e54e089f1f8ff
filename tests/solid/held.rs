//! Rigid motions, and supports at any angle in space.

use crate::support::build::{Build, elastic};
use crate::support::grid::{Grid, Point};
use crate::support::run_model;
use brinell::ErrorKind;
use brinell::analysis::Analysis;
use brinell::linalg::Backend;
use brinell::mesh::Shape;
use brinell::model::ModelBuilder;
use brinell::results::Results;
use brinell::scene::{Contact, Kind, Load};

/// Orthonormal rows: the axes of a block that stands askew.
const ASKEW: [Point; 3] = [
    [2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0],
    [3.0 / 7.0, -6.0 / 7.0, 2.0 / 7.0],
    [6.0 / 7.0, 2.0 / 7.0, -3.0 / 7.0],
];

fn body(builder: &mut ModelBuilder, name: &str, shape: Shape, map: &dyn Fn(Point) -> Point) {
    let cells = [2, 2, 2];
    Grid {
        name,
        cells,
        shape,
        map,
    }
    .add(builder);
    let steel = elastic(1000.0, 0.3);
    builder.material(name, steel).unwrap();
    builder.of(name, name);
}

fn pulled(builder: &mut ModelBuilder, on: &str, traction: Point) {
    builder.load(Load {
        on: on.into(),
        traction: Some(traction.into()),
        ..Load::default()
    });
}

fn run_to_the_load(builder: &mut ModelBuilder) -> Results {
    builder.reach(1.0);
    run_model(builder.build().unwrap(), Backend::Dense)
}

fn stresses_are(results: &Results, exact: [f64; 6], what: &str) {
    let fields = results.states[0].fields.as_ref().unwrap();
    for stress in fields.stress.chunks_exact(6) {
        for (s, exact) in stress.iter().zip(exact) {
            assert!((s - exact).abs() < 1e-9, "{what}: {stress:?}");
        }
    }
}

const X: Point = [1.0, 0.0, 0.0];
const Y: Point = [0.0, 1.0, 0.0];
const Z: Point = [0.0, 0.0, 1.0];

/// A block on which all but one rigid motion are held: a load that drives it is refused, and the
/// motion is named.
#[test]
fn each_of_the_six_rigid_motions_is_named() {
    // Corners and what they are held along: six constraints, all that a body needs.
    let corners: [(&str, Point, &[Point]); 3] = [
        ("a", [0.0, 0.0, 0.0], &[X, Y, Z]),
        ("b", [1.0, 0.0, 0.0], &[Y, Z]),
        ("c", [0.0, 1.0, 0.0], &[Z]),
    ];
    let of_corners = |without: (&str, Point), load: (&str, Point)| {
        let mut builder = ModelBuilder::new(Kind::Solid);
        body(&mut builder, "block", Shape::Hex8, &|x| x);
        for (name, at, directions) in corners {
            let nodes = builder.set_nodes("block.z0");
            let node = nodes.iter().find(|(_, x)| *x == at).unwrap().0;
            builder.node_set(name, &[node]).unwrap();
            for &direction in directions.iter().filter(|&&d| (name, d) != without) {
                builder.hold_along(name, direction);
            }
        }
        pulled(&mut builder, load.0, load.1);
        builder
    };
    let of_sides = |held: [(&str, Point); 2], load: (&str, Point)| {
        let mut builder = ModelBuilder::new(Kind::Solid);
        body(&mut builder, "block", Shape::Hex8, &|x| x);
        for (on, direction) in held {
            builder.hold_along(on, direction);
        }
        pulled(&mut builder, load.0, load.1);
        builder
    };
    let (x0, y0, z0) = (("block.x0", X), ("block.y0", Y), ("block.z0", Z));
    let slant = [0.0, 0.6, 0.8];
    for (builder, words) in [
        (of_sides([y0, z0], ("block.x1", X)), "move along x"),
        (of_sides([x0, z0], ("block.y1", Y)), "move along y"),
        (of_sides([x0, y0], ("block.z1", Z)), "move along z"),
        (
            of_corners(("c", Z), ("block.y1", Z)),
            "rotate about x through (",
        ),
        (
            of_corners(("b", Z), ("block.x1", Z)),
            "rotate about y through (",
        ),
        (
            of_corners(("b", Y), ("block.x1", Y)),
            "rotate about z through (",
        ),
        // About the line from b to c.
        (
            of_corners(("a", Z), ("block.x0", Z)),
            "rotate about (0.707, -0.707, 0.000) through (",
        ),
        // What is held is along x and across the slant.
        (
            of_sides([x0, ("block.z0", slant)], ("block.z1", Z)),
            "move along (0.000, 0.800, -0.600)",
        ),
    ] {
        let refused = builder.build().and_then(|model| {
            Analysis::new(model, Backend::Dense).map(|_| "it was taken".to_string())
        });
        let error = refused.unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Unheld, "{words}: {error}");
        let message = error.message();
        let opposite = words.replace("0.707, -0.707", "-0.707, 0.707");
        let opposite = opposite.replace("0.800, -0.600", "-0.800, 0.600");
        assert!(
            message.contains(words) || message.contains(&opposite),
            "{words}: {message}"
        );
        assert!(message.contains("body `block`"), "{message}");
    }
}

/// A body that nothing holds, pressed from both sides: its six motions are held where it does not
/// matter, and told.
#[test]
fn a_body_that_no_support_holds_and_no_load_drives() {
    let mut builder = ModelBuilder::new(Kind::Solid);
    body(&mut builder, "block", Shape::Hex8, &|x| x);
    let both = ["block.x0", "block.x1"].map(|side| builder.set_nodes(side));
    let both: Vec<usize> = both.iter().flatten().map(|(node, _)| *node).collect();
    builder.surface_of_nodes("ends", &both).unwrap();
    builder.press("ends", 10.0);
    let results = run_to_the_load(&mut builder);
    stresses_are(&results, [-10.0, 0.0, 0.0, 0.0, 0.0, 0.0], "free");
    let told = results
        .warnings
        .iter()
        .filter(|w| w.contains("no load drives it"));
    assert_eq!(told.count(), 6, "{:?}", results.warnings);
}

/// Loads of one history act together: two that press from both sides drive no motion, though each
/// alone would; if they differ, they do.
#[test]
fn two_loads_that_balance_drive_no_motion() {
    let pressed = |pressures: [f64; 2]| {
        let mut builder = ModelBuilder::new(Kind::Solid);
        body(&mut builder, "block", Shape::Hex8, &|x| x);
        builder.press("block.x0", pressures[0]);
        builder.press("block.x1", pressures[1]);
        builder
    };
    let results = run_to_the_load(&mut pressed([10.0, 10.0]));
    stresses_are(&results, [-10.0, 0.0, 0.0, 0.0, 0.0, 0.0], "free");
    let refused = pressed([10.0, 10.001]).build();
    let refused = refused.and_then(|model| Analysis::new(model, Backend::Dense).map(|_| ()));
    let error = refused.unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Unheld, "{error}");
    assert!(
        error.message().contains("drives it by 5.0e-5 of its size"),
        "{error}"
    );
}

/// A block askew in space, held on three of its sides: edges belong to two of them, a corner to
/// three. One stress everywhere, under every element; and so in two blocks in contact, whose pairs
/// lie on the edges.
#[test]
fn a_block_askew_between_three_planes() {
    let turned = |[x, y, z]: Point| -> Point {
        std::array::from_fn(|d| x * ASKEW[0][d] + y * ASKEW[1][d] + z * ASKEW[2][d])
    };
    // -10 along the third axis.
    let c = ASKEW[2];
    let exact = [
        c[0] * c[0],
        c[1] * c[1],
        c[2] * c[2],
        c[0] * c[1],
        c[1] * c[2],
        c[2] * c[0],
    ]
    .map(|cc| -10.0 * cc);
    for shape in Shape::SOLID {
        let mut builder = ModelBuilder::new(Kind::Solid);
        body(&mut builder, "lower", shape, &turned);
        builder.hold_along("lower.x0", ASKEW[0]);
        builder.hold_along("lower.y0", ASKEW[1]);
        builder.hold_along("lower.z0", ASKEW[2]);
        builder.press("lower.z1", 10.0);
        stresses_are(
            &run_to_the_load(&mut builder),
            exact,
            &format!("{shape:?}, one block"),
        );

        let mut builder = ModelBuilder::new(Kind::Solid);
        body(&mut builder, "lower", shape, &turned);
        body(&mut builder, "upper", shape, &|[x, y, z]| {
            turned([x, y, 1.0 + z])
        });
        for name in ["lower", "upper"] {
            builder.hold_along(format!("{name}.x0"), ASKEW[0]);
            builder.hold_along(format!("{name}.y0"), ASKEW[1]);
        }
        builder.hold_along("lower.z0", ASKEW[2]);
        builder.contact(Contact {
            first: "upper.z0".into(),
            second: "lower.z1".into(),
            ..Contact::default()
        });
        builder.press("upper.z1", 10.0);
        let results = run_to_the_load(&mut builder);
        stresses_are(&results, exact, &format!("{shape:?}, two blocks"));
        for pair in &results.states[0].pairs {
            assert!((pair.pressure - 10.0).abs() < 1e-9, "{shape:?} {pair:?}");
        }
    }
}
