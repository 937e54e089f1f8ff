//! Rules of validation, one per row: a change that spoils a good scene, and words that the message
//! must contain.

use crate::scene::{
    Direction, Displacement, DisplacementTarget, History, Kind, MaterialRow, PlaneForce, Plastic,
    Reference, Ring, Scene, Target, Unit,
};
use crate::shape::Shape;

mod effects;
mod material;

/// The paper's first example, which has every kind of entry that the rules are about.
fn good() -> Scene {
    let text = include_str!("../../../data/scenes/cylinder_on_half_plane.toml");
    Scene::parse(text, "good.toml").unwrap()
}

/// A scene of one block, one ring and one disc.
fn parts() -> Scene {
    let text = r#"
        kind = "plane_strain"
        mesh.parts = [
            { body = "a", block = { x = [0, 1], y = [0, 1], elements = [1, 1], pieces = [
                { name = "p", side = "top", from = 0, to = 0.5 } ] } },
            { body = "b", ring = { radius = [1, 2], elements = [1, 1] } },
            { body = "c", disc = { radius = 1, elements = 2 } },
        ]
        materials.m = { youngs_modulus = 1, poissons_ratio = 0 }
        bodies = { a.material = "m", b.material = "m", c.material = "m" }
        load = [{ on = "a.p", force = [0, 0] }]
        program.targets = [{ load_factor = 1 }]
    "#;
    Scene::parse(text, "parts.toml").unwrap()
}

type Spoil = fn(&mut Scene);

fn refused(make: fn() -> Scene, cases: &[(Spoil, &str)]) {
    for (spoil, fragment) in cases {
        let mut scene = make();
        scene.validate().unwrap();
        spoil(&mut scene);
        match scene.validate() {
            Ok(()) => panic!("accepted, but expected {fragment:?}"),
            Err(error) => assert!(
                error.message().contains(fragment),
                "no {fragment:?} in {error}"
            ),
        }
    }
}

fn by_figure(set: impl Fn(&mut Target)) -> Target {
    let mut target = Target::default();
    set(&mut target);
    target
}

fn target(scene: &mut Scene, target: Target) {
    scene.program.targets = vec![target];
}

#[test]
fn mesh_sources() {
    macro_rules! cylinder {
        ($scene:ident) => {
            $scene.mesh.cylinder_on_half_plane.as_mut().unwrap()
        };
    }
    refused(
        good,
        &[
            (
                |s| s.mesh.cylinder_on_half_plane = None,
                "mesh: no mesh source; give exactly one of",
            ),
            (
                |s| s.mesh.file = Some("a.msh".into()),
                "2 of mesh source given",
            ),
            (
                |s| s.units.as_mut().unwrap().stress = "Pa".into(),
                "units.stress: \"Pa\" is not force over length squared: 1 N on 1 mm squared is \
                 1.0000e6 Pa",
            ),
            (|s| cylinder!(s).radius = -1.0, "radius: -1 must be greater"),
            (
                |s| cylinder!(s).resolution = 0,
                "resolution: 0 must be at least 1",
            ),
            (
                |s| cylinder!(s).growth = 0.9,
                "growth: 0.9 must be at least 1",
            ),
            (
                |s| cylinder!(s).far_size = Some(2.0),
                "far_size: 2 must be greater than fine_width",
            ),
            (
                |s| cylinder!(s).half_width = Some(10.0),
                "half_width: 10 must be less than",
            ),
            (
                |s| s.materials.get_mut("steel").unwrap().yield_stress = None,
                "half_width: is missing, and cannot be computed",
            ),
        ],
    );
    refused(
        || {
            let text = include_str!("../../../data/scenes/disc_in_plate.toml");
            Scene::parse(text, "disc.toml").unwrap()
        },
        &[
            (
                |s| s.mesh.disc_in_plate.as_mut().unwrap().resolution = 45,
                "mesh.disc_in_plate.resolution: 45 must be an even number",
            ),
            (
                |s| s.mesh.disc_in_plate.as_mut().unwrap().far_radius = 1.0,
                "mesh.disc_in_plate.far_radius: 1 must be greater than 1",
            ),
            (
                |s| s.mesh.disc_in_plate.as_mut().unwrap().interference = -10.0,
                "mesh.disc_in_plate.interference: -10 must be small",
            ),
            (
                |s| s.kind = Kind::Axisymmetric,
                "kind: disc_in_plate is a plane model",
            ),
        ],
    );
    macro_rules! part {
        ($scene:ident, $index:literal) => {
            $scene.mesh.parts.as_mut().unwrap()[$index]
        };
    }
    macro_rules! block {
        ($scene:ident) => {
            part!($scene, 0).block.as_mut().unwrap()
        };
    }
    refused(
        parts,
        &[
            (|s| part!(s, 0).block = None, "mesh.parts.0: no shape"),
            (
                |s| {
                    part!(s, 0).ring = Some(Ring {
                        center: [0.0; 2],
                        radius: [1.0, 2.0],
                        angle: [0.0, 90.0],
                        elements: [1, 1],
                        bias: 1.0,
                    })
                },
                "mesh.parts.0: 2 of shape given (block, ring)",
            ),
            (|s| block!(s).x = [1.0, 1.0], "block.x: [1, 1] must run"),
            (
                |s| block!(s).elements = [1, 0],
                "block.elements.1: 0 must be",
            ),
            (|s| block!(s).bias = [0.0, 1.0], "block.bias.0: 0 must be"),
            (
                |s| block!(s).pieces[0].side = "front".into(),
                "\"front\" is none of left",
            ),
            (
                |s| block!(s).pieces[0].name = "top".into(),
                "name of a side or corner",
            ),
            (
                |s| block!(s).pieces[0].to = 0.0,
                "from = 0 must be less than to = 0",
            ),
            (
                |s| {
                    s.kind = Kind::Axisymmetric;
                    block!(s).x = [-1.0, 1.0];
                },
                "block.x: -1 is left of the axis",
            ),
            (
                |s| part!(s, 1).ring.as_mut().unwrap().radius = [0.0, 1.0],
                "ring.radius: [0, 1]",
            ),
            (
                |s| part!(s, 1).ring.as_mut().unwrap().angle = [0.0, 400.0],
                "ring.angle: [0, 400]",
            ),
            (
                |s| part!(s, 2).disc.as_mut().unwrap().angle = [0.0, 45.0],
                "disc.angle: [0, 45]",
            ),
            (
                |s| part!(s, 2).disc.as_mut().unwrap().elements = 3,
                "disc.elements: 3 must be an even",
            ),
            (
                |s| part!(s, 1).body = "a".into(),
                "mesh.parts.1.body: \"a\" is used twice",
            ),
            (|s| s.mesh.parts = Some(vec![]), "mesh.parts: is empty"),
        ],
    );
    let mut scene = parts();
    scene.mesh.parts.as_mut().unwrap()[0].element = Shape::Tri3;
    scene.validate().unwrap();
}

#[test]
fn contact_supports_and_loads() {
    refused(
        good,
        &[
            (
                |s| s.contact[0].first = String::new(),
                "contact.0.first: is empty",
            ),
            (
                |s| s.contact[0].second = "cylinder.contact".into(),
                "contact.0.second: \"cylinder.contact\" cannot touch itself",
            ),
            (
                |s| s.contact[0].normal = Some([0.0, 0.0].into()),
                "contact.0.normal: [0, 0]",
            ),
            (
                |s| s.contact[0].gap = Some((-0.1).into()),
                "contact.0.gap: -0.1 is negative",
            ),
            (
                |s| s.contact[0].interference = f64::INFINITY.into(),
                "contact.0.interference: inf",
            ),
            (|s| s.support[1].fix.clear(), "support.1.fix: is empty"),
            (
                |s| s.support[1].fix = vec![Direction::X, Direction::X],
                "support.1.fix: names a direction twice",
            ),
            (
                |s| s.load[0].plane_force = None,
                "load.0: no load kind; give exactly one of force",
            ),
            (
                |s| s.load[0].pressure = Some(1.0.into()),
                "2 of load kind given (pressure, plane_force)",
            ),
            (
                |s| {
                    s.load[0].plane_force = None;
                    s.load[0].displacement = Some(Displacement::default());
                },
                "load.0.displacement: has no component",
            ),
            (
                |s| s.load[0].history = History::Table(vec![]),
                "load.0.history: is empty",
            ),
            (
                |s| s.load[0].history = History::Table(vec![[0.0, 1.0], [0.0, 2.0]]),
                "load.0.history.1: load factor 0 must be greater than 0",
            ),
            (
                |s| s.load.clear(),
                "load: there is no load, no interference and no initial stress",
            ),
            (
                |s| {
                    let again = s.load[0].clone();
                    s.load.push(again);
                },
                "load.1.name: \"press\" is the name of an earlier load",
            ),
        ],
    );
    let mut scene = good();
    scene.load[0].plane_force = Some(PlaneForce {
        direction: Direction::Y,
        total: 0.0,
    });
    scene.validate().unwrap();
}

#[test]
fn programs_settings_and_references() {
    refused(
        good,
        &[
            (|s| s.program.targets.clear(), "program.targets: is empty"),
            (|s| s.program.gamma = 0.0, "program.gamma: 0 must be"),
            (|s| s.program.gamma = 0.6, "program.gamma: 0.6 must be"),
            (|s| s.program.steps = 0, "program.steps: 0 must be"),
            (
                |s| s.analysis.tolerance = 1e-2,
                "analysis.tolerance: 1e-2 must lie",
            ),
            (
                |s| s.analysis.tolerance = 1e-15,
                "analysis.tolerance: 1e-15 must lie",
            ),
            (
                |s| s.analysis.max_iterations = 0,
                "analysis.max_iterations: 0",
            ),
            (
                |s| target(s, Target::default()),
                "program.targets.0: no target condition",
            ),
            (
                |s| {
                    let both = Target {
                        first_yield: true,
                        load_factor: Some(1.0),
                        ..Target::default()
                    };
                    target(s, both);
                },
                "2 of target condition given (yield, load_factor)",
            ),
            (
                |s| s.program.targets[1].name = Some("yield".into()),
                "program.targets.1.name: \"yield\" is the name of an earlier target",
            ),
            (
                |s| s.program.targets[4].half_width = Some(0.0),
                "program.targets.4.half_width: 0 must be greater",
            ),
            (
                |s| {
                    let both = Target {
                        residual_depth: Some(1e-3),
                        approach: Some(1.0),
                        ..Target::default()
                    };
                    target(s, both);
                },
                "2 of target condition given (residual_depth, approach)",
            ),
            (
                |s| target(s, by_figure(|t| t.contact_force = Some(-5.0))),
                "program.targets.0.contact_force: -5 must be greater",
            ),
            (
                |s| {
                    let named = |t: &mut Target| {
                        (t.residual_depth, t.body) = (Some(1.0), Some("roller".into()));
                    };
                    target(s, by_figure(named));
                },
                "targets.0.body: the scene has no body \"roller\"; it has cylinder, half_plane",
            ),
            (
                |s| {
                    let numbered = |t: &mut Target| {
                        (t.max_pressure, t.contact) = (Some(1.0), Some(2));
                    };
                    target(s, by_figure(numbered));
                },
                "program.targets.0.contact: 2: contacts count from 1, and the scene has 1",
            ),
            (
                |s| {
                    let of_contact = |t: &mut Target| {
                        (t.approach, t.contact) = (Some(1.0), Some(1));
                    };
                    target(s, by_figure(of_contact));
                },
                "program.targets.0.contact: belongs to `contact_force`",
            ),
            (
                |s| {
                    let of_body = |t: &mut Target| {
                        (t.approach, t.body) = (Some(1.0), Some("cylinder".into()));
                    };
                    target(s, by_figure(of_body));
                },
                "program.targets.0.body: belongs to `residual_depth`",
            ),
            (
                |s| {
                    target(s, by_figure(|t| t.residual_depth = Some(2.0)));
                    let less = by_figure(|t| t.residual_depth = Some(1.0));
                    s.program.targets.push(less);
                },
                "program.targets.1.residual_depth: 1 is less than the 2 of an earlier target",
            ),
            (
                |s| {
                    target(
                        s,
                        by_figure(|t| t.max_equivalent_plastic_strain = Some(0.1)),
                    );
                    s.bodies.values_mut().for_each(|b| b.plastic = Plastic::No);
                },
                "max_equivalent_plastic_strain: what yielding leaves, but no body",
            ),
            (
                |s| s.contact.clear(),
                "half_width: the scene has no contact",
            ),
            (
                |s| s.bodies.values_mut().for_each(|b| b.plastic = Plastic::No),
                "program.unit: \"yield\", but no body can yield",
            ),
            (
                |s| s.load[0].history = History::Constant,
                "program.unit: \"yield\", but no load changes with the load factor",
            ),
            (
                |s| s.load[0].history = History::Table(vec![[0.0, 0.0], [1.0, 1.0]]),
                "load.0.history: is a table over the load factor, but `unit = \"yield\"`",
            ),
            (
                |s| {
                    s.program.unit = Unit::Load;
                    s.load[0].history = History::Constant;
                    let moved = Target {
                        displacement: Some(DisplacementTarget {
                            on: "cylinder.top".into(),
                            direction: Direction::Y,
                            value: -0.1,
                        }),
                        ..Target::default()
                    };
                    target(s, moved);
                },
                "program.targets.0.displacement: no load changes",
            ),
            (
                |s| s.kind = Kind::Axisymmetric,
                "reference.0.hertz_line: line contact needs",
            ),
            (
                |s| s.reference[0].value = Some(1.0),
                "reference.0.value: belongs to a `quantity`",
            ),
            (
                |s| s.reference[0].hertz_line = None,
                "reference.0: no reference",
            ),
            (
                |s| {
                    s.reference[0].hertz_line = None;
                    s.reference[0].quantity = Some("yield.load".into());
                    s.reference[0].value = Some(1.0);
                },
                "reference.0.source: is missing",
            ),
        ],
    );
    let mut scene = good();
    scene.reference.push(Reference {
        hertz_line: None,
        hertz_point: None,
        hertz_ellipse: None,
        disc_in_plate: None,
        quantity: Some("yield.load".into()),
        at: None,
        body: None,
        value: Some(1.0),
        source: Some("hand".into()),
    });
    scene.validate().unwrap();
    // A quantity at a point needs coordinates, any other quantity must have none.
    let bad = |change: &dyn Fn(&mut Reference)| {
        let mut scene = scene.clone();
        change(scene.reference.last_mut().unwrap());
        scene.validate().unwrap_err().to_string()
    };
    let named = bad(&|r| r.quantity = Some("states.a.stress_xx".into()));
    assert!(named.contains("is one of a place"), "{named}");
    let named = bad(&|r| r.at = Some(vec![0.0, 0.0]));
    assert!(
        named.contains("belongs to a quantity of a place"),
        "{named}"
    );
    let place = |r: &mut Reference| {
        r.quantity = Some("states.a.pressure".into());
        r.at = Some(vec![0.0]);
        r.body = Some("nobody".into());
    };
    let named = bad(&place);
    assert!(
        named.contains("needs 2 coordinates, 1 are given"),
        "{named}"
    );
    assert!(named.contains("there is no body `nobody`"), "{named}");
}
