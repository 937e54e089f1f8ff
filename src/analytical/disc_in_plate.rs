//! A smooth disc that fills a hole in an infinite plate under tension: the second example of the
//! paper.

use super::domain::{poisson as check_poisson, positive};
use super::quadrature::integrate;
use super::{KirschField, Plane, von_mises};
use crate::error::Result;
use crate::root;
use nalgebra::Complex;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::OnceLock;

/// Frictionless disc in a hole of the same diameter and material, remote tension `S` along `x`.
///
/// The hole closes on the disc around the two poles on the `y` axis and lifts off it elsewhere. The
/// contact is receding: its half angle `e` is 19.625 degrees from the first load on, independent of
/// the tension, modulus, Poisson's ratio and plane idealisation. Every stress is proportional to
/// `S`.
///
/// # Equations
/// With `t` the angle from the pole and `p(t) = sum q_n cos n t` over even `n`, Muskhelishvili's
/// potentials of a disc and of a hole under a radial pressure give the gap (`E*` the contact
/// modulus of the equal bodies, `a` the radius)
///
/// ```text
/// E* g(t)/(2 a) = S/4 (1 - 2 cos 2t) + q_0/2 + sum_{n>=2} n/(n^2-1) q_n cos n t.
/// ```
///
/// Applying `d^2/dt^2 + 1` to the zero gap on `|t| < e` gives a finite Hilbert transform in
/// `tan t`. Its inverse with `p` zero at both ends is the closed form
///
/// ```text
/// p(t) = (q_0/2 + S/4) atanh w + (3/2) S w cos^2 t,        w = sqrt(1 - cos^2 e/cos^2 t),
/// q_0 (1 - L/2) = S/4 L + 3/4 S sin^2 e,                   L = -ln cos e,
/// ```
///
/// where `e` is the root of `g(0) = 0`, the one condition that the differentiation loses. The
/// stress fields follow from `F(z) = q_0 + sum q_n z^n`, which is closed too: nothing here is a
/// table.
///
/// Stresses are positive in tension, pressures in compression. Units are any consistent ones.
///
/// # Source
/// The problem: N. Endahl, section 5.2; M. Stippes, Proc. 4th U.S. Nat. Congr. Appl. Mech. (1962)
/// 799. The solution is derived here as above from N. I. Muskhelishvili, *Some Basic Problems of
/// the Mathematical Theory of Elasticity*, 1953, par. 54-56.
///
/// ```
/// use brinell::analytical::{DiscInPlate, Plane};
/// let disc = DiscInPlate::new(1.0)?;
/// assert!((disc.half_angle().to_degrees() - 19.625).abs() < 5e-4);
/// assert!((disc.pressure(0.0, 1.0) - 0.60908).abs() < 5e-6);
/// assert!((disc.yield_tension(Plane::Stress, 0.3, 1.0)? - 0.3392).abs() < 5e-5);
/// # Ok::<(), brinell::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiscInPlate {
    radius: f64,
    half_angle: f64,
    /// Mean pressure over the tension, `q_0/S`.
    mean_pressure: f64,
}

impl DiscInPlate {
    /// Solves for the contact angle of a disc and hole of radius `radius`.
    ///
    /// # Errors
    /// `Input` if the radius is not finite and positive.
    pub fn new(radius: f64) -> Result<Self> {
        let radius = positive("disc in a plate", "radius", radius)?;
        let half_angle = half_angle();
        Ok(DiscInPlate {
            radius,
            half_angle,
            mean_pressure: mean_pressure(half_angle),
        })
    }

    /// Radius of the disc and the hole.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Half angle of the contact in radians: 19.625 degrees.
    pub fn half_angle(&self) -> f64 {
        self.half_angle
    }

    /// Contact pressure at the angle `from_pole` (radians from the `y` axis) under the remote
    /// tension `tension >= 0`; 0 outside the contact, 0.60908 S at the pole.
    pub fn pressure(&self, from_pole: f64, tension: f64) -> f64 {
        tension * unit_pressure(from_pole, self.half_angle, self.mean_pressure)
    }

    /// Force per thickness with which the plate presses the disc at one pole: the resultant of the
    /// pressure along `y`.
    pub fn pole_force(&self, tension: f64) -> f64 {
        let e = self.half_angle;
        let half = integrate(|t| self.pressure(t, tension) * t.cos(), 0.0, e);
        2.0 * self.radius * half
    }

    /// Gap between disc and hole, a length, at the angle `from_pole`; 0 in the contact.
    /// `contact_modulus` is `E*` of the pair: half of [`Plane::modulus`] for the equal bodies.
    pub fn gap(&self, from_pole: f64, tension: f64, contact_modulus: f64) -> f64 {
        // Fold to the quarter turn next to the pole, because the state is symmetric about both
        // axes.
        let t = (from_pole.sin().abs()).atan2(from_pole.cos().abs());
        let e = self.half_angle;
        if t <= e {
            return 0.0;
        }
        let scale = 2.0 * self.radius * tension / contact_modulus;
        scale * unit_gap(t, e, self.mean_pressure)
    }

    /// Hoop stress of the plate at the edge of the hole: `S (1 + 2 cos 2t) - p(t) + 2 q_0`.
    pub fn edge_hoop_stress(&self, from_pole: f64, tension: f64) -> f64 {
        tension * (1.0 + 2.0 * (2.0 * from_pole).cos() + 2.0 * self.mean_pressure)
            - self.pressure(from_pole, tension)
    }

    /// Stresses `[s_xx, s_yy, s_xy]` in the disc at `(x, y)`, `x^2 + y^2 <= radius^2`.
    pub fn disc_stress(&self, x: f64, y: f64, tension: f64) -> [f64; 3] {
        let z = self.pole_frame(x, y);
        let (f, slope) = self.potential(z);
        // 4 Re phi' and 2 (conj(z) phi'' + psi') with phi' = -F/2, psi' = F'/(2 z).
        let sum = -2.0 * f.re;
        let deviator = slope * edge_factor(1.0 - z.norm_sqr());
        turned(sum, deviator, tension)
    }

    /// Stresses `[s_xx, s_yy, s_xy]` in the plate at `(x, y)`, `x^2 + y^2 >= radius^2`.
    pub fn plate_stress(&self, x: f64, y: f64, tension: f64) -> [f64; 3] {
        let z = self.pole_frame(x, y);
        let w = z.inv();
        let (f, slope) = self.potential(w);
        let q0 = self.mean_pressure;
        // phi' = -(F(1/z) - q_0)/2, psi' = q_0/z^2 - F'(1/z)/(2 z^3).
        let sum = -2.0 * (f.re - q0);
        let w2 = w * w;
        let deviator = w2 * 2.0 * q0 + w2 * w2 * slope * edge_factor(z.norm_sqr() - 1.0);
        let contact = turned(sum, deviator, tension);
        let free = KirschField {
            stress_x: tension,
            stress_y: 0.0,
            radius: self.radius,
        };
        let remote = free.stress(x, y);
        [
            contact[0] + remote[0],
            contact[1] + remote[1],
            contact[2] + remote[2],
        ]
    }

    /// Remote tension at which the plate first yields according to von Mises, at the edge of the
    /// hole at the pole: 0.3392 Y in plane stress, 0.3566 Y in plane strain with `nu = 0.3`.
    ///
    /// # Errors
    /// `Input` if Poisson's ratio lies outside (-1, 0.5] or the yield stress is not finite and
    /// positive.
    pub fn yield_tension(&self, plane: Plane, poisson: f64, yield_stress: f64) -> Result<f64> {
        check_poisson("disc in a plate", poisson)?;
        positive("disc in a plate", "yield stress", yield_stress)?;
        let (radial, hoop) = (-self.pressure(0.0, 1.0), self.edge_hoop_stress(0.0, 1.0));
        let out_of_plane = plane.out_of_plane(radial + hoop, poisson);
        Ok(yield_stress / von_mises([radial, hoop, out_of_plane], 0.0))
    }

    /// The scaled point `(x, y)/radius` as a complex number whose real axis passes through the
    /// poles.
    fn pole_frame(&self, x: f64, y: f64) -> Complex<f64> {
        Complex::new(y, -x) / self.radius
    }

    /// `F(z)` and `F'(z)/z` for unit tension, `|z| <= 1`, poles on the real axis.
    ///
    /// `F = A ln[(g + H)/(2 cos e)] + B sin^2 e g/(H + n)` with `g = 1 + z^2`, `n = 1 - z^2`,
    /// `H^2 = 1 - 2 z^2 cos 2e + z^4`, `A = q_0/2 + 1/4`, `B = 3/2`.
    fn potential(&self, z: Complex<f64>) -> (Complex<f64>, Complex<f64>) {
        let e = self.half_angle;
        let (a, b) = (0.5 * self.mean_pressure + 0.25, 1.5);
        let s2 = e.sin().powi(2);
        let z2 = z * z;
        let (g, n) = (z2 + 1.0, Complex::new(1.0, 0.0) - z2);
        // Each factor has a positive real part in the disc, so the principal roots apply and no
        // branch has to be chosen.
        let edge = Complex::from_polar(1.0, 2.0 * e);
        let one = Complex::new(1.0, 0.0);
        let h = (one - z2 * edge).sqrt() * (one - z2 * edge.conj()).sqrt();
        let f = ((g + h) / (2.0 * e.cos())).ln() * a + g / (h + n) * (b * s2);
        if h.norm_sqr() == 0.0 {
            return (f, Complex::new(0.0, 0.0));
        }
        let h_slope = (z2 - (2.0 * e).cos()) * 2.0 / h;
        let slope = (h_slope + 2.0) / (g + h) * a
            + ((h + n) * 2.0 - g * (h_slope - 2.0)) / ((h + n) * (h + n)) * (b * s2);
        (f, slope)
    }
}

/// Distance from the rim, set to zero within round-off of `|z|^2`, because the distance multiplies
/// a slope that is singular at the edges of the contact.
fn edge_factor(distance: f64) -> f64 {
    if distance.abs() <= 8.0 * f64::EPSILON {
        0.0
    } else {
        distance
    }
}

/// Stresses in `x`, `y` from `s_11 + s_22` and `s_22 - s_11 + 2 i s_12` in the pole frame (`1 = y`,
/// `2 = -x`).
fn turned(sum: f64, deviator: Complex<f64>, tension: f64) -> [f64; 3] {
    let (s11, s22) = (0.5 * (sum - deviator.re), 0.5 * (sum + deviator.re));
    [tension * s22, tension * s11, -0.5 * tension * deviator.im]
}

/// Mean pressure over the tension, `q_0/S`, for the half angle `e`.
fn mean_pressure(e: f64) -> f64 {
    let log = -e.cos().ln();
    (0.25 * log + 0.75 * e.sin().powi(2)) / (1.0 - 0.5 * log)
}

/// Pressure over the tension, `p(t)/S`, at the angle `t`.
fn unit_pressure(t: f64, e: f64, q0: f64) -> f64 {
    let (s, c) = t.sin_cos();
    let c2 = c * c;
    // cos^2 t - cos^2 e = sin(e - t) sin(e + t), without cancellation at the edge; the period is
    // pi.
    let near = s.abs().atan2(c.abs());
    if near >= e {
        return 0.0;
    }
    let w = ((e - near).sin() * (e + near).sin() / c2).sqrt();
    (0.5 * q0 + 0.25) * w.atanh() + 1.5 * c2 * w
}

/// Half angle of the contact, which is the same for every disc and therefore computed only once.
fn half_angle() -> f64 {
    static FOUND: OnceLock<f64> = OnceLock::new();
    // The tension alone lifts the hole off the disc beyond 30 degrees from the pole.
    *FOUND.get_or_init(|| root::of(pole_gap, 1e-3, PI / 6.0))
}

/// `E* g/(2 a S)` at the pole, by the closed Fourier sums of `p`, as an integral of a smooth
/// function.
fn pole_gap(e: f64) -> f64 {
    let (s2, c2) = (e.sin().powi(2), e.cos().powi(2));
    let log = -e.cos().ln();
    let q0 = mean_pressure(e);
    // (1/pi) int p cos t ln cot|t/2| dt for the two parts of p; v = sin x, beta = cos x.
    let first = |x: f64| {
        let (v2, beta) = (x.sin().powi(2), x.cos());
        let h = (s2 + c2 * beta * beta).sqrt();
        let argument = s2 / ((h + beta) * (1.0 + beta));
        (v2 * argument).ln_1p() / v2 + log / (1.0 + beta)
    };
    let second = |x: f64| {
        let (v2, beta) = (x.sin().powi(2), x.cos());
        let h = (s2 + c2 * beta * beta).sqrt();
        s2 * (1.0 + (1.0 + c2 - c2 * v2) / (1.0 + beta * h)) / (2.0 * (h + beta))
    };
    let (j1, j2) = (
        integrate(first, 0.0, FRAC_PI_2),
        integrate(second, 0.0, FRAC_PI_2),
    );
    -0.25 - 0.5 * q0 + (0.5 * q0 + 0.25) * j1 + 1.5 * j2
}

/// Scaled gap `E* g/(2 a S)` at the angle `t` in `[0, pi/2]`, by the integral of the pressure over
/// the contact.
fn unit_gap(t: f64, e: f64, q0: f64) -> f64 {
    // sum_{n even} n/(n^2-1) cos n x = cos x ln|cot(x/2)| - 1/2. The interval is split so that the
    // logarithmic singularity at x = 0 lies at an end.
    let kernel = |x: f64| x.cos() * (0.5 * x).tan().abs().ln();
    let right = |s: f64| unit_pressure(t + s, e, q0) * kernel(s);
    let left = |s: f64| unit_pressure(t - s, e, q0) * kernel(s);
    let sum = if t < e {
        integrate(right, 0.0, e - t) + integrate(left, 0.0, e + t)
    } else {
        integrate(left, t - e, t + e)
    };
    0.25 * (1.0 - 2.0 * (2.0 * t).cos()) - 0.5 * q0 - sum / PI
}

#[cfg(test)]
#[path = "disc_in_plate_tests.rs"]
mod tests;
