//! A plane of symmetry that bounds a body, beyond which the stress continues as its mirror image.

use crate::space::{Vector, along, cross, dot, length};

/// Sine of the angle up to which directions count as equal, and share of a facet's length up to
/// which positions count as equal.
pub(super) const SAME: f64 = 1e-9;
/// Fraction of a facet's length within which a pair counts as lying on a plane.
pub(super) const ON_PLANE: f64 = 1e-6;

/// A plane `normal . x = offset`; the body lies where `normal . x` is smaller.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mirror {
    pub(super) normal: Vector,
    pub(super) offset: f64,
}

impl Mirror {
    /// Makes the plane with a unit normal that points away from the body.
    #[cfg(test)]
    pub(super) fn new(normal: Vector, offset: f64) -> Self {
        Mirror { normal, offset }
    }

    /// Unit normal of the plane, away from the body.
    pub fn normal(&self) -> Vector {
        self.normal
    }

    /// Mirror image of a point in the plane.
    pub fn image(&self, x: Vector) -> Vector {
        along(x, -2.0 * self.beyond(x), self.normal)
    }

    /// Whether two planes are parallel.
    pub fn is_parallel_to(&self, other: &Mirror) -> bool {
        length(cross(self.normal, other.normal)) < SAME
    }

    /// Whether a point lies on the plane, up to a small fraction of the length of facets there.
    pub fn holds(&self, x: Vector, facet_length: f64) -> bool {
        self.beyond(x).abs() <= ON_PLANE * facet_length
    }

    /// Signed distance of a point from the plane, positive on the side away from the body.
    pub fn beyond(&self, x: Vector) -> f64 {
        dot(self.normal, x) - self.offset
    }
}
