//! True shapes of surfaces: circles, spheres and cylinders on which their nodes lie.

use super::spheres::{self, BENT, LARGEST_TURN, OFF};
use crate::mesh::surface::ordered_nodes;
use crate::mesh::{Curve, Mesh, Surface};

/// Smallest number of nodes of a circle; fewer form a polygon.
const FEWEST: usize = 6;

/// The true shape of a surface: the one that the mesh knows, or the circle, sphere or cylinder on
/// which its nodes lie.
pub(in crate::model) fn true_shape(mesh: &Mesh, surface: &Surface) -> Option<Curve> {
    surface.curve.or_else(|| find(mesh, surface))
}

/// Finds the circle on which the nodes of a plane surface lie; in a solid the sphere or cylinder.
fn find(mesh: &Mesh, surface: &Surface) -> Option<Curve> {
    if mesh.is_solid() {
        return spheres::find(mesh, surface);
    }
    let nodes = ordered_nodes(mesh, surface).ok()?;
    if nodes.len() < FEWEST {
        return None;
    }
    let points: Vec<[f64; 2]> = nodes.iter().map(|&node| mesh.in_plane(node)).collect();
    let third = nodes.len() / 3;
    let (center, radius) = through([points[0], points[third], points[2 * third]])?;
    let far = |p: &[f64; 2]| (p[0] - center[0]).hypot(p[1] - center[1]);
    let steps = points
        .windows(2)
        .map(|p| (p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1]));
    let chord = steps.fold(0.0, f64::max);
    let depth = chord * chord / (8.0 * radius);
    let is_polygon = chord > 2.0 * radius * (0.5 * LARGEST_TURN).to_radians().sin();
    if is_polygon
        || depth <= BENT * chord
        || points.iter().any(|p| (far(p) - radius).abs() > OFF * depth)
    {
        return None;
    }
    // The body lies on the left of its boundary: inside a circle that runs counter-clockwise.
    let [a, b] = [points[0], points[1]];
    let [p, q] = [a, b].map(|x| [x[0] - center[0], x[1] - center[1]]);
    Some(Curve::Circle {
        center,
        radius,
        outward: p[0] * q[1] - p[1] * q[0] > 0.0,
    })
}

/// Centre and radius of the circle through three points; `None` if they lie on a straight line.
fn through([a, b, c]: [[f64; 2]; 3]) -> Option<([f64; 2], f64)> {
    let [p, q] = [b, c].map(|x| [x[0] - a[0], x[1] - a[1]]);
    let det = 2.0 * (p[0] * q[1] - p[1] * q[0]);
    let [pp, qq] = [p, q].map(|x| x[0] * x[0] + x[1] * x[1]);
    // Points on a straight line have no circle.
    if det.abs() <= BENT * pp.max(qq) {
        return None;
    }
    let way = [(q[1] * pp - p[1] * qq) / det, (p[0] * qq - q[0] * pp) / det];
    Some(([a[0] + way[0], a[1] + way[1]], way[0].hypot(way[1])))
}
