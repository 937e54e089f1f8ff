//! Plane strain and plane stress, the two closures of a plane problem in the third direction.

/// The plane idealisation in which a closed form is evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Plane {
    /// No strain out of the plane: `s_z = nu (s_x + s_y)`.
    Strain,
    /// No stress out of the plane: `s_z = 0`.
    Stress,
}

impl Plane {
    /// Kolosov's constant: `3 - 4 nu` in plane strain, `(3 - nu)/(1 + nu)` in plane stress.
    ///
    /// # Source
    /// N. I. Muskhelishvili, *Some Basic Problems of the Mathematical Theory of Elasticity*, 1953,
    /// par. 32.
    pub fn kolosov(self, poisson: f64) -> f64 {
        match self {
            Plane::Strain => 3.0 - 4.0 * poisson,
            Plane::Stress => (3.0 - poisson) / (1.0 + poisson),
        }
    }

    /// Plane modulus `E' = 8 G/(kolosov + 1)`: `E/(1 - nu^2)` in plane strain, `E` in plane stress.
    pub fn modulus(self, young: f64, poisson: f64) -> f64 {
        match self {
            Plane::Strain => young / (1.0 - poisson * poisson),
            Plane::Stress => young,
        }
    }

    /// Out-of-plane stress that accompanies the sum `s_x + s_y` of the in-plane stresses.
    pub fn out_of_plane(self, in_plane_sum: f64, poisson: f64) -> f64 {
        match self {
            Plane::Strain => poisson * in_plane_sum,
            Plane::Stress => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modulus_agrees_with_kolosov() {
        for plane in [Plane::Strain, Plane::Stress] {
            for nu in [-0.4, 0.0, 0.3, 0.5] {
                let young = 210.0;
                let shear = young / (2.0 * (1.0 + nu));
                let expected = 8.0 * shear / (plane.kolosov(nu) + 1.0);
                assert!((plane.modulus(young, nu) / expected - 1.0).abs() < 1e-14);
            }
        }
    }
}
