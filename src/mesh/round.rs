//! Surfaces of a mesh file that, according to the scene, lie on a circle, a sphere, a cylinder or a
//! torus.

use super::{Curve, Mesh};
use crate::scene::MeshSource;
use crate::space::{Vector, along, difference, dot, in_words};
use crate::{Error, Result};

/// Largest distance of a node from its surface, as a fraction of the radius: files are written with
/// about six digits.
const OFF: f64 = 1e-5;

/// The exact shapes that the scene declares for surfaces of the file, each with the key that
/// declares it and the name of the surface.
pub fn declared(source: &MeshSource) -> Vec<(String, &str, Curve)> {
    let mut out = Vec::new();
    let mut add = |list: &str, index: usize, on, curve| {
        out.push((format!("mesh.{list}.{index}"), on, curve));
    };
    // Overwritten once the mesh is known, which shows the side on which the body lies.
    let outward = true;
    for (index, given) in source.circles.iter().enumerate() {
        let curve = Curve::Circle {
            center: given.center,
            radius: given.radius,
            outward,
        };
        add("circles", index, given.on.as_str(), curve);
    }
    for (index, given) in source.spheres.iter().enumerate() {
        let curve = Curve::Sphere {
            center: given.center,
            radius: given.radius,
            outward,
        };
        add("spheres", index, given.on.as_str(), curve);
    }
    for (index, given) in source.cylinders.iter().enumerate() {
        let curve = Curve::Cylinder {
            point: given.point,
            axis: given.axis,
            radius: given.radius,
            outward,
        };
        add("cylinders", index, given.on.as_str(), curve);
    }
    for (index, given) in source.tori.iter().enumerate() {
        let curve = Curve::Torus {
            center: given.center,
            axis: given.axis,
            ring: given.ring_radius,
            radius: given.radius,
            outward,
        };
        add("tori", index, given.on.as_str(), curve);
    }
    out
}

/// Assigns an exact round shape to a surface. Nodes of the surface are moved onto the shape (by the
/// digits that the file leaves out), normals become exact, and subdivision puts new nodes on the
/// shape. The side on which the body lies is determined from the facets.
///
/// # Errors
/// `Input` for an unknown surface, a shape of another dimension, a node that does not lie on the
/// shape, or facets that face both inward and outward.
pub fn lay_on(mesh: &mut Mesh, on: &str, curve: Curve) -> Result<()> {
    let Some(surface) = mesh.surfaces.get(on) else {
        let known: Vec<&str> = mesh.surfaces.keys().map(String::as_str).collect();
        return Err(Error::input(format!(
            "the mesh has no such surface; it has {}",
            known.join(", ")
        )));
    };
    let what = curve.name();
    if mesh.is_solid() == matches!(curve, Curve::Circle { .. }) {
        return Err(Error::input(match mesh.is_solid() {
            true => {
                "a circle is for plane meshes; give a sphere, a cylinder or a torus".to_string()
            }
            false => format!("a {what} is for solid meshes; give a circle"),
        }));
    }
    let mut outward = None;
    for &facet in &surface.facets {
        let points: Vec<Vector> = mesh.facet_nodes(facet).map(|n| mesh.point(n)).collect();
        let reference = mesh.facet_reference(facet);
        let at = (reference.functions)(reference.center());
        let middle =
            (points.iter().zip(at.values)).fold([0.0; 3], |sum, (x, value)| along(sum, value, *x));
        let Some((from, ..)) = curve.spine(middle) else {
            continue;
        };
        let away = dot(reference.area(&at, &points), difference(middle, from)) > 0.0;
        if *outward.get_or_insert(away) != away {
            return Err(Error::input(format!(
                "the body lies inside the {what} along one part of the surface and outside along \
                 another (element {}); check where it is, or make two surfaces of it",
                mesh.element_label(facet.element)
            )));
        }
    }
    let nodes = mesh.set_nodes(on).unwrap_or_default();
    let mut moved = Vec::with_capacity(nodes.len());
    for node in nodes {
        let x = mesh.point(node);
        let (Some((to, off)), Some((from, radius, _))) = (curve.nearest(x), curve.spine(x)) else {
            continue;
        };
        if off.is_nan() || off > OFF * radius {
            return Err(Error::input(format!(
                "node {} at {} lies {off:.3e} off the {what} round {} with radius {radius}; \
                 check its place and radius, and that mid-side nodes were exported curved",
                mesh.node_label(node),
                mesh.place(node),
                in_words(from, mesh.dimension),
            )));
        }
        moved.push((node, to));
    }
    let d = mesh.dimension;
    for (node, x) in moved {
        mesh.coordinates[d * node..d * (node + 1)].copy_from_slice(&x[..d]);
    }
    if let Some(surface) = mesh.surfaces.get_mut(on) {
        surface.curve = Some(curve.facing(outward.unwrap_or(true)));
    }
    Ok(())
}
