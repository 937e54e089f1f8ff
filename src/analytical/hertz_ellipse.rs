//! Hertz's contact of bodies of any curvature: the contact is an ellipse.

use super::Peak;
use super::domain::positive;
use super::elliptic::{carlson_rd, complementary_d, complementary_k};
use super::von_mises::{greatest_shear, von_mises};
use crate::error::{Error, Result};
use crate::root::{self, maximum};
use std::f64::consts::PI;

/// Frictionless contact of elastic bodies whose gap before loading is `x^2/(2 R_x) + y^2/(2 R_y)`.
///
/// The contact is the ellipse with the half axes `a >= b`, the pressure `p0 sqrt(1 - x^2/a^2 -
/// y^2/b^2)` with `p0 = 3 P/(2 pi a b)`. With `e^2 = 1 - b^2/a^2`, the complete elliptic integrals
/// `K`, `D = (K - E)/e^2` and `B = K - D` of the parameter `e^2`, and R' >= R'' the relative radii,
/// of which R' lies along a,
///
/// ```text
/// 1/(2 R') = p0/E* (b/a^2) D         1/(2 R'') = p0/E* B/b         approach = p0 b K/E*
/// ```
///
/// so that `R'/R'' = B a^2/(D b^2)` determines the shape of the ellipse, and any of the three
/// equations its size. Units are any consistent ones; pressures are positive in compression.
///
/// # Source
/// K. L. Johnson, *Contact Mechanics*, Cambridge 1985, section 4.2, eqs (4.25)-(4.28), pp. 95-98.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HertzEllipse {
    /// Relative radii `R_x`, `R_y`, see [`HertzEllipse::relative_radii`].
    pub radii: [f64; 2],
    /// Contact modulus `E*`, see [`contact_modulus`](super::contact_modulus).
    pub contact_modulus: f64,
    /// Ratio of the half axes, `b/a`.
    ratio: f64,
}

impl HertzEllipse {
    /// The contact of bodies with the given relative radii along x and y.
    ///
    /// # Errors
    /// `Input` if a value is not finite and positive: surfaces between which no gap opens in some
    /// direction have no elliptical contact.
    pub fn new(radii: [f64; 2], contact_modulus: f64) -> Result<Self> {
        for radius in radii {
            positive("elliptical contact", "relative radius", radius)?;
        }
        positive("elliptical contact", "contact modulus", contact_modulus)?;
        let [large, small] = [radii[0].max(radii[1]), radii[0].min(radii[1])];
        // R'/R'' decreases with b/a, from infinity to 1.
        let off = |k: f64| {
            let d = complementary_d(k);
            (complementary_k(k) - d) / (d * k * k) - large / small
        };
        Ok(HertzEllipse {
            radii,
            contact_modulus,
            ratio: if large == small {
                1.0
            } else {
                root::of(off, 1e-8, 1.0)
            },
        })
    }

    /// Relative radii along x and y of two bodies whose principal directions are x and y:
    /// `1/R = 1/R_1 + 1/R_2`, with positive radii for convex surfaces, negative ones for hollow
    /// surfaces, 0 or infinity for flat surfaces.
    ///
    /// # Errors
    /// `Input` if no gap opens between the bodies along an axis: a hollow that is no wider than the
    /// body in it, or flat on flat.
    ///
    /// # Source
    /// Johnson, eq. (4.3) for axes that agree.
    pub fn relative_radii(first: [f64; 2], second: [f64; 2]) -> Result<[f64; 2]> {
        let curvature = |radius: f64| if radius == 0.0 { 0.0 } else { 1.0 / radius };
        let mut out = [0.0; 2];
        for (d, axis) in ["x", "y"].into_iter().enumerate() {
            let sum = curvature(first[d]) + curvature(second[d]);
            if !(sum.is_finite() && sum > 0.0) {
                return Err(Error::input(format!(
                    "the radii {} and {} along {axis} leave no gap: a hollow must be wider than \
                     what lies in it, and one of two surfaces curved",
                    first[d], second[d]
                )));
            }
            out[d] = 1.0 / sum;
        }
        Ok(out)
    }

    /// Ratio `b/a` of the half axes, at most 1.
    pub fn axis_ratio(&self) -> f64 {
        self.ratio
    }

    /// Half axes along x and y under `load >= 0`: `a^3 = 3 P R' D/(pi E*)` along the larger radius.
    pub fn semi_axes(&self, load: f64) -> [f64; 2] {
        let large = self.radii[0].max(self.radii[1]);
        let cube = 3.0 * load * large * complementary_d(self.ratio) / (PI * self.contact_modulus);
        let a = cube.cbrt();
        match self.radii[0] >= self.radii[1] {
            true => [a, self.ratio * a],
            false => [self.ratio * a, a],
        }
    }

    /// Load under which the half axis along x (0) or y (1) has the given length. The load is
    /// proportional to the cube of the length.
    pub fn load_for_semi_axis(&self, axis: usize, length: f64) -> f64 {
        (length / self.semi_axes(1.0)[axis]).powi(3)
    }

    /// Greatest pressure `3 P/(2 pi a b)` under `load >= 0`.
    pub fn max_pressure(&self, load: f64) -> f64 {
        let [x, y] = self.semi_axes(load);
        match load > 0.0 {
            true => 1.5 * load / (PI * x * y),
            false => 0.0,
        }
    }

    /// Approach `p0 b K/E*` of points far from the contact under `load >= 0`.
    pub fn approach(&self, load: f64) -> f64 {
        let [x, y] = self.semi_axes(load);
        let k = complementary_k(self.ratio);
        self.max_pressure(load) * x.min(y) * k / self.contact_modulus
    }

    /// Load at which the greatest pressure is `p0`. The load is proportional to the cube of `p0`.
    pub fn load_for_max_pressure(&self, pressure: f64) -> f64 {
        (pressure / self.max_pressure(1.0)).powi(3)
    }

    /// Load at `approach >= 0`. The load is proportional to `approach^(3/2)`.
    pub fn load_for_approach(&self, approach: f64) -> f64 {
        (approach / self.approach(1.0)).powf(1.5)
    }

    /// Contact pressure at a point of the surface; 0 outside the contact.
    pub fn pressure(&self, [x, y]: [f64; 2], load: f64) -> f64 {
        let [a, b] = self.semi_axes(load);
        let inside = 1.0 - (x / a).powi(2) - (y / b).powi(2);
        self.max_pressure(load) * inside.max(0.0).sqrt()
    }

    /// Principal stresses `[s_xx, s_yy, s_zz]` at the depth `z >= 0` below the centre of the
    /// contact, in a body with Poisson's ratio `poisson`.
    ///
    /// With `A^2 = a^2 + z^2`, `B^2 = b^2 + z^2` and, after Carlson,
    /// `I_x = 2/3 R_D(z^2, B^2, A^2)`, `I_y = 2/3 R_D(z^2, A^2, B^2)`, the half axis a along x,
    ///
    /// ```text
    /// s_zz = -p0 a b/(A B)
    /// s_xx = p0 a b [z I_x + nu z I_y - 2 nu/(A B) - (1 - 2 nu)/(A (A + B))]
    /// s_yy = p0 a b [z I_y + nu z I_x - 2 nu/(A B) - (1 - 2 nu)/(B (A + B))]
    /// ```
    ///
    /// from `psi(z) = pi a b p0/2 int_{z^2}^inf dw/((a^2+w)(b^2+w) w)^(1/2)` and its derivatives.
    ///
    /// # Source
    /// K. L. Johnson, *Contact Mechanics*, eqs (3.8), (3.9), (3.58), pp. 48-64; A. Sackfield, D. A.
    /// Hills, J. Strain Analysis 18 (1983) 101-105.
    pub fn stress_below_middle(&self, z: f64, load: f64, poisson: f64) -> [f64; 3] {
        let [x, y] = self.semi_axes(load);
        if x.min(y) == 0.0 {
            return [0.0; 3];
        }
        let [major, minor, down] = axis_stress(1.0 / self.ratio, z / x.min(y), poisson);
        let p0 = self.max_pressure(load);
        match self.radii[0] >= self.radii[1] {
            true => [major, minor, down].map(|s| p0 * s),
            false => [minor, major, down].map(|s| p0 * s),
        }
    }

    /// Shear stress `s_xz` at `y = 0`, or `s_yz` at `x = 0`, in either body: `axis` is 0 or 1, `at`
    /// the distance from the centre along this axis, `z >= 0` the depth.
    ///
    /// With `lambda >= 0` (l for short) the root of `x^2/(a^2 + lambda) + z^2/lambda = 1`, the
    /// shear stress is `-p0 a b x z^2/((a^2 + l)^(3/2) (b^2 + l)^(1/2) l^(3/2) S)` with
    /// `S = x^2/(a^2 + l)^2 + z^2/l^2`, for any Poisson's ratio.
    ///
    /// # Source
    /// Sources of [`stress_below_middle`](Self::stress_below_middle): `s_xz = -z psi_xz/(2 pi)`.
    pub fn shear(&self, axis: usize, at: f64, z: f64, load: f64) -> f64 {
        let axes = self.semi_axes(load);
        let (along, across) = (axes[axis], axes[1 - axis]);
        if along == 0.0 || z == 0.0 {
            return 0.0;
        }
        let (x, z, other) = (at / along, z / along, across / along);
        let q = (x - 1.0) * (x + 1.0) + z * z;
        let root = q.hypot(2.0 * z);
        let l = match q >= 0.0 {
            true => 0.5 * (root + q),
            false => 2.0 * z * z / (root - q),
        };
        let spread = (x / (1.0 + l)).powi(2) + (z / l).powi(2);
        let size = other * x * z * z
            / ((1.0 + l).powf(1.5) * (other * other + l).sqrt() * l.powf(1.5) * spread);
        -self.max_pressure(load) * size
    }

    /// Largest shear stress below the centre of the contact under `load >= 0`: half the largest
    /// difference of principal stresses.
    ///
    /// # Source
    /// K. L. Johnson, *Contact Mechanics*, table 4.1, p. 99, for `nu = 0.3`.
    pub fn largest_shear(&self, load: f64, poisson: f64) -> Peak {
        self.scaled(load, self.peak(greatest_shear, poisson))
    }

    /// Largest von Mises stress below the centre of the contact under `load >= 0`.
    pub fn largest_von_mises(&self, load: f64, poisson: f64) -> Peak {
        self.scaled(
            load,
            self.peak(|stresses| von_mises(stresses, 0.0), poisson),
        )
    }

    /// Amplitude of the shear stress parallel to the surface, along x (0) or y (1), by which a
    /// contact rolling along this axis fatigues the material. The stress reaches this size, with
    /// opposite signs, before and behind the centre of the contact.
    ///
    /// With `t` the root of `(s/o)^2 = (t^2 - 1)(2 t - 1)`, where s is the half axis along the
    /// direction of rolling and o the other one, the amplitude is `p0 (2 t - 1)^(1/2)/(2 t (t +
    /// 1))` at the depth `s/((t + 1)(2 t - 1)^(1/2))`.
    ///
    /// # Source
    /// G. Lundberg, A. Palmgren, Dynamic capacity of rolling bearings, Acta Polytechnica, Mech.
    /// Eng. Ser. 1 (1947) no. 3.
    pub fn orthogonal_shear(&self, axis: usize, load: f64) -> Peak {
        let axes = self.semi_axes(load);
        let along = axes[axis];
        let ratio = match axis == usize::from(self.radii[0] < self.radii[1]) {
            true => 1.0 / self.ratio,
            false => self.ratio,
        };
        let off = |t: f64| (t - 1.0) * (t + 1.0) * (2.0 * t - 1.0) - ratio * ratio;
        let t = root::of(off, 1.0, 1.0 + ratio);
        let width = (2.0 * t - 1.0).sqrt();
        Peak {
            stress: self.max_pressure(load) * width / (2.0 * t * (t + 1.0)),
            depth: along / ((t + 1.0) * width),
        }
    }

    /// Pressure `p0` at which a body with Poisson's ratio `poisson` and tensile yield stress
    /// `yield_stress` first yields according to von Mises, at the point below the centre of the
    /// contact where the stress is largest. For ellipses with `b/a` from 0.1 and `nu` from 0.2 to
    /// 0.5 the stress is no larger at any other point (tested).
    pub fn yield_pressure(&self, poisson: f64, yield_stress: f64) -> f64 {
        yield_stress / self.yield_peak(poisson).stress
    }

    /// Load at first yield according to von Mises.
    pub fn yield_load(&self, poisson: f64, yield_stress: f64) -> f64 {
        self.load_for_max_pressure(self.yield_pressure(poisson, yield_stress))
    }

    /// Depth below the centre at which yield begins.
    pub fn yield_depth(&self, poisson: f64, yield_stress: f64) -> f64 {
        let [x, y] = self.semi_axes(self.yield_load(poisson, yield_stress));
        self.yield_peak(poisson).depth * x.min(y)
    }

    fn yield_peak(&self, poisson: f64) -> Peak {
        self.peak(|stresses| von_mises(stresses, 0.0), poisson)
    }

    /// The largest value below the centre of a function of the principal stresses, for `p0 = b =
    /// 1`.
    fn peak(&self, figure: impl Fn([f64; 3]) -> f64, poisson: f64) -> Peak {
        let at = |depth: f64| figure(axis_stress(1.0 / self.ratio, depth, poisson));
        // At a depth of three half axes the stresses are below a third of p0, and so less than any
        // peak.
        let (depth, stress) = maximum(at, 0.0, 3.0, 300);
        Peak { stress, depth }
    }

    fn scaled(&self, load: f64, unit: Peak) -> Peak {
        let [x, y] = self.semi_axes(load);
        Peak {
            stress: unit.stress * self.max_pressure(load),
            depth: unit.depth * x.min(y),
        }
    }
}

/// Stresses at the depth `z` below the centre, along the half axes `a` and 1 and downwards, for `p0
/// = 1`.
fn axis_stress(a: f64, z: f64, poisson: f64) -> [f64; 3] {
    let squares = [z * z, a * a + z * z, 1.0 + z * z];
    let [za, zb] = match z > 0.0 {
        // The integral has a root of z^2 as its lower end, so z times the integral vanishes at the
        // surface.
        true => [[0, 2, 1], [0, 1, 2]]
            .map(|order| 2.0 / 3.0 * z * carlson_rd(order.map(|i| squares[i]))),
        false => [0.0; 2],
    };
    let [_, ra, rb] = squares.map(f64::sqrt);
    let both = 2.0 * poisson / (ra * rb);
    let share = (1.0 - 2.0 * poisson) / (ra + rb);
    [
        a * (za + poisson * zb - both - share / ra),
        a * (zb + poisson * za - both - share / rb),
        -a / (ra * rb),
    ]
}

#[cfg(test)]
#[path = "hertz_ellipse_tests.rs"]
mod tests;
