//! Tests of every generator with every element shape, and of every refusal.

mod cylinder;
mod disc;
mod parts;

use super::ContactSize;
use crate::mesh::{Curve, Mesh, Shape, surface, validate};

/// Area of a body: corners by the shoelace formula, plus 2/3 of chord times sag for each parabolic
/// side.
pub(super) fn area(mesh: &Mesh, body: &str) -> f64 {
    let body = mesh.bodies.iter().position(|b| b == body).unwrap() as u32;
    let mut sum = 0.0;
    for element in (0..mesh.n_elements()).filter(|&e| mesh.element_body[e] == body) {
        let nodes = mesh.nodes(element);
        let n = mesh.shapes[element].n_corners();
        let at = |k: usize| mesh.in_plane(nodes[k] as usize);
        for k in 0..n {
            let (p, q) = (at(k), at((k + 1) % n));
            sum += 0.5 * (p[0] * q[1] - p[1] * q[0]);
            if mesh.shapes[element].is_quadratic() {
                let m = at(n + k);
                let sag = [m[0] - 0.5 * (p[0] + q[0]), m[1] - 0.5 * (p[1] + q[1])];
                sum += 2.0 / 3.0 * (sag[0] * (q[1] - p[1]) - sag[1] * (q[0] - p[0]));
            }
        }
    }
    sum
}

/// Checks the properties of every generated mesh: it is valid, no two bodies share a node, each
/// surface is one curve of facets on one body's boundary, and the exact normals of the surface
/// agree with those of its facets.
pub(super) fn check_common(mesh: &Mesh) {
    validate(mesh).unwrap();
    let mut owner = vec![None; mesh.n_nodes()];
    for element in 0..mesh.n_elements() {
        let body = mesh.element_body[element];
        for &node in mesh.nodes(element) {
            assert!(owner[node as usize].is_none_or(|b| b == body));
            owner[node as usize] = Some(body);
        }
    }
    for (name, surface) in &mesh.surfaces {
        let body = name.split('.').next().unwrap();
        for facet in &surface.facets {
            assert_eq!(
                mesh.bodies[mesh.element_body[facet.element] as usize], body,
                "{name}"
            );
        }
        let nodes = surface::ordered_nodes(mesh, surface).unwrap();
        assert_eq!(
            nodes
                .iter()
                .copied()
                .collect::<std::collections::BTreeSet<_>>(),
            mesh.set_nodes(name).unwrap().into_iter().collect(),
            "{name}"
        );
        let exact = surface::normals(mesh, surface, &nodes);
        let mut unknown = surface.clone();
        let Some(curve) = unknown.curve.take() else {
            // The part of the cylinder's surface that levels off is no simple curve.
            assert_eq!(name, "cylinder.outside");
            continue;
        };
        let averaged = surface::normals(mesh, &unknown, &nodes);
        // At the ends, where a single facet determines the normal, half the largest angle of a
        // facet bounds the deviation.
        let tolerance = match curve {
            Curve::Line { .. } => 1e-12,
            Curve::Circle { radius, .. } => surface
                .facets
                .iter()
                .map(|&f| {
                    let n: Vec<usize> = mesh.facet_nodes(f).collect();
                    let (p, q) = (mesh.in_plane(n[0]), mesh.in_plane(n[1]));
                    0.55 * (p[0] - q[0]).hypot(p[1] - q[1]) / radius
                })
                .fold(1e-12, f64::max),
            _ => unreachable!("a shape of solids"),
        };
        for ((e, a), node) in exact.iter().zip(&averaged).zip(&nodes) {
            assert!((e[0].hypot(e[1]) - 1.0).abs() < 4.0 * f64::EPSILON);
            assert!(
                (e[0] - a[0]).hypot(e[1] - a[1]) <= tolerance,
                "{name} node {node} {e:?} {a:?}"
            );
            if let Curve::Circle { center, radius, .. } = curve {
                let [x, y] = mesh.in_plane(*node);
                let off = (x - center[0]).hypot(y - center[1]) - radius;
                assert!(
                    off.abs() <= 4.0 * f64::EPSILON * (radius + center[0].abs() + center[1].abs())
                );
            }
        }
    }
    for nodes in mesh.node_sets.values() {
        assert_eq!(nodes.len(), 1);
    }
}

/// Number of nodes on a curve of `n` elements.
pub(super) fn nodes_on(n: usize, shape: Shape) -> usize {
    if shape.is_quadratic() {
        2 * n + 1
    } else {
        n + 1
    }
}

#[test]
fn exactly_one_source_is_needed() {
    use crate::scene::MeshSource;
    let none = super::from_source(
        &MeshSource::default(),
        None,
        |_| unreachable!(),
        |_| unreachable!(),
    )
    .unwrap_err();
    assert!(none.message().contains("0 sources"), "{none}");
    let two = MeshSource {
        parts: Some(Vec::new()),
        file: Some("a.msh".into()),
        ..MeshSource::default()
    };
    let two = super::from_source(&two, None, |_| unreachable!(), |_| unreachable!()).unwrap_err();
    assert!(two.message().contains("2 sources"), "{two}");
}

#[test]
fn the_source_decides_what_is_made() {
    use crate::scene::MeshSource;
    let source = MeshSource {
        cylinder_on_half_plane: Some(cylinder::example(Shape::Quad4)),
        ..MeshSource::default()
    };
    let mesh = super::from_source(
        &source,
        None,
        |p| Ok(ContactSize::at_yield(0.01 * p.radius)),
        |_| unreachable!(),
    )
    .unwrap();
    assert_eq!(mesh.bodies, ["cylinder", "half_plane"]);
    let source = MeshSource {
        disc_in_plate: Some(disc::example(8, Shape::Quad4)),
        ..MeshSource::default()
    };
    let mesh = super::from_source(&source, None, |_| unreachable!(), |_| unreachable!()).unwrap();
    assert_eq!(mesh.bodies, ["disc", "plate"]);
    let source = MeshSource {
        file: Some("no_such_file.msh".into()),
        ..MeshSource::default()
    };
    let error = super::from_source(
        &source,
        Some(std::path::Path::new("nowhere")),
        |_| unreachable!(),
        |_| unreachable!(),
    );
    let error = error.unwrap_err();
    assert_eq!(error.kind(), crate::ErrorKind::Io);
    assert!(error.message().contains("no_such_file.msh"), "{error}");
    assert!(error.message().contains("nowhere"), "{error}");
}
