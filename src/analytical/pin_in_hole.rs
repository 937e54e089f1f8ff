//! Persson's pin in a hole: conforming contact of bodies of the same material.

use super::domain::{finite, positive};
use crate::error::{Error, Result};
use crate::root;
use std::f64::consts::PI;

/// Frictionless pin loaded at its centre in the hole of an infinite plate of the same material.
///
/// With the half angle `e` of the contact and `t = tan(e/2)`, `Q` the load per thickness, `R` the
/// radius, `dR` the clearance on the radius and `E*` the contact modulus
///
/// ```text
/// E* dR/Q = [2 - ln(1 + t^2) - 2 t^4]/[2 pi t^2 (1 + t^2)],
/// p(f) R/Q = 2 w/[pi sqrt(1+t^2) (1+y^2)] + ln[(s + w)/(s - w)]/[2 pi t^2 (1+t^2)],
///            y = tan(f/2), s = sqrt(1 + t^2), w = sqrt(t^2 - y^2).
/// ```
///
/// Neat fit (`dR = 0`): `e` = 84.828 degrees and `p(0) R/Q = 0.59963` at any load. With
/// interference (`dR < 0`) the contact is wider, and closed all around below `Q = pi E* |dR|`,
/// where `p = E* |dR|/R + Q/(pi R) cos f`. Units are any consistent ones; pressures are positive in
/// compression.
///
/// # Source
/// B. G. A. Persson, *On the stress distribution of cylindrical elastic bodies in contact*,
/// dissertation, Chalmers, Gothenburg 1964; M. Ciavarella, P. Decuzzi, Int. J. Solids Structures 38
/// (2001) 4507-4523; K. L. Johnson, *Contact Mechanics*, Cambridge 1985, par. 5.3, pp. 114-119.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PinInHole {
    /// Radius `R` of the pin and, apart from the clearance, of the hole.
    pub radius: f64,
    /// Clearance `dR` on the radius, negative for an interference.
    pub clearance: f64,
    /// Contact modulus `E*` of the two equal bodies, half of
    /// [`Plane::modulus`](super::Plane::modulus).
    pub contact_modulus: f64,
}

impl PinInHole {
    /// A pin in a hole, both with radius `radius` apart from the clearance.
    ///
    /// # Errors
    /// `Input` if the radius or the modulus is not finite and positive, or the clearance is not
    /// finite.
    pub fn new(radius: f64, clearance: f64, contact_modulus: f64) -> Result<Self> {
        let what = "pin in a hole";
        Ok(PinInHole {
            radius: positive(what, "radius", radius)?,
            clearance: finite(what, "clearance", clearance)?,
            contact_modulus: positive(what, "contact modulus", contact_modulus)?,
        })
    }

    /// Ratio `E* dR/Q` for which the half angle of the contact is `half_angle`, in `(0, pi)`. The
    /// ratio falls from infinity through 0 (neat fit) to `-1/pi`.
    pub fn clearance_ratio(half_angle: f64) -> f64 {
        let t2 = (0.5 * half_angle).tan().powi(2);
        (2.0 - t2.ln_1p() - 2.0 * t2 * t2) / (2.0 * PI * t2 * (1.0 + t2))
    }

    /// Half angle in radians of the contact of a neat fit, which is 84.828 degrees at any load.
    pub fn neat_half_angle() -> f64 {
        root::of(Self::clearance_ratio, 1.0, 2.0)
    }

    /// Load per thickness at which the half angle of the contact is `half_angle`.
    ///
    /// # Errors
    /// `Input` if no positive load gives this angle: with clearance, for angles from the angle of
    /// the neat fit upwards; with interference, for angles up to that angle; with a neat fit, for
    /// all angles.
    pub fn load_for_half_angle(&self, half_angle: f64) -> Result<f64> {
        let load = self.contact_modulus * self.clearance / Self::clearance_ratio(half_angle);
        if half_angle > 0.0 && half_angle < PI && load.is_finite() && load > 0.0 {
            return Ok(load);
        }
        Err(Error::input(format!(
            "pin in a hole: no load gives the half angle {half_angle} rad with the clearance {}",
            self.clearance
        )))
    }

    /// Half angle of the contact under `load` per thickness, in radians; `pi` if the contact is
    /// closed all around.
    ///
    /// # Errors
    /// `Input` if the load is not finite and positive.
    pub fn half_angle(&self, load: f64) -> Result<f64> {
        let load = positive("pin in a hole", "load", load)?;
        let target = self.contact_modulus * self.clearance / load;
        if target <= -1.0 / PI {
            return Ok(PI);
        }
        Ok(root::of(|e| Self::clearance_ratio(e) - target, 0.0, PI))
    }

    /// Contact pressure at the angle `from_load` (radians from the line of the load) under `load`.
    ///
    /// # Errors
    /// Errors of [`half_angle`](Self::half_angle).
    pub fn pressure(&self, from_load: f64, load: f64) -> Result<f64> {
        let half_angle = self.half_angle(load)?;
        let (sin, cos) = from_load.sin_cos();
        if half_angle >= PI {
            let shrink = -self.contact_modulus * self.clearance;
            return Ok((shrink + load / PI * cos) / self.radius);
        }
        // The angle is folded to (-pi, pi].
        Ok(load / self.radius * unit_pressure(sin.atan2(cos), half_angle))
    }

    /// Greatest pressure, on the line of the load.
    ///
    /// # Errors
    /// Errors of [`half_angle`](Self::half_angle).
    pub fn max_pressure(&self, load: f64) -> Result<f64> {
        self.pressure(0.0, load)
    }
}

/// Scaled pressure `p R/Q` at the angle `f`, for the half angle `e` of the contact.
fn unit_pressure(f: f64, e: f64) -> f64 {
    if f.abs() >= e {
        return 0.0;
    }
    let (t, y) = ((0.5 * e).tan(), (0.5 * f).tan());
    let s2 = 1.0 + t * t;
    let w = ((t - y) * (t + y)).sqrt();
    let even = 2.0 * w / (PI * s2.sqrt() * (1.0 + y * y));
    // ln[(s+w)/(s-w)] = 2 atanh(w/s).
    even + (w / s2.sqrt()).atanh() / (PI * t * t * s2)
}

#[cfg(test)]
mod tests {
    use super::super::quadrature::integrate;
    use super::*;

    #[test]
    fn neat_fit() {
        let e = PinInHole::neat_half_angle();
        assert!((e.to_degrees() - 84.828).abs() < 5e-4);
        let pin = PinInHole::new(20.0, 0.0, 1e5).unwrap();
        assert!((pin.max_pressure(300.0).unwrap() * 20.0 / 300.0 - 0.59963).abs() < 5e-6);
        assert!((pin.half_angle(1e-6).unwrap() - e).abs() < 1e-14);
        assert!(pin.load_for_half_angle(1.0).is_err());
    }

    #[test]
    fn pressure_carries_the_load_and_angles_invert() {
        for (clearance, load) in [(0.1, 3e4), (1e-3, 10.0), (0.0, 50.0), (-0.01, 1e4)] {
            let pin = PinInHole::new(20.0, clearance, 1e5).unwrap();
            let e = pin.half_angle(load).unwrap();
            let along = |f: f64| 2.0 * 20.0 * f.cos() * pin.pressure(f, load).unwrap();
            let carried = integrate(along, 0.0, e) / load;
            assert!((carried - 1.0).abs() < 1e-8, "{carried}");
            if clearance != 0.0 {
                assert!((pin.load_for_half_angle(e).unwrap() / load - 1.0).abs() < 1e-11);
            }
        }
    }

    #[test]
    fn small_contact_is_hertz() {
        // Relative radius R^2/dR; the two solutions agree up to e^2.
        let pin = PinInHole::new(20.0, 0.2, 1e5).unwrap();
        let load = pin.load_for_half_angle(1e-3).unwrap();
        let line = super::super::HertzLine::new(20.0 * 20.0 / 0.2, 1e5).unwrap();
        let width = line.half_width(load) / 20.0;
        assert!((width / 1e-3 - 1.0).abs() < 1e-5, "{width}");
        let ratio = pin.max_pressure(load).unwrap() / line.max_pressure(load);
        assert!((ratio - 1.0).abs() < 1e-5, "{ratio}");
    }

    #[test]
    fn gap_is_closed_over_the_contact() {
        // sum_{n>=2} n/(n^2-1) cos n x = -cos x ln|2 sin(x/2)| - 1/2 - cos(x)/4, plus the terms of
        // n = 0. The remainder of E* g/(2 R) after the rigid shift (cos f) must vanish; three
        // angles are more than the two free terms could fit.
        let e = 1.2;
        let q0 = integrate(|f| unit_pressure(f, e), 0.0, e) / PI;
        let residual = |f: f64| {
            let kernel = |x: f64| -x.cos() * (2.0 * (0.5 * x).sin().abs()).ln() - 0.5;
            let right = integrate(|s| unit_pressure(f + s, e) * kernel(s), 0.0, e - f);
            let left = integrate(|s| unit_pressure(f - s, e) * kernel(s), 0.0, e + f);
            0.5 * q0 + (right + left) / PI + 0.5 * PinInHole::clearance_ratio(e)
        };
        // residual = C cos f with one C, because cos(x)/4 is a rigid shift too.
        let shift = residual(0.0);
        for f in [0.2, 0.5_f64, 0.9, 1.1] {
            assert!(
                (residual(f) - shift * f.cos()).abs() < 1e-8,
                "{}",
                residual(f) - shift * f.cos()
            );
        }
    }

    #[test]
    fn interference_closes_all_round() {
        let pin = PinInHole::new(20.0, -0.01, 1e5).unwrap();
        let separation = PI * 1e5 * 0.01;
        assert_eq!(pin.half_angle(0.99 * separation).unwrap(), PI);
        assert!(pin.half_angle(1.01 * separation).unwrap() < PI);
        assert!(pin.pressure(PI, separation).unwrap().abs() < 1e-12);
        // The two forms agree at the load of separation.
        for f in [0.0, 1.0, 2.5] {
            let closed = pin.pressure(f, separation).unwrap();
            let open = pin.pressure(f, separation * (1.0 + 1e-8)).unwrap();
            assert!((closed - open).abs() < 1e-3 * closed, "{closed} {open}");
        }
        assert!(pin.half_angle(0.0).is_err());
        assert!(PinInHole::new(1.0, f64::NAN, 1.0).is_err());
    }
}
