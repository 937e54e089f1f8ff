//! True shapes of surfaces: circles, spheres and cylinders on which their nodes lie, and gaps
//! between the true surfaces.

use super::face::FacePlane;
use super::{Sides, spheres};
use crate::mesh::surface::ordered_nodes;
use crate::mesh::{Curve, Mesh, Surface};
use crate::space::{Vector, along, difference, dot, length};

/// Largest distance of a node from the circle at which the circle is recognised, relative to the
/// sagitta of the chords between nodes.
pub(super) const OFF: f64 = 1e-2;
/// Smallest ratio of sagitta to chord at which nodes count as off a straight line.
pub(super) const BENT: f64 = 1e-8;
/// Smallest number of nodes of a circle, and largest turn in degrees from one facet to the next:
/// otherwise the nodes form a polygon.
const FEWEST: usize = 6;
pub(super) const LARGEST_TURN: f64 = 30.0;
/// Fraction of a facet by which a point on the border of two facets may lie outside either.
const BORDER: f64 = 1e-6;

/// Finds the circle on which the nodes of a plane surface lie; in a solid the sphere or cylinder.
pub(super) fn find(mesh: &Mesh, surface: &Surface) -> Option<Curve> {
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

/// Master facet that the line along a slave's normal meets, with the gap.
pub(super) struct Met {
    pub gap: f64,
    pub masters: Vec<(usize, f64)>,
}

impl Sides<'_> {
    /// Finds, among some master facets, the one that the normal of a slave meets, and the gap
    /// there.
    pub(super) fn meet(&self, node: usize, normal: Vector, faced: &[usize]) -> Option<Met> {
        let mesh = self.entries.mesh;
        let x = mesh.point(node);
        let plane = FacePlane::new(x, normal, mesh.is_solid());
        let mut nearest: Option<(f64, Met)> = None;
        for &number in faced {
            let face = &self.masters[number];
            if dot(face.normal, normal) >= 0.0 {
                continue;
            }
            let Some(place) = face
                .locate(&plane, [0.0; 2])
                .filter(|&place| face.holds(place, BORDER))
            else {
                continue;
            };
            let (y, values) = face.at(place);
            let far = dot(difference(y, x), normal).abs();
            if nearest.as_ref().is_none_or(|(known, _)| far < *known) {
                let [own, other] = [(0, x), (1, y)].map(|(side, x)| self.truly(side, x, normal));
                let met = Met {
                    gap: dot(difference(other, own), normal),
                    masters: face.nodes.iter().copied().zip(values).collect(),
                };
                nearest = Some((far, met));
            }
        }
        nearest.map(|(_, met)| met)
    }

    /// Point at which the line through a point of a mesh's surface along a direction meets the true
    /// surface of the slave (0) or of the master (1).
    pub(super) fn truly(&self, side: usize, x: Vector, way: Vector) -> Vector {
        let Some(curve) = self.curves[side] else {
            return x;
        };
        let mut at = x;
        // Newton's method for the distance from the surface; it starts close, on a facet.
        for _ in 0..20 {
            let Some((from, radius, outward)) = curve.spine(at) else {
                return x;
            };
            let out = difference(at, from);
            let off = length(out) - radius;
            let sign = if outward { 1.0 } else { -1.0 };
            let slope = sign * dot(curve.normal(at), way);
            if slope.abs() < 0.1 {
                return x;
            }
            at = along(at, -off / slope, way);
            if off.abs() <= 4.0 * f64::EPSILON * radius {
                break;
            }
        }
        at
    }
}
