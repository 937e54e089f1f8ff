//! Integration over the facets of elements: tractions and nodal areas.

use crate::shape::{FACET_RULE, FacetReference, MAX_FACET_NODES};
use crate::space::Space;

/// An integration point on a facet.
#[derive(Debug, Clone, Copy)]
pub struct FacetPoint {
    /// Shape function values of the facet's nodes (ends first, then the mid-side node).
    pub values: [f64; MAX_FACET_NODES],
    /// Weight times length of the tangent, times circumference where axisymmetric.
    pub weight: f64,
    /// Coordinates.
    pub position: [f64; 2],
    /// Outward unit normal (the body is on the left from the first end to the second).
    pub normal: [f64; 2],
}

/// The points of a facet ([`FACET_RULE`]) with these nodes.
pub fn facet_points(
    space: Space,
    facet: &FacetReference,
    coordinates: &[[f64; 2]],
) -> [FacetPoint; 3] {
    FACET_RULE.map(|(s, weight)| {
        let (values, slopes) = (facet.functions)(s);
        let mut x = [0.0; 2];
        let mut tangent = [0.0; 2];
        for (i, c) in coordinates.iter().enumerate() {
            for d in 0..2 {
                x[d] += values[i] * c[d];
                tangent[d] += slopes[i] * c[d];
            }
        }
        let length = tangent[0].hypot(tangent[1]);
        FacetPoint {
            values,
            weight: weight * length * space.measure(x[0]),
            position: x,
            normal: [tangent[1] / length, -tangent[0] / length],
        }
    })
}
