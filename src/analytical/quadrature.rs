//! Integrals over an interval by the double-exponential rule, for integrands with weak
//! singularities (roots, logarithms) at the ends.

/// Integral of `f` over `[a, b]`: `x = (a+b)/2 + (b-a)/2 tanh(pi/2 sinh t)`, trapezoidal rule in
/// `t`.
///
/// The ends themselves are never evaluated. The relative error is about 1e-14 if the integrand is
/// analytic around the interval, up to distances of the order of the interval's length or, near an
/// end, of the distance to the end. For a root singularity at `b` the error is about 1e-8 times the
/// strength of the singularity if `|b|` exceeds `b - a` (the distance to `b` is then rounded).
///
/// # Source
/// H. Takahasi, M. Mori, Publ. RIMS Kyoto Univ. 9 (1974) 721-741.
pub(super) fn integrate(f: impl Fn(f64) -> f64, a: f64, b: f64) -> f64 {
    const STEPS_PER_UNIT: i32 = 32;
    const LAST: i32 = 4 * STEPS_PER_UNIT;
    let step = 1.0 / f64::from(STEPS_PER_UNIT);
    let mut sum = 0.0;
    for i in -LAST..=LAST {
        let t = f64::from(i) * step;
        let s = std::f64::consts::PI * t.sinh();
        // Fraction of the interval to the nearer end, computed without cancellation.
        let fraction = 1.0 / (1.0 + s.abs().exp());
        let x = if i < 0 {
            a + (b - a) * fraction
        } else {
            b - (b - a) * fraction
        };
        if x == a || x == b {
            continue;
        }
        let weight = std::f64::consts::PI * t.cosh() * fraction * (1.0 - fraction);
        sum += weight * f(x);
    }
    sum * step * (b - a)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn integrates_smooth_root_and_logarithm() {
        assert!((integrate(f64::exp, 0.0, 1.0) - (1.0_f64.exp() - 1.0)).abs() < 1e-14);
        assert!((integrate(|x| (1.0 - x * x).sqrt(), -1.0, 1.0) - 0.5 * PI).abs() < 1e-13);
        assert!((integrate(|x| x.ln(), 0.0, 1.0) + 1.0).abs() < 1e-14);
    }
}
