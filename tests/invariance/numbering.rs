//! Numbers of nodes and elements, order of bodies and contacts, which surface is called first.

use crate::support::{
    SMALL_BALL, SMALL_PUNCH, close, largest, load, parse, run, run_on, same_contact, state,
};
use brinell::mesh::{Facet, Mesh, Shape, gmsh};
use brinell::model::Model;
use brinell::results::{Results, State};
use brinell::scene::Scene;

/// A fixed shuffle of `0..n`: steps of the golden ratio, made prime to `n`.
fn shuffle(n: usize) -> Vec<usize> {
    let divides = |step: usize| (2..=step).any(|d| step.is_multiple_of(d) && n.is_multiple_of(d));
    let mut step = (n as f64 * 0.618) as usize + 1;
    while divides(step) {
        step += 1;
    }
    (0..n).map(|k| (k * step + 3) % n).collect()
}

/// An element whose corners are listed in another order: where its nodes come from, and which facet
/// each of its facets has become.
pub struct Turned {
    pub nodes: Vec<usize>,
    pub facets: Vec<usize>,
}

impl Turned {
    pub fn new(shape: Shape, corners: &[usize]) -> Turned {
        let row = shape.reference();
        let mut nodes = corners.to_vec();
        for edge in &row.edges[..row.nodes.len() - row.n_corners] {
            let ends = edge.map(|k| corners[k]);
            let same = |e: &[usize; 2]| e == &ends || e == &[ends[1], ends[0]];
            nodes.push(row.n_corners + row.edges.iter().position(same).unwrap());
        }
        let sorted = |mut list: Vec<usize>| {
            list.sort_unstable();
            list
        };
        let of_new = |facet: &[usize]| sorted(facet.iter().map(|&k| nodes[k]).collect());
        let facets = (row.facets.iter())
            .map(|old| {
                let same = |new: &&[usize]| of_new(new) == sorted(old.to_vec());
                row.facets.iter().position(same).unwrap()
            })
            .collect();
        Turned { nodes, facets }
    }
}

/// Corners from the `k`-th on: of a solid those of its lowest face are turned, with them those
/// above.
fn turn(shape: Shape, k: usize) -> Vec<usize> {
    let n = match shape.n_corners() {
        8 => 4,
        6 => 3,
        4 if shape.dimension() == 3 => 3,
        n => n,
    };
    let turned = |i: usize| match i / n {
        // The apex of a tetrahedron.
        1 if shape.n_corners() == n + 1 => i,
        row => row * n + (i + k) % n,
    };
    (0..shape.n_corners()).map(turned).collect()
}

/// The same mesh with other numbers of nodes and elements, and elements that begin at another
/// corner.
pub fn renumbered(mesh: &Mesh) -> Mesh {
    let (nodes, elements) = (shuffle(mesh.n_nodes()), shuffle(mesh.n_elements()));
    let d = mesh.dimension;
    let mut out = Mesh {
        dimension: d,
        coordinates: vec![0.0; mesh.coordinates.len()],
        bodies: mesh.bodies.clone(),
        ..Mesh::default()
    };
    for (old, &new) in nodes.iter().enumerate() {
        let x = mesh.point(old);
        out.coordinates[d * new..d * (new + 1)].copy_from_slice(&x[..d]);
    }
    let mut old_of = vec![0; elements.len()];
    for (old, &new) in elements.iter().enumerate() {
        old_of[new] = old;
    }
    // Where each element begins.
    let turned = |old: usize| {
        let shape = mesh.shapes[old];
        Turned::new(shape, &turn(shape, old % shape.n_corners()))
    };
    for &old in &old_of {
        let own = mesh.nodes(old);
        let turned = turned(old);
        let list: Vec<u32> = (turned.nodes.iter())
            .map(|&local| nodes[own[local] as usize] as u32)
            .collect();
        out.push_element(mesh.shapes[old], mesh.element_body[old] as usize, &list);
    }
    for (name, surface) in &mesh.surfaces {
        let mut surface = surface.clone();
        for facet in &mut surface.facets {
            *facet = Facet {
                element: elements[facet.element],
                local: turned(facet.element).facets[facet.local],
            };
        }
        surface.facets.reverse();
        out.surfaces.insert(name.clone(), surface);
    }
    for (name, set) in &mesh.node_sets {
        let mut set: Vec<usize> = set.iter().map(|&n| nodes[n]).collect();
        set.sort_unstable();
        out.node_sets.insert(name.clone(), set);
    }
    out
}

/// States with their pairs sorted by contact and position.
fn sorted(results: &Results) -> Vec<State> {
    let mut states = results.states.clone();
    for s in &mut states {
        s.pairs.sort_by(|a, b| {
            let key = |p: &brinell::results::PairState| (p.contact, p.position);
            key(a).partial_cmp(&key(b)).unwrap()
        });
    }
    states
}

/// Both runs end in the same states. Elastic: `tolerance` is round-off; plastic: that of the
/// plastic iteration and of gamma.
fn same(what: &str, a: &Results, b: &Results, tolerance: f64) {
    assert_eq!(a.states.len(), b.states.len(), "{what}");
    for (s, t) in sorted(a).iter().zip(&sorted(b)) {
        same_contact(&format!("{what}, state {}", s.name), s, t, tolerance);
        let strain = largest(a.states.iter().map(|s| s.max_equivalent_plastic_strain));
        close(
            what,
            s.max_equivalent_plastic_strain,
            t.max_equivalent_plastic_strain,
            strain,
            tolerance,
        );
        // A dent is a difference of movements: of gaps, and of strain times the size of the model
        // (about 1).
        let depth = largest(a.states.iter().flat_map(|s| &s.pairs).map(|p| p.gap)).max(strain);
        close(what, s.residual_depth, t.residual_depth, depth, tolerance);
    }
    if let (Some(x), Some(y)) = (a.first_yield, b.first_yield) {
        close(what, x.alpha, y.alpha, x.alpha, 1e-11);
    }
}

#[test]
fn numbers_of_nodes_and_elements_do_not_matter() {
    for (name, tolerance) in [
        ("hard/unload_reload", 1e-8),
        ("hard/zero_gap_conforming", 1e-10),
        ("hard/three_in_a_row", 1e-11),
        ("hard/interference", 1e-11),
        ("hard/all_closed", 1e-8),
    ] {
        let scene = load(name, &[]);
        let mesh = Model::new(&scene).unwrap().continuum.mesh;
        let other = renumbered(&mesh);
        assert_ne!(mesh.connectivity, other.connectivity);
        same(name, &run(&scene), &run_on(&scene, other), tolerance);
    }
}

/// A solid through a plastic history.
#[test]
fn numbers_of_solid_elements_do_not_matter() {
    let flow = "program.targets=[{ load_factor = 2.0 }, { load_factor = 0.0 }]";
    let ball = [&SMALL_BALL[..], &[flow]].concat();
    let scene = load("ball_on_flat_3d", &ball);
    let mesh = Model::new(&scene).unwrap().continuum.mesh;
    let other = renumbered(&mesh);
    assert_ne!(mesh.connectivity, other.connectivity);
    let (a, b) = (run(&scene), run_on(&scene, other));
    assert!(a.states[0].plastic_points > 0);
    same("ball", &a, &b, 1e-8);
}

#[test]
fn quadratic_elements_may_begin_at_any_corner() {
    let set = [
        "mesh.cylinder_on_half_plane.element=quad8",
        "mesh.cylinder_on_half_plane.resolution=2",
    ];
    let scene = load("hard/separation", &set);
    let mesh = Model::new(&scene).unwrap().continuum.mesh;
    same(
        "quad8",
        &run(&scene),
        &run_on(&scene, renumbered(&mesh)),
        1e-8,
    );
}

/// Through a file, with straight surfaces (the format has no curves).
#[test]
fn a_mesh_survives_gmsh_in_any_numbering() {
    for name in ["hard/three_in_a_row", "hard/floating_body", "three_bodies"] {
        let scene = load(name, &[]);
        let mesh = Model::new(&scene).unwrap().continuum.mesh;
        let mut text = Vec::new();
        gmsh::write(&renumbered(&mesh), &mut text).unwrap();
        let read = gmsh::parse(&text, "renumbered.msh").unwrap();
        let tolerance = if name == "three_bodies" { 1e-8 } else { 1e-10 };
        same(name, &run(&scene), &run_on(&scene, read), tolerance);
    }
}

/// Bodies and supports of a solid in the opposite order.
#[test]
fn the_order_in_a_solid_scene_does_not_matter() {
    let scene = load("square_punch", &SMALL_PUNCH);
    let mut other = scene.clone();
    other.mesh.parts.as_mut().unwrap().reverse();
    other.support.reverse();
    same("reversed", &run(&scene), &run(&other), 1e-8);
}

/// Bodies, contacts, supports and loads in the opposite order.
#[test]
fn the_order_in_the_scene_does_not_matter() {
    let scene = load("hard/three_in_a_row", &[]);
    let mut other = scene.clone();
    other.mesh.parts.as_mut().unwrap().reverse();
    other.support.reverse();
    other.contact.reverse();
    let (a, mut b) = (run(&scene), run(&other));
    for s in &mut b.states {
        for p in &mut s.pairs {
            p.contact = 1 - p.contact;
        }
    }
    same("reversed", &a, &b, 1e-11);
}

/// First and second surface swapped: the normal turns round, gaps and forces stay. On straight
/// surfaces.
#[test]
fn first_and_second_may_be_swapped() {
    for (name, overrides, tolerance) in [
        ("hard/three_in_a_row", &[][..], 1e-11),
        ("hard/lift_off", &[], 1e-11),
        ("hard/all_closed", &[], 1e-8),
        ("square_punch", &SMALL_PUNCH, 1e-8),
    ] {
        let scene = load(name, overrides);
        let mut other: Scene = scene.clone();
        for contact in &mut other.contact {
            std::mem::swap(&mut contact.first, &mut contact.second);
        }
        same(name, &run(&scene), &run(&other), tolerance);
    }
}

/// One load of 100 or two of 50 on the same place; a support twice.
#[test]
fn loads_add_up() {
    let text = std::fs::read_to_string(crate::support::scene_file("hard/three_in_a_row")).unwrap();
    let load = "[[load]]\nname = \"press\"\non = \"upper.pad\"\npressure = 100.0\n";
    assert!(text.contains(load));
    let half =
        |name: &str| format!("[[load]]\nname = \"{name}\"\non = \"upper.pad\"\npressure = 50.0\n");
    let split = text.replace(load, &(half("a") + &half("b")));
    let (a, b) = (run(&parse(&text)), run(&parse(&split)));
    same("split load", &a, &b, 1e-11);
    close(
        "force",
        state(&b, "half").contact_force,
        state(&a, "half").contact_force,
        100.0,
        1e-11,
    );
}
