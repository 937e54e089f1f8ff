//! Lame's thick cylinder: elastic, under internal and external pressure.

use super::domain::{nested_radii, poisson as check_poisson, positive};
use super::{Plane, von_mises};
use crate::error::Result;

/// Elastic thick-walled cylinder (or ring) under internal and external pressure.
///
/// `s_rr = A - B/r^2`, `s_tt = A + B/r^2` with `A = (p_i a^2 - p_o b^2)/(b^2 - a^2)`, `B = (p_i -
/// p_o) a^2 b^2/(b^2 - a^2)`; plane strain (`e_zz = 0`) or plane stress. Stresses are positive in
/// tension, pressures in compression, displacements outwards; units are any consistent ones.
///
/// # Source
/// S. P. Timoshenko, J. N. Goodier, *Theory of Elasticity*, 3rd ed. 1970, par. 28, pp. 68-71.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThickCylinder {
    /// Inner radius `a`.
    pub inner_radius: f64,
    /// Outer radius `b`.
    pub outer_radius: f64,
    /// Young's modulus.
    pub young: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Plane strain or plane stress.
    pub plane: Plane,
}

impl ThickCylinder {
    /// A cylinder with the given radii and elastic constants.
    ///
    /// # Errors
    /// `Input` unless `0 < inner_radius < outer_radius`, `young > 0` and `-1 < poisson <= 1/2`, all
    /// finite.
    pub fn new(
        inner_radius: f64,
        outer_radius: f64,
        young: f64,
        poisson: f64,
        plane: Plane,
    ) -> Result<Self> {
        let what = "thick cylinder";
        nested_radii(what, inner_radius, outer_radius)?;
        Ok(ThickCylinder {
            inner_radius,
            outer_radius,
            young: positive(what, "Young's modulus", young)?,
            poisson: check_poisson(what, poisson)?,
            plane,
        })
    }

    /// Stresses `[s_rr, s_tt (hoop), s_zz]` at the radius `r` in `[a, b]`.
    pub fn stress(&self, r: f64, inner_pressure: f64, outer_pressure: f64) -> [f64; 3] {
        let (uniform, ring) = self.constants(inner_pressure, outer_pressure);
        let variable = ring / (r * r);
        [
            uniform - variable,
            uniform + variable,
            self.plane.out_of_plane(2.0 * uniform, self.poisson),
        ]
    }

    /// Radial displacement `u = [(k - 1) A r/2 + B/r]/(2 G)` at the radius `r`, with Kolosov's
    /// constant `k`.
    pub fn displacement(&self, r: f64, inner_pressure: f64, outer_pressure: f64) -> f64 {
        let (uniform, ring) = self.constants(inner_pressure, outer_pressure);
        let bulk = 0.5 * (self.plane.kolosov(self.poisson) - 1.0);
        (1.0 + self.poisson) / self.young * (bulk * uniform * r + ring / r)
    }

    /// Internal pressure at which the bore first yields according to von Mises (no external
    /// pressure): `Y/sqrt(3 b^4 + (1 - 2 nu)^2 a^4) (b^2 - a^2)` in plane strain, with 1 instead of
    /// `1 - 2 nu` in plane stress.
    pub fn yield_pressure(&self, yield_stress: f64) -> f64 {
        yield_stress / von_mises(self.stress(self.inner_radius, 1.0, 0.0), 0.0)
    }

    /// Constants `(A, B)` of the solution.
    fn constants(&self, inner_pressure: f64, outer_pressure: f64) -> (f64, f64) {
        let (a2, b2) = (self.inner_radius.powi(2), self.outer_radius.powi(2));
        let wall =
            (self.outer_radius - self.inner_radius) * (self.outer_radius + self.inner_radius);
        (
            (inner_pressure * a2 - outer_pressure * b2) / wall,
            (inner_pressure - outer_pressure) * a2 * (b2 / wall),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cylinder(plane: Plane) -> ThickCylinder {
        ThickCylinder::new(100.0, 200.0, 210e3, 0.3, plane).unwrap()
    }

    #[test]
    fn edges_carry_the_pressures_and_a_section_balances_them() {
        let c = cylinder(Plane::Strain);
        assert!((c.stress(100.0, 80.0, 30.0)[0] + 80.0).abs() < 1e-12);
        assert!((c.stress(200.0, 80.0, 30.0)[0] + 30.0).abs() < 1e-12);
        let hoop = |r| c.stress(r, 80.0, 30.0)[1];
        let section = super::super::quadrature::integrate(hoop, 100.0, 200.0);
        assert!((section - (80.0 * 100.0 - 30.0 * 200.0)).abs() < 1e-9);
    }

    #[test]
    fn displacement_gives_the_stress_by_hookes_law() {
        for plane in [Plane::Strain, Plane::Stress] {
            let c = cylinder(plane);
            let (r, h) = (140.0, 1e-2);
            let [srr, stt, szz] = c.stress(r, 80.0, 30.0);
            let hoop = c.displacement(r, 80.0, 30.0) / r;
            assert!((210e3 * hoop - (stt - 0.3 * (srr + szz))).abs() < 1e-11);
            let ends = c.displacement(r + h, 80.0, 30.0) - c.displacement(r - h, 80.0, 30.0);
            let radial = ends / (2.0 * h);
            // The error is (h/r)^2 of stresses of the order of 100.
            assert!((210e3 * radial - (srr - 0.3 * (stt + szz))).abs() < 1e-5);
        }
    }

    #[test]
    fn yield_pressure_is_the_stated_form() {
        let expected = 240.0 * 3.0 / (3.0 * 16.0 + 0.16_f64).sqrt();
        let got = cylinder(Plane::Strain).yield_pressure(240.0);
        assert!((got / expected - 1.0).abs() < 1e-14);
        let expected = 240.0 * 3.0 / 49.0_f64.sqrt();
        let got = cylinder(Plane::Stress).yield_pressure(240.0);
        assert!((got / expected - 1.0).abs() < 1e-14);
        let rubber = ThickCylinder::new(100.0, 200.0, 1.0, 0.5, Plane::Strain).unwrap();
        assert!((rubber.yield_pressure(240.0) - 103.92).abs() < 5e-3);
    }

    #[test]
    fn a_thin_one_is_a_pipe() {
        let c = ThickCylinder::new(100.0, 100.001, 210e3, 0.3, Plane::Stress).unwrap();
        // The hoop stress is p r/t, with a relative error of t/r.
        assert!((c.stress(100.0, 1.0, 0.0)[1] / 1e5 - 1.0).abs() < 2e-5);
        assert!(ThickCylinder::new(2.0, 1.0, 1.0, 0.3, Plane::Stress).is_err());
        assert!(ThickCylinder::new(1.0, 2.0, 1.0, 0.51, Plane::Stress).is_err());
    }
}
