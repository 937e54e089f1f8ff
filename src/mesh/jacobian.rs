//! The Jacobian of the map from the reference element, where an element is checked.

use super::{Integration, Shape};
use crate::shape::Functions;
use crate::space::{Vector, cross, dot, unit};

/// The shape functions where an element is checked: beyond the usual places at the points that it
/// is integrated with.
pub(super) fn check_points(shape: Shape, integration: Integration) -> Vec<Functions> {
    let mut places = shape.reference().checked.to_vec();
    if integration == Integration::Full && shape.is_quadratic() {
        places.extend(shape.rule(integration).iter().map(|(place, _)| *place));
    }
    places.iter().map(|&place| shape.functions(place)).collect()
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
