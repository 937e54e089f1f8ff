//! Subdivision of solids, whose elements are divided into eight.

use super::*;
use crate::mesh::{extruded, gmsh};
use crate::scene::{CurvedBodies, Extrusion, Meshed};
use crate::space::length;

/// A quarter of a tube, two elements long, extruded from a ring of plane elements.
fn tube(plane: Shape) -> Mesh {
    drawn(ring(plane))
}

fn drawn(ring: Mesh) -> Mesh {
    let extrusion = Extrusion {
        depth: 0.7,
        elements: 2,
    };
    extruded(&ring, &extrusion).unwrap()
}

/// Blocks from a Gmsh file, with straight edges if `linear`.
fn tetrahedra(linear: bool) -> Mesh {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/data/meshes/blocks_tet10.msh");
    let mesh = gmsh::read(path.as_ref()).unwrap();
    if !linear {
        return mesh;
    }
    let mut out = Mesh {
        dimension: 3,
        bodies: mesh.bodies.clone(),
        surfaces: mesh.surfaces.clone(),
        ..Mesh::default()
    };
    let mut corners: Vec<u32> = Vec::new();
    for element in 0..mesh.n_elements() {
        corners.extend(&mesh.nodes(element)[..4]);
    }
    corners.sort_unstable();
    corners.dedup();
    for &node in &corners {
        out.coordinates.extend(mesh.point(node as usize));
    }
    for element in 0..mesh.n_elements() {
        let at = |n: &u32| corners.binary_search(n).unwrap() as u32;
        let nodes: Vec<u32> = mesh.nodes(element)[..4].iter().map(at).collect();
        out.push_element(Shape::Tet4, mesh.element_body[element] as usize, &nodes);
    }
    out
}

fn all() -> Vec<Mesh> {
    let mut out: Vec<Mesh> = Shape::PLANE.into_iter().map(tube).collect();
    out.extend([tetrahedra(true), tetrahedra(false)]);
    out
}

/// Volume of the mesh: a third of the flux of the position through the boundary of all elements, by
/// a rule that is exact for quadratic facets.
fn volume(mesh: &Mesh) -> f64 {
    let mut sum = 0.0;
    for element in 0..mesh.n_elements() {
        for local in 0..mesh.shapes[element].n_facets() {
            let facet = Facet { element, local };
            let (reference, nodes) = (mesh.facet_reference(facet), points(mesh, facet));
            for &(place, weight) in reference.rule {
                let at = (reference.functions)(place);
                let terms = at.values.iter().zip(&nodes);
                let x = terms.fold([0.0; 3], |sum, (v, node)| along(sum, *v, *node));
                sum += weight * dot(x, reference.area(&at, &nodes)) / 3.0;
            }
        }
    }
    sum
}

#[test]
fn bodies_and_surfaces_stay() {
    for (k, mesh) in all().into_iter().enumerate() {
        let shape = mesh.shapes[0];
        let times = if k == 0 { 2 } else { 1 };
        let finer = subdivided(mesh.clone(), times, &[]).unwrap();
        validate(&finer).unwrap();
        assert_eq!(
            finer.n_elements(),
            8usize.pow(times as u32) * mesh.n_elements()
        );
        assert_eq!(finer.shapes[0], shape);
        let (before, after) = (volume(&mesh), volume(&finer));
        assert!(
            (after / before - 1.0).abs() < 1e-12,
            "{shape:?}: {before} {after}"
        );
        assert_eq!(
            finer.coordinates[..mesh.coordinates.len()],
            mesh.coordinates
        );
        for (name, surface) in &mesh.surfaces {
            let per_facet = 4usize.pow(times as u32);
            assert_eq!(
                finer.surfaces[name].facets.len(),
                per_facet * surface.facets.len()
            );
            // Old nodes of the surface still lie on it, with its new nodes between them.
            let (old, new) = (mesh.set_nodes(name), finer.set_nodes(name).unwrap());
            let kept: Vec<usize> = new.into_iter().filter(|n| *n < mesh.n_nodes()).collect();
            assert_eq!(Some(kept), old, "{shape:?} {name}");
        }
    }
}

/// Children of tetrahedra do not become flatter with every subdivision.
#[test]
fn tetrahedra_keep_their_angles() {
    let flattest = |mesh: &Mesh| {
        let elements = 0..mesh.n_elements();
        let shares = elements.map(|element| {
            let x: Vec<Vector> = (mesh.nodes(element)[..4].iter())
                .map(|&n| mesh.point(n as usize))
                .collect();
            let [a, b, c] = [1, 2, 3].map(|k| difference(x[k], x[0]));
            let volume = dot(a, crate::space::cross(b, c)) / 6.0;
            let longest = (0..4).flat_map(|i| (0..i).map(move |j| (i, j)));
            let longest = longest.map(|(i, j)| length(difference(x[i], x[j])));
            volume / longest.fold(0.0, f64::max).powi(3)
        });
        shares.fold(f64::INFINITY, f64::min)
    };
    let mesh = tetrahedra(true);
    let [once, twice, thrice] =
        [1, 2, 3].map(|times| flattest(&subdivided(mesh.clone(), times, &[]).unwrap()));
    assert!(once > 0.3 * flattest(&mesh), "{once} {}", flattest(&mesh));
    assert!(
        twice > 0.99 * once && thrice > 0.99 * once,
        "{once} {twice} {thrice}"
    );
}

/// New nodes lie on both cylinders of a tube, and the volume converges to the tube's with the order
/// of the facets. New nodes in between must follow, because the facets of the thin tube sag by its
/// thickness.
#[test]
fn new_nodes_lie_on_cylinders_and_those_between_follow() {
    for (shape, outer) in [
        (Shape::Quad4, 1.02),
        (Shape::Quad8, 1.02),
        (Shape::Tri3, 1.3),
        (Shape::Tri6, 1.3),
    ] {
        let mut mesh = drawn(ring_of([1, 4], shape));
        for node in 0..mesh.n_nodes() {
            let [x, y, _] = mesh.point(node);
            let r = x.hypot(y);
            let factor = (1.0 + (outer - 1.0) * (r - 1.0)) / r;
            mesh.coordinates[3 * node] *= factor;
            mesh.coordinates[3 * node + 1] *= factor;
        }
        mesh.surfaces.values_mut().for_each(|s| s.curve = None);
        for (name, radius) in [("tube.inner", 1.0), ("tube.outer", outer)] {
            let curve = Curve::Cylinder {
                point: [0.0; 3],
                axis: [0.0, 0.0, 2.0],
                radius,
                outward: true,
            };
            lay_on(&mut mesh, name, curve).unwrap();
        }
        let exact = std::f64::consts::PI / 4.0 * (outer * outer - 1.0f64) * 0.7;
        let mut errors = Vec::new();
        for times in 0..4 {
            let finer = subdivided(mesh.clone(), times, &[]).unwrap();
            validate(&finer).unwrap();
            for node in finer.set_nodes("tube.outer").unwrap() {
                let [x, y, _] = finer.point(node);
                assert!((x.hypot(y) - outer).abs() < 1e-15, "{shape:?}");
            }
            errors.push((volume(&finer) / exact - 1.0).abs());
        }
        let order = (errors[1] / errors[2]).log2();
        let expected = if shape.is_quadratic() { 4.0 } else { 2.0 };
        assert!((order - expected).abs() < 0.2, "{shape:?} {errors:?}");
    }
}

/// Nodes of curved bodies whose exact surfaces are not known face each other, and so do the new
/// nodes.
#[test]
fn solid_faces_go_on_facing_each_other() {
    for element in [Shape::Hex8, Shape::Hex20] {
        let bodies = CurvedBodies {
            names: ["upper", "lower"].map(String::from),
            upper: [10.0, 20.0],
            lower: [0.0, -50.0],
            resolution: 3,
            semi_axes: None,
            model: Meshed::Quarter,
            fine_width: 2.0,
            contact_width: None,
            fine_depth: 2.0,
            far_size: 10.0,
            growth: 1.5,
            element,
        };
        let contact_size = generate::EllipseSize {
            semi_axes: [0.3, 0.2],
            reach: 2.0,
        };
        let mesh = generate::curved_bodies(&bodies, contact_size);
        let contact = Contact {
            first: "upper.contact".into(),
            second: "lower.contact".into(),
            ..Contact::default()
        };
        let finer = subdivided(mesh.unwrap(), 1, std::slice::from_ref(&contact)).unwrap();
        let [first, second] = ["upper.contact", "lower.contact"].map(|n| &finer.surfaces[n]);
        let found = partners(&finer, &contact, first, second);
        assert_eq!(found.len(), finer.set_nodes("lower.contact").unwrap().len());
        for (a, b) in found {
            let (a, b) = (finer.point(a as usize), finer.point(b as usize));
            let across = (a[0] - b[0]).hypot(a[1] - b[1]);
            assert!(across < 1e-13, "{element:?}: {a:?} {b:?}");
        }
    }
}
