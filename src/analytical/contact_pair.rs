//! What two elastic bodies are to a local contact: one modulus and one radius.

/// Contact modulus `E* = [(1 - nu1^2)/E1 + (1 - nu2^2)/E2]^-1`, plane strain or three-dimensional.
///
/// `f64::INFINITY` for a Young's modulus makes that body rigid. For plane stress pass `poisson = 0`
/// for both bodies: only the moduli of the planes enter.
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
/// `f64::INFINITY` is a plane, a negative radius a hollow (a ball in a socket). Where the hollow is
/// the tighter one the result is negative and the bodies do not touch in a point: constructors
/// reject it.
///
/// # Source
/// K. L. Johnson, *Contact Mechanics*, Cambridge 1985, p. 85 and p. 100.
pub fn relative_radius(radius1: f64, radius2: f64) -> f64 {
    1.0 / (1.0 / radius1 + 1.0 / radius2)
}

#[cfg(test)]
mod tests {
    use super::*;

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
