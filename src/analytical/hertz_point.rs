//! Hertz's point contact: two balls, or a ball on a half space.

use super::domain::positive;
use super::von_mises;
use crate::error::Result;
use crate::root::maximum;
use std::f64::consts::PI;

/// Frictionless contact of elastic spheres.
///
/// Contact radius `a = (3 P R/(4 E*))^(1/3)`, pressure `p(r) = p0 sqrt(1 - r^2/a^2)` with
/// `p0 = 3 P/(2 pi a^2)`, approach of distant points `a^2/R`. Valid for `a` small compared with the
/// radii.
///
/// Units are any consistent ones. Stresses are positive in tension, pressures in compression.
///
/// # Source
/// K. L. Johnson, *Contact Mechanics*, Cambridge 1985, pp. 60-63 and 90-93, eqs (3.39)-(3.45),
/// (4.21)-(4.24).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HertzPoint {
    /// Relative radius `R`, see [`relative_radius`](super::relative_radius).
    pub radius: f64,
    /// Contact modulus `E*`, see [`contact_modulus`](super::contact_modulus).
    pub contact_modulus: f64,
}

impl HertzPoint {
    /// A point contact with relative radius `radius` and contact modulus `contact_modulus`.
    ///
    /// # Errors
    /// `Input` if either is not finite and positive.
    pub fn new(radius: f64, contact_modulus: f64) -> Result<Self> {
        Ok(HertzPoint {
            radius: positive("point contact", "relative radius", radius)?,
            contact_modulus: positive("point contact", "contact modulus", contact_modulus)?,
        })
    }

    /// Contact radius `a` under `load >= 0`.
    pub fn contact_radius(&self, load: f64) -> f64 {
        (0.75 * load * self.radius / self.contact_modulus).cbrt()
    }

    /// Greatest pressure `p0 = (6 P E*^2/(pi^3 R^2))^(1/3)` under `load >= 0`.
    pub fn max_pressure(&self, load: f64) -> f64 {
        let ratio = self.contact_modulus / self.radius;
        (6.0 * load * ratio * ratio).cbrt() / PI
    }

    /// Approach `a^2/R` of points far from the contact under `load >= 0`.
    pub fn approach(&self, load: f64) -> f64 {
        self.contact_radius(load).powi(2) / self.radius
    }

    /// Load that produces a contact of radius `a`: `P = 4 E* a^3/(3 R)`.
    pub fn load_for_contact_radius(&self, contact_radius: f64) -> f64 {
        4.0 * self.contact_modulus * contact_radius.powi(3) / (3.0 * self.radius)
    }

    /// Load at the approach `d >= 0`: `P = (4/3) E* R^(1/2) d^(3/2)`.
    pub fn load_for_approach(&self, approach: f64) -> f64 {
        self.load_for_contact_radius((self.radius * approach).sqrt())
    }

    /// Load at which the greatest pressure is `p0`: `P = pi^3 R^2 p0^3/(6 E*^2)`.
    pub fn load_for_max_pressure(&self, pressure: f64) -> f64 {
        (PI * pressure).powi(3) * (self.radius / self.contact_modulus).powi(2) / 6.0
    }

    /// Contact pressure at the radius `r`; 0 outside the contact.
    pub fn pressure(&self, r: f64, load: f64) -> f64 {
        let contact_radius = self.contact_radius(load);
        if r.abs() >= contact_radius {
            return 0.0;
        }
        let root = ((contact_radius - r) * (contact_radius + r)).sqrt();
        self.max_pressure(load) * root / contact_radius
    }

    /// Stresses `[s_rr, s_tt (hoop), s_zz, s_rz]` at the radius `r >= 0` and the depth `z >= 0`, on
    /// and off the axis, and at the surface.
    ///
    /// The stresses are given in oblate spheroidal coordinates, `u >= 0` with
    /// `r^2/(a^2+u) + z^2/u = 1` and `c = z/sqrt(u)`. On the axis they reduce to
    /// `s_zz = -p0/(1 + z^2/a^2)`, `s_rr = s_tt = -p0 [(1+nu)(1 - (z/a) atan(a/z)) - 1/(2 (1 +
    /// z^2/a^2))]`.
    ///
    /// # Source
    /// M. T. Huber, Ann. Phys. 14 (1904) 153; on the axis and at the
    /// surface K. L. Johnson, *Contact Mechanics*, eqs (3.42)-(3.45), pp. 61-62.
    pub fn stress(&self, r: f64, z: f64, load: f64, poisson: f64) -> [f64; 4] {
        let contact_radius = self.contact_radius(load);
        if contact_radius == 0.0 {
            return [0.0; 4];
        }
        let peak = self.max_pressure(load);
        unit_stress(r / contact_radius, z / contact_radius, poisson).map(|s| peak * s)
    }

    /// Pressure `p0` at which a body with Poisson's ratio `poisson` and tensile yield stress
    /// `yield_stress` first yields according to von Mises: 1.6128 Y for `nu = 0.3`. Found by
    /// maximising over the depth.
    ///
    /// # Source
    /// K. L. Johnson, *Contact Mechanics*, p. 155 (1.60 Y).
    pub fn yield_pressure(poisson: f64, yield_stress: f64) -> f64 {
        yield_stress / peak_von_mises(poisson).1
    }

    /// Load at first yield: `pi^3 R^2 p0^3/(6 E*^2)`; 21.68 R^2 Y^3/E*^2 for `nu = 0.3`.
    pub fn yield_load(&self, poisson: f64, yield_stress: f64) -> f64 {
        self.load_for_max_pressure(Self::yield_pressure(poisson, yield_stress))
    }

    /// Contact radius at first yield: `pi R p0/(2 E*)`.
    pub fn yield_contact_radius(&self, poisson: f64, yield_stress: f64) -> f64 {
        0.5 * PI * self.radius * Self::yield_pressure(poisson, yield_stress) / self.contact_modulus
    }

    /// Depth at which yield begins: 0.4809 of the contact radius at first yield for `nu = 0.3`.
    pub fn yield_depth(&self, poisson: f64, yield_stress: f64) -> f64 {
        peak_von_mises(poisson).0 * self.yield_contact_radius(poisson, yield_stress)
    }
}

/// Stresses for `a = p0 = 1`.
fn unit_stress(r: f64, z: f64, poisson: f64) -> [f64; 4] {
    // u and -c^2 are the roots of t^2 - q t - z^2: the root of larger size is computed as a sum,
    // the other one from the product.
    let q = (r - 1.0) * (r + 1.0) + z * z;
    let root = q.hypot(2.0 * z);
    let (u, c) = if q >= 0.0 {
        let u = 0.5 * (root + q);
        (u, if u > 0.0 { z / u.sqrt() } else { 0.0 })
    } else {
        let c2 = 0.5 * (root - q);
        (z * z / c2, c2.sqrt())
    };
    let w = u.sqrt();
    let inside = 1.0 + u;
    let spread = u + c * c;
    // (1 - c^3)/r^2, with 1 - c^2 = r^2/(1 + u).
    let ring = (1.0 - 2.0 * poisson) / 3.0 * (1.0 + c + c * c) / ((1.0 + c) * inside);
    // c^3 u/(u^2 + z^2) = c^3/spread; at the edge itself (u = c = 0) the limit along the surface is
    // 0.
    let axial = if spread > 0.0 {
        c * c * c / spread
    } else {
        0.0
    };
    let shear = if spread > 0.0 {
        r * c * c * w / (spread * inside)
    } else {
        0.0
    };
    // atan(1/w), without dividing by w.
    let arc = w * 1.0_f64.atan2(w);
    let common = (1.0 - poisson) * u / inside;
    let srr = ring + axial + c * (common + (1.0 + poisson) * arc - 2.0);
    let stt = -ring - c * (2.0 * poisson + common - (1.0 + poisson) * arc);
    [srr, stt, -axial, -shear]
}

/// Values `(depth/a, von Mises/p0)` at the point with the largest von Mises stress, which lies on
/// the axis.
fn peak_von_mises(poisson: f64) -> (f64, f64) {
    let at = |depth: f64| {
        let [srr, stt, szz, srz] = unit_stress(0.0, depth, poisson);
        von_mises([srr, stt, szz], srz)
    };
    maximum(at, 0.0, 3.0, 300)
}

#[cfg(test)]
mod tests {
    use super::super::{contact_modulus, quadrature::integrate, relative_radius};
    use super::*;

    fn ball() -> HertzPoint {
        HertzPoint::new(50.0, contact_modulus(210e3, 0.3, 210e3, 0.3)).unwrap()
    }

    #[test]
    fn code_aster_ssnv104() {
        // Two spheres R = 50, E = 20000, nu = 0.3, each moved by 2.
        let modulus = contact_modulus(20e3, 0.3, 20e3, 0.3);
        let contact = HertzPoint::new(relative_radius(50.0, 50.0), modulus).unwrap();
        let load = contact.load_for_approach(4.0);
        assert!((contact.contact_radius(load) - 10.0).abs() < 1e-12);
        assert!((contact.max_pressure(load) - 2798.0).abs() < 0.5);
        assert!((contact.approach(load) - 4.0).abs() < 1e-14 * 4.0 * 4.0);
    }

    #[test]
    fn first_yield() {
        let contact = HertzPoint::new(1.0, 1.0).unwrap();
        assert!((HertzPoint::yield_pressure(0.3, 1.0) - 1.6128).abs() < 5e-5);
        let a = contact.yield_contact_radius(0.3, 1.0);
        assert!((contact.yield_depth(0.3, 1.0) / a - 0.4809).abs() < 5e-5);
        let load = contact.yield_load(0.3, 1.0);
        assert!((load - 21.68).abs() < 5e-3);
        assert!((contact.contact_radius(load) / a - 1.0).abs() < 1e-14);
    }

    #[test]
    fn the_peak_lies_on_the_axis() {
        for nu in [0.0, 0.15, 0.3, 0.5] {
            let peak = peak_von_mises(nu).1;
            for i in 1..150 {
                for j in 0..100 {
                    let [srr, stt, szz, srz] = unit_stress(0.02 * i as f64, 0.02 * j as f64, nu);
                    assert!(von_mises([srr, stt, szz], srz) <= peak * (1.0 + 1e-14));
                }
            }
        }
    }

    #[test]
    fn axis_and_surface_agree_with_johnsons_forms() {
        let nu = 0.3;
        for i in 0..60 {
            let s = 0.05 * f64::from(i);
            let [srr, stt, szz, srz] = unit_stress(0.0, s, nu);
            let axial = -1.0 / (1.0 + s * s);
            let lateral = -(1.0 + nu) * (1.0 - s * 1.0_f64.atan2(s)) - 0.5 * axial;
            assert!((szz - axial).abs() < 1e-14 && srz == 0.0);
            assert!((srr - lateral).abs() < 1e-14 && (stt - lateral).abs() < 1e-14);
            let r = s + 0.025;
            let [srr, stt, szz, srz] = unit_stress(r, 0.0, nu);
            let root = (1.0 - r * r).max(0.0).sqrt();
            let ring = (1.0 - 2.0 * nu) / (3.0 * r * r) * (1.0 - root.powi(3));
            // 1 - root^3 over r^2 in the reference form loses eps/r^2.
            let tolerance = 1e-14 + 1e-15 / (r * r);
            assert!((srr - (ring - root)).abs() < tolerance);
            assert!((stt - (-ring - 2.0 * nu * root)).abs() < tolerance);
            assert!((szz + root).abs() < tolerance && srz.abs() < tolerance);
        }
    }

    #[test]
    fn field_is_in_equilibrium() {
        let h = 1e-4;
        for (r, z) in [(0.3, 0.5), (0.8, 0.3), (1.0, 0.4), (1.7, 0.2), (2.0, 3.0)] {
            let at = |r, z| unit_stress(r, z, 0.3);
            let (e, w, d, u) = (at(r + h, z), at(r - h, z), at(r, z + h), at(r, z - h));
            let here = at(r, z);
            let out = (e[0] - w[0] + d[3] - u[3]) / (2.0 * h) + (here[0] - here[1]) / r;
            let down = (e[3] - w[3] + d[2] - u[2]) / (2.0 * h) + here[3] / r;
            assert!(out.abs() < 1e-6 && down.abs() < 1e-6, "{out} {down}");
        }
    }

    #[test]
    fn pressure_and_a_deeper_plane_carry_the_load() {
        let (contact, load) = (ball(), 1000.0);
        let a = contact.contact_radius(load);
        let total = integrate(|r| 2.0 * PI * r * contact.pressure(r, load), 0.0, a);
        assert!((total / load - 1.0).abs() < 1e-12);
        // -s_zz falls as r^-5 over the plane z = a/2; substitution r = tan(t) a.
        let below = integrate(
            |t| {
                let r = a * t.tan();
                -contact.stress(r, 0.5 * a, load, 0.3)[2] * 2.0 * PI * r * a / t.cos().powi(2)
            },
            0.0,
            0.5 * PI,
        );
        assert!((below / load - 1.0).abs() < 1e-10, "{}", below / load);
    }

    #[test]
    fn loads_invert() {
        let contact = ball();
        let load = 321.0;
        let p0 = contact.max_pressure(load);
        let a = contact.contact_radius(load);
        assert!((p0 / (1.5 * load / (PI * a * a)) - 1.0).abs() < 1e-14);
        for back in [
            contact.load_for_contact_radius(a),
            contact.load_for_max_pressure(p0),
            contact.load_for_approach(contact.approach(load)),
        ] {
            assert!((back / load - 1.0).abs() < 1e-13);
        }
        assert!(HertzPoint::new(-1.0, 1.0).is_err());
    }
}
