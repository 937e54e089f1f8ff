//! Measures of a stress state, such as the von Mises stress, and the depth at which one is largest.

/// Von Mises stress of three normal stresses and the one shear stress of a plane or axisymmetric
/// state: `sqrt(((s1-s2)^2 + (s2-s3)^2 + (s3-s1)^2)/2 + 3 t^2)`. Units of stress.
pub fn von_mises(normal: [f64; 3], shear: f64) -> f64 {
    let [s1, s2, s3] = normal;
    let (d1, d2, d3) = (s1 - s2, s2 - s3, s3 - s1);
    (0.5 * (d1 * d1 + d2 * d2 + d3 * d3) + 3.0 * shear * shear).sqrt()
}

/// Greatest shear of three principal stresses: half the difference of the largest and the smallest.
pub(super) fn greatest_shear([s1, s2, s3]: [f64; 3]) -> f64 {
    0.5 * (s1.max(s2).max(s3) - s1.min(s2).min(s3))
}

/// The largest value of a stress below a contact, with its depth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// The largest stress.
    pub stress: f64,
    /// Depth below the surface.
    pub depth: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tension_pressure_and_shear() {
        assert_eq!(von_mises([5.0, 0.0, 0.0], 0.0), 5.0);
        assert_eq!(von_mises([7.0, 7.0, 7.0], 0.0), 0.0);
        assert!((von_mises([0.0; 3], 1.0) - 3.0_f64.sqrt()).abs() < f64::EPSILON);
    }
}
