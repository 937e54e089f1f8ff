//! Hill's thick cylinder: elastic-perfectly plastic under internal pressure.

use super::domain::{nested_radii, positive};
use super::plastic_wall::{plastic_front, refuse_reverse_yield};
use super::{Plane, ThickCylinder};
use crate::error::Result;

/// Elastic-perfectly plastic thick cylinder in plane strain, von Mises, exact for `nu = 1/2`.
///
/// The plastic front stands at `c` under the pressure `p(c) = k [2 ln(c/a) + 1 - c^2/b^2]`,
/// `k = Y/sqrt(3)`. In the plastic part `s_rr = -k [2 ln(c/r) + 1 - c^2/b^2]`, `s_tt = s_rr + 2 k`;
/// outside `s_rr = -k c^2 (1/r^2 - 1/b^2)`, `s_tt = k c^2 (1/r^2 + 1/b^2)`; everywhere
/// `s_zz = (s_rr + s_tt)/2` and, the volume being constant, `u = 3 k c^2/(2 E r)`. The solution is
/// exact for an elastic Poisson's ratio of 1/2 and an approximation for smaller ones. Units are any
/// consistent ones; displacements are positive outwards.
///
/// # Source
/// R. Hill, *The Mathematical Theory of Plasticity*, Oxford 1950, ch. V par. 2, pp. 106-114; W.
/// Prager, P. G. Hodge, *Theory of Perfectly Plastic Solids*, 1951, par. 15-17.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElastoplasticCylinder {
    /// Inner radius `a`.
    pub inner_radius: f64,
    /// Outer radius `b`.
    pub outer_radius: f64,
    /// Young's modulus.
    pub young: f64,
    /// Tensile yield stress `Y`.
    pub yield_stress: f64,
}

impl ElastoplasticCylinder {
    /// A cylinder with the given radii, modulus and tensile yield stress.
    ///
    /// # Errors
    /// `Input` unless `0 < inner_radius < outer_radius`, `young > 0` and `yield_stress > 0`, all
    /// finite.
    pub fn new(
        inner_radius: f64,
        outer_radius: f64,
        young: f64,
        yield_stress: f64,
    ) -> Result<Self> {
        let what = "elastoplastic cylinder";
        nested_radii(what, inner_radius, outer_radius)?;
        Ok(ElastoplasticCylinder {
            inner_radius,
            outer_radius,
            young: positive(what, "Young's modulus", young)?,
            yield_stress: positive(what, "yield stress", yield_stress)?,
        })
    }

    /// Pressure at which the bore yields: `k (1 - a^2/b^2)`.
    pub fn yield_pressure(&self) -> f64 {
        self.pressure(self.inner_radius)
    }

    /// Pressure at which the whole wall is plastic: `2 k ln(b/a)`.
    pub fn collapse_pressure(&self) -> f64 {
        self.pressure(self.outer_radius)
    }

    /// Pressure that holds the plastic front at the radius `front` in `[a, b]`.
    pub fn pressure(&self, front: f64) -> f64 {
        let ratio = front / self.outer_radius;
        let plastic = 2.0 * (front / self.inner_radius).ln();
        self.shear_yield_stress() * (plastic + (1.0 - ratio) * (1.0 + ratio))
    }

    /// Radius of the plastic front under `pressure`; the inner radius as long as the wall is
    /// elastic.
    ///
    /// # Errors
    /// [`Input`](crate::ErrorKind::Input) if the pressure is negative or not a number,
    /// [`Collapse`](crate::ErrorKind::Collapse) if it exceeds the collapse pressure.
    pub fn plastic_front(&self, pressure: f64) -> Result<f64> {
        let wall = [self.inner_radius, self.outer_radius];
        plastic_front("elastoplastic cylinder", pressure, wall, |front| {
            self.pressure(front)
        })
    }

    /// Stresses `[s_rr, s_tt (hoop), s_zz]` at the radius `r` in `[a, b]` under `pressure`.
    ///
    /// # Errors
    /// Errors of [`plastic_front`](Self::plastic_front).
    pub fn stress(&self, r: f64, pressure: f64) -> Result<[f64; 3]> {
        let front = self.plastic_front(pressure)?;
        if pressure <= self.yield_pressure() {
            return Ok(self.elastic().stress(r, pressure, 0.0));
        }
        let k = self.shear_yield_stress();
        let ratio2 = (front / self.outer_radius).powi(2);
        let [srr, stt] = if r < front {
            let srr = -k * (2.0 * (front / r).ln() + 1.0 - ratio2);
            [srr, srr + 2.0 * k]
        } else {
            let ring2 = (front / r).powi(2);
            [-k * (ring2 - ratio2), k * (ring2 + ratio2)]
        };
        Ok([srr, stt, 0.5 * (srr + stt)])
    }

    /// Radial displacement at the radius `r` under `pressure`.
    ///
    /// # Errors
    /// Errors of [`plastic_front`](Self::plastic_front).
    pub fn displacement(&self, r: f64, pressure: f64) -> Result<f64> {
        let front = self.plastic_front(pressure)?;
        if pressure <= self.yield_pressure() {
            return Ok(self.elastic().displacement(r, pressure, 0.0));
        }
        Ok(1.5 * self.shear_yield_stress() * front * front / (self.young * r))
    }

    /// Residual stresses `[s_rr, s_tt, s_zz]` after `pressure` has been removed (autofrettage).
    ///
    /// # Errors
    /// Errors of [`plastic_front`](Self::plastic_front), and `Input` if the pressure exceeds twice
    /// the yield pressure, because the bore then yields again in unloading.
    pub fn residual_stress(&self, r: f64, pressure: f64) -> Result<[f64; 3]> {
        let loaded = self.stress(r, pressure)?;
        refuse_reverse_yield("elastoplastic cylinder", pressure, self.yield_pressure())?;
        let relief = self.elastic().stress(r, pressure, 0.0);
        Ok([0, 1, 2].map(|i| loaded[i] - relief[i]))
    }

    fn shear_yield_stress(&self) -> f64 {
        self.yield_stress / 3.0_f64.sqrt()
    }

    fn elastic(&self) -> ThickCylinder {
        ThickCylinder {
            inner_radius: self.inner_radius,
            outer_radius: self.outer_radius,
            young: self.young,
            poisson: 0.5,
            plane: Plane::Strain,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{quadrature::integrate, von_mises};
    use super::*;
    use crate::ErrorKind;

    fn cylinder() -> ElastoplasticCylinder {
        ElastoplasticCylinder::new(100.0, 200.0, 210e3, 240.0).unwrap()
    }

    #[test]
    fn first_yield_and_collapse() {
        assert!((cylinder().yield_pressure() - 103.92).abs() < 5e-3);
        assert!((cylinder().collapse_pressure() - 192.09).abs() < 5e-3);
    }

    #[test]
    fn front_inverts_the_pressure() {
        let c = cylinder();
        for front in [100.0, 130.0, 170.0, 200.0] {
            let back = c.plastic_front(c.pressure(front)).unwrap();
            // p' vanishes at c = b, so the front is determined there to sqrt(eps) only.
            assert!((back / front - 1.0).abs() < 4.0 * f64::EPSILON.sqrt());
        }
        let err = c.plastic_front(200.0).unwrap_err();
        assert_eq!(err.kind(), ErrorKind::Collapse);
        assert_eq!(c.plastic_front(-1.0).unwrap_err().kind(), ErrorKind::Input);
        assert!(c.plastic_front(f64::NAN).is_err());
        assert_eq!(c.plastic_front(50.0).unwrap(), 100.0);
    }

    #[test]
    fn yields_inside_the_front_and_balances() {
        let c = cylinder();
        let p = c.pressure(150.0);
        for i in 0..=20 {
            let r = 100.0 + 5.0 * f64::from(i);
            let equivalent = von_mises(c.stress(r, p).unwrap(), 0.0);
            if r < 150.0 {
                assert!((equivalent - 240.0).abs() < 1e-10);
            } else {
                assert!(equivalent <= 240.0 + 1e-10);
            }
        }
        assert!((c.stress(100.0, p).unwrap()[0] + p).abs() < 1e-10);
        assert!(c.stress(200.0, p).unwrap()[0].abs() < 1e-10);
        let hoop = |r| c.stress(r, p).unwrap()[1];
        let section = integrate(hoop, 100.0, 150.0) + integrate(hoop, 150.0, 200.0);
        assert!((section / (p * 100.0) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn continuous_at_the_front_and_at_first_yield() {
        let c = cylinder();
        let p = c.pressure(150.0);
        let step = 1e-6;
        let (inside, outside) = (
            c.stress(150.0 - step, p).unwrap(),
            c.stress(150.0 + step, p).unwrap(),
        );
        for i in 0..3 {
            // Slopes are below 10 per unit length.
            assert!((inside[i] - outside[i]).abs() < 20.0 * step);
        }
        let y = c.yield_pressure();
        let (before, after) = (
            c.displacement(170.0, y).unwrap(),
            c.displacement(170.0, y * (1.0 + 1e-9)).unwrap(),
        );
        assert!((after / before - 1.0).abs() < 1e-8);
        let elastic = c.elastic().displacement(170.0, y, 0.0);
        assert!((before - elastic).abs() < 1e-15);
    }

    #[test]
    fn displacement_follows_the_elastic_part_by_hookes_law() {
        let c = cylinder();
        let p = c.pressure(150.0);
        let [srr, stt, szz] = c.stress(180.0, p).unwrap();
        let hoop = c.displacement(180.0, p).unwrap() / 180.0;
        assert!((210e3 * hoop - (stt - 0.5 * (srr + szz))).abs() < 1e-9);
    }

    #[test]
    fn residual_stress_leaves_free_edges_and_compressed_bore() {
        let c = cylinder();
        let p = c.pressure(150.0);
        let bore = c.residual_stress(100.0, p).unwrap();
        assert!(bore[0].abs() < 1e-10 && bore[1] < 0.0);
        assert!(c.residual_stress(200.0, p).unwrap()[0].abs() < 1e-10);
        let hoop = |r| c.residual_stress(r, p).unwrap()[1];
        let section = integrate(hoop, 100.0, 150.0) + integrate(hoop, 150.0, 200.0);
        assert!(section.abs() < 1e-8);
        let thick = ElastoplasticCylinder::new(1.0, 10.0, 1.0, 1.0).unwrap();
        assert!(
            thick
                .residual_stress(1.0, 2.1 * thick.yield_pressure())
                .is_err()
        );
    }
}
