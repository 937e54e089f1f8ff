//! The Jacobian of the map from the reference element, evaluated to check elements.

use super::{Integration, Shape};
use crate::shape::Functions;
use crate::space::{Vector, cross, dot, unit};

/// The shape functions at all places where the Jacobian of an element must be positive: the
/// integration points, and for a linear element also the corners.
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

/// The shape functions at all nodes of an element, corners and mid-side nodes.
pub(super) fn at_nodes(shape: Shape) -> Vec<Functions> {
    let places = shape.reference().nodes.iter();
    places.map(|&place| shape.functions(place)).collect()
}

/// Determinant of the Jacobian of an element with the given node positions.
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
