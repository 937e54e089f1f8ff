//! Flat rigid punches, plane and circular: elastic pressure and plastic limit.

use super::domain::positive;
use crate::error::Result;
use std::f64::consts::PI;

/// Smooth flat rigid punch of width `2 b` on a half plane in plane strain.
///
/// Elastic: `p(x) = P/(pi sqrt(b^2 - x^2))`, infinite at the corners, so a real body yields there
/// from the first load on. Perfectly plastic: the mean pressure cannot exceed `(2 + pi) k`, `k` the
/// yield stress in shear (`Y/sqrt(3)` according to von Mises, `Y/2` according to Tresca), rough or
/// smooth. Units are any consistent ones.
///
/// # Source
/// Elastic: K. L. Johnson, *Contact Mechanics*, Cambridge 1985, par. 2.8, eq. (2.64), p. 38. Limit:
/// L. Prandtl, Nachr. Ges. Wiss. Goettingen (1920) 74; R. Hill, *The Mathematical Theory of
/// Plasticity*, Oxford 1950, pp. 254-255.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlatPunch {
    /// Half width `b`.
    pub half_width: f64,
}

impl FlatPunch {
    /// Mean pressure at the limit load over the yield stress in shear: `2 + pi`, exact.
    pub const LIMIT_OVER_SHEAR_YIELD: f64 = 2.0 + PI;

    /// A punch with half width `half_width`.
    ///
    /// # Errors
    /// `Input` if the half width is not finite and positive.
    pub fn new(half_width: f64) -> Result<Self> {
        Ok(FlatPunch {
            half_width: positive("flat punch", "half width", half_width)?,
        })
    }

    /// Elastic pressure at `x` under `load` per length; 0 outside the contact, infinite at the
    /// corner.
    pub fn pressure(&self, x: f64, load: f64) -> f64 {
        if x.abs() > self.half_width {
            return 0.0;
        }
        load / (PI * ((self.half_width - x) * (self.half_width + x)).sqrt())
    }

    /// Mean pressure at the limit load according to von Mises: `(2 + pi) Y/sqrt(3)` = 2.9685 Y.
    pub fn limit_mean_pressure(yield_stress: f64) -> f64 {
        Self::LIMIT_OVER_SHEAR_YIELD * yield_stress / 3.0_f64.sqrt()
    }

    /// Limit load per length according to von Mises.
    pub fn limit_load(&self, yield_stress: f64) -> f64 {
        2.0 * self.half_width * Self::limit_mean_pressure(yield_stress)
    }
}

/// Flat rigid punch of circular section on a half space.
///
/// Elastic: `p(r) = P/(2 pi a sqrt(a^2 - r^2))`, penetration `P/(2 a E*)`. Perfectly plastic with
/// Tresca: mean pressure 5.69 k for a smooth punch, 6.05 k for a rough one, `k = Y/2`; both are
/// published numerical solutions of the slip-line equations, to the digits given. Units are
/// any consistent ones.
///
/// # Source
/// Elastic: K. L. Johnson, *Contact Mechanics*, Cambridge 1985, par. 3.4, eqs (3.34), (3.36), pp.
/// 59-60. Smooth: R. T. Shield, Proc. R. Soc. A 233 (1955) 267-287. Rough: G. Eason, R. T. Shield,
/// ZAMP 11 (1960) 33-43.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CircularPunch {
    /// Radius `a` of the punch.
    pub radius: f64,
}

impl CircularPunch {
    /// Mean pressure at the limit load over the yield stress in shear, smooth punch, Tresca.
    pub const SMOOTH_LIMIT_OVER_SHEAR_YIELD: f64 = 5.69;
    /// Mean pressure at the limit load over the yield stress in shear, perfectly rough punch,
    /// Tresca.
    pub const ROUGH_LIMIT_OVER_SHEAR_YIELD: f64 = 6.05;

    /// A punch with radius `radius`.
    ///
    /// # Errors
    /// `Input` if the radius is not finite and positive.
    pub fn new(radius: f64) -> Result<Self> {
        Ok(CircularPunch {
            radius: positive("circular punch", "radius", radius)?,
        })
    }

    /// Elastic pressure at the radius `r` under `load`; 0 outside the contact, infinite at the
    /// edge.
    pub fn pressure(&self, r: f64, load: f64) -> f64 {
        if r.abs() > self.radius {
            return 0.0;
        }
        load / (2.0 * PI * self.radius * ((self.radius - r) * (self.radius + r)).sqrt())
    }

    /// Elastic penetration under `load` into a half space of contact modulus `contact_modulus`.
    pub fn penetration(&self, load: f64, contact_modulus: f64) -> f64 {
        load / (2.0 * self.radius * contact_modulus)
    }

    /// Limit load of a smooth punch for the yield stress in shear `k` (Tresca: `Y/2`).
    pub fn smooth_limit_load(&self, shear_yield_stress: f64) -> f64 {
        PI * self.radius * self.radius * Self::SMOOTH_LIMIT_OVER_SHEAR_YIELD * shear_yield_stress
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits() {
        assert!((FlatPunch::limit_mean_pressure(1.0) - 2.9685).abs() < 5e-5);
        let punch = FlatPunch::new(3.0).unwrap();
        assert!((punch.limit_load(2.0) / (6.0 * 2.0 * 2.9685) - 1.0).abs() < 5e-5);
        let round = CircularPunch::new(2.0).unwrap();
        assert!((round.smooth_limit_load(0.5) / (4.0 * PI) - 2.845).abs() < 1e-12);
        assert!(FlatPunch::new(0.0).is_err() && CircularPunch::new(-1.0).is_err());
    }

    #[test]
    fn elastic_pressures_carry_the_load() {
        // The substitution x = b sin t removes the infinite ends.
        let punch = FlatPunch::new(3.0).unwrap();
        let round = CircularPunch::new(3.0).unwrap();
        let n = 50;
        let (mut flat, mut disc) = (0.0, 0.0);
        for i in 0..n {
            let t = 0.5 * PI * (f64::from(i) + 0.5) / f64::from(n);
            let (x, dx) = (3.0 * t.sin(), 3.0 * t.cos() * 0.5 * PI / f64::from(n));
            flat += 2.0 * punch.pressure(x, 7.0) * dx;
            disc += 2.0 * PI * x * round.pressure(x, 7.0) * dx;
        }
        assert!((flat / 7.0 - 1.0).abs() < 1e-12);
        // Error of the midpoint rule on sin t: (pi/(2 n))^2/24.
        let step = 0.5 * PI / f64::from(n);
        assert!((disc / 7.0 - 1.0).abs() < step * step / 20.0);
        assert_eq!(punch.pressure(3.1, 7.0), 0.0);
        assert_eq!(round.pressure(-3.1, 7.0), 0.0);
    }

    #[test]
    fn penetration_is_the_slope_of_hertz() {
        // dP/d(approach) of a ball is 2 a E*, Johnson p. 60 and 93.
        let ball = super::super::HertzPoint::new(10.0, 100.0).unwrap();
        let (d, h) = (0.1, 1e-6);
        let slope = (ball.load_for_approach(d + h) - ball.load_for_approach(d - h)) / (2.0 * h);
        let a = (10.0_f64 * d).sqrt();
        let stiffness = 1.0 / CircularPunch::new(a).unwrap().penetration(1.0, 100.0);
        assert!((slope / stiffness - 1.0).abs() < 1e-8);
    }
}
