//! The Jacobian of the map from the reference element, where an element is checked.

use super::Shape;
use crate::shape::Functions;

/// The shape functions where an element is checked.
pub(super) fn check_points(shape: Shape) -> Vec<Functions> {
    let places = shape.reference().checked.iter();
    places.map(|&place| shape.functions(place)).collect()
}

/// Determinant of the Jacobian of an element with these node positions.
pub(super) fn determinant(at: &Functions, points: &[[f64; 2]]) -> f64 {
    let mut j = [[0.0; 2]; 2];
    for (gradient, point) in at.gradients.iter().zip(points) {
        for a in 0..2 {
            for b in 0..2 {
                j[a][b] += gradient[a] * point[b];
            }
        }
    }
    j[0][0] * j[1][1] - j[0][1] * j[1][0]
}
