//! Integration over the facets of elements: tractions and nodal areas.

use crate::shape::{FacetReference, MAX_FACET_NODES};
use crate::space::{Space, Vector, length};

/// An integration point on a facet.
#[derive(Debug, Clone, Copy)]
pub struct FacetPoint {
    /// Values of the shape functions of the facet's nodes (corners first, then mid-side nodes).
    pub values: [f64; MAX_FACET_NODES],
    /// Quadrature weight times length or area, times circumference if axisymmetric.
    pub weight: f64,
    /// Coordinates of the point.
    pub position: Vector,
    /// Outward unit normal at the point.
    pub normal: Vector,
}

/// Returns the integration points of a facet with the given nodes, by the facet's own rule.
pub fn facet_points(
    space: Space,
    facet: &FacetReference,
    nodes: &[Vector],
) -> impl Iterator<Item = FacetPoint> {
    facet.rule.iter().map(move |&(place, weight)| {
        let at = (facet.functions)(place);
        let mut position = [0.0; 3];
        for (value, x) in at.values.iter().zip(nodes) {
            (0..3).for_each(|d| position[d] += value * x[d]);
        }
        let area = facet.area(&at, nodes);
        let size = length(area);
        FacetPoint {
            values: std::array::from_fn(|k| at.values[k]),
            weight: weight * size * space.measure(position[0]),
            position,
            normal: area.map(|a| a / size),
        }
    })
}
