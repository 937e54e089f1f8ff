//! The Jacobian of the map from the reference element, where an element is checked.

use super::Shape;
use crate::shape::Functions;
use crate::space::{Vector, cross, dot, unit};

/// The shape functions where an element is checked.
pub(super) fn check_points(shape: Shape) -> Vec<Functions> {
    let places = shape.reference().checked.iter();
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
