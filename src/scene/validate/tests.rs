//! Rules of validation, one per row: a change that spoils a good scene, and words that the message
//! must contain.

use crate::scene::{
    Direction, Displacement, DisplacementTarget, History, Kind, MaterialRow, PlaneForce, Plastic,
    Reference, Ring, Scene, Target, Unit,
};
use crate::shape::Shape;

mod effects;
mod material;
mod program;

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

#[test]
fn sources_of_a_cylinder_on_a_half_plane() {
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
}

#[test]
fn sources_of_a_disc_in_a_plate() {
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
}

#[test]
fn parts_of_a_mesh() {
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
