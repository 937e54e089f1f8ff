//! Hertz's line contact: two parallel cylinders, or a cylinder on a half plane.

use super::Peak;
use super::domain::positive;
use super::von_mises::{greatest_shear, von_mises};
use crate::error::Result;
use crate::root::maximum;
use std::f64::consts::PI;

/// Frictionless line contact of elastic cylinders with parallel axes in plane strain.
///
/// Half width `b = sqrt(4 P R/(pi E*))`, pressure `p(x) = p0 sqrt(1 - x^2/b^2)` with
/// `p0 = sqrt(P E*/(pi R))`, load `P = pi b p0/2` per length. Valid for `b` small compared with the
/// radii and the size of the bodies. The approach of the bodies depends on their size: each body
/// contributes [`cylinder_compression`](Self::cylinder_compression) or
/// [`half_space_compression`](Self::half_space_compression).
///
/// Units are any consistent ones: `radius` is a length, `contact_modulus` a stress, the load a
/// force per length. Stresses are positive in tension, pressures in compression.
///
/// # Source
/// K. L. Johnson, *Contact Mechanics*, Cambridge 1985, pp. 99-103, eqs (4.43)-(4.49).
///
/// ```
/// use brinell::analytical::{HertzLine, contact_modulus};
/// // NAFEMS R0094 CB1: 35 kN/mm on a cylinder of radius 50 mm.
/// let contact = HertzLine::new(50.0, contact_modulus(210e3, 0.3, 70e3, 0.3))?;
/// assert!((contact.half_width(35e3) - 6.215).abs() < 5e-4);
/// # Ok::<(), brinell::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HertzLine {
    /// Relative radius `R`, see [`relative_radius`](super::relative_radius).
    pub radius: f64,
    /// Contact modulus `E*`, see [`contact_modulus`](super::contact_modulus).
    pub contact_modulus: f64,
}

impl HertzLine {
    /// A line contact with relative radius `radius` and contact modulus `contact_modulus`.
    ///
    /// # Errors
    /// `Input` if either is not finite and positive.
    pub fn new(radius: f64, contact_modulus: f64) -> Result<Self> {
        Ok(HertzLine {
            radius: positive("line contact", "relative radius", radius)?,
            contact_modulus: positive("line contact", "contact modulus", contact_modulus)?,
        })
    }

    /// Half width `b` of the contact under `load >= 0` per length.
    pub fn half_width(&self, load: f64) -> f64 {
        (4.0 * load * self.radius / (PI * self.contact_modulus)).sqrt()
    }

    /// Greatest pressure `p0`, at the centre of the contact, under `load >= 0` per length.
    pub fn max_pressure(&self, load: f64) -> f64 {
        (load * self.contact_modulus / (PI * self.radius)).sqrt()
    }

    /// Load per length that produces a contact of half width `b`: `P = pi E* b^2/(4 R)`.
    pub fn load_for_half_width(&self, half_width: f64) -> f64 {
        PI * self.contact_modulus * half_width * half_width / (4.0 * self.radius)
    }

    /// Load per length at which the greatest pressure is `p0`: `P = pi R p0^2/E*`.
    pub fn load_for_max_pressure(&self, pressure: f64) -> f64 {
        PI * self.radius * pressure * pressure / self.contact_modulus
    }

    /// Contact pressure at the distance `x` from the middle; 0 outside the contact.
    pub fn pressure(&self, x: f64, load: f64) -> f64 {
        let half_width = self.half_width(load);
        if x.abs() >= half_width {
            return 0.0;
        }
        // The product (b - x)(b + x) keeps its digits at the edge.
        let root = ((half_width - x) * (half_width + x)).sqrt();
        self.max_pressure(load) * root / half_width
    }

    /// Stresses `[s_xx, s_yy, s_zz, s_xz]` in either body at `x` along the surface and at the depth
    /// `z >= 0`.
    ///
    /// `y` is the axis of the cylinders, along which the strain is zero: `s_yy = nu (s_xx + s_zz)`.
    /// At the edge of the contact itself (`|x| = b`, `z = 0`) all stresses are 0, their limit along
    /// the surface.
    ///
    /// With `m` and `n`, which have the signs of `z` and `x`, from `m^2 - n^2 = b^2 - x^2 + z^2`,
    /// `m n = x z`: `s_xx = -(p0/b) [m (1 + (z^2+n^2)/(m^2+n^2)) - 2 z]`, `s_zz = -(p0/b) m (1 -
    /// (z^2+n^2)/(m^2+n^2))`, `s_xz = -(p0/b) n (m^2-z^2)/(m^2+n^2)`, evaluated in a form that does
    /// not cancel at any distance.
    ///
    /// # Source
    /// E. McEwen, Phil. Mag. 40 (1949) 454; K. L. Johnson, *Contact Mechanics*, eq. (4.49), p. 103.
    pub fn stress(&self, x: f64, z: f64, load: f64, poisson: f64) -> [f64; 4] {
        let half_width = self.half_width(load);
        let peak = self.max_pressure(load);
        if half_width == 0.0 {
            return [0.0; 4];
        }
        unit_stress(x / half_width, z / half_width, poisson).map(|s| peak * s)
    }

    /// Compression of a cylinder from the contact to the cylinder's axis, if a load `P = load > 0`
    /// (force per unit length) acts at each end of a diameter: `P (1 - nu^2)/(pi E) (2 ln(4 R/b) -
    /// 1)`. Valid if the half width `b` of the contact is small compared with the radius `R` of
    /// this cylinder.
    ///
    /// # Source
    /// K. L. Johnson, *Contact Mechanics*, section 5.6, pp. 129-131.
    pub fn cylinder_compression(&self, load: f64, radius: f64, young: f64, poisson: f64) -> f64 {
        let logarithm = (4.0 * radius / self.half_width(load)).ln();
        load * (1.0 - poisson * poisson) / (PI * young) * (2.0 * logarithm - 1.0)
    }

    /// Displacement of the surface of a half space relative to a point at the depth `depth` below
    /// the contact, under `load > 0` per length: `P (1 - nu^2)/(pi E) (2 ln(2 d/b) - nu/(1 -
    /// nu))`, for `b` small compared with the depth d.
    ///
    /// # Source
    /// K. L. Johnson, *Contact Mechanics*, section 5.6, pp. 130-131.
    pub fn half_space_compression(&self, load: f64, depth: f64, young: f64, poisson: f64) -> f64 {
        let logarithm = (2.0 * depth / self.half_width(load)).ln();
        load * (1.0 - poisson * poisson) / (PI * young)
            * (2.0 * logarithm - poisson / (1.0 - poisson))
    }

    /// Largest shear stress below the centre of the contact under `load >= 0` per length, half the
    /// largest difference of principal stresses: `0.300 p0` at `0.786 b` for `nu` from 0.19 on.
    ///
    /// # Source
    /// K. L. Johnson, *Contact Mechanics*, p. 102 and p. 103.
    pub fn largest_shear(&self, load: f64, poisson: f64) -> Peak {
        self.scaled(load, peak(greatest_shear, poisson))
    }

    /// Largest von Mises stress below the centre of the contact under `load >= 0` per length.
    pub fn largest_von_mises(&self, load: f64, poisson: f64) -> Peak {
        self.scaled(load, peak(|stresses| von_mises(stresses, 0.0), poisson))
    }

    /// Amplitude of the shear stress parallel to the surface, by which a rolling contact fatigues
    /// the material: `p0/4` at the depth `b/2` and `x = 3^(1/2)/2 b` before and behind the middle.
    ///
    /// # Source
    /// K. L. Johnson, *Contact Mechanics*, p. 103 and section 9.2; the value also follows from
    /// [`Self::stress`].
    pub fn orthogonal_shear(&self, load: f64) -> Peak {
        Peak {
            stress: 0.25 * self.max_pressure(load),
            depth: 0.5 * self.half_width(load),
        }
    }

    fn scaled(&self, load: f64, unit: Peak) -> Peak {
        Peak {
            stress: unit.stress * self.max_pressure(load),
            depth: unit.depth * self.half_width(load),
        }
    }

    /// Pressure `p0` at which a body with Poisson's ratio `poisson` and tensile yield stress
    /// `yield_stress` first yields according to von Mises: 1.7937 Y for `nu = 0.3`.
    ///
    /// Found by maximising the von Mises stress over the depth, not taken from a table. For `nu`
    /// below 0.1938 first yield is at the surface, where the von Mises stress is `(1 - 2 nu) p0`.
    ///
    /// # Source
    /// K. L. Johnson, *Contact Mechanics*, pp. 154-155 (Tresca 1.67 Y and, for von Mises and
    /// `nu = 0.3`, 1.79 Y).
    pub fn yield_pressure(poisson: f64, yield_stress: f64) -> f64 {
        yield_stress / peak_von_mises(poisson).stress
    }

    /// Load per length at first yield: `pi R p0^2/E*`; 10.107 R Y^2/E* for `nu = 0.3`.
    pub fn yield_load(&self, poisson: f64, yield_stress: f64) -> f64 {
        self.load_for_max_pressure(Self::yield_pressure(poisson, yield_stress))
    }

    /// Half width at first yield: `2 R p0/E*`; 3.587 R Y/E* for `nu = 0.3`.
    pub fn yield_half_width(&self, poisson: f64, yield_stress: f64) -> f64 {
        2.0 * self.radius * Self::yield_pressure(poisson, yield_stress) / self.contact_modulus
    }

    /// Depth at which yield begins: 0.7043 of the half width at first yield for `nu = 0.3`.
    pub fn yield_depth(&self, poisson: f64, yield_stress: f64) -> f64 {
        peak_von_mises(poisson).depth * self.yield_half_width(poisson, yield_stress)
    }
}

/// Stresses for `b = p0 = 1`.
fn unit_stress(x: f64, z: f64, poisson: f64) -> [f64; 4] {
    // m^2 and -n^2 are the roots of t^2 - q t - x^2 z^2: the root of larger size is computed as a
    // sum, the other one from the product.
    let q = (1.0 - x) * (1.0 + x) + z * z;
    let root = q.hypot(2.0 * x * z);
    let (m, n) = if q >= 0.0 {
        let m = (0.5 * (root + q)).sqrt();
        (m, if m > 0.0 { x * z / m } else { 0.0 })
    } else {
        let n = (0.5 * (root - q)).sqrt().copysign(x);
        (x * z / n, n)
    };
    let spread = m * m + n * n;
    if spread == 0.0 {
        return [0.0; 4];
    }
    // The definitions give m^2 - z^2 = m^2/(m^2 + x^2), so d = m - z needs no subtraction.
    let reach = m * m + x * x;
    let excess = if reach > 0.0 { m * m / reach } else { 1.0 };
    let d = if m + z > 0.0 { excess / (m + z) } else { 0.0 };
    let sxx = -d * (m * d + 2.0 * n * n) / spread;
    let szz = -m * excess / spread;
    let sxz = -n * excess / spread;
    [sxx, poisson * (sxx + szz), szz, sxz]
}

/// The point with the largest von Mises stress for `b = p0 = 1`; it lies on the axis for every
/// `nu`.
fn peak_von_mises(poisson: f64) -> Peak {
    peak(|stresses| von_mises(stresses, 0.0), poisson)
}

/// The largest value below the centre of a function of the principal stresses, for `b = p0 = 1`.
fn peak(figure: impl Fn([f64; 3]) -> f64, poisson: f64) -> Peak {
    let at = |depth: f64| {
        let [sxx, syy, szz, _] = unit_stress(0.0, depth, poisson);
        figure([sxx, syy, szz])
    };
    // At a depth of three half widths the stresses are below a third of p0, and so less than any
    // peak.
    let (depth, stress) = maximum(at, 0.0, 3.0, 300);
    Peak { stress, depth }
}

#[cfg(test)]
mod tests {
    use super::super::contact_modulus;
    use super::*;

    fn contact() -> HertzLine {
        HertzLine::new(50.0, contact_modulus(210e3, 0.3, 70e3, 0.3)).unwrap()
    }

    #[test]
    fn nafems_r0094_cb1() {
        assert!((contact().half_width(35e3) - 6.215).abs() < 5e-4);
        assert!((contact().max_pressure(35e3) - 3585.0).abs() < 0.5);
    }

    #[test]
    fn first_yield_of_the_paper() {
        let line = HertzLine::new(1.0, 1.0).unwrap();
        assert!((HertzLine::yield_pressure(0.3, 1.0) - 1.7937).abs() < 5e-5);
        let ratio = line.yield_depth(0.3, 1.0) / line.yield_half_width(0.3, 1.0);
        assert!((ratio - 0.7043).abs() < 5e-5);
        assert!((line.yield_load(0.3, 1.0) - 10.107).abs() < 1e-3);
        assert!((line.yield_half_width(0.3, 1.0) - 3.587).abs() < 5e-4);
        let load = line.yield_load(0.3, 1.0);
        assert!((line.half_width(load) / line.yield_half_width(0.3, 1.0) - 1.0).abs() < 1e-14);
        assert!((line.max_pressure(load) / 1.7937 - 1.0).abs() < 5e-5);
    }

    #[test]
    fn incompressible_yield_is_trescas_and_small_poisson_yields_at_the_surface() {
        // For nu = 1/2 the von Mises stress is sqrt(3) times the greatest shear, 0.300 p0 at 0.786
        // b (Johnson p. 102).
        let Peak {
            depth,
            stress: peak,
        } = peak_von_mises(0.5);
        assert!((peak / 3.0_f64.sqrt() - 0.300).abs() < 5e-4);
        assert!((depth - 0.786).abs() < 5e-4);
        let at_surface = Peak {
            stress: 1.0,
            depth: 0.0,
        };
        assert_eq!(peak_von_mises(0.0), at_surface);
        assert_eq!(peak_von_mises(0.1937).depth, 0.0);
        assert!(peak_von_mises(0.1939).depth > 0.5);
    }

    #[test]
    fn the_peak_lies_on_the_axis() {
        for nu in [0.0, 0.1, 0.2, 0.3, 0.4, 0.5] {
            let peak = peak_von_mises(nu).stress;
            for i in 1..200 {
                for j in 0..150 {
                    let [sxx, syy, szz, sxz] = unit_stress(0.01 * i as f64, 0.02 * j as f64, nu);
                    assert!(von_mises([sxx, syy, szz], sxz) <= peak * (1.0 + 1e-14));
                }
            }
        }
    }

    #[test]
    fn surface_carries_the_pressure_and_nothing_else() {
        let (line, load) = (contact(), 35e3);
        let b = line.half_width(load);
        for i in -30..=30 {
            let x = 0.1 * b * f64::from(i);
            let [sxx, _, szz, sxz] = line.stress(x, 0.0, load, 0.3);
            let p = line.pressure(x, load);
            // At the edge the root turns a round-off eps of x into sqrt(eps) of p0.
            let tolerance = 4.0 * f64::EPSILON.sqrt() * line.max_pressure(load);
            assert!((szz + p).abs() <= tolerance && (sxx + p).abs() <= tolerance);
            assert!(sxz.abs() <= tolerance);
        }
    }

    #[test]
    fn field_is_in_equilibrium() {
        // Central differences: error h^2/6 times third derivatives (of order 10 here), round-off
        // eps/h.
        let h = 1e-4;
        for (x, z) in [(0.0, 0.7), (0.5, 0.3), (-0.9, 0.4), (1.5, 0.2), (-2.0, 3.0)] {
            let at = |x, z| unit_stress(x, z, 0.3);
            let (e, w) = (at(x + h, z), at(x - h, z));
            let (d, u) = (at(x, z + h), at(x, z - h));
            let along = (e[0] - w[0] + d[3] - u[3]) / (2.0 * h);
            let down = (e[3] - w[3] + d[2] - u[2]) / (2.0 * h);
            assert!(along.abs() < 1e-6 && down.abs() < 1e-6, "{along} {down}");
        }
    }

    #[test]
    fn pressure_and_every_deeper_plane_carry_the_load() {
        let (line, load) = (contact(), 35e3);
        let b = line.half_width(load);
        let total = super::super::quadrature::integrate(|x| line.pressure(x, load), -b, b);
        assert!((total / load - 1.0).abs() < 1e-12);
        // The integral of -s_zz over the plane z = b, with x = z tan(t).
        let below = super::super::quadrature::integrate(
            |t| -line.stress(b * t.tan(), b, load, 0.3)[2] * b / t.cos().powi(2),
            -0.5 * PI,
            0.5 * PI,
        );
        assert!((below / load - 1.0).abs() < 1e-12, "{}", below / load);
    }

    #[test]
    fn far_away_it_is_flamants_point_load() {
        // s_rr = -2 P cos(t)/(pi r), with a relative error of (b/r)^2.
        let (line, load) = (contact(), 35e3);
        let r = 1e4 * line.half_width(load);
        for angle in [0.0_f64, 0.4, -1.2] {
            let (x, z) = (r * angle.sin(), r * angle.cos());
            let [sxx, _, szz, sxz] = line.stress(x, z, load, 0.3);
            let radial = -2.0 * load * angle.cos() / (PI * r);
            let scale = 1e-7 * radial.abs();
            assert!((sxx - radial * angle.sin().powi(2)).abs() < scale);
            assert!((szz - radial * angle.cos().powi(2)).abs() < scale);
            assert!((sxz - radial * angle.sin() * angle.cos()).abs() < scale);
        }
    }

    #[test]
    fn load_and_width_invert_and_follow_the_root_of_the_load() {
        let line = contact();
        assert!((line.load_for_half_width(line.half_width(123.0)) / 123.0 - 1.0).abs() < 1e-14);
        assert!((line.load_for_max_pressure(line.max_pressure(123.0)) / 123.0 - 1.0).abs() < 1e-14);
        assert!((line.half_width(4.0) / line.half_width(1.0) - 2.0).abs() < 1e-14);
        assert_eq!(line.stress(1.0, 1.0, 0.0, 0.3), [0.0; 4]);
        assert!(HertzLine::new(0.0, 1.0).is_err());
        assert!(HertzLine::new(1.0, f64::NAN).is_err());
    }

    /// Johnson pp. 102-103: 0.30 p0 at 0.786 b, p0/4 at b/2; the shear of the field is nowhere
    /// larger.
    #[test]
    fn largest_shears() {
        let (line, load) = (contact(), 35e3);
        let (p0, b) = (line.max_pressure(load), line.half_width(load));
        let largest = line.largest_shear(load, 0.3);
        assert!((largest.stress / p0 - 0.300).abs() < 5e-4);
        assert!((largest.depth / b - 0.786).abs() < 5e-4);
        let orthogonal = line.orthogonal_shear(load);
        let x = 0.75f64.sqrt() * b;
        let there = line.stress(-x, orthogonal.depth, load, 0.3)[3];
        assert!((there / orthogonal.stress - 1.0).abs() < 1e-14);
        for i in 1..100 {
            for j in 1..100 {
                let [x, z] = [i, j].map(|i| 0.02 * b * f64::from(i));
                let shear = line.stress(x, z, load, 0.3)[3].abs();
                assert!(shear <= orthogonal.stress * (1.0 + 1e-14));
            }
        }
    }

    /// The compressions are the integrals, from the surface to the depth, of the strains of
    /// McEwen's field and of the field that a cylinder adds to it; terms of (b/d)^2 are neglected.
    #[test]
    fn compressions_are_integrals_of_the_strain() {
        let (line, load, young, nu) = (contact(), 200.0, 210e3, 0.3);
        let b = line.half_width(load);
        let strain = |sx: f64, sz: f64| (1.0 - nu * nu) / young * (sz - nu / (1.0 - nu) * sx);
        let depth = 1e4 * b;
        let below = -super::super::quadrature::integrate(
            |z| {
                let [sx, _, sz, _] = line.stress(0.0, z, load, nu);
                strain(sx, sz)
            },
            0.0,
            depth,
        );
        let found = line.half_space_compression(load, depth, young, nu);
        assert!((below / found - 1.0).abs() < 1e-7, "{below} {found}");
        // The opposite line load, and the tension that makes the circle traction-free (Timoshenko
        // and Goodier, par. 41).
        let radius = depth;
        let whole = -super::super::quadrature::integrate(
            |z| {
                let [sx, _, sz, _] = line.stress(0.0, z, load, nu);
                let all_round = load / (PI * radius);
                let opposite = -2.0 * load / (PI * (2.0 * radius - z));
                strain(sx + all_round, sz + all_round + opposite)
            },
            0.0,
            radius,
        );
        let found = line.cylinder_compression(load, radius, young, nu);
        assert!((whole / found - 1.0).abs() < 1e-7, "{whole} {found}");
    }
}
