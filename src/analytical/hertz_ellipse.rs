//! Hertz's contact of bodies of any curvature: the contact is an ellipse.

use super::domain::positive;
use super::elliptic::{elliptic_d, elliptic_k};
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
/// so that `R'/R'' = B a^2/(D b^2)` gives the shape of the ellipse, and any of the three its size.
/// Units are consistent, any; pressures are positive in compression.
///
/// # Source
/// K. L. Johnson, *Contact Mechanics*, Cambridge 1985, section 4.2, eqs (4.25)-(4.28), pp. 95-98.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HertzEllipse {
    /// Relative radii `R_x`, `R_y`, see [`HertzEllipse::relative_radii`].
    pub radii: [f64; 2],
    /// Contact modulus `E*`, see [`contact_modulus`](super::contact_modulus).
    pub contact_modulus: f64,
    /// `b/a`.
    ratio: f64,
}

impl HertzEllipse {
    /// The contact of bodies with the relative radii along x and y.
    ///
    /// # Errors
    /// Where a value is not finite and positive: surfaces that do not part in a direction have no
    /// elliptical contact.
    pub fn new(radii: [f64; 2], contact_modulus: f64) -> Result<Self> {
        for radius in radii {
            positive("elliptical contact", "relative radius", radius)?;
        }
        positive("elliptical contact", "contact modulus", contact_modulus)?;
        let [large, small] = [radii[0].max(radii[1]), radii[0].min(radii[1])];
        // R'/R'' falls with b/a, from infinity to 1.
        let off = |k: f64| {
            let m = (1.0 - k) * (1.0 + k);
            let d = elliptic_d(m);
            (elliptic_k(m) - d) / (d * k * k) - large / small
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

    /// Relative radii along x and y of two bodies whose principal directions are these:
    /// `1/R = 1/R_1 + 1/R_2`, positive radii convex, negative ones hollow, 0 or infinity flat.
    ///
    /// # Errors
    /// Where the bodies do not part along an axis: a hollow that is no wider than what lies in it,
    /// or flat on flat.
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

    /// `b/a`, at most 1.
    pub fn axis_ratio(&self) -> f64 {
        self.ratio
    }

    fn parameter(&self) -> f64 {
        (1.0 - self.ratio) * (1.0 + self.ratio)
    }

    /// Half axes along x and y under `load >= 0`: `a^3 = 3 P R' D/(pi E*)` along the larger radius.
    pub fn semi_axes(&self, load: f64) -> [f64; 2] {
        let large = self.radii[0].max(self.radii[1]);
        let cube = 3.0 * load * large * elliptic_d(self.parameter()) / (PI * self.contact_modulus);
        let a = cube.cbrt();
        match self.radii[0] >= self.radii[1] {
            true => [a, self.ratio * a],
            false => [self.ratio * a, a],
        }
    }

    /// Load under which the half axis along x (0) or y (1) has a length: `P` grows with its cube.
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
        let k = elliptic_k(self.parameter());
        self.max_pressure(load) * x.min(y) * k / self.contact_modulus
    }

    /// Load at which the greatest pressure is `p0`: `P` grows with its cube.
    pub fn load_for_max_pressure(&self, pressure: f64) -> f64 {
        (pressure / self.max_pressure(1.0)).powi(3)
    }

    /// Contact pressure at a place; 0 outside the contact.
    pub fn pressure(&self, [x, y]: [f64; 2], load: f64) -> f64 {
        let [a, b] = self.semi_axes(load);
        let inside = 1.0 - (x / a).powi(2) - (y / b).powi(2);
        self.max_pressure(load) * inside.max(0.0).sqrt()
    }

    /// Pressure `p0` at first yield after von Mises of a body with Poisson's ratio `poisson` and
    /// tensile yield stress `yield_stress`: where the stress below the middle of the contact is
    /// largest. For ellipses with `b/a` from 0.1 on and `nu` from 0.2 to 0.5 no other point is
    /// stressed more (tested).
    pub fn yield_pressure(&self, poisson: f64, yield_stress: f64) -> f64 {
        yield_stress / self.peak(poisson).1
    }

    /// Load at first yield.
    pub fn yield_load(&self, poisson: f64, yield_stress: f64) -> f64 {
        self.load_for_max_pressure(self.yield_pressure(poisson, yield_stress))
    }

    /// Depth below the middle at which yield begins.
    pub fn yield_depth(&self, poisson: f64, yield_stress: f64) -> f64 {
        let [x, y] = self.semi_axes(self.yield_load(poisson, yield_stress));
        self.peak(poisson).0 * x.min(y)
    }

    /// `(depth/b, von Mises/p0)` of the most stressed point of the axis.
    fn peak(&self, poisson: f64) -> (f64, f64) {
        let at = |depth: f64| {
            let [sx, sy, sz] = axis_stress(1.0 / self.ratio, depth, poisson);
            (0.5 * ((sx - sy).powi(2) + (sy - sz).powi(2) + (sz - sx).powi(2))).sqrt()
        };
        maximum(at, 0.2, 1.2, 20)
    }
}

/// Stresses `[s_xx, s_yy, s_zz]` at the depth `z` below the middle, for `p0 = 1` and the half axes
/// `a` along x, 1 along y: the sum of those of the point forces `p dA` at the surface,
///
/// ```text
/// s_zz = -3 z^3/(2 pi rho^5)
/// s_xx = 1/(2 pi) { (1 - 2 nu)/r^2 [(1 - z/rho)(x^2 - y^2)/r^2 + z y^2/rho^3] - 3 z x^2/rho^5 }
/// ```
///
/// # Source
/// Johnson, eqs (3.19), p. 51 (Boussinesq).
fn axis_stress(a: f64, z: f64, poisson: f64) -> [f64; 3] {
    let mut sums = [0.0; 3];
    // With s = sin t along a ray, p dA = a cos^2 t sin t dt dphi: smooth, so that Gauss' rule in t
    // and even steps in phi converge like powers.
    for (t, weight) in gauss(0.0, 0.5 * PI) {
        let (s, c) = t.sin_cos();
        let share = weight * a * c * c * s * (0.5 * PI / RAYS as f64);
        for ray in 0..RAYS {
            let phi = 0.5 * PI * (ray as f64 + 0.5) / RAYS as f64;
            let (x, y) = (a * s * phi.cos(), s * phi.sin());
            let (x2, y2) = (x * x, y * y);
            let r2 = x2 + y2;
            let rho = (r2 + z * z).sqrt();
            // (1 - z/rho)/r^2
            let slope = 1.0 / (rho * (rho + z));
            let spread = (1.0 - 2.0 * poisson) / r2;
            let turn = slope * (x2 - y2);
            let [fx, fy] = [
                spread * (turn + z * y2 / rho.powi(3)),
                spread * (-turn + z * x2 / rho.powi(3)),
            ];
            let third = 3.0 * z / rho.powi(5);
            let stresses = [fx - third * x2, fy - third * y2, -third * z * z];
            for (sum, stress) in sums.iter_mut().zip(stresses) {
                *sum += share * stress;
            }
        }
    }
    // Four quarters over 2 pi.
    sums.map(|sum| sum * 4.0 / (2.0 * PI))
}

/// Rays in a quarter.
const RAYS: usize = 64;
/// Gauss' rule with 8 points on each of 8 parts of an interval.
fn gauss(from: f64, to: f64) -> impl Iterator<Item = (f64, f64)> {
    const HALF: [(f64, f64); 4] = [
        (0.183_434_642_495_649_8, 0.362_683_783_378_362),
        (0.525_532_409_916_329, 0.313_706_645_877_887_3),
        (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
        (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
    ];
    const PARTS: usize = 8;
    let length = (to - from) / PARTS as f64;
    (0..PARTS).flat_map(move |part| {
        let middle = from + (part as f64 + 0.5) * length;
        HALF.into_iter()
            .flat_map(move |(x, w)| [-x, x].map(|x| (middle + 0.5 * length * x, 0.5 * length * w)))
    })
}

#[cfg(test)]
mod tests {
    use super::super::{HertzPoint, contact_modulus};
    use super::*;

    #[test]
    fn a_circle_is_the_point_contact() {
        let modulus = contact_modulus(210e3, 0.3, 210e3, 0.3);
        let ellipse = HertzEllipse::new([8.0, 8.0], modulus).unwrap();
        let point = HertzPoint::new(8.0, modulus).unwrap();
        let load = 700.0;
        let [x, y] = ellipse.semi_axes(load);
        let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
        close(x, point.contact_radius(load));
        assert_eq!(x, y);
        close(ellipse.max_pressure(load), point.max_pressure(load));
        close(ellipse.approach(load), point.approach(load));
        for nu in [0.2, 0.3, 0.45] {
            close(
                ellipse.yield_pressure(nu, 1.0),
                HertzPoint::yield_pressure(nu, 1.0),
            );
            let depth = ellipse.yield_depth(nu, 500.0) / point.yield_depth(nu, 500.0);
            assert!((depth - 1.0).abs() < 1e-6);
        }
        // Nearly a circle, without cancellation.
        let nearly = HertzEllipse::new([8.0, 8.0 * (1.0 + 1e-9)], modulus).unwrap();
        assert!((nearly.axis_ratio() - 1.0).abs() < 1e-9);
    }

    /// Johnson's integrals are satisfied: the displacement of the pressure is the gap that is
    /// closed.
    #[test]
    fn the_pressure_closes_the_gap() {
        let ellipse = HertzEllipse::new([30.0, 4.0], 1000.0).unwrap();
        let load = 50.0;
        let [a, b] = ellipse.semi_axes(load);
        assert!(a > b && (b / a - ellipse.axis_ratio()).abs() < 1e-14);
        // u(0) - u(x) = x^2/(2 R): u = 1/(pi E*) int p/r dA, by rays from the point.
        let displacement = |px: f64, py: f64| {
            let mut sum = 0.0;
            let rays = 400;
            for i in 0..rays {
                let phi = 2.0 * PI * (i as f64 + 0.5) / rays as f64;
                let (c, s) = (phi.cos() / a, phi.sin() / b);
                let (x, y) = (px / a, py / b);
                // Along the ray 1 - |.|^2 is C - 2 B r - A r^2, of which int sqrt dr is elementary.
                let (qa, qb, qc) = (c * c + s * s, x * c + y * s, 1.0 - x * x - y * y);
                let d = qc / qa + (qb / qa).powi(2);
                let u0 = qb / qa;
                let root = (qc / qa).sqrt();
                sum += qa.sqrt() * 0.5 * (d * (0.5 * PI - (u0 / d.sqrt()).asin()) - u0 * root);
            }
            ellipse.max_pressure(load) * sum * 2.0 * PI / rays as f64 / (PI * 1000.0)
        };
        let middle = displacement(0.0, 0.0);
        assert!((middle / ellipse.approach(load) - 1.0).abs() < 1e-10);
        for (x, y) in [(0.4 * a, 0.0), (0.0, 0.7 * b), (0.3 * a, -0.5 * b)] {
            let gap = x * x / 60.0 + y * y / 8.0;
            assert!(
                ((middle - displacement(x, y)) / gap - 1.0).abs() < 1e-9,
                "{x} {y}"
            );
        }
    }

    #[test]
    fn loads_invert_and_axes_exchange() {
        let ellipse = HertzEllipse::new([3.0, 11.0], 500.0).unwrap();
        let turned = HertzEllipse::new([11.0, 3.0], 500.0).unwrap();
        let load = 7.0;
        let [x, y] = ellipse.semi_axes(load);
        assert_eq!(turned.semi_axes(load), [y, x]);
        assert!(y > x);
        for back in [
            ellipse.load_for_semi_axis(0, x),
            ellipse.load_for_semi_axis(1, y),
            ellipse.load_for_max_pressure(ellipse.max_pressure(load)),
        ] {
            assert!((back / load - 1.0).abs() < 1e-13);
        }
        // Equal cylinders that cross at right angles touch in a circle.
        let crossed = HertzEllipse::relative_radii([5.0, f64::INFINITY], [0.0, 5.0]).unwrap();
        assert_eq!(crossed, [5.0, 5.0]);
        assert!(HertzEllipse::relative_radii([5.0, 5.0], [-5.0, 20.0]).is_err());
        assert!(HertzEllipse::relative_radii([5.0, 0.0], [0.0, 0.0]).is_err());
    }

    /// The stress below the middle is the largest: everywhere else it is found by the sum over all
    /// point forces too.
    #[test]
    fn no_other_point_is_stressed_more() {
        for ratio in [0.1, 0.3, 0.6, 1.0] {
            for nu in [0.2, 0.3, 0.5] {
                let ellipse = HertzEllipse {
                    radii: [1.0, 1.0],
                    contact_modulus: 1.0,
                    ratio,
                };
                let peak = ellipse.peak(nu).1;
                for (x, y) in [
                    (0.3, 0.0),
                    (0.0, 0.3),
                    (0.6, 0.0),
                    (0.0, 0.6),
                    (0.4, 0.4),
                    (0.9, 0.0),
                ] {
                    for depth in [0.15, 0.3, 0.45, 0.6, 0.8] {
                        let own = von_mises_at(1.0 / ratio, [x / ratio, y, depth], nu);
                        assert!(
                            own < peak * (1.0 + 1e-3),
                            "{ratio} {nu} {x} {y} {depth}: {own} {peak}"
                        );
                    }
                }
            }
        }
    }

    /// Von Mises stress at any point below the surface, by Boussinesq's point forces.
    fn von_mises_at(a: f64, [px, py, z]: [f64; 3], nu: f64) -> f64 {
        let mut t = [0.0; 6];
        let rays = 256;
        for ray in 0..rays {
            let (sin, cos) = (2.0 * PI * (ray as f64 + 0.5) / rays as f64).sin_cos();
            // From the point outward the square of the pressure is C - 2 B r - A r^2.
            let qa = (cos / a).powi(2) + sin * sin;
            let qb = px * cos / (a * a) + py * sin;
            let qc = 1.0 - (px / a).powi(2) - py * py;
            let end = ((qb * qb + qa * qc).sqrt() - qb) / qa;
            for (v, weight) in gauss(0.0, 1.0) {
                let r = end * v * (2.0 - v);
                let p = (qc - 2.0 * qb * r - qa * r * r).max(0.0).sqrt();
                let share = weight * 2.0 * end * (1.0 - v) * p * r / rays as f64;
                // To the point from there.
                let (x, y) = (-r * cos, -r * sin);
                let (r2, z2) = (r * r, z * z);
                let rho = (r2 + z2).sqrt();
                let (k, third) = (1.0 - 2.0 * nu, 3.0 * z / rho.powi(5));
                let slope = 1.0 / (rho * (rho + z));
                let turn = slope * (x * x - y * y);
                let part = [
                    k / r2 * (turn + z * y * y / rho.powi(3)) - third * x * x,
                    k / r2 * (-turn + z * x * x / rho.powi(3)) - third * y * y,
                    -third * z2,
                    k / r2 * (2.0 * slope * x * y - z * x * y / rho.powi(3)) - third * x * y,
                    -third * z * y,
                    -third * z * x,
                ];
                for (sum, part) in t.iter_mut().zip(part) {
                    *sum += share * part;
                }
            }
        }
        let [x, y, z, xy, yz, zx] = t;
        let normal = (x - y).powi(2) + (y - z).powi(2) + (z - x).powi(2);
        (0.5 * normal + 3.0 * (xy * xy + yz * yz + zx * zx)).sqrt()
    }
}
