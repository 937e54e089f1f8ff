mod solid;

use super::*;
use crate::mesh::generate;
use crate::mesh::lay_on;
use crate::mesh::{Shape, validate};
use crate::scene::{CylinderOnHalfPlane, Part, Ring};

/// A quarter ring without the exact shapes of its surfaces, as from a file.
fn ring(element: Shape) -> Mesh {
    ring_of([3, 4], element)
}

fn ring_of(elements: [usize; 2], element: Shape) -> Mesh {
    let mut mesh = generate::parts(&[Part {
        body: "tube".into(),
        block: None,
        ring: Some(Ring {
            center: [0.0; 2],
            radius: [1.0, 2.0],
            angle: [0.0, 90.0],
            elements,
            bias: 1.0,
        }),
        disc: None,
        brick: None,
        element,
    }])
    .unwrap();
    mesh.surfaces.values_mut().for_each(|s| s.curve = None);
    mesh
}

fn circle(center: [f64; 2], radius: f64) -> Curve {
    Curve::Circle {
        center,
        radius,
        outward: true,
    }
}

/// Area by the divergence theorem over all sides, exact for parabolic sides.
fn area(mesh: &Mesh) -> f64 {
    let mut sum = 0.0;
    for element in 0..mesh.n_elements() {
        for local in 0..mesh.shapes[element].n_facets() {
            let x: Vec<[f64; 2]> = mesh
                .facet_nodes(Facet { element, local })
                .map(|n| mesh.in_plane(n))
                .collect();
            let cross = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
            let (p, q) = (x[0], x[1]);
            sum += 0.5 * cross(p, q);
            if let Some(m) = x.get(2) {
                let sag = [0, 1].map(|d| m[d] - 0.5 * (p[d] + q[d]));
                sum += 2.0 / 3.0 * cross(sag, [q[0] - p[0], q[1] - p[1]]);
            }
        }
    }
    sum
}

#[test]
fn the_body_the_surfaces_and_the_sets_stay() {
    for shape in Shape::PLANE {
        let mesh = ring(shape);
        let finer = subdivided(mesh.clone(), 2, &[]).unwrap();
        validate(&finer).unwrap();
        assert_eq!(finer.n_elements(), 16 * mesh.n_elements());
        assert_eq!(finer.shapes[0], shape);
        // Sides stay straight or become halves of the same parabola.
        assert!(
            (area(&finer) / area(&mesh) - 1.0).abs() < 1e-13,
            "{shape:?}"
        );
        assert_eq!(
            finer.coordinates[..mesh.coordinates.len()],
            mesh.coordinates
        );
        assert_eq!(finer.node_sets, mesh.node_sets);
        for (name, surface) in &mesh.surfaces {
            let fine = &finer.surfaces[name];
            assert_eq!(fine.facets.len(), 4 * surface.facets.len());
            let (old, new) = (
                super::super::surface::ordered_nodes(&mesh, surface).unwrap(),
                super::super::surface::ordered_nodes(&finer, fine).unwrap(),
            );
            let kept: Vec<usize> = new.into_iter().filter(|n| *n < mesh.n_nodes()).collect();
            assert_eq!(kept, old, "{shape:?} {name}");
        }
    }
}

#[test]
fn new_nodes_lie_on_the_circle_that_is_known_and_on_the_side_else() {
    for shape in Shape::PLANE {
        let off = |mesh: &Mesh, name: &str, radius: f64| -> f64 {
            let nodes = mesh.set_nodes(name).unwrap();
            let distances = nodes.iter().map(|&n| {
                let [x, y] = mesh.in_plane(n);
                (x.hypot(y) - radius).abs()
            });
            distances.fold(0.0, f64::max)
        };
        let mut mesh = ring(shape);
        let polygon = subdivided(mesh.clone(), 1, &[]).unwrap();
        // Sides span 22.5 degrees; parabolas come closer to the circle, but do not lie on it.
        let sag = 1.0 - (11.25f64).to_radians().cos();
        let expected = if shape.is_quadratic() { 0.0 } else { sag };
        assert!(
            (off(&polygon, "tube.inner", 1.0) - expected).abs() < 2e-4,
            "{shape:?}"
        );
        assert!(off(&polygon, "tube.inner", 1.0) > 1e-6);
        lay_on(&mut mesh, "tube.inner", circle([0.0; 2], 1.0)).unwrap();
        let round = subdivided(mesh, 3, &[]).unwrap();
        validate(&round).unwrap();
        assert!(
            off(&round, "tube.inner", 1.0) < 4.0 * f64::EPSILON,
            "{shape:?}"
        );
        assert!(off(&round, "tube.outer", 2.0) > 1e-6, "{shape:?}");
    }
}

#[test]
fn nodes_that_face_each_other_have_new_ones_that_do() {
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
        let mut mesh =
            generate::cylinder_on_half_plane(&parameters, generate::ContactSize::at_yield(0.5))
                .unwrap();
        mesh.surfaces.values_mut().for_each(|s| s.curve = None);
        lay_on(&mut mesh, "cylinder.contact", circle([0.0, 10.0], 10.0)).unwrap();
        for [first, second] in [
            ["cylinder.contact", "half_plane.contact"],
            ["half_plane.contact", "cylinder.contact"],
        ] {
            // The normal is vertical, whichever surface comes second.
            let contact = Contact {
                first: first.into(),
                second: second.into(),
                normal: Some([0.0, if first.starts_with('c') { 2.0 } else { -2.0 }].into()),
                ..Contact::default()
            };
            let finer = subdivided(mesh.clone(), 2, &[contact]).unwrap();
            let at = |name: &str| -> Vec<[f64; 2]> {
                let mut x: Vec<[f64; 2]> = finer
                    .set_nodes(name)
                    .unwrap()
                    .into_iter()
                    .map(|n| finer.in_plane(n))
                    .collect();
                x.sort_by(|a, b| a[0].total_cmp(&b[0]));
                x
            };
            let (round, flat) = (at("cylinder.contact"), at("half_plane.contact"));
            assert_eq!(round.len(), flat.len());
            assert!(round.len() > 4 * 6);
            for (r, f) in round.iter().zip(&flat) {
                assert!((r[0] - f[0]).abs() < 1e-14, "{shape:?}: {r:?} {f:?}");
                assert_eq!(f[1], 0.0);
                // The exact gap under the circle.
                let gap = r[0] * r[0] / (10.0 + (100.0 - r[0] * r[0]).sqrt());
                assert!((r[1] - gap).abs() < 1e-14, "{shape:?}: {r:?}");
            }
        }
    }
}

#[test]
fn without_a_circle_nodes_still_face_each_other() {
    // The lower side of the upper block is a polygon with unequal sides, and its partner is a
    // parabola.
    let mut mesh = ring(Shape::Tri6);
    let facing = ring(Shape::Tri6);
    let n = mesh.n_nodes();
    for node in 0..n {
        // The same ring, scaled by two, lies outside: its bore faces the rim.
        let [x, y] = facing.in_plane(node);
        mesh.coordinates.extend([2.0 * x, 2.0 * y]);
    }
    mesh.bodies.push("shell".into());
    for element in 0..facing.n_elements() {
        let nodes: Vec<u32> = facing.nodes(element).iter().map(|k| k + n as u32).collect();
        mesh.push_element(Shape::Tri6, 1, &nodes);
    }
    let bore = facing.surfaces["tube.inner"].facets.iter().map(|f| Facet {
        element: f.element + facing.n_elements(),
        ..*f
    });
    let bore = Surface {
        facets: bore.collect(),
        curve: None,
    };
    mesh.surfaces.insert("shell.inner".into(), bore);
    let contact = Contact {
        first: "shell.inner".into(),
        second: "tube.outer".into(),
        ..Contact::default()
    };
    let finer = subdivided(mesh, 1, std::slice::from_ref(&contact)).unwrap();
    let (first, second) = (
        &finer.surfaces["shell.inner"],
        &finer.surfaces["tube.outer"],
    );
    let found = partners(&finer, &contact, first, second);
    assert_eq!(found.len(), finer.set_nodes("tube.outer").unwrap().len());
    for (a, b) in found {
        let (a, b) = (finer.in_plane(a as usize), finer.in_plane(b as usize));
        assert!((a[0] - b[0]).hypot(a[1] - b[1]) < 1e-14, "{a:?} {b:?}");
    }
}

#[test]
fn what_cannot_be_subdivided_is_named() {
    let mut mesh = ring(Shape::Quad8);
    let nodes = mesh.set_nodes("tube.inner").unwrap();
    mesh.node_sets.insert("held".into(), nodes);
    let error = subdivided(mesh, 1, &[]).unwrap_err();
    for part in ["`held`", "node ", "element ", "surface"] {
        assert!(error.message().contains(part), "{error}");
    }
    let error = subdivided(ring(Shape::Tri3), 60, &[]).unwrap_err();
    assert!(
        error.message().starts_with("mesh.subdivisions = 60: 24"),
        "{error}"
    );
}

#[test]
fn a_surface_that_is_not_on_its_circle_is_named() {
    let refused = |on: &str, given: Curve| {
        let error = lay_on(&mut ring(Shape::Quad4), on, given).unwrap_err();
        error.message().to_string()
    };
    let error = refused("tube.inside", circle([0.0; 2], 1.0));
    assert!(
        error.contains("no such surface") && error.contains("tube.inner"),
        "{error}"
    );
    let error = refused("tube.inner", circle([0.0; 2], 1.1));
    assert!(error.contains("lies 1.000e-1 off"), "{error}");
    let error = refused("tube.inner", circle([f64::NAN, 0.0], 1.0));
    assert!(error.contains("off the circle"), "{error}");
    // The digits that a file leaves out are restored.
    let mut mesh = ring(Shape::Quad4);
    mesh.coordinates
        .iter_mut()
        .for_each(|c| *c = (*c * 1e6).round() / 1e6);
    lay_on(&mut mesh, "tube.outer", circle([0.0; 2], 2.0)).unwrap();
    for node in mesh.set_nodes("tube.outer").unwrap() {
        let [x, y] = mesh.in_plane(node);
        assert!((x.hypot(y) - 2.0).abs() < 1e-15);
    }
    let Some(Curve::Circle { outward, .. }) = mesh.surfaces["tube.outer"].curve else {
        panic!("no circle");
    };
    assert!(outward);
}
