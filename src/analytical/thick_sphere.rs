//! Hill's thick sphere: elastic-perfectly plastic under internal pressure, exact for any Poisson's
//! ratio.

use super::domain::{nested_radii, poisson as check_poisson, positive};
use super::plastic_wall::{plastic_front, refuse_reverse_yield};
use crate::error::Result;

/// Thick-walled sphere under internal pressure, elastic or elastic-perfectly plastic.
///
/// Tresca and von Mises agree. The plastic front stands at `c` under the pressure
/// `p(c) = 2 Y ln(c/a) + (2/3) Y (1 - c^3/b^3)`. Plastic part:
/// `s_rr = -2 Y ln(c/r) - (2/3) Y (1 - c^3/b^3)`, `s_tt = s_rr + Y`, `u = (Y r/E) [(1-nu) c^3/r^3 -
/// (2/3)(1-2nu)(1 + 3 ln(c/r) - c^3/b^3)]`. Outside: `s_rr = -(2/3) Y c^3 (1/r^3 - 1/b^3)`, `s_tt =
/// (2/3) Y c^3 (1/(2 r^3) + 1/b^3)`, `u = (Y c^3/E)
/// [(2/3)(1-2nu) r/b^3 + (1+nu)/(3 r^2)]`, so `u(b) = Y c^3 (1-nu)/(E b^2)`. Units are any
/// consistent ones; displacements are positive outwards.
///
/// # Source
/// R. Hill, *The Mathematical Theory of Plasticity*, Oxford 1950, ch. V par. 1, pp. 97-103.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThickSphere {
    /// Inner radius `a`.
    pub inner_radius: f64,
    /// Outer radius `b`.
    pub outer_radius: f64,
    /// Young's modulus.
    pub young: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Tensile yield stress `Y`.
    pub yield_stress: f64,
}

impl ThickSphere {
    /// A sphere with the given radii and material.
    ///
    /// # Errors
    /// `Input` unless `0 < inner_radius < outer_radius`, `young > 0`, `-1 < poisson <= 1/2` and
    /// `yield_stress > 0`, all finite.
    pub fn new(
        inner_radius: f64,
        outer_radius: f64,
        young: f64,
        poisson: f64,
        yield_stress: f64,
    ) -> Result<Self> {
        let what = "thick sphere";
        nested_radii(what, inner_radius, outer_radius)?;
        Ok(ThickSphere {
            inner_radius,
            outer_radius,
            young: positive(what, "Young's modulus", young)?,
            poisson: check_poisson(what, poisson)?,
            yield_stress: positive(what, "yield stress", yield_stress)?,
        })
    }

    /// Pressure at which the bore yields: `(2/3) Y (1 - a^3/b^3)`.
    pub fn yield_pressure(&self) -> f64 {
        self.pressure(self.inner_radius)
    }

    /// Pressure at which the whole wall is plastic: `2 Y ln(b/a)`.
    pub fn collapse_pressure(&self) -> f64 {
        self.pressure(self.outer_radius)
    }

    /// Pressure that holds the plastic front at the radius `front` in `[a, b]`.
    pub fn pressure(&self, front: f64) -> f64 {
        let plastic = (front / self.inner_radius).ln();
        2.0 * self.yield_stress * (plastic + self.shell(front) / 3.0)
    }

    /// Radius of the plastic front under `pressure`; the inner radius as long as the wall is
    /// elastic.
    ///
    /// # Errors
    /// [`Input`](crate::ErrorKind::Input) if the pressure is negative or not a number,
    /// [`Collapse`](crate::ErrorKind::Collapse) if it exceeds the collapse pressure.
    pub fn plastic_front(&self, pressure: f64) -> Result<f64> {
        let wall = [self.inner_radius, self.outer_radius];
        plastic_front("thick sphere", pressure, wall, |front| self.pressure(front))
    }

    /// Stresses `[s_rr, s_tt]` at the radius `r` in `[a, b]` under `pressure`; both hoop stresses
    /// are equal.
    ///
    /// # Errors
    /// Errors of [`plastic_front`](Self::plastic_front).
    pub fn stress(&self, r: f64, pressure: f64) -> Result<[f64; 2]> {
        let front = self.plastic_front(pressure)?;
        let y = self.yield_stress;
        if r < front {
            let srr = -2.0 * y * ((front / r).ln() + self.shell(front) / 3.0);
            return Ok([srr, srr + y]);
        }
        Ok(self.outer_stress(r, self.strength(pressure, front)))
    }

    /// Radial displacement at the radius `r` under `pressure`.
    ///
    /// # Errors
    /// Errors of [`plastic_front`](Self::plastic_front).
    pub fn displacement(&self, r: f64, pressure: f64) -> Result<f64> {
        let front = self.plastic_front(pressure)?;
        let bulk = 2.0 / 3.0 * (1.0 - 2.0 * self.poisson);
        if r < front {
            let shape = 3.0 * (front / r).ln() + self.shell(front);
            let plastic = (1.0 - self.poisson) * (front / r).powi(3) - bulk * shape;
            return Ok(self.yield_stress * r / self.young * plastic);
        }
        let shear = (1.0 + self.poisson) / 3.0;
        let strength = self.strength(pressure, front);
        let b3 = self.outer_radius.powi(3);
        Ok(strength / self.young * (bulk * r / b3 + shear / (r * r)))
    }

    /// Residual stresses `[s_rr, s_tt]` after `pressure` has been removed.
    ///
    /// # Errors
    /// Errors of [`plastic_front`](Self::plastic_front), and `Input` if the pressure exceeds twice
    /// the yield pressure, because the bore then yields again in unloading.
    pub fn residual_stress(&self, r: f64, pressure: f64) -> Result<[f64; 2]> {
        let loaded = self.stress(r, pressure)?;
        refuse_reverse_yield("thick sphere", pressure, self.yield_pressure())?;
        let relief = self.outer_stress(r, self.strength(pressure, self.inner_radius));
        Ok([loaded[0] - relief[0], loaded[1] - relief[1]])
    }

    /// `1 - c^3/b^3`, computed without cancellation for a front near the outer radius.
    fn shell(&self, front: f64) -> f64 {
        let ratio = front / self.outer_radius;
        (1.0 - ratio) * (1.0 + ratio + ratio * ratio)
    }

    /// Coefficient `Y c^3` of the elastic field; below first yield it is scaled by pressure over
    /// yield pressure.
    fn strength(&self, pressure: f64, front: f64) -> f64 {
        let scale = if front <= self.inner_radius {
            pressure / self.yield_pressure()
        } else {
            1.0
        };
        scale * self.yield_stress * front.powi(3)
    }

    fn outer_stress(&self, r: f64, strength: f64) -> [f64; 2] {
        let (r3, b3) = (r.powi(3), self.outer_radius.powi(3));
        let scale = 2.0 / 3.0 * strength;
        [
            -scale * (1.0 / r3 - 1.0 / b3),
            scale * (0.5 / r3 + 1.0 / b3),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::super::quadrature::integrate;
    use super::*;
    use crate::ErrorKind;

    fn sphere() -> ThickSphere {
        ThickSphere::new(100.0, 200.0, 210e3, 0.3, 240.0).unwrap()
    }

    #[test]
    fn stated_pressures_and_outer_displacement() {
        let s = sphere();
        assert!((s.yield_pressure() - 140.0).abs() < 1e-12);
        assert!((s.collapse_pressure() - 480.0 * 2.0_f64.ln()).abs() < 1e-12);
        let c = 150.0_f64;
        let p = 480.0 * 1.5_f64.ln() + 160.0 * (1.0 - 27.0 / 64.0);
        assert!((s.pressure(c) - p).abs() < 1e-12);
        assert!((s.plastic_front(p).unwrap() - c).abs() < 1e-11);
        let u = 240.0 * c.powi(3) * 0.7 / (210e3 * 200.0 * 200.0);
        assert!((s.displacement(200.0, p).unwrap() / u - 1.0).abs() < 1e-13);
    }

    #[test]
    fn in_balance_and_continuous() {
        let s = sphere();
        let p = s.pressure(150.0);
        assert!((s.stress(100.0, p).unwrap()[0] + p).abs() < 1e-11);
        assert!(s.stress(200.0, p).unwrap()[0].abs() < 1e-12);
        // Balance of half the sphere: int s_tt 2 pi r dr = p pi a^2.
        let hoop = |r: f64| 2.0 * r * s.stress(r, p).unwrap()[1];
        let section = integrate(hoop, 100.0, 150.0) + integrate(hoop, 150.0, 200.0);
        assert!((section / (p * 1e4) - 1.0).abs() < 1e-12);
        let step = 1e-7;
        let (inside, outside) = (150.0 - step, 150.0 + step);
        for i in 0..2 {
            let jump = s.stress(inside, p).unwrap()[i] - s.stress(outside, p).unwrap()[i];
            assert!(jump.abs() < 20.0 * step);
        }
        let jump = s.displacement(inside, p).unwrap() - s.displacement(outside, p).unwrap();
        assert!(jump.abs() < step);
        assert!(s.stress(120.0, p).unwrap()[1] - s.stress(120.0, p).unwrap()[0] - 240.0 < 1e-11);
    }

    #[test]
    fn volume_changes_elastically_in_both_parts() {
        let s = sphere();
        let p = s.pressure(150.0);
        let h = 1e-2;
        for r in [110.0, 140.0, 160.0, 190.0] {
            let u = |r| s.displacement(r, p).unwrap();
            let dilatation = (u(r + h) - u(r - h)) / (2.0 * h) + 2.0 * u(r) / r;
            let [srr, stt] = s.stress(r, p).unwrap();
            // The error is (h/r)^2 times strains of 1e-3.
            assert!((dilatation - 0.4 * (srr + 2.0 * stt) / 210e3).abs() < 1e-10);
        }
    }

    #[test]
    fn elastic_is_lame() {
        let s = sphere();
        let (p, r) = (70.0, 130.0_f64);
        let factor = p * 1e6 / 7e6;
        let [srr, stt] = s.stress(r, p).unwrap();
        let ratio = 8e6 / r.powi(3);
        assert!((srr - factor * (1.0 - ratio)).abs() < 1e-12);
        assert!((stt - factor * (1.0 + 0.5 * ratio)).abs() < 1e-12);
        let hoop = s.displacement(r, p).unwrap() / r;
        assert!((210e3 * hoop - (0.7 * stt - 0.3 * srr)).abs() < 1e-11);
        let y = s.yield_pressure();
        let jump = s.displacement(r, y).unwrap() / s.displacement(r, y * (1.0 + 1e-9)).unwrap();
        assert!((jump - 1.0).abs() < 1e-8);
    }

    #[test]
    fn residual_and_errors() {
        let s = sphere();
        let p = s.pressure(130.0);
        let bore = s.residual_stress(100.0, p).unwrap();
        assert!(bore[0].abs() < 1e-11 && bore[1] < 0.0);
        assert!(s.residual_stress(100.0, 2.01 * s.yield_pressure()).is_err());
        assert_eq!(
            s.stress(100.0, 400.0).unwrap_err().kind(),
            ErrorKind::Collapse
        );
        assert_eq!(s.stress(100.0, -1.0).unwrap_err().kind(), ErrorKind::Input);
        assert!(ThickSphere::new(1.0, 1.0, 1.0, 0.3, 1.0).is_err());
    }
}
