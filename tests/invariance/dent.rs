//! The dent is a shape of the bodies: it does not depend on how far the candidates reach, on the
//! mesh, or on whether a force or a displacement led there.

use crate::support::{close, load, run, state};
use brinell::accuracy::{Effort, Extent, estimate};
use brinell::linalg::Backend;
use brinell::model::Model;
use brinell::progress::Silent;
use brinell::results::Results;
use brinell::scene::Scene;

const SCENES: [&str; 2] = ["cylinder_on_half_plane", "ball_on_half_space"];
const PRESSED: &str = "program.targets=[{yield=true},{name=\"pressed\",load_factor=1.5},\
    {name=\"unloaded\",load_factor=0.0,fields=true}]";

/// The dent of a run and its stated error.
fn dent(scene: &Scene) -> [f64; 2] {
    let results = run(scene);
    let accuracy = estimate(
        scene,
        Backend::default(),
        &results,
        Extent::Program,
        Effort::Full,
        &mut Silent,
    );
    let path = "states.unloaded.residual_depth";
    let row = accuracy.quantities.iter().find(|q| q.quantity == path);
    let stated = row
        .and_then(|q| q.error)
        .expect("the dent has a stated error");
    [state(&results, "unloaded").residual_depth, stated]
}

#[test]
fn strip_and_resolution_change_it_by_less_than_is_stated() {
    for name in SCENES {
        let of = |resolution: usize, width: f64| {
            dent(&load(
                name,
                &[
                    PRESSED,
                    &format!("mesh.cylinder_on_half_plane.resolution={resolution}"),
                    &format!("mesh.cylinder_on_half_plane.fine_width={width:?}"),
                ],
            ))
        };
        let meshes = [(12, 1.7), (12, 2.0), (12, 6.0), (8, 2.0), (20, 2.0)];
        let all = meshes.map(|(resolution, width)| of(resolution, width));
        for a in all {
            for b in all {
                let off = (a[0] - b[0]).abs();
                assert!(off <= a[1] + b[1], "{name}: {a:?} and {b:?}");
            }
        }
        println!("{name}: dents and stated errors {all:?}");
        // Before, relative to the outermost candidate, the strip alone changed it by 9 %. With 8
        // and 12 elements up to 21 % are stated now (the meshes there show no order), so that only
        // the finest is held to say more than that.
        let [dent, stated] = all[4];
        assert!(
            stated < 0.09 * dent,
            "{name}: {stated} of {dent} says nothing"
        );
    }
}

/// The state that a displacement of the loaded surface leads to is the one that the force leads to.
/// The displacement is a float and the increments end at other events: states are the same to the
/// tolerance of the plastic iteration (1e-10 of the force), which a dent, a hundredth of the
/// displacement, shows as 1e-7.
#[test]
fn force_and_displacement_lead_to_the_same_dent() {
    for name in SCENES {
        // The same mesh for both: by itself its candidates reach as far as either may take the
        // contact.
        let mesh = [
            "mesh.cylinder_on_half_plane.resolution=8",
            "mesh.cylinder_on_half_plane.contact_width=2.0",
        ];
        let stepping = "program.stepping=events";
        let mut scene = load(name, &[PRESSED, stepping, mesh[0], mesh[1]]);
        let by_force = run(&scene);
        let pressed = state(&by_force, "pressed");
        scene.program.unit = brinell::scene::Unit::Load;
        scene.program.targets.remove(0);
        scene.program.targets[0].load_factor = Some(1.0);
        scene.load[0].plane_force = None;
        scene.load[0].displacement = Some(brinell::scene::Displacement {
            x: None,
            y: Some((-pressed.approach).into()),
            z: None,
        });
        let by_displacement = run(&scene);
        let other = state(&by_displacement, "pressed");
        close("load", other.load, pressed.load, pressed.load, 1e-6);
        let depth = pressed.residual_depth;
        close("dent", other.residual_depth, depth, depth, 1e-6);
        for (a, b) in other
            .residual_depth_by_body
            .iter()
            .zip(&pressed.residual_depth_by_body)
        {
            close("share", *a, *b, depth, 1e-6);
        }
        close("rim", other.rim_height, pressed.rim_height, depth, 1e-6);
    }
}

/// Vertical displacement of a node set, its mean.
fn mean(model: &Model, results: &Results, set: &str) -> f64 {
    let nodes = model.mesh.set_nodes(set).expect("a set of the generator");
    let fields = state(results, "unloaded")
        .fields
        .as_ref()
        .expect("fields were asked for");
    let sum: f64 = nodes.iter().map(|&n| fields.displacement[2 * n + 1]).sum();
    sum / nodes.len() as f64
}

/// Let go, the bodies are where the dent says: the displacements that are written for the whole
/// mesh, which a full solve gives, have the same depth at the pole below bottom and top of the
/// model. They are right to the tolerance of a state's equilibrium, 1e-8 of the largest
/// displacement.
#[test]
fn it_is_what_the_displacements_show_after_unloading() {
    for name in SCENES {
        let scene = load(name, &[PRESSED, "mesh.cylinder_on_half_plane.resolution=8"]);
        let results = run(&scene);
        let model = Model::new(&scene).unwrap();
        let unloaded = state(&results, "unloaded");
        assert!(unloaded.contact_force <= 1e-9 * state(&results, "pressed").contact_force);
        let moved = |set: &str| mean(&model, &results, set);
        let cylinder = moved("cylinder.pole") - moved("cylinder.top");
        let half_plane = moved("half_plane.bottom") - moved("half_plane.pole");
        let largest = state(&results, "pressed").approach;
        let [first, second] = unloaded.residual_depth_by_body[..] else {
            panic!("two bodies: {:?}", unloaded.residual_depth_by_body)
        };
        close("upper", first, cylinder, largest, 1e-8);
        close("lower", second, half_plane, largest, 1e-8);
        let sum = first + second;
        close("sum", unloaded.residual_depth, sum, sum, 1e-14);
        // Of the dent's volume a rim shows what flows aside: lower than the dent is deep.
        assert!(unloaded.rim_height > 0.0 && unloaded.rim_height < unloaded.residual_depth);
    }
}

/// Whichever surface has the slaves.
#[test]
fn a_body_that_stays_elastic_has_no_share() {
    for slave in ["first", "second"] {
        let scene = load(
            "ball_on_half_space",
            &[
                PRESSED,
                "mesh.cylinder_on_half_plane.resolution=8",
                "bodies.cylinder.plastic=false",
                &format!("contact.0.slave={slave}"),
            ],
        );
        let results = run(&scene);
        let unloaded = state(&results, "unloaded");
        let [ball, flat] = unloaded.residual_depth_by_body[..] else {
            panic!("two bodies")
        };
        let depth = unloaded.residual_depth;
        assert!(depth > 0.0);
        close("ball", ball, 0.0, depth, 1e-9);
        close("flat", flat, depth, depth, 1e-9);
    }
}

/// Two blocks squeezed evenly, plane stress: each is left shorter by what its plastic strain makes
/// of its height of 1, `(600 - 500) / H = 0.1`. A load that presses elsewhere and hardly at all
/// does not move what it is measured from.
#[test]
fn a_load_beside_does_not_move_the_reference() {
    let scene = |beside: &str| {
        crate::support::parse(&format!(
            "kind = \"plane_stress\"
            mesh.parts = [
                {{ body = \"lower\", block = {{ x = [0.0,
                    2.0], y = [0.0, 1.0], elements = [4, 2] }} }},
                {{ body = \"upper\", block = {{ x = [0.0,
                    2.0], y = [1.0, 2.0], elements = [4, 2] }} }},
            ]
            materials.s.youngs_modulus = 2e5
            materials.s.poissons_ratio = 0.3
            materials.s.yield_stress = 500.0
            materials.s.plastic_modulus = 1000.0
            bodies = {{ lower = {{ material = \"s\" }}, upper = {{ material = \"s\" }} }}
            contact = [{{ first = \"upper.bottom\", second = \"lower.top\" }}]
            support = [
                {{ on = \"lower.bottom\", fix = [\"y\"] }},
                {{ on = \"lower.left\", fix = [\"x\"] }},
                {{ on = \"upper.left\", fix = [\"x\"] }},
            ]
            load = [{{ on = \"upper.top\", pressure = 600.0 }}{beside}]
            program.targets = [{{ load_factor = 1.0 }}]"
        ))
    };
    for beside in ["", ", { on = \"upper.right\", pressure = 1e-9 }"] {
        let results = run(&scene(beside));
        let state = &results.states[0];
        close("dent", state.residual_depth, 0.2, 0.2, 1e-8);
        for share in &state.residual_depth_by_body {
            close("share", *share, 0.1, 0.1, 1e-8);
        }
    }
}

/// Two blocks that never touch, squeezed from their sides until they flow: their faces come towards
/// each other. The depth is negative then, and the sum of the shares, as everywhere.
#[test]
fn faces_that_grow_towards_each_other_have_a_negative_depth() {
    let set = [
        "kind=plane_stress",
        "mesh.parts.1.block.y=[1.5, 2.5]",
        "materials.steel.yield_stress=500.0",
        "materials.steel.plastic_modulus=2e4",
        "load=[{name=\"a\",on=\"lower.right\",pressure=600.0},\
         {name=\"b\",on=\"upper.right\",pressure=500.1}]",
        "support=[{on=\"lower.bottom\",fix=[\"y\"]},{on=\"lower.left\",fix=[\"x\"]},\
         {on=\"upper.left\",fix=[\"x\"]},{on=\"upper.top\",fix=[\"y\"]}]",
        "program.targets=[{name=\"pressed\",load_factor=1.0},\
         {name=\"unloaded\",load_factor=0.0}]",
    ];
    let results = run(&load("contact_patch", &set));
    for state in &results.states {
        // Uniaxial flow that keeps its volume: half the plastic strain along x, of a height of 1.
        let strains = [100.0, 0.1].map(|beyond| beyond / 2e4);
        let grown: f64 = strains.iter().map(|strain| 0.5 * strain).sum();
        close("depth", state.residual_depth, -grown, grown, 1e-8);
        let shares: f64 = state.residual_depth_by_body.iter().sum();
        close("shares", shares, state.residual_depth, grown, 1e-12);
        close("rim", state.rim_height, 0.5 * strains[0], grown, 1e-8);
    }
}
