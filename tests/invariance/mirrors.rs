//! A mirrored model has mirrored results; half a model has those of the whole.

use crate::invariance::numbering::Turned;
use crate::support::{SMALL_BALL, close, largest, load, run, run_on};
use brinell::mesh::{Curve, Facet, Mesh, Shape};
use brinell::model::Model;
use brinell::results::{PairState, Results};
use brinell::scene::Scene;

/// Corners of an element in an order that is right-handed again after a reflection.
fn turned(shape: Shape) -> Turned {
    let corners: &[usize] = match (shape.dimension(), shape.n_corners()) {
        (2, 3) => &[0, 2, 1],
        (2, _) => &[0, 3, 2, 1],
        (_, 4) => &[0, 2, 1, 3],
        (_, 6) => &[0, 2, 1, 3, 5, 4],
        _ => &[0, 3, 2, 1, 4, 7, 6, 5],
    };
    Turned::new(shape, corners)
}

/// The mesh reflected in x = 0.
fn mirrored(mesh: &Mesh) -> Mesh {
    let mut out = Mesh {
        dimension: mesh.dimension,
        bodies: mesh.bodies.clone(),
        node_sets: mesh.node_sets.clone(),
        ..Mesh::default()
    };
    out.coordinates = mesh.coordinates.clone();
    for point in out.coordinates.chunks_mut(mesh.dimension) {
        point[0] = -point[0];
    }
    for e in 0..mesh.n_elements() {
        let own = mesh.nodes(e);
        let nodes = turned(mesh.shapes[e]).nodes;
        let nodes: Vec<u32> = nodes.into_iter().map(|i| own[i]).collect();
        out.push_element(mesh.shapes[e], mesh.element_body[e] as usize, &nodes);
    }
    for (name, surface) in &mesh.surfaces {
        let mut surface = surface.clone();
        for facet in &mut surface.facets {
            facet.local = turned(mesh.shapes[facet.element]).facets[facet.local];
        }
        surface.curve = surface.curve.map(|curve| match curve {
            Curve::Line { normal } => Curve::Line {
                normal: [-normal[0], normal[1]],
            },
            Curve::Circle {
                center,
                radius,
                outward,
            } => Curve::Circle {
                center: [-center[0], center[1]],
                radius,
                outward,
            },
            Curve::Plane { normal: [x, y, z] } => Curve::Plane { normal: [-x, y, z] },
            _ => unreachable!("no scene here has one"),
        });
        out.surfaces.insert(name.clone(), surface);
    }
    out
}

/// A half mesh (x >= 0) and its mirror image in one, joined at x = 0; the nodes there are the set
/// `axis`.
fn doubled(half: &Mesh) -> Mesh {
    let reflection = mirrored(half);
    let mut out = half.clone();
    out.node_labels.clear();
    out.element_labels.clear();
    let size = largest(half.coordinates.iter().copied());
    let mut axis = Vec::new();
    let mut new_of = Vec::with_capacity(half.n_nodes());
    for node in 0..half.n_nodes() {
        let x = reflection.point(node);
        if x[0].abs() <= 1e-12 * size {
            axis.push(node);
            new_of.push(node as u32);
        } else {
            new_of.push(out.n_nodes() as u32);
            out.coordinates.extend(&x[..2]);
        }
    }
    for e in 0..half.n_elements() {
        let nodes: Vec<u32> = reflection
            .nodes(e)
            .iter()
            .map(|&n| new_of[n as usize])
            .collect();
        out.push_element(half.shapes[e], half.element_body[e] as usize, &nodes);
    }
    let on_axis = |facet: Facet| {
        let mut nodes = half.facet_nodes(facet);
        nodes.all(|n| half.point(n)[0].abs() <= 1e-12 * size)
    };
    for (name, surface) in &reflection.surfaces {
        let own = out.surfaces.get_mut(name).unwrap();
        let n_elements = half.n_elements();
        // What was the cut is inside now.
        if half.surfaces[name].facets.iter().all(|&f| on_axis(f)) {
            own.facets.clear();
            continue;
        }
        own.facets.extend(surface.facets.iter().map(|f| Facet {
            element: f.element + n_elements,
            local: f.local,
        }));
        if let (Some(Curve::Line { normal: a }), Some(Curve::Line { normal: b })) =
            (own.curve, surface.curve)
            && a != b
        {
            own.curve = None;
        }
    }
    out.surfaces.retain(|_, surface| !surface.facets.is_empty());
    out.node_sets.clear();
    out.node_sets.insert("axis".into(), axis);
    out
}

/// The scene of the whole: supports on the cut become a support of the axis.
fn of_the_whole(scene: &Scene, mesh: &Mesh) -> Scene {
    let mut whole = scene.clone();
    let cut = |s: &brinell::scene::Support| !mesh.surfaces.contains_key(&s.on);
    let mut axis = scene.support.iter().find(|s| cut(s)).unwrap().clone();
    axis.on = "axis".into();
    whole.support.retain(|s| !cut(s));
    whole.support.push(axis);
    // Total forces in a scene with a symmetry are those of the whole.
    if scene.symmetry == 1
        && let Some(force) = whole.load.iter_mut().find_map(|l| l.plane_force.as_mut())
    {
        force.total *= 2.0;
    }
    whole.symmetry = 1;
    whole
}

fn at_right(pairs: &[PairState]) -> Vec<PairState> {
    let mut out: Vec<PairState> = pairs
        .iter()
        .copied()
        .filter(|p| p.position[0] >= -1e-12)
        .collect();
    out.sort_by(|a, b| {
        (a.contact, a.position[0])
            .partial_cmp(&(b.contact, b.position[0]))
            .unwrap()
    });
    out
}

/// The whole has the half's gaps and forces on its right side, and twice the force where the half
/// was cut.
fn half_of(whole: &Results, half: &Results, tolerance: f64) {
    assert_eq!(half.states.len(), whole.states.len());
    let all = |f: fn(&PairState) -> f64| largest(half.states.iter().flat_map(|s| &s.pairs).map(f));
    let (gap, force, pressure) = (all(|p| p.gap), all(|p| p.force), all(|p| p.pressure));
    let width = largest(half.states.iter().map(|s| s.half_width));
    for (s, t) in half.states.iter().zip(&whole.states) {
        let (halves, wholes) = (at_right(&s.pairs), at_right(&t.pairs));
        assert_eq!(halves.len(), wholes.len());
        assert!(halves.len() > 2);
        for (p, q) in halves.iter().zip(&wholes) {
            let share = if p.position[0].abs() < 1e-12 {
                2.0
            } else {
                1.0
            };
            close(
                &format!("{}: gap", s.name),
                q.gap,
                p.gap,
                gap.max(1e-300),
                tolerance,
            );
            close(
                &format!("{}: force", s.name),
                q.force,
                share * p.force,
                force,
                tolerance,
            );
            close(
                &format!("{}: pressure", s.name),
                q.pressure,
                p.pressure,
                pressure,
                tolerance,
            );
        }
        close("half width", t.half_width, s.half_width, width, tolerance);
        close("alpha", t.alpha, s.alpha, 1.0, tolerance);
        close(
            "strain",
            t.max_equivalent_plastic_strain,
            s.max_equivalent_plastic_strain,
            largest(half.states.iter().map(|s| s.max_equivalent_plastic_strain)),
            tolerance,
        );
        assert_eq!(t.plastic_points, 2 * s.plastic_points, "{}", s.name);
    }
    if let (Some(a), Some(b)) = (half.first_yield, whole.first_yield) {
        close("yield", b.alpha, a.alpha, a.alpha, 1e-10);
    }
}

#[test]
fn a_mirrored_model_has_the_same_results() {
    let small = [
        &SMALL_BALL[..],
        &["program.targets=[{ load_factor = 2.0 }]"],
    ]
    .concat();
    for (name, overrides, tolerance) in [
        ("hard/three_in_a_row", &[][..], 1e-11),
        ("hard/zero_gap_conforming", &[], 1e-10),
        ("hard/unload_reload", &[], 1e-8),
        ("ball_on_flat_3d", &small, 1e-8),
    ] {
        let scene = load(name, overrides);
        let mesh = Model::new(&scene).unwrap().continuum.mesh;
        let mut other = scene.clone();
        for contact in &mut other.contact {
            contact.normal = contact.normal.map(|n| {
                let [x, y, _] = n.vector();
                [-x, y].into()
            });
        }
        let (a, b) = (run(&scene), run_on(&other, mirrored(&mesh)));
        for (s, t) in a.states.iter().zip(&b.states) {
            let mut pairs = t.pairs.clone();
            for p in &mut pairs {
                p.position[0] = -p.position[0];
            }
            let key = |p: &PairState| (p.contact, p.position);
            pairs.sort_by(|p, q| key(p).partial_cmp(&key(q)).unwrap());
            let mut own = s.pairs.clone();
            own.sort_by(|p, q| key(p).partial_cmp(&key(q)).unwrap());
            let (gap, force) = (
                largest(own.iter().map(|p| p.gap)),
                largest(own.iter().map(|p| p.force)),
            );
            for (p, q) in own.iter().zip(&pairs) {
                close(name, q.gap, p.gap, gap, tolerance);
                close(name, q.force, p.force, force, tolerance);
            }
        }
    }
}

#[test]
fn half_a_stack_of_blocks_is_half_of_the_whole() {
    for name in ["hard/three_in_a_row", "hard/lift_off", "hard/floating_body"] {
        let scene = load(name, &[]);
        let mesh = doubled(&Model::new(&scene).unwrap().mesh);
        let whole = run_on(&of_the_whole(&scene, &mesh), mesh);
        half_of(&whole, &run(&scene), 1e-10);
    }
}

/// Every change of contact off the axis is a tie of left and right. (Elastic: the stress that
/// decides on first yield is recovered from the elements on one side of the axis in the half and on
/// both in the whole, so that yield loads differ by the mesh's error.)
#[test]
fn half_a_cylinder_is_half_of_the_whole() {
    let scene = load(
        "hard/unload_reload",
        &[
            "bodies.cylinder.plastic=false",
            "bodies.half_plane.plastic=false",
            "mesh.cylinder_on_half_plane.half_width=0.2",
            "program.unit=load",
            "program.targets=[{ load_factor = 1.0 }, { load_factor = 3.0 }, { load_factor = 0.5 }]",
        ],
    );
    let mesh = doubled(&Model::new(&scene).unwrap().mesh);
    let whole = run_on(&of_the_whole(&scene, &mesh), mesh);
    half_of(&whole, &run(&scene), 1e-10);
    // Left and right change together.
    assert!(whole.history.len() > 6);
    assert!(whole.history.iter().all(|row| row.closed_pairs % 2 == 1));
}
