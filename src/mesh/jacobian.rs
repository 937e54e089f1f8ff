//! The Jacobian of the map from the reference element, where an element is checked.

use super::{Integration, Shape};
use crate::shape::Functions;
use crate::space::{Vector, cross, dot, unit};

/// The shape functions where the Jacobian of an element must be positive: at the points that it is
/// integrated with; at the corners, too, if it is linear.
pub(super) fn integrated(shape: Shape, integration: Integration) -> Vec<Functions> {
    let corners = if shape.is_quadratic() {
        vec![]
    } else {
        at_nodes(shape)
    };
    let rules = [shape.reference().gauss, shape.rule(integration)];
    let points = rules.into_iter().flatten();
    corners
        .into_iter()
        .chain(points.map(|(place, _)| shape.functions(*place)))
        .collect()
}

/// The shape functions at corners and mid-side nodes.
pub(super) fn at_nodes(shape: Shape) -> Vec<Functions> {
    let places = shape.reference().nodes.iter();
    places.map(|&place| shape.functions(place)).collect()
}

/// Determinant of the Jacobian of an element with these node positions.
pub(super) fn determinant(dimension: usize, at: &Functions, points: &[Vector]) -> f64 {
    let mut along = [[0.0; 3]; 3];
    for (gradient, point) in at.gradients.iter().zip(points) {
        for (along, slope) in along.iter_mut().zip(gradient) {
            (0..3).for_each(|d| along[d] += slope * point[d]);
        }
    }
    if dimension == 2 {
        along[2] = unit(2);
    }
    dot(cross(along[0], along[1]), along[2])
}
