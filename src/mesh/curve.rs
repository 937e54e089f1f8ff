//! Exact shapes of surfaces: lines, circles, planes, spheres, cylinders and tori.

use crate::space::{Vector, along, difference, direction, dot, in_space, length};
use serde::{Deserialize, Serialize};

/// The exact shape of a surface, if it is known. Normals are then exact at every node.
///
/// `outward` is true if the body's outward normal points away from the centre, the axis or the ring
/// (a disc, a shaft, a ball), and false for a hole or a groove.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Curve {
    /// A straight line with an outward unit normal.
    Line {
        /// Outward unit normal of the body.
        normal: [f64; 2],
    },
    /// A circular arc.
    Circle {
        /// Centre of the circle.
        center: [f64; 2],
        /// Radius of the circle.
        radius: f64,
        /// True if the body's outward normal points away from the centre (a disc), false for a
        /// hole.
        outward: bool,
    },
    /// A plane surface of a solid.
    Plane {
        /// Outward unit normal of the body.
        normal: Vector,
    },
    /// A part of a sphere.
    Sphere {
        /// Centre of the sphere.
        center: Vector,
        /// Radius of the sphere.
        radius: f64,
        /// True if the body's outward normal points away from the centre (a ball).
        outward: bool,
    },
    /// A part of a circular cylinder.
    Cylinder {
        /// A point of the axis.
        point: Vector,
        /// Direction of the axis.
        axis: Vector,
        /// Radius of the cylinder.
        radius: f64,
        /// True if the body's outward normal points away from the axis (a shaft).
        outward: bool,
    },
    /// A part of a torus: all points at distance `radius` from a circle.
    Torus {
        /// Centre of the ring.
        center: Vector,
        /// Direction of the ring's axis.
        axis: Vector,
        /// Radius of the ring.
        ring: f64,
        /// Radius of the tube, the distance of the surface from the ring.
        radius: f64,
        /// True if the body's outward normal points away from the ring.
        outward: bool,
    },
}

impl Curve {
    /// Point of the surface's spine that is nearest to `x`, with the radius and the value of
    /// `outward`. The spine is the centre, the axis or the ring from which the radius is measured.
    /// `None` for lines and planes.
    pub(crate) fn spine(&self, x: Vector) -> Option<(Vector, f64, bool)> {
        match *self {
            Curve::Line { .. } | Curve::Plane { .. } => None,
            Curve::Circle {
                center,
                radius,
                outward,
            } => Some((in_space(center), radius, outward)),
            Curve::Sphere {
                center,
                radius,
                outward,
            } => Some((center, radius, outward)),
            Curve::Cylinder {
                point,
                axis,
                radius,
                outward,
            } => {
                let axis = direction(axis);
                let nearest = along(point, dot(difference(x, point), axis), axis);
                Some((nearest, radius, outward))
            }
            Curve::Torus {
                center,
                axis,
                ring,
                radius,
                outward,
            } => {
                let axis = direction(axis);
                let way = difference(x, center);
                let across = along(way, -dot(way, axis), axis);
                Some((along(center, ring, direction(across)), radius, outward))
            }
        }
    }

    /// The outward unit normal at a point of the surface.
    pub fn normal(&self, x: Vector) -> Vector {
        match *self {
            Curve::Line { normal } => direction(in_space(normal)),
            Curve::Plane { normal } => direction(normal),
            _ => {
                let (from, _, outward) = self.spine(x).unwrap_or_default();
                let sign = if outward { 1.0 } else { -1.0 };
                direction(difference(x, from).map(|d| sign * d))
            }
        }
    }

    /// The point of a round surface nearest to `x`, and its distance from `x`; `None` for lines and
    /// planes.
    pub fn nearest(&self, x: Vector) -> Option<(Vector, f64)> {
        let (from, radius, _) = self.spine(x)?;
        let way = difference(x, from);
        Some((
            along(from, radius, direction(way)),
            (length(way) - radius).abs(),
        ))
    }

    /// A copy of the surface with `outward` set, so that the body lies on the chosen side of it.
    pub(crate) fn facing(self, outward: bool) -> Curve {
        let mut out = self;
        match &mut out {
            Curve::Line { .. } | Curve::Plane { .. } => {}
            Curve::Circle { outward: o, .. }
            | Curve::Sphere { outward: o, .. }
            | Curve::Cylinder { outward: o, .. }
            | Curve::Torus { outward: o, .. } => *o = outward,
        }
        out
    }

    /// All numbers that define the curve, in the order of the fields, and whether the normal points
    /// away from the centre.
    pub fn numbers(&self) -> (Vec<f64>, bool) {
        let join = |parts: &[&[f64]]| parts.concat();
        match self {
            Curve::Line { normal } => (normal.to_vec(), true),
            Curve::Plane { normal } => (normal.to_vec(), true),
            Curve::Circle {
                center,
                radius,
                outward,
            } => (join(&[center, &[*radius]]), *outward),
            Curve::Sphere {
                center,
                radius,
                outward,
            } => (join(&[center, &[*radius]]), *outward),
            Curve::Cylinder {
                point,
                axis,
                radius,
                outward,
            } => (join(&[point, axis, &[*radius]]), *outward),
            Curve::Torus {
                center,
                axis,
                ring,
                radius,
                outward,
            } => (join(&[center, axis, &[*ring, *radius]]), *outward),
        }
    }

    /// Name of the kind of curve, in words.
    pub fn name(&self) -> &'static str {
        match self {
            Curve::Line { .. } => "line",
            Curve::Circle { .. } => "circle",
            Curve::Plane { .. } => "plane",
            Curve::Sphere { .. } => "sphere",
            Curve::Cylinder { .. } => "cylinder",
            Curve::Torus { .. } => "torus",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::cross;

    /// Normals are unit vectors and perpendicular to the surface (checked by differences), and
    /// nearest points lie on the surface.
    #[test]
    fn nearest_points_lie_on_the_surface_along_the_normal() {
        let axis = [1.0, 2.0, -2.0];
        let point = [0.3, -0.1, 0.7];
        let shapes = [
            Curve::Sphere {
                center: point,
                radius: 2.0,
                outward: true,
            },
            Curve::Cylinder {
                point,
                axis,
                radius: 2.0,
                outward: false,
            },
            Curve::Torus {
                center: point,
                axis,
                ring: 5.0,
                radius: 2.0,
                outward: true,
            },
        ];
        for curve in shapes {
            let x = [3.0, 1.5, 2.0];
            let (on, off) = curve.nearest(x).unwrap();
            let (_, none) = curve.nearest(on).unwrap();
            assert!(none < 1e-14 && off > 0.01, "{curve:?}");
            let normal = curve.normal(on);
            assert!((length(normal) - 1.0).abs() < 1e-15);
            let way = difference(x, on);
            assert!(length(cross(way, normal)) < 1e-14, "{curve:?}");
            assert!((length(way) - off).abs() < 1e-14, "{curve:?}");
            let turned = curve.facing(!curve.numbers().1).normal(on);
            assert!((dot(turned, normal) + 1.0).abs() < 1e-14);
        }
    }
}
