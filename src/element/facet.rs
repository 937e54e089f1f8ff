//! Integration over the facets of elements: tractions and nodal areas.

use crate::scene::Kind;

/// An integration point on a facet.
#[derive(Debug, Clone, Copy)]
pub struct FacetPoint {
    /// Shape function values of the facet's nodes (ends first, then the mid-side node).
    pub values: [f64; 3],
    /// Weight times length of the tangent, times circumference where axisymmetric.
    pub weight: f64,
    /// Coordinates.
    pub position: [f64; 2],
    /// Outward unit normal (the body is on the left from the first end to the second).
    pub normal: [f64; 2],
}

/// Three-point Gauss rule on a facet with 2 or 3 nodes: exact to degree 5.
pub fn facet_points(kind: Kind, coordinates: &[[f64; 2]]) -> [FacetPoint; 3] {
    const G: f64 = 0.774_596_669_241_483_4;
    [(-G, 5.0 / 9.0), (0.0, 8.0 / 9.0), (G, 5.0 / 9.0)].map(|(s, weight)| {
        let (values, slopes) = if coordinates.len() == 2 {
            ([0.5 * (1.0 - s), 0.5 * (1.0 + s), 0.0], [-0.5, 0.5, 0.0])
        } else {
            (
                [0.5 * s * (s - 1.0), 0.5 * s * (s + 1.0), 1.0 - s * s],
                [s - 0.5, s + 0.5, -2.0 * s],
            )
        };
        let mut x = [0.0; 2];
        let mut tangent = [0.0; 2];
        for (i, c) in coordinates.iter().enumerate() {
            for d in 0..2 {
                x[d] += values[i] * c[d];
                tangent[d] += slopes[i] * c[d];
            }
        }
        let length = tangent[0].hypot(tangent[1]);
        let around = if kind == Kind::Axisymmetric {
            2.0 * std::f64::consts::PI * x[0]
        } else {
            1.0
        };
        FacetPoint {
            values,
            weight: weight * length * around,
            position: x,
            normal: [tangent[1] / length, -tangent[0] / length],
        }
    })
}
