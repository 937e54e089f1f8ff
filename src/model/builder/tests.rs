//! Invalid arrays are refused with index and value, never with a panic.

use super::*;
use crate::ErrorKind;
use crate::mesh::{Curve, Shape};
use crate::scene::Direction;

/// Two unit squares, one at a distance of 0.01 above the other.
fn squares() -> ModelBuilder {
    let mut builder = ModelBuilder::new(Space::PlaneStrain);
    let steel = || Body {
        material: "steel".into(),
        ..Body::default()
    };
    builder
        .nodes(&[0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0])
        .and_then(|b| b.nodes(&[0.0, 1.01, 1.0, 1.01, 1.0, 2.01, 0.0, 2.01]))
        .and_then(|b| b.elements(Shape::Quad4, "lower", &[0, 1, 2, 3]))
        .and_then(|b| b.elements(Shape::Quad4, "upper", &[4, 5, 6, 7]))
        .and_then(|b| b.surface_of_nodes("floor", &[0, 1]))
        .and_then(|b| b.surface_of_nodes("face", &[2, 3]))
        .and_then(|b| b.surface("opposite", [(1, 0)]))
        .and_then(|b| b.surface_of_nodes("top", &[7, 6]))
        .and_then(|b| b.node_set("left", &[7, 0, 3, 4, 0]))
        .and_then(|b| b.material("steel", steel_values(0.3)))
        .and_then(|b| b.body("lower", steel()))
        .and_then(|b| b.body("upper", steel()))
        .unwrap()
        .load(Load {
            on: "top".into(),
            pressure: Some(10.0.into()),
            ..Load::default()
        });
    builder
}

fn steel_values(nu: f64) -> Material {
    Material {
        youngs_modulus: 210e3,
        poissons_ratio: nu,
        ..Material::default()
    }
}

fn held() -> ModelBuilder {
    let mut builder = squares();
    builder.contact(contact());
    hold(&mut builder, "floor", Direction::Y);
    hold(&mut builder, "left", Direction::X);
    builder
}

fn hold(builder: &mut ModelBuilder, on: &str, direction: Direction) {
    builder.support(Support {
        on: on.into(),
        fix: vec![direction],
        ..Support::default()
    });
}

fn contact() -> Contact {
    Contact {
        first: "opposite".into(),
        second: "face".into(),
        ..Contact::default()
    }
}

fn pair(first: usize, second: usize) -> NodePair {
    NodePair {
        first,
        second,
        normal: None,
        gap: None,
    }
}

fn refused<T>(result: Result<T>, kind: ErrorKind, words: &[&str]) {
    match result {
        Ok(_) => panic!("taken, although {words:?}"),
        Err(error) => {
            assert_eq!(error.kind(), kind, "{error}");
            for word in words {
                assert!(error.message().contains(word), "{error} lacks {word}");
            }
        }
    }
}

#[test]
fn a_model_of_two_squares_has_its_sets_pairs_and_loads() {
    let model = held().build().unwrap();
    assert_eq!(model.mesh.node_sets["left"], [0, 3, 4, 7]);
    let pairs: Vec<_> = model
        .pairs
        .iter()
        .map(|p| (p.masters[0].0, p.slave))
        .collect();
    assert_eq!(pairs, [(5, 2), (4, 3)]);
    for pair in &model.pairs {
        assert_eq!(pair.normal, [0.0, 1.0, 0.0]);
        assert!((pair.gap - 0.01).abs() < 4.0 * f64::EPSILON);
    }
    assert_eq!(model.scene.program.targets[0].load_factor, Some(1.0));
    assert_eq!(model.loads[0].magnitude, 10.0);
}

#[test]
fn given_pairs_replace_the_geometry() {
    let mut builder = squares();
    let given = NodePair {
        normal: Some([0.1, 2.0, 0.0]),
        gap: Some(0.5),
        ..pair(5, 2)
    };
    builder.contact_pairs(contact(), &[given]).unwrap();
    hold(&mut builder, "floor", Direction::Y);
    hold(&mut builder, "left", Direction::X);
    let model = builder.build().unwrap();
    assert_eq!(model.pairs.len(), 1);
    let pair = &model.pairs[0];
    assert_eq!((pair.masters[0].0, pair.slave, pair.gap), (5, 2, 0.5));
    let length = 0.1f64.hypot(2.0);
    assert_eq!(pair.normal, [0.1 / length, 2.0 / length, 0.0]);
    // Only the node's share of the surface belongs to the pair.
    assert!((pair.area - 0.5).abs() < 1e-15);
}

#[test]
fn nodal_forces_are_summed_by_node_and_counted_for_the_whole() {
    let mut builder = held();
    builder
        .nodal_load(
            "push",
            &[6, 7, 6],
            &[[0.0, -1.0, 0.0], [0.0, -2.0, 0.0], [0.5, -3.0, 0.0]],
            History::Constant,
        )
        .unwrap()
        .symmetry(2);
    let model = builder.build().unwrap();
    let load = &model.loads[1];
    // The support at the left takes the force along x at node 7 only.
    let total: f64 = load.forces.iter().map(|(_, f)| f).sum();
    assert_eq!(total, -6.0 + 0.5);
    assert_eq!(load.magnitude, 1.0f64.hypot(12.0));
    assert_eq!(load.history, History::Constant);
}

#[test]
fn bad_nodes_and_elements_are_refused_by_index() {
    use ErrorKind::Input;
    let b = squares;
    refused(b().nodes(&[1.0]).map(drop), Input, &["1 coordinates"]);
    let nan = [3.0, f64::NAN];
    refused(
        b().nodes(&nan).map(drop),
        Input,
        &["node 8", "coordinate y", "NaN"],
    );
    refused(
        b().elements(Shape::Tri3, "x", &[0, 1]).map(drop),
        Input,
        &["2 node indices", "tri3"],
    );
    refused(
        b().elements(Shape::Tri3, "x", &[0, 1, 2, 3, 4, 8])
            .map(drop),
        Input,
        &["element 3", "node 2 is 8", "8 nodes"],
    );
    let mut inverted = held();
    inverted
        .nodes(&[5.0, 0.0, 6.0, 0.0, 6.0, 1.0])
        .and_then(|b| b.elements(Shape::Tri3, "lower", &[8, 10, 9]))
        .unwrap();
    refused(
        inverted.build(),
        Input,
        &["element 2", "lower", "inverted", "near node 8"],
    );
    let mut loose = held();
    loose.nodes(&[9.0, 9.0]).unwrap();
    refused(loose.build(), Input, &["1 nodes belong to no element: 8"]);
    refused(
        ModelBuilder::new(Space::PlaneStress).build(),
        Input,
        &["bodies"],
    );
    let mut negative = held();
    negative
        .mesh
        .coordinates
        .iter_mut()
        .step_by(2)
        .for_each(|r| *r -= 0.5);
    negative.scene.kind = Space::Axisymmetric;
    refused(negative.build(), Input, &["node 0", "-0.5"]);
}

#[test]
fn bad_sets_and_surfaces_are_refused_by_index() {
    use ErrorKind::Input;
    let b = squares;
    refused(b().node_set("s", &[0; 0]).map(drop), Input, &["`s`"]);
    refused(
        b().node_set("s", &[1, 88]).map(drop),
        Input,
        &["entry 1", "88", "8 nodes"],
    );
    refused(b().node_set("left", &[1]).map(drop), Input, &["already"]);
    refused(b().surface("left", [(0, 0)]).map(drop), Input, &["already"]);
    refused(b().surface("s", [(0, 0); 0]).map(drop), Input, &["`s`"]);
    refused(
        b().surface("s", [(0, 0), (7, 0)]).map(drop),
        Input,
        &["facet 1", "element 7", "2 elements"],
    );
    refused(
        b().surface("s", [(0, 4)]).map(drop),
        Input,
        &["facet 4", "element 0", "quad4"],
    );
    refused(
        b().surface_of_nodes("s", &[0, 1, 6]).map(drop),
        Input,
        &["node 6"],
    );
    let circle = Curve::Circle {
        center: [0.5, 2.0],
        radius: 1.0,
        outward: true,
    };
    refused(b().curve("face", circle).map(drop), Input, &["node 2"]);
    refused(b().curve("nose", circle).map(drop), Input, &["`nose`"]);
}

#[test]
fn a_facet_between_two_elements_is_no_surface() {
    let mut builder = ModelBuilder::new(Space::PlaneStrain);
    builder
        .nodes(&[0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0])
        .and_then(|b| b.elements(Shape::Tri3, "a", &[0, 1, 2, 0, 2, 3]))
        .unwrap();
    refused(
        builder.surface_of_nodes("inner", &[0, 2]).map(drop),
        ErrorKind::Input,
        &["node 0"],
    );
}

#[test]
fn bad_pairs_are_refused_by_index() {
    use ErrorKind::Input;
    let refuse = |pairs: &[NodePair], words: &[&str]| {
        refused(
            squares().contact_pairs(contact(), pairs).map(drop),
            Input,
            words,
        );
    };
    refuse(&[pair(5, 2), pair(5, 3)], &["pair 1", "node 5", "pair 0"]);
    refuse(&[pair(4, 4)], &["pair 0", "node 4"]);
    refuse(&[pair(9, 2)], &["pair 0", "node 9", "8 nodes"]);
    for gap in [-0.1, f64::NAN, f64::INFINITY] {
        let bad = NodePair {
            gap: Some(gap),
            ..pair(5, 2)
        };
        refuse(&[bad], &["pair 0", "gap", &gap.to_string()]);
    }
    for normal in [[0.0; 3], [f64::NAN, 1.0, 0.0], [1e300, f64::INFINITY, 0.0]] {
        let bad = NodePair {
            normal: Some(normal),
            ..pair(5, 2)
        };
        refuse(&[bad], &["pair 0", "normal"]);
    }
    let build = |pairs: &[NodePair]| {
        let mut builder = squares();
        builder.contact_pairs(contact(), pairs).unwrap();
        builder.build()
    };
    refused(
        build(&[pair(6, 2)]),
        Input,
        &["pair 0", "node 6", "`opposite`"],
    );
    refused(build(&[pair(5, 0)]), Input, &["pair 0", "node 0", "`face`"]);
    let into = NodePair {
        normal: Some([0.0, -1.0, 0.0]),
        ..pair(5, 2)
    };
    refused(build(&[into]), Input, &["pair 0", "into the second body"]);
    refused(build(&[]), Input, &["no pair of nodes is given"]);
}

#[test]
fn bad_values_and_names_are_refused() {
    use ErrorKind::Input;
    let mut nan = held();
    nan.material("bad", steel_values(f64::NAN)).unwrap();
    refused(nan.build(), Input, &["materials.bad.poissons_ratio", "NaN"]);
    refused(
        squares().material("steel", steel_values(0.3)).map(drop),
        Input,
        &["steel"],
    );
    refused(
        squares().body("lower", Body::default()).map(drop),
        Input,
        &["lower"],
    );
    let mut missing = held();
    hold(&mut missing, "flor", Direction::X);
    refused(missing.build(), Input, &["flor", "did you mean `floor`"]);
    let forces = |forces: &[[f64; 3]]| {
        held()
            .nodal_load("push", &[6, 7], forces, History::Proportional)
            .map(drop)
    };
    refused(forces(&[[0.0; 3]]), Input, &["2 nodes", "1 forces"]);
    refused(
        forces(&[[0.0; 3], [f64::INFINITY, 0.0, 0.0]]),
        Input,
        &["push", "node 7", "inf"],
    );
    let mut twice = held();
    let entry = Contact {
        first: "opposite".into(),
        second: "face".into(),
        ..Contact::default()
    };
    twice.contact(entry);
    refused(twice.build(), Input, &["is the slave of two contacts"]);
}

#[test]
fn a_body_that_nothing_holds_is_named() {
    let mut builder = squares();
    hold(&mut builder, "floor", Direction::Y);
    hold(&mut builder, "left", Direction::X);
    refused(builder.build(), ErrorKind::Unheld, &["upper"]);
}

#[test]
fn scene_text_says_the_rest_or_leaves_the_builder_as_it_was() {
    let mut builder = squares();
    let tables = "
        bodies = { other = { material = 'steel' } }
        contact = [{ first = 'opposite', second = 'face', gap = 0.5 }]
        support = [{ on = 'floor', fix = ['y'] }]
        load = [{ on = 'top', pressure = 3.0 }]
        program = { steps = 7, targets = [{ load_factor = 2.0 }] }
        analysis = { tolerance = 1e-9 }
    ";
    builder.tables(tables).unwrap();
    let scene = &builder.scene;
    assert_eq!(scene.contact.last().unwrap().gap, Some(0.5.into()));
    assert_eq!(scene.load.last().unwrap().pressure, Some(3.0.into()));
    assert_eq!((scene.program.steps, scene.analysis.tolerance), (7, 1e-9));
    let before = scene.clone();
    for (text, part) in [
        ("kind = 'solid'", "kind"),
        ("\nload = [{ on = 3 }]", "line 2"),
        (
            "load = [{ on = 'top' }]\nbodies.other = { material = 'steel' }",
            "given a material twice",
        ),
    ] {
        let error = builder.tables(text).map(drop).unwrap_err();
        assert!(error.message().contains(part), "{error}");
        assert_eq!(builder.scene, before);
    }
}
