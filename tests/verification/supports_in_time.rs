//! Supports and prescribed displacements that begin or end within the program.

use crate::support::build::Build;
use crate::support::{close, load, run, same_contact, state};
use brinell::analysis::Analysis;
use brinell::linalg::Backend;
use brinell::mesh::Shape;
use brinell::model::{Model, ModelBuilder};
use brinell::progress::Silent;
use brinell::results::{Results, State};
use brinell::scene::{
    Body, Contact, Direction, Displacement, EquationTerm, History, Kind, Load, Material, Relative,
    Support, Target,
};
use brinell::{ErrorKind, Result};

const E: f64 = 1000.0;
const YIELD: f64 = 10.0;
const TANGENT: f64 = 100.0;

/// A unit cube that may bend in no direction: uniaxial stress along z.
fn cube() -> ModelBuilder {
    let mut builder = ModelBuilder::new(Kind::Solid);
    let corners = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 1.0],
        [1.0, 1.0, 1.0],
        [0.0, 1.0, 1.0],
    ];
    let material = Material {
        youngs_modulus: E,
        poissons_ratio: 0.3,
        yield_stress: Some(YIELD),
        tangent_modulus: Some(TANGENT),
        ..Material::default()
    };
    let body = Body {
        material: "m".into(),
        ..Body::default()
    };
    builder
        .nodes(corners.as_flattened())
        .unwrap()
        .elements(Shape::Hex8, "cube", &[0, 1, 2, 3, 4, 5, 6, 7])
        .unwrap()
        .node_set("x", &[0, 3, 4, 7])
        .unwrap()
        .node_set("y", &[0, 1, 4, 5])
        .unwrap()
        .node_set("z", &[0, 1, 2, 3])
        .unwrap()
        .node_set("top", &[4, 5, 6, 7])
        .unwrap()
        .material("m", material)
        .unwrap()
        .body("cube", body)
        .unwrap();
    for (on, axis) in [
        ("x", Direction::X),
        ("y", Direction::Y),
        ("z", Direction::Z),
    ] {
        builder.hold(on, axis);
    }
    reach(&mut builder, &[1.0, 2.0, 3.0]);
    builder
}

/// Adds targets at load factors.
fn reach(builder: &mut ModelBuilder, factors: &[f64]) {
    for &factor in factors {
        builder.reach(factor);
    }
}

fn force(rows: &[[f64; 2]]) -> Load {
    Load {
        name: "force".into(),
        on: "top".into(),
        force: Some([0.0, 0.0, 1.0].into()),
        history: History::Table(rows.to_vec()),
        ..Load::default()
    }
}

fn displaced(value: f64, rows: &[[f64; 2]]) -> Load {
    Load {
        name: "displaced".into(),
        on: "top".into(),
        displacement: Some(Displacement {
            z: Some(value.into()),
            ..Displacement::default()
        }),
        history: History::Table(rows.to_vec()),
        ..Load::default()
    }
}

fn computed(builder: &ModelBuilder) -> Result<Results> {
    Analysis::new(builder.build()?, Backend::default())?.run(&mut Silent)
}

/// Displacement along z of the top and force along z on it, in each state.
fn top(results: &Results) -> Vec<[f64; 2]> {
    assert!(results.incomplete.is_none(), "{:?}", results.incomplete);
    let of = |state: &State| {
        let fields = state.fields.as_ref().unwrap();
        let forces = (4..8).map(|node| fields.force[3 * node + 2]);
        [fields.displacement[3 * 6 + 2], forces.sum()]
    };
    results.states.iter().map(of).collect()
}

fn near(found: &[[f64; 2]], expected: [[f64; 2]; 3]) {
    for (found, expected) in found.iter().zip(expected) {
        close("displacement", found[0], expected[0], 0.1, 1e-9);
        close("force", found[1], expected[1], YIELD, 1e-9);
    }
}

/// Strain and plastic strain under a stress that grows beyond yield.
fn beyond_yield(stress: f64) -> [f64; 2] {
    let strain = YIELD / E + (stress - YIELD) / TANGENT;
    [strain, strain - stress / E]
}

/// A bar is pulled beyond yield by a force and fixed there. The force that is taken off goes into
/// the support; when this ends, the plastic strain is left.
#[test]
fn a_support_holds_where_the_nodes_are_and_lets_go() {
    let mut bar = cube();
    bar.load(force(&[[0.0, 0.0], [1.0, 15.0], [2.0, 0.0]]));
    bar.support(Support {
        on: "top".into(),
        fix: vec![Direction::Z],
        since: Some(1.0),
        until: Some([2.0, 3.0]),
        ..Support::default()
    });
    let results = computed(&bar).unwrap();
    let [strain, plastic] = beyond_yield(15.0);
    near(
        &top(&results),
        [[strain, 15.0], [strain, 15.0], [plastic, 0.0]],
    );
    // A leg of the program has one factorisation.
    assert_eq!(results.counts.factorizations, 3);
    let increments: Vec<usize> = results.history.iter().map(|row| row.increment).collect();
    let counted: Vec<usize> = (1..=increments.len()).collect();
    assert_eq!(increments, counted);
    assert!((results.first_yield.unwrap().load - YIELD).abs() < 1e-9);
}

/// What a load with the history "constant" takes over stays: a displacement as under a support, and
/// a difference of displacements.
#[test]
fn what_is_taken_over_stays_where_it_is() {
    let [strain, plastic] = beyond_yield(15.0);
    let rows = [[0.0, 0.0], [1.0, 15.0], [2.0, 0.0]];
    let over = Load {
        since: Some(1.0),
        until: Some([2.0, 3.0]),
        history: History::Constant,
        ..Load::default()
    };
    let mut bar = cube();
    bar.load(force(&rows)).load(Load {
        name: "stays".into(),
        on: "top".into(),
        displacement: displaced(1.0, &[]).displacement,
        ..over.clone()
    });
    let expected = [[strain, 15.0], [strain, 15.0], [plastic, 0.0]];
    near(&top(&computed(&bar).unwrap()), expected);
    // The height of the cube stays, against its bottom.
    let mut bar = cube();
    bar.load(force(&rows)).load(Load {
        name: "height".into(),
        on: "top".into(),
        relative: Some(Relative {
            direction: Direction::Z,
            value: 0.0,
            terms: vec![EquationTerm {
                on: "z".into(),
                direction: Direction::Z,
                coefficient: 1.0,
            }],
        }),
        ..over
    });
    let heights = top(&computed(&bar).unwrap());
    for (found, expected) in heights.iter().zip(expected) {
        close("height", found[0], expected[0], 0.1, 1e-9);
    }
}

/// A displacement that is prescribed from the start lets go beyond yield; one that is prescribed
/// later begins where the bar then is, and yields further from there.
#[test]
fn displacements_begin_where_the_nodes_are() {
    let mut bar = cube();
    let [strain, plastic] = beyond_yield(14.0);
    bar.load(Load {
        until: Some([1.0, 2.0]),
        ..displaced(strain, &[[0.0, 0.0], [1.0, 1.0]])
    });
    let [further, _] = beyond_yield(16.0);
    bar.load(Load {
        name: "again".into(),
        since: Some(2.0),
        ..displaced(further, &[[2.0, 0.0], [2.5, 0.6], [3.0, 1.0]])
    });
    let results = computed(&bar).unwrap();
    near(
        &top(&results),
        [[strain, 14.0], [plastic, 0.0], [further, 16.0]],
    );
}

/// A support may turn its axes, and may begin while nothing has yielded; yield is found later.
#[test]
fn first_yield_is_found_in_a_later_leg() {
    let mut bar = cube();
    bar.load(force(&[[0.0, 0.0], [1.0, 5.0], [2.0, 5.0], [3.0, 20.0]]));
    bar.support(Support {
        on: "x".into(),
        direction: Some([0.0, 1.0, 1.0].into()),
        since: Some(1.0),
        until: Some([2.0, 2.5]),
        ..Support::default()
    });
    let results = computed(&bar).unwrap();
    let [strain, _] = beyond_yield(20.0);
    let states = top(&results);
    assert!((states[2][0] - strain).abs() < 1e-9, "{states:?}");
    let first = results.first_yield.unwrap();
    assert!((first.alpha - 2.0 - 1.0 / 3.0).abs() < 1e-9, "{first:?}");
    assert!((first.load - YIELD).abs() < 1e-9, "{first:?}");
}

/// A roller beyond yield is fixed where it is pressed, and its load is taken off: nothing changes.
/// Once it is released, it leaves the dent that unloading leaves.
#[test]
fn a_roller_stays_pressed_where_it_is_fixed() {
    let mut scene = load("roller_on_plate", &[]);
    let twin = run(&scene);
    let targets = &mut scene.program.targets;
    targets.truncate(2);
    let name = |name: &str, factor: f64| Target {
        name: Some(name.into()),
        load_factor: Some(factor),
        ..targets[0].clone()
    };
    let more = [name("fixed", 2.0), name("released", 3.0)];
    targets.extend(more);
    scene.load[0].history = History::Table(vec![[0.0, 0.0], [1.5, 1.5], [2.0, 0.0]]);
    scene.support.push(Support {
        on: "roller.top".into(),
        fix: vec![Direction::Y],
        since: Some(1.5),
        until: Some([2.0, 3.0]),
        ..Support::default()
    });
    let results = run(&scene);
    let pressed = state(&results, "beyond yield");
    same_contact("the load", pressed, state(&twin, "beyond yield"), 1e-9);
    same_contact("fixed", state(&results, "fixed"), pressed, 1e-6);
    let [released, unloaded] = [state(&results, "released"), state(&twin, "unloaded")];
    let dents = [released, unloaded].map(|state| state.residual_depth);
    assert!((dents[0] / dents[1] - 1.0).abs() < 1e-3, "{dents:?}");
    assert_eq!(released.max_pressure, 0.0);
}

/// Nodes of both bodies of a contact are fixed and let go; what holds no longer is named.
#[test]
fn what_supports_leave_unheld_is_named() {
    let mut bar = cube();
    bar.load(force(&[[0.0, 0.0], [1.0, 5.0], [2.0, 5.0]]));
    bar.hold("top", Direction::X);
    let model: Model = bar.build().unwrap();
    let mut loose = model.scene.clone();
    loose.support[2].until = Some([1.0, 2.0]);
    // What a later leg lacks is told before the first begins.
    let error = Model::from_mesh(&loose, model.continuum.mesh.clone()).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Unheld);
    let said = error.to_string();
    assert!(said.contains("load `force` drives it"), "{said}");

    let mut touching = ModelBuilder::new(Kind::PlaneStrain);
    touching
        .nodes(&[0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0])
        .unwrap()
        .nodes(&[0.0, 1.0, 1.0, 1.0, 1.0, 2.0, 0.0, 2.0])
        .unwrap()
        .elements(Shape::Quad4, "low", &[0, 1, 2, 3])
        .unwrap()
        .elements(Shape::Quad4, "high", &[4, 5, 6, 7])
        .unwrap()
        .surface_of_nodes("face", &[2, 3])
        .unwrap()
        .surface_of_nodes("opposite", &[4, 5])
        .unwrap()
        .surface_of_nodes("top", &[6, 7])
        .unwrap()
        .node_set("bottom", &[0, 1])
        .unwrap()
        .node_set("corner", &[2, 5])
        .unwrap()
        .node_set("left", &[0, 3, 4, 7])
        .unwrap()
        .material(
            "m",
            Material {
                youngs_modulus: E,
                ..Material::default()
            },
        )
        .unwrap();
    for name in ["low", "high"] {
        touching.of(name, "m");
    }
    touching
        .contact(Contact {
            first: "opposite".into(),
            second: "face".into(),
            held: true,
            ..Contact::default()
        })
        .load(Load {
            on: "top".into(),
            pressure: Some(1.0.into()),
            ..Load::default()
        });
    for (on, axis, since) in [
        ("bottom", Direction::Y, None),
        ("left", Direction::X, None),
        ("corner", Direction::Y, Some(1.0)),
    ] {
        touching.support(Support {
            on: on.into(),
            fix: vec![axis],
            since,
            ..Support::default()
        });
    }
    reach(&mut touching, &[1.0, 2.0]);
    let error = touching.build().unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Unsupported);
    let said = error.to_string();
    assert!(
        said.contains("along its contact normal") && said.contains("take turns"),
        "{said}"
    );
}
