//! Direction vectors of angles on a circle, exact on the axes.

use std::f64::consts::FRAC_1_SQRT_2;

/// `[cos, sin]` of an angle in degrees: exactly 0 and 1 at multiples of 90 degrees, and exactly
/// equal components at odd multiples of 45 degrees. Nodes on symmetry lines therefore lie exactly
/// on these lines.
pub(crate) fn direction(degrees: f64) -> [f64; 2] {
    let turned = degrees.rem_euclid(360.0);
    let quadrant = (turned / 90.0).floor();
    let [c, s] = first_quadrant(turned - 90.0 * quadrant);
    // Adding zero turns a negative zero into zero.
    match quadrant as u8 % 4 {
        0 => [c, s],
        1 => [0.0 - s, c],
        2 => [0.0 - c, 0.0 - s],
        _ => [s, 0.0 - c],
    }
}

/// Directions of angles from 0 to 90 degrees, computed from the first octant.
fn first_quadrant(degrees: f64) -> [f64; 2] {
    if degrees < 45.0 {
        let (s, c) = degrees.to_radians().sin_cos();
        [c, s]
    } else if degrees > 45.0 {
        let (s, c) = (90.0 - degrees).to_radians().sin_cos();
        [s, c]
    } else {
        [FRAC_1_SQRT_2, FRAC_1_SQRT_2]
    }
}

/// Directions at `2 n + 1` equally spaced angles from `start` over `span` degrees, for element
/// corners and mid-side nodes.
pub(crate) fn directions(start: f64, span: f64, n: usize) -> Vec<[f64; 2]> {
    let halves = 2 * n;
    (0..=halves)
        .map(|k| direction(start + span * k as f64 / halves as f64))
        .collect()
}

/// The vector `v` turned counter-clockwise by the angle whose direction is `d`.
pub(super) fn turned(v: [f64; 2], d: [f64; 2]) -> [f64; 2] {
    [v[0] * d[0] - v[1] * d[1], v[0] * d[1] + v[1] * d[0]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_and_diagonals_are_exact() {
        for (degrees, expected) in [
            (0.0, [1.0, 0.0]),
            (90.0, [0.0, 1.0]),
            (180.0, [-1.0, 0.0]),
            (270.0, [0.0, -1.0]),
            (360.0, [1.0, 0.0]),
            (-90.0, [0.0, -1.0]),
            (450.0, [0.0, 1.0]),
            (45.0, [FRAC_1_SQRT_2; 2]),
        ] {
            let d = direction(degrees);
            assert_eq!(d, expected, "{degrees}");
            assert!(d.iter().all(|c| *c != 0.0 || c.is_sign_positive()));
        }
    }

    #[test]
    fn agrees_with_the_library_functions() {
        for k in -720..=720 {
            let degrees = 0.7 * f64::from(k);
            let (s, c) = degrees.to_radians().sin_cos();
            let d = direction(degrees);
            // The plain argument in radians carries a relative round-off, and is as large as 9
            // radians here.
            let tolerance = 16.0 * f64::EPSILON;
            assert!((d[0] - c).abs() < tolerance && (d[1] - s).abs() < tolerance);
            assert!((d[0].hypot(d[1]) - 1.0).abs() < 4.0 * f64::EPSILON);
        }
    }

    #[test]
    fn a_tiny_negative_angle_stays_in_range() {
        assert_eq!(direction(-1e-300), [1.0, 0.0]);
    }
}
