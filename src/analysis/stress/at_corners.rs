//! Values at the corners of an element, from values at its integration points.

use crate::shape::{Rule, Shape};
use nalgebra::{Matrix3, Vector3};

/// The largest corner value of the linear function that fits the values at the points of a rule
/// best (least squares in the coordinates of the reference element). Returns the largest value at a
/// point instead if that is larger, or if the points determine no slope.
pub(super) fn largest_at_corners(shape: Shape, rule: &Rule, values: &[f64]) -> f64 {
    let reference = shape.reference();
    let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let share = 1.0 / rule.len() as f64;
    let places = || rule.iter().map(|(place, _)| Vector3::from(*place));
    let middle: Vector3<f64> = places().sum::<Vector3<f64>>() * share;
    let mean = values.iter().sum::<f64>() * share;
    // Coordinates that the element does not have get a one on the diagonal.
    let mut moments = Matrix3::zeros();
    (reference.dimension..3).for_each(|d| moments[(d, d)] = 1.0);
    let mut slopes = Vector3::zeros();
    for (place, value) in places().zip(values) {
        let off = place - middle;
        moments += off * off.transpose();
        slopes += off * (value - mean);
    }
    // Points of a rule lie as far apart as the element is large, so no case is nearly singular.
    let Some(inverse) = moments.try_inverse() else {
        return largest;
    };
    let slope = inverse * slopes;
    let corners = reference.nodes[..reference.n_corners].iter();
    let at_corners = corners.map(|place| mean + slope.dot(&(Vector3::from(*place) - middle)));
    at_corners.fold(largest, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A linear field is reproduced at the corners of every shape with more than one point.
    #[test]
    fn a_linear_field_is_met_exactly() {
        let field = |x: &[f64; 3]| 0.3 + 0.7 * x[0] - 0.4 * x[1] + 0.2 * x[2];
        for shape in Shape::ALL {
            let reference = shape.reference();
            for rule in [reference.gauss, reference.full] {
                let values: Vec<f64> = rule.iter().map(|(place, _)| field(place)).collect();
                let corners = reference.nodes[..reference.n_corners].iter();
                let expected = match rule.len() {
                    1 => values[0],
                    _ => corners.map(field).fold(f64::NEG_INFINITY, f64::max),
                };
                let found = largest_at_corners(shape, rule, &values);
                assert!((found - expected).abs() < 1e-13, "{shape:?}: {found}");
            }
        }
    }

    /// The result is never below the largest value at a point, and a uniform field keeps its value.
    #[test]
    fn a_peak_inside_keeps_its_value() {
        let values = [1.0, 0.0, 1.0, 0.0];
        let rule = Shape::Quad4.reference().gauss;
        assert!(largest_at_corners(Shape::Quad4, rule, &values) >= 1.0);
        let even = [2.0; 4];
        assert_eq!(largest_at_corners(Shape::Quad4, rule, &even), 2.0);
    }
}
