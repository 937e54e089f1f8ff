//! Complete elliptic integrals.

use std::f64::consts::PI;

/// Complete elliptic integral of the first kind, `K = int_0^{pi/2} dt/sqrt(1 - m sin^2 t)`, of the
/// parameter `m = e^2 < 1`: `pi/(2 agm(1, sqrt(1 - m)))`, to round-off.
///
/// # Source
/// M. Abramowitz, I. A. Stegun, *Handbook of Mathematical Functions*, 17.3.1, 17.6.3.
pub fn elliptic_k(m: f64) -> f64 {
    complementary_k((1.0 - m).sqrt())
}

/// Complete elliptic integral of the second kind, `E = int_0^{pi/2} sqrt(1 - m sin^2 t) dt`.
pub fn elliptic_e(m: f64) -> f64 {
    elliptic_k(m) - m * elliptic_d(m)
}

/// `D = (K - E)/m = int_0^{pi/2} sin^2 t/sqrt(1 - m sin^2 t) dt`, without cancellation at `m = 0`,
/// where it is `pi/4`: a third of Carlson's `R_D(0, 1 - m, 1)`.
pub fn elliptic_d(m: f64) -> f64 {
    carlson_rd([0.0, 1.0 - m, 1.0]) / 3.0
}

/// `K` of the parameter `1 - k^2`, for any `k > 0` to round-off: `pi/(2 agm(1, k))`.
pub(super) fn complementary_k(k: f64) -> f64 {
    let (mut a, mut g) = (1.0, k);
    while (a - g).abs() > 2.0 * f64::EPSILON * a {
        (a, g) = (0.5 * (a + g), (a * g).sqrt());
    }
    0.5 * PI / a
}

/// `D` of the parameter `1 - k^2`, for any `k > 0` to round-off.
pub(super) fn complementary_d(k: f64) -> f64 {
    carlson_rd([0.0, k * k, 1.0]) / 3.0
}

/// Carlson's `R_D(x, y, z) = 3/2 int_0^inf dt/((t + x)^(1/2) (t + y)^(1/2) (t + z)^(3/2))`, for
/// `z > 0` and not negative `x` and `y` of which one at most is 0.
///
/// # Source
/// B. C. Carlson, Numerical computation of real or complex elliptic integrals, Numer. Algorithms 10
/// (1995) 13-26, doi:10.1007/BF02198293 (duplication).
pub(super) fn carlson_rd([mut x, mut y, mut z]: [f64; 3]) -> f64 {
    let (mut sum, mut factor) = (0.0, 1.0);
    loop {
        let mean = (x + y + 3.0 * z) / 5.0;
        let [dx, dy, dz] = [x, y, z].map(|v| (mean - v) / mean);
        if dx.abs().max(dy.abs()).max(dz.abs()) < 1e-3 {
            let (ea, eb) = (dx * dy, dz * dz);
            let (ec, ed) = (ea - eb, ea - 6.0 * eb);
            let ee = ed + 2.0 * ec;
            let series = 1.0
                + ed * (-3.0 / 14.0 + 9.0 / 88.0 * ed - 4.5 / 26.0 * dz * ee)
                + dz * (ee / 6.0 + dz * (-9.0 / 22.0 * ec + dz * 3.0 / 26.0 * ea));
            return 3.0 * sum + factor * series / (mean * mean.sqrt());
        }
        let roots = [x, y, z].map(f64::sqrt);
        let lambda = roots[0] * roots[1] + roots[1] * roots[2] + roots[2] * roots[0];
        sum += factor / (roots[2] * (z + lambda));
        factor *= 0.25;
        [x, y, z] = [x, y, z].map(|v| 0.25 * (v + lambda));
    }
}

#[cfg(test)]
mod tests {
    use super::super::quadrature::integrate;
    use super::*;

    /// The integrals agree with their definitions, the limit of a circle, and Legendre's relation.
    #[test]
    fn integrals_are_those_of_their_definition() {
        for m in [0.0, 1e-9, 0.1, 0.5, 0.9, 0.999] {
            let root = |t: f64| (1.0 - m * t.sin().powi(2)).sqrt();
            let d = integrate(|t| t.sin().powi(2) / root(t), 0.0, 0.5 * PI);
            let k = integrate(|t| 1.0 / root(t), 0.0, 0.5 * PI);
            let e = integrate(root, 0.0, 0.5 * PI);
            for (found, exact) in [(elliptic_k(m), k), (elliptic_e(m), e), (elliptic_d(m), d)] {
                assert!((found / exact - 1.0).abs() < 1e-13, "{m}: {found} {exact}");
            }
            if m > 0.0 {
                let (n, minus) = (1.0 - m, elliptic_k(m) * elliptic_k(1.0 - m));
                let sum = elliptic_e(m) * elliptic_k(n) + elliptic_e(n) * elliptic_k(m);
                assert!((sum - minus - 0.5 * PI).abs() < 1e-13 * sum);
            }
        }
        assert!((elliptic_d(0.0) - 0.25 * PI).abs() < 1e-15);
    }

    /// `R_D` compared with its integral, and `K` and `D` near the limit of a line with their
    /// series: for small `k`, `K = ln(4/k) + k^2 (ln(4/k) - 1)/4`, `E = 1 + k^2 (ln(4/k) - 1/2)/2`.
    #[test]
    fn carlsons_integral_and_long_ellipses() {
        for [x, y, z] in [
            [0.0, 1.0, 2.0],
            [0.3, 7.0, 0.2],
            [2.0, 2.0, 2.0],
            [1e-3, 40.0, 5.0],
        ] {
            // Substitution t = tan^2 s.
            let whole = integrate(
                |s: f64| {
                    let t = s.tan().powi(2);
                    let slope = 2.0 * s.tan() / s.cos().powi(2);
                    slope / ((t + x) * (t + y)).sqrt() / (t + z).powf(1.5)
                },
                0.0,
                0.5 * PI,
            );
            let found = carlson_rd([x, y, z]);
            assert!(
                (found / (1.5 * whole) - 1.0).abs() < 1e-11,
                "{x} {y} {z}: {found}"
            );
        }
        for k in [1e-3f64, 1e-6, 1e-9] {
            let l = (4.0 / k).ln();
            let long = l + 0.25 * k * k * (l - 1.0);
            assert!((complementary_k(k) / long - 1.0).abs() < 1e-11, "{k}");
            // D = (K - E)/(1 - k^2).
            let d = (long - 1.0 - 0.5 * k * k * (l - 0.5)) / (1.0 - k * k);
            assert!((complementary_d(k) / d - 1.0).abs() < 1e-11, "{k}");
        }
    }
}
