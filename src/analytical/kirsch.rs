//! Kirsch's field: a circular hole in an infinite plate under remote stress.

use super::Plane;
use super::domain::{finite, positive};
use crate::error::Result;

/// Stress and displacement around a traction-free circular hole in an infinite plate.
///
/// The origin is at the centre of the hole. The remote state is `s_xx = stress_x`,
/// `s_yy = stress_y`, `s_xy = 0`. The in-plane stresses hold in both plane strain and plane stress.
/// The field is used as far-field traction on the outer edge of a finite mesh. Stresses are
/// positive in tension; units are any consistent ones. Points inside the hole are outside the
/// domain of the formulas.
///
/// # Source
/// G. Kirsch, Z. VDI 42 (1898) 797; S. P. Timoshenko, J. N. Goodier, *Theory of Elasticity*, 3rd
/// ed. 1970, par. 35, pp. 90-92; displacements from the potentials of N. I. Muskhelishvili, *Some
/// Basic Problems of the Mathematical Theory of Elasticity*, 1953, par. 56a.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KirschField {
    /// Remote stress along `x`.
    pub stress_x: f64,
    /// Remote stress along `y`.
    pub stress_y: f64,
    /// Radius of the hole.
    pub radius: f64,
}

impl KirschField {
    /// The field of the remote stresses `stress_x` and `stress_y` around a hole of radius `radius`.
    ///
    /// # Errors
    /// `Input` if a stress is not finite or the radius is not finite and positive.
    pub fn new(stress_x: f64, stress_y: f64, radius: f64) -> Result<Self> {
        Ok(KirschField {
            stress_x: finite("plate with a hole", "remote stress along x", stress_x)?,
            stress_y: finite("plate with a hole", "remote stress along y", stress_y)?,
            radius: positive("plate with a hole", "hole radius", radius)?,
        })
    }

    /// Polar stresses `[s_rr, s_tt (hoop), s_rt]` at the distance `r >= radius` and the angle
    /// `theta` from the `x` axis. With `m = (s_x + s_y)/2`, `d = (s_x - s_y)/2`, `q = a^2/r^2`:
    /// `s_rr = m (1 - q) + d (1 - 4 q + 3 q^2) cos 2t`, `s_tt = m (1 + q) - d (1 + 3 q^2) cos 2t`,
    /// `s_rt = -d (1 + 2 q - 3 q^2) sin 2t`.
    pub fn polar_stress(&self, r: f64, theta: f64) -> [f64; 3] {
        let (sin2, cos2) = (2.0 * theta).sin_cos();
        self.polar(r, cos2, sin2)
    }

    /// Stresses `[s_xx, s_yy, s_xy]` at `(x, y)` outside the hole.
    pub fn stress(&self, x: f64, y: f64) -> [f64; 3] {
        let r = x.hypot(y);
        let (c, s) = (x / r, y / r);
        let (cos2, sin2) = ((c - s) * (c + s), 2.0 * s * c);
        let [srr, stt, srt] = self.polar(r, cos2, sin2);
        let (mean, half) = (0.5 * (srr + stt), 0.5 * (srr - stt));
        [
            mean + half * cos2 - srt * sin2,
            mean - half * cos2 + srt * sin2,
            half * sin2 + srt * cos2,
        ]
    }

    /// Traction `[t_x, t_y]` that the material outside exerts on a cut at `(x, y)` with the unit
    /// outward normal `normal`: the traction to apply to the edge of a finite mesh.
    pub fn traction(&self, x: f64, y: f64, normal: [f64; 2]) -> [f64; 2] {
        let [sxx, syy, sxy] = self.stress(x, y);
        [
            sxx * normal[0] + sxy * normal[1],
            sxy * normal[0] + syy * normal[1],
        ]
    }

    /// Displacement `[u_x, u_y]` at `(x, y)` outside the hole, without rigid body motion: on each
    /// axis of symmetry the component across the axis is 0.
    pub fn displacement(&self, x: f64, y: f64, young: f64, poisson: f64, plane: Plane) -> [f64; 2] {
        let kolosov = plane.kolosov(poisson);
        let shear = young / (2.0 * (1.0 + poisson));
        let along = self.uniaxial_displacement(x, y, kolosov);
        // Tension along y is tension along x turned by a quarter turn: x' = y, y' = -x.
        let across = self.uniaxial_displacement(y, -x, kolosov);
        let scale = self.radius / (8.0 * shear);
        [
            scale * (self.stress_x * along[0] - self.stress_y * across[1]),
            scale * (self.stress_x * along[1] + self.stress_y * across[0]),
        ]
    }

    fn polar(&self, r: f64, cos2: f64, sin2: f64) -> [f64; 3] {
        let mean = 0.5 * (self.stress_x + self.stress_y);
        let half = 0.5 * (self.stress_x - self.stress_y);
        let q = (self.radius / r).powi(2);
        [
            mean * (1.0 - q) + half * (1.0 - q) * (1.0 - 3.0 * q) * cos2,
            mean * (1.0 + q) - half * (1.0 + 3.0 * q * q) * cos2,
            -half * (1.0 - q) * (1.0 + 3.0 * q) * sin2,
        ]
    }

    /// Displacement for unit tension along `x`, in units of `radius/(8 G)`.
    fn uniaxial_displacement(&self, x: f64, y: f64, kolosov: f64) -> [f64; 2] {
        let rho = x.hypot(y) / self.radius;
        let theta = y.atan2(x);
        let (sin, cos) = theta.sin_cos();
        let (sin3, cos3) = (3.0 * theta).sin_cos();
        let (inv, cube) = (2.0 / rho, 2.0 / (rho * rho * rho));
        [
            rho * (kolosov + 1.0) * cos + inv * ((1.0 + kolosov) * cos + cos3) - cube * cos3,
            rho * (kolosov - 3.0) * sin + inv * ((1.0 - kolosov) * sin + sin3) - cube * sin3,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    fn field() -> KirschField {
        KirschField::new(3.0, -1.2, 2.0).unwrap()
    }

    #[test]
    fn hole_is_free_and_concentrates_three_times() {
        let one = KirschField::new(1.0, 0.0, 2.0).unwrap();
        assert!((one.polar_stress(2.0, FRAC_PI_2)[1] - 3.0).abs() < 1e-14);
        assert!((one.polar_stress(2.0, 0.0)[1] + 1.0).abs() < 1e-14);
        for i in 0..12 {
            let [srr, _, srt] = field().polar_stress(2.0, 0.1 + 0.5 * f64::from(i));
            assert!(srr.abs() < 1e-14 && srt.abs() < 1e-14);
        }
    }

    #[test]
    fn cartesian_is_polar_turned_and_uniform_far_away() {
        let f = field();
        let (r, t) = (3.1, 0.7_f64);
        let [srr, stt, srt] = f.polar_stress(r, t);
        let [sxx, syy, sxy] = f.stress(r * t.cos(), r * t.sin());
        let n = [t.cos(), t.sin()];
        let pull = f.traction(r * n[0], r * n[1], n);
        assert!((pull[0] * n[0] + pull[1] * n[1] - srr).abs() < 1e-14);
        assert!((pull[1] * n[0] - pull[0] * n[1] - srt).abs() < 1e-14);
        assert!((sxx + syy - srr - stt).abs() < 1e-14);
        assert!((sxx * syy - sxy * sxy - (srr * stt - srt * srt)).abs() < 1e-13);
        // The disturbance falls as (a/r)^2, with a factor of at most 5 of the greater stress.
        let far = f.stress(2e4, 1e4);
        assert!((far[0] - 3.0).abs() < 2e-7 && (far[1] + 1.2).abs() < 2e-7 && far[2].abs() < 2e-7);
    }

    #[test]
    fn displacement_gives_the_stress_by_hookes_law() {
        let (f, young, nu, h) = (field(), 7.0, 0.3, 1e-5);
        for plane in [Plane::Strain, Plane::Stress] {
            for (x, y) in [(2.5, 0.4), (-0.3, 2.2), (1.9, -2.7)] {
                let at = |x, y| f.displacement(x, y, young, nu, plane);
                let (e, w, n, s) = (at(x + h, y), at(x - h, y), at(x, y + h), at(x, y - h));
                let exx = (e[0] - w[0]) / (2.0 * h);
                let eyy = (n[1] - s[1]) / (2.0 * h);
                let gamma = (e[1] - w[1] + n[0] - s[0]) / (2.0 * h);
                let [sxx, syy, sxy] = f.stress(x, y);
                let szz = plane.out_of_plane(sxx + syy, nu);
                // Errors of central differences: h^2 times third derivatives, and eps/h.
                assert!((young * exx - (sxx - nu * (syy + szz))).abs() < 1e-8);
                assert!((young * eyy - (syy - nu * (sxx + szz))).abs() < 1e-8);
                assert!((young * gamma - 2.0 * (1.0 + nu) * sxy).abs() < 1e-8);
            }
        }
    }

    #[test]
    fn a_ring_is_in_balance() {
        let f = field();
        // The trapezoidal rule is exact for these few harmonics.
        let (mut force, mut moment) = ([0.0; 2], 0.0);
        for i in 0..16 {
            let t = 2.0 * PI * f64::from(i) / 16.0;
            let n = [t.cos(), t.sin()];
            let pull = f.traction(3.0 * n[0], 3.0 * n[1], n);
            force[0] += pull[0];
            force[1] += pull[1];
            moment += n[0] * pull[1] - n[1] * pull[0];
        }
        assert!(force[0].abs() < 1e-13 && force[1].abs() < 1e-13 && moment.abs() < 1e-13);
    }
}
