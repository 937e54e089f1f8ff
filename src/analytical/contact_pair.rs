//! Parameters by which two elastic bodies enter a local contact: one contact modulus and one or two
//! relative radii.

use crate::error::{Error, Result};

/// Contact modulus `E* = [(1 - nu1^2)/E1 + (1 - nu2^2)/E2]^-1`, plane strain or three-dimensional.
///
/// `f64::INFINITY` for a Young's modulus makes that body rigid. For plane stress pass `poisson = 0`
/// for both bodies, because only the in-plane moduli enter.
///
/// # Source
/// K. L. Johnson, *Contact Mechanics*, Cambridge 1985, p. 92.
///
/// ```
/// use brinell::analytical::contact_modulus;
/// assert!((contact_modulus(210e3, 0.3, 70e3, 0.3) - 57_692.307_692).abs() < 1e-5);
/// ```
pub fn contact_modulus(young1: f64, poisson1: f64, young2: f64, poisson2: f64) -> f64 {
    1.0 / ((1.0 - poisson1 * poisson1) / young1 + (1.0 - poisson2 * poisson2) / young2)
}

/// Relative radius `R = [1/R1 + 1/R2]^-1` of two surfaces that touch.
///
/// `f64::INFINITY` is a plane, a negative radius a hollow (a ball in a socket). If the hollow is
/// tighter than the body in it, the result is negative and the bodies do not touch in a point:
/// constructors reject it.
///
/// # Source
/// K. L. Johnson, *Contact Mechanics*, Cambridge 1985, p. 85 and p. 100.
pub fn relative_radius(radius1: f64, radius2: f64) -> f64 {
    1.0 / (1.0 / radius1 + 1.0 / radius2)
}

/// Relative curvature of two surfaces that touch in a point or along a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RelativeRadii {
    /// Larger and smaller relative radius; the larger one is infinite for a line contact.
    pub radii: [f64; 2],
    /// Angle in degrees, at least 0 and less than 180, from the first principal plane of the first
    /// surface to the plane of the larger radius.
    pub direction: f64,
}

impl RelativeRadii {
    /// Round-off of a sum of curvatures relative to the largest of them.
    const ROUND_OFF: f64 = 1e-12;

    /// The relative curvature of surfaces with two principal radii each, positive if convex,
    /// negative if hollow, 0 or infinite if flat. The principal planes of the second surface are
    /// turned by `angle` degrees from those of the first. The two relative curvatures are
    ///
    /// ```text
    /// k = sum/2 -+ ((d1 + d2 cos 2 angle)^2 + (d2 sin 2 angle)^2)^(1/2)
    /// ```
    ///
    /// with the sum of all four curvatures, and d1 and d2 half the difference of the two curvatures
    /// of each surface.
    ///
    /// # Errors
    /// `Input` if there is a direction in which no gap opens between the surfaces, unless both are
    /// flat along it (a line contact): a hollow that is no wider than the body in it, or flat on
    /// flat. Also for a radius or an angle that is not a number.
    ///
    /// # Source
    /// K. L. Johnson, *Contact Mechanics*, Cambridge 1985, p. 85 and appendix 2, pp. 414-415.
    pub fn new(first: [f64; 2], second: [f64; 2], angle: f64) -> Result<Self> {
        let given = || format!("the radii {first:?} and {second:?} at {angle} degrees");
        if !angle.is_finite() || [first, second].concat().iter().any(|r| r.is_nan()) {
            return Err(Error::input(format!(
                "{}: radii are numbers or infinite, the angle is finite",
                given()
            )));
        }
        let curvature = |radius: f64| if radius == 0.0 { 0.0 } else { 1.0 / radius };
        let [k1, k2] = [first, second].map(|radii| radii.map(curvature));
        let [small, large, direction] = principal(k1, k2, angle);
        let largest = [k1, k2].concat().iter().fold(0.0f64, |m, k| m.max(k.abs()));
        let zero = Self::ROUND_OFF * largest;
        let has_flat = |k: [f64; 2]| k[0] * k[1] == 0.0;
        let is_line = small.abs() <= zero && has_flat(k1) && has_flat(k2);
        if large <= zero || (small <= zero && !is_line) {
            return Err(Error::input(format!(
                "{} leave no gap in some direction, so that the bodies do not touch in a point or \
                 a line: a hollow must be wider than what lies in it, and one of two surfaces \
                 curved",
                given()
            )));
        }
        Ok(RelativeRadii {
            radii: [
                if is_line { f64::INFINITY } else { 1.0 / small },
                1.0 / large,
            ],
            direction,
        })
    }
}

/// Smaller and larger sum of curvatures, and the direction of the smaller one.
fn principal(k1: [f64; 2], k2: [f64; 2], angle: f64) -> [f64; 3] {
    // If the principal planes coincide, the curvatures are added without differences, which would
    // lose digits.
    let aligned = match angle.rem_euclid(180.0) {
        0.0 => Some(k2),
        90.0 => Some([k2[1], k2[0]]),
        _ => None,
    };
    if let Some(k2) = aligned {
        let [x, y] = [k1[0] + k2[0], k1[1] + k2[1]];
        return if x <= y { [x, y, 0.0] } else { [y, x, 90.0] };
    }
    let (sin, cos) = (2.0 * angle.to_radians()).sin_cos();
    let [d1, d2] = [k1, k2].map(|k| 0.5 * (k[0] - k[1]));
    let mean = 0.5 * (k1[0] + k1[1] + k2[0] + k2[1]);
    let (along, across) = (d1 + d2 * cos, d2 * sin);
    let half = along.hypot(across);
    // The larger curvature lies at half the angle of the difference, the smaller one perpendicular
    // to it.
    let direction = 90.0 + 0.5 * across.atan2(along).to_degrees();
    [mean - half, mean + half, direction.rem_euclid(180.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curvatures_of_turned_planes() {
        let flat = f64::INFINITY;
        let of = |first, second, angle| RelativeRadii::new(first, second, angle).unwrap();
        // Along the axes each relative curvature is the sum of the two curvatures.
        let groove = of([5.0, 5.0], [-5.2, 20.0], 0.0);
        assert!((groove.radii[0] - 130.0).abs() < 1e-10 && groove.direction == 0.0);
        assert!((groove.radii[1] - 4.0).abs() < 1e-14);
        assert_eq!(of([5.0, 5.0], [20.0, -5.2], 90.0), groove);
        // Equal cylinders at an angle w: R'/R'' = cot^2(w/2), and the larger radius lies between
        // them.
        for angle in [10.0f64, 45.0, 90.0, 120.0] {
            let crossed = of([3.0, flat], [3.0, flat], angle);
            let half = 0.5 * angle.to_radians();
            let [small, large] = [half.sin().abs(), half.cos().abs()];
            let ratio = (large / small).powi(2);
            let found = crossed.radii[0] / crossed.radii[1];
            assert!(
                (found / ratio.max(1.0 / ratio) - 1.0).abs() < 1e-12,
                "{angle}"
            );
            if angle < 90.0 {
                // The flat directions are at 90 and 90 + angle degrees.
                assert!(
                    (crossed.direction - 90.0 - 0.5 * angle).abs() < 1e-12,
                    "{angle}"
                );
            }
        }
        // Parallel cylinders touch along a line, and so do turned cylindrical surfaces if one of
        // the two is a plane.
        assert_eq!(of([6.0, flat], [3.0, flat], 0.0).radii, [flat, 2.0]);
        assert_eq!(of([6.0, 0.0], [flat, 0.0], 30.0).radii[0], flat);
        assert_eq!(of([6.0, flat], [-12.0, flat], 0.0).radii, [flat, 12.0]);
    }

    #[test]
    fn surfaces_that_do_not_part_are_refused() {
        let flat = f64::INFINITY;
        for (first, second, angle) in [
            ([5.0, 5.0], [-5.0, 20.0], 0.0),
            ([5.0, 5.0], [-4.0, 20.0], 0.0),
            ([5.0, 5.0], [-5.0, -5.0], 17.0),
            ([flat, flat], [flat, 0.0], 0.0),
            ([5.0, flat], [-6.0, flat], 20.0),
            ([f64::NAN, 1.0], [1.0, 1.0], 0.0),
            ([1.0, 1.0], [1.0, 1.0], f64::INFINITY),
        ] {
            let refused = RelativeRadii::new(first, second, angle);
            assert!(
                refused.is_err(),
                "{first:?} {second:?} {angle}: {refused:?}"
            );
        }
    }

    #[test]
    fn limits_of_rigid_and_plane() {
        let steel = 210e3 / (1.0 - 0.09);
        assert!((contact_modulus(210e3, 0.3, f64::INFINITY, 0.3) / steel - 1.0).abs() < 1e-15);
        assert!((contact_modulus(210e3, 0.3, 210e3, 0.3) / (0.5 * steel) - 1.0).abs() < 1e-15);
        assert_eq!(relative_radius(50.0, f64::INFINITY), 50.0);
        assert_eq!(relative_radius(50.0, 50.0), 25.0);
        assert!((relative_radius(10.0, -11.0) - 110.0).abs() < 1e-11);
    }
}
