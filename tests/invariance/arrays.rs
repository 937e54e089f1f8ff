//! A model from arrays gives bit for bit what the same model from a scene gives.

use crate::support::{SMALL_BALL, close, load, run_model, same_contact};
use brinell::linalg::Backend;
use brinell::mesh::Mesh;
use brinell::model::{Model, ModelBuilder, NodePair};
use brinell::results::Results;
use brinell::scene::Scene;

/// Hands the mesh and the entries of a scene over as arrays; `pairs` takes the place of the
/// contacts' geometry.
fn from_arrays(scene: &Scene, mesh: &Mesh, pairs: Option<&Model>) -> ModelBuilder {
    let mut builder = ModelBuilder::new(scene.kind);
    builder
        .title(&scene.title)
        .symmetry(scene.symmetry)
        .nodes(&mesh.coordinates)
        .unwrap();
    for element in 0..mesh.n_elements() {
        let body = &mesh.bodies[mesh.element_body[element] as usize];
        builder
            .elements(mesh.shapes[element], body, mesh.nodes(element))
            .unwrap();
    }
    for (name, nodes) in &mesh.node_sets {
        builder.node_set(name, nodes).unwrap();
    }
    for (k, (name, surface)) in mesh.surfaces.iter().enumerate() {
        // Every other one by its nodes: both ways must find the same facets.
        if k % 2 == 0 {
            let facets: Vec<_> = surface
                .facets
                .iter()
                .map(|f| (f.element, f.local))
                .collect();
            builder.surface(name, facets).unwrap();
        } else {
            let nodes = mesh.set_nodes(name).unwrap();
            builder.surface_of_nodes(name, &nodes).unwrap();
        }
        if let Some(curve) = surface.curve {
            builder.curve(name, curve).unwrap();
        }
    }
    for (name, material) in &scene.materials {
        builder.material(name, material.clone()).unwrap();
    }
    for (name, body) in &scene.bodies {
        builder.body(name, body.clone()).unwrap();
    }
    for (index, contact) in scene.contact.iter().enumerate() {
        match pairs {
            None => {
                builder.contact(contact.clone());
            }
            Some(model) => {
                let given: Vec<NodePair> = model
                    .pairs
                    .iter()
                    .filter(|p| p.contact == index)
                    .map(|p| NodePair {
                        first: p.masters[0].0,
                        second: p.slave,
                        normal: Some(p.normal),
                        gap: Some(p.gap),
                    })
                    .collect();
                builder.contact_pairs(contact.clone(), &given).unwrap();
            }
        }
    }
    for support in &scene.support {
        builder.support(support.clone());
    }
    for load in &scene.load {
        builder.load(load.clone());
    }
    builder
        .program(scene.program.clone())
        .settings(scene.analysis.clone());
    builder
}

/// All figures, each number to its last bit.
fn bits(results: &Results) -> String {
    assert!(!results.states.is_empty() && results.incomplete.is_none());
    format!(
        "{:?}\n{:?}\n{:?}\n{:?}",
        results.first_yield, results.states, results.history, results.counts
    )
}

fn same(name: &str, overrides: &[&str]) {
    let scene = load(name, overrides);
    let model = Model::new(&scene).unwrap();
    let expected = bits(&run_model(model.clone(), Backend::default()));
    let plain = from_arrays(&scene, &model.mesh, None).build().unwrap();
    assert!(
        bits(&run_model(plain, Backend::default())) == expected,
        "{name}: sets and surfaces"
    );
    let paired = from_arrays(&scene, &model.mesh, Some(&model));
    let paired = paired.build().unwrap();
    assert_eq!(paired.pairs, model.pairs, "{name}");
    assert!(
        bits(&run_model(paired, Backend::default())) == expected,
        "{name}: given pairs"
    );
}

#[test]
fn line_contact_with_flow_and_symmetry() {
    same(
        "cylinder_on_half_plane",
        &["mesh.cylinder_on_half_plane.resolution=5"],
    );
}

#[test]
fn point_contact_with_linear_elements() {
    same(
        "ball_on_half_space",
        &[
            "mesh.cylinder_on_half_plane.resolution=5",
            "mesh.cylinder_on_half_plane.element=quad4",
        ],
    );
}

#[test]
fn circular_contact_in_a_kirsch_field() {
    same("disc_in_plate", &["mesh.disc_in_plate.resolution=12"]);
}

#[test]
fn interference_without_load() {
    same("shrink_fit", &[]);
}

#[test]
fn a_solid_with_flow() {
    let flow = "program.targets=[{ load_factor = 2.0 }, { load_factor = 0.0 }]";
    same("ball_on_flat_3d", &[&SMALL_BALL[..], &[flow]].concat());
}

/// Pairs from the last to the first: the same to the round-off that a plastic history makes of it.
#[test]
fn the_order_of_pairs_does_not_matter() {
    let flow = "program.targets=[{ load_factor = 2.0 }, { load_factor = 0.0 }]";
    let ball = [&SMALL_BALL[..], &[flow]].concat();
    let cylinder = [flow, "mesh.cylinder_on_half_plane.resolution=5"];
    for (name, overrides) in [
        ("ball_on_flat_3d", &ball[..]),
        ("cylinder_on_half_plane", &cylinder[..]),
    ] {
        let scene = load(name, overrides);
        let model = Model::new(&scene).unwrap();
        let mut reversed = model.clone();
        reversed.pairs.reverse();
        let other = from_arrays(&scene, &model.mesh, Some(&reversed));
        let (a, b) = (
            run_model(model, Backend::default()),
            run_model(other.build().unwrap(), Backend::default()),
        );
        assert!(a.states[0].plastic_points > 0);
        for (s, t) in a.states.iter().zip(&b.states) {
            let mut t = t.clone();
            t.pairs
                .sort_by_key(|p| s.pairs.iter().position(|q| q.position == p.position));
            same_contact(name, s, &t, 1e-8);
            close(
                name,
                t.residual_depth,
                s.residual_depth,
                a.states[0].approach,
                1e-8,
            );
        }
    }
}

#[test]
fn three_bodies() {
    same("three_bodies", &[]);
}

/// Consistent nodal forces by hand stand for a pressure.
#[test]
fn nodal_forces_act_as_the_pressure_that_they_are_consistent_with() {
    let scene = load("hard/floating_body", &[]);
    let model = Model::new(&scene).unwrap();
    let expected = run_model(model.clone(), Backend::default());
    let entry = scene.load[0].clone();
    let nodes = model.mesh.set_nodes(&entry.on).unwrap();
    let pressure = entry.pressure.unwrap().uniform().unwrap();
    // The top of 8 equal quad4 elements over a width of 2.
    let forces: Vec<[f64; 3]> = nodes
        .iter()
        .map(|&n| model.mesh.point(n)[0])
        .map(|x| if x == 0.0 || x == 2.0 { 0.125 } else { 0.25 })
        .map(|width| [0.0, -pressure * width, 0.0])
        .collect();
    let mut without = scene.clone();
    without.load.clear();
    let mut builder = from_arrays(&without, &model.mesh, None);
    builder
        .nodal_load("by hand", &nodes, &forces, entry.history)
        .unwrap();
    let found = run_model(builder.build().unwrap(), Backend::default());
    for (a, b) in expected.states.iter().zip(&found.states) {
        for (p, q) in a.pairs.iter().zip(&b.pairs) {
            // Both solve the same system; the forces differ by the round-off of the integration.
            assert!((p.force - q.force).abs() <= 1e-12 * a.contact_force.max(p.force));
        }
        assert!((b.contact_force / a.contact_force - 1.0).abs() < 1e-12);
    }
}
