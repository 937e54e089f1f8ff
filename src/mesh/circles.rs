//! A surface of a mesh file that a scene says lies on a circle.

use super::{Curve, Mesh};
use crate::scene::SurfaceCircle;
use crate::{Error, Result};

/// Share of the radius that a node may lie off its circle: files are written with some six digits.
const OFF: f64 = 1e-5;

/// Gives a surface its circle: its nodes are moved onto it (what the digits of the file left out),
/// normals become exact, and subdivision puts new nodes on the circle.
///
/// # Errors
/// Input errors: an unknown surface, a node that does not lie on the circle, facets that face both
/// inward and outward.
pub fn lay_on_circle(mesh: &mut Mesh, given: &SurfaceCircle) -> Result<()> {
    let Some(surface) = mesh.surfaces.get(&given.on) else {
        let known: Vec<&str> = mesh.surfaces.keys().map(String::as_str).collect();
        return Err(Error::input(format!(
            "the mesh has no such surface; it has {}",
            known.join(", ")
        )));
    };
    let ([cx, cy], radius) = (given.center, given.radius);
    let mut outward = None;
    for &facet in &surface.facets {
        let ends: Vec<[f64; 2]> = mesh
            .facet_nodes(facet)
            .take(2)
            .map(|n| mesh.in_plane(n))
            .collect();
        let (a, b) = (ends[0], ends[1]);
        // The body lies on the left of the facet.
        let normal = [b[1] - a[1], a[0] - b[0]];
        let from_center = [0.5 * (a[0] + b[0]) - cx, 0.5 * (a[1] + b[1]) - cy];
        let away = normal[0] * from_center[0] + normal[1] * from_center[1] > 0.0;
        if *outward.get_or_insert(away) != away {
            return Err(Error::input(format!(
                "the body lies inside the circle along one part of the surface and outside along another (element {}); \
                 check `center`, or make two surfaces of it",
                mesh.element_label(facet.element)
            )));
        }
    }
    let nodes = mesh.set_nodes(&given.on).unwrap_or_default();
    let mut moved = Vec::with_capacity(nodes.len());
    for node in nodes {
        let [x, y] = mesh.in_plane(node);
        let (dx, dy) = (x - cx, y - cy);
        let distance = dx.hypot(dy);
        let off = distance - radius;
        if off.is_nan() || off.abs() > OFF * radius {
            return Err(Error::input(format!(
                "node {} at ({x}, {y}) lies {:.3e} off the circle round ({cx}, {cy}) with radius {radius}; \
                 check center and radius, and that mid-side nodes were exported curved",
                mesh.node_label(node),
                off.abs()
            )));
        }
        moved.push((
            node,
            [cx + radius * (dx / distance), cy + radius * (dy / distance)],
        ));
    }
    for (node, x) in moved {
        mesh.coordinates[2 * node..2 * node + 2].copy_from_slice(&x);
    }
    if let Some(surface) = mesh.surfaces.get_mut(&given.on) {
        surface.curve = Some(Curve::Circle {
            center: given.center,
            radius,
            outward: outward.unwrap_or(true),
        });
    }
    Ok(())
}
