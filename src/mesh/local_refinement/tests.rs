use super::*;
use crate::mesh::{Facet, Shape, generate, validate};
use crate::scene::{Block, CylinderOnHalfPlane, Disc, Part};

fn part(element: Shape) -> Part {
    Part {
        body: "body".into(),
        block: None,
        ring: None,
        disc: None,
        brick: None,
        element,
    }
}

/// A block of 4 by 3 units with elements of size 1.
fn block(element: Shape) -> Mesh {
    let block = Block {
        x: [0.0, 4.0],
        y: [0.0, 3.0],
        elements: [4, 3],
        bias: [1.0; 2],
        pieces: Vec::new(),
    };
    let block = Some(block);
    generate::parts(&[Part {
        block,
        ..part(element)
    }])
    .unwrap()
}

/// Half of a disc of radius 1 around the origin.
fn half_disc(element: Shape) -> Mesh {
    let disc = Disc {
        center: [0.0; 2],
        radius: 1.0,
        angle: [0.0, 180.0],
        elements: 8,
    };
    let disc = Some(disc);
    generate::parts(&[Part {
        disc,
        ..part(element)
    }])
    .unwrap()
}

fn around(at: [f64; 2], radius: f64, times: usize) -> LocalRefinement {
    LocalRefinement { at, radius, times }
}

fn area(mesh: &Mesh, element: usize) -> f64 {
    let x = |k: usize| {
        let nodes = mesh.nodes(element);
        mesh.point(nodes[k % mesh.shapes[element].n_corners()] as usize)
    };
    let n = mesh.shapes[element].n_corners();
    let twice = (0..n).map(|k| x(k)[0] * x(k + 1)[1] - x(k + 1)[0] * x(k)[1]);
    0.5 * twice.sum::<f64>()
}

/// Smallest angle of an element, in degrees.
fn sharpest(mesh: &Mesh, element: usize) -> f64 {
    let n = mesh.shapes[element].n_corners();
    let x = |k: usize| mesh.point(mesh.nodes(element)[k % n] as usize);
    let angle = |k: usize| {
        let [a, b] = [x(k + 1), x(k + n - 1)].map(|p| difference(p, x(k)));
        (dot(a, b) / length(a) / length(b)).acos().to_degrees()
    };
    (0..n).map(angle).fold(180.0, f64::min)
}

/// Sides that belong to one element only.
fn rim(mesh: &Mesh) -> HashSet<ElementSide> {
    let mut rim = HashSet::new();
    for side in (0..mesh.n_elements()).flat_map(|element| sides_of(mesh, element)) {
        if !rim.insert(side) {
            rim.remove(&side);
        }
    }
    rim
}

/// Numbers below 1, the same in every run.
fn evenly() -> impl FnMut() -> f64 {
    let mut seed = 7u64;
    move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (seed >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// A mesh without hanging nodes has all its single sides on the surfaces of the body, which keep
/// their length and their names; a hanging node would leave single sides inside.
#[test]
fn any_places_leave_a_mesh_without_hanging_nodes() {
    let mut random = evenly();
    for case in 0..200 {
        let shape = Shape::PLANE[case % 4];
        let places: Vec<LocalRefinement> = (0..1 + case % 3)
            .map(|_| {
                let at = [5.0 * random() - 0.5, 4.0 * random() - 0.5];
                around(at, 0.02 + 0.5 * random(), 1 + (5.0 * random()) as usize)
            })
            .collect();
        let mesh = block(shape);
        let finer = refined(mesh, &places, &[]).unwrap();
        validate(&finer).unwrap();
        let sum: f64 = (0..finer.n_elements()).map(|e| area(&finer, e)).sum();
        assert!((sum - 12.0).abs() < 1e-12, "{places:?}: {sum}");
        let names = ["left", "right", "top", "bottom"];
        let named = names.iter().flat_map(|name| {
            let facets = &finer.surfaces[&format!("body.{name}")].facets;
            facets.iter().map(|&Facet { element, local }| {
                let [a, b] = finer.shapes[element].reference().edges[local];
                let nodes = finer.nodes(element);
                ordered([nodes[a], nodes[b]])
            })
        });
        assert_eq!(rim(&finer), named.collect(), "{places:?}");
        let sharpest = (0..finer.n_elements()).map(|e| sharpest(&finer, e));
        let (sharpest, least) = (sharpest.fold(180.0, f64::min), of_one_cut(shape));
        assert!(
            sharpest > least - 0.1,
            "{shape:?} {places:?}: {sharpest} degrees"
        );
        // Next to each place the size is what is asked for.
        for place in &places {
            let near = (0..finer.n_elements()).filter(|e| distance(&finer, *e, place.at) == 0.0);
            for element in near {
                let whole = if shape.n_corners() == 3 { 0.5 } else { 1.0 };
                let most = whole * 0.25f64.powi(place.times as i32);
                assert!(area(&finer, element) < 1.001 * most, "{place:?}");
            }
        }
    }
}

/// The sharpest angle of the elements into which a square, or a triangle that is half of one, is
/// divided at some of its sides: no element is divided again at some of its sides.
fn of_one_cut(shape: Shape) -> f64 {
    match shape.n_corners() {
        3 => (1.0f64 / 3.0).atan().to_degrees(),
        _ => 0.5f64.atan().to_degrees(),
    }
}

#[test]
fn each_pass_divides_about_as_many_elements() {
    let count = |times| {
        let place = around([1.3, 3.0], 0.3 * 0.5f64.powi(times as i32), times);
        let finer = refined(block(Shape::Quad4), &[place], &[]).unwrap();
        finer.n_elements()
    };
    let [few, more, most] = [4, 8, 12].map(count);
    assert!(
        more - few < 4 * 60 && most - more < 4 * 60,
        "{few} {more} {most}"
    );
}

#[test]
fn new_nodes_lie_on_the_circle() {
    for shape in Shape::PLANE {
        let finer = refined(half_disc(shape), &[around([0.0, 1.0], 0.02, 5)], &[]).unwrap();
        validate(&finer).unwrap();
        let nodes = finer.set_nodes("body.outer").unwrap();
        for &node in &nodes {
            let [x, y] = finer.in_plane(node);
            assert!((x.hypot(y) - 1.0).abs() < 4.0 * f64::EPSILON);
        }
        let near = nodes.iter().filter(|n| finer.in_plane(**n)[0].abs() < 0.02);
        assert!(near.count() > 4, "{shape:?}");
    }
}

/// A place beside the contact, so that the disc cuts the two surfaces at different nodes: the
/// nodes pair one to one all the same.
#[test]
fn nodes_that_face_each_other_continue_to_do_so() {
    for shape in Shape::PLANE {
        let parameters = CylinderOnHalfPlane {
            names: ["cylinder", "half_plane"].map(String::from),
            radius: 10.0,
            resolution: 3,
            half_width: None,
            fine_width: 2.0,
            contact_width: None,
            fine_depth: 2.0,
            far_size: Some(10.0),
            growth: 1.3,
            far_growth: None,
            element: shape,
        };
        let size = generate::ContactSize::at_yield(0.5);
        let mesh = generate::cylinder_on_half_plane(&parameters, size).unwrap();
        let contact = Contact {
            first: "cylinder.contact".into(),
            second: "half_plane.contact".into(),
            normal: Some([0.0, 1.0].into()),
            ..Contact::default()
        };
        let places = [around([0.31, -0.2], 0.25, 3)];
        let finer = refined(mesh, &places, std::slice::from_ref(&contact)).unwrap();
        validate(&finer).unwrap();
        let [first, second] = [&contact.first, &contact.second].map(|name| {
            let nodes = finer.set_nodes(name).unwrap();
            (&finer.surfaces[name], nodes.len())
        });
        let found = partners(&finer, &contact, first.0, second.0);
        assert_eq!([found.len(); 2], [first.1, second.1], "{shape:?}");
    }
}

#[test]
fn what_cannot_be_refined_is_named() {
    let mut mesh = block(Shape::Quad4);
    let nodes = mesh.set_nodes("body.top").unwrap();
    mesh.node_sets.insert("held".into(), nodes);
    // Far from the set nothing of it is divided.
    assert!(refined(mesh.clone(), &[around([2.0, 0.0], 0.1, 2)], &[]).is_ok());
    let error = refined(mesh, &[around([2.0, 3.0], 0.1, 2)], &[]).unwrap_err();
    assert!(error.message().contains("`held`"), "{error}");
    let error = refined(block(Shape::Tri3), &[around([0.0; 2], 9.0, 20)], &[]).unwrap_err();
    assert!(
        error.message().starts_with("mesh.refine: in pass 11 of 20"),
        "{error}"
    );
}
