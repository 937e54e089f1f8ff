//! The uncertainty of a value from those on other meshes: the procedure of Eca and Hoekstra.
//!
//! A quantity that converges with order `p` in the element size `h` obeys `q(h) = q0 + a h^p`. The
//! constants come from a least-squares fit over the meshes, once with equal weights and once with
//! weights `1/h`, whichever leaves less. An order between [`LEAST_ORDER`] and the formal one of the
//! elements is believed; else the better of the laws of first and of formal order takes its place.
//! With `s` the standard deviation of the fit and `d` the range of the values over the number of
//! meshes less one, the uncertainty of the finest value `q` is
//!
//! ```text
//!     F |a| h^p + s + |q - q_fit|              where s < d,
//!     3 s/d (|a| h^p + s + |q - q_fit|)        else,
//! ```
//!
//! The factor of safety `F` is 1.25 where the order is believed and 3 otherwise; the uncertainty
//! then is no smaller than `d` either: values that agree by chance have no order. Two meshes, which
//! leave it open, state 3 times the error of the formal one.
//!
//! # Source
//! L. Eca, M. Hoekstra, A procedure for the estimation of the numerical uncertainty of CFD
//! calculations based on grid refinement studies, J. Comput. Phys. 262 (2014) 104-130,
//! doi:10.1016/j.jcp.2014.01.006. The factors: P. J. Roache,
//! *Verification and Validation in Computational Science and Engineering*, Hermosa 1998, chapter 5.

use crate::root;

/// Lowest order that is believed (Eca and Hoekstra, section 3).
pub(super) const LEAST_ORDER: f64 = 0.5;
/// How far an order may exceed the formal one and still have the small factor of safety (Eca and
/// Hoekstra, section 3).
const ABOVE_FORMAL: f64 = 0.1;
/// Factor of safety where the meshes show an order that is believed (Roache).
const SAFETY: f64 = 1.25;
/// Factor of safety where the meshes show no order that is believed (Roache).
const SAFETY_WITHOUT_ORDER: f64 = 3.0;
/// Range of orders in which the best is sought, and the number of steps over it: beyond this range
/// meshes do not show the order.
const SOUGHT: [f64; 2] = [-2.0, 8.0];
const STEPS: usize = 200;

/// What a family of meshes says about its finest member.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extrapolation {
    /// Stated uncertainty of the first value, factor of safety included.
    pub uncertainty: f64,
    /// The order of convergence that fits best; `None` with two meshes, and where all values are
    /// the same.
    pub order: Option<f64>,
    /// The value extrapolated to an element size of zero, where the order is believed.
    pub limit: Option<f64>,
}

/// The uncertainty of the first of values `(h, q)` with their element sizes, by the formal order of
/// the elements. `None` for fewer than two values, equal sizes or values that are no numbers.
pub fn extrapolate(values: &[(f64, f64)], formal: f64) -> Option<Extrapolation> {
    let [(h, q), others @ ..] = values else {
        return None;
    };
    let is_usable = |v: &(f64, f64)| v.1.is_finite() && v.0 > 0.0;
    if others.is_empty() || !values.iter().all(is_usable) || others.iter().any(|v| v.0 == *h) {
        return None;
    }
    let range = range(values);
    if range == 0.0 {
        let uncertainty = 0.0;
        return Some(Extrapolation {
            uncertainty,
            order: None,
            limit: Some(*q),
        });
    }
    if let [(other, value)] = others {
        let error = (value - q).abs() / ((other / h).powf(formal) - 1.0).abs();
        return Some(Extrapolation {
            uncertainty: SAFETY_WITHOUT_ORDER * error,
            order: None,
            limit: None,
        });
    }
    let free = best(values, &orders());
    let order = free.order;
    let is_believed = (LEAST_ORDER..=formal).contains(&order);
    let fit = if is_believed {
        free
    } else {
        best(values, &[1.0, formal])
    };
    let is_reliable = (LEAST_ORDER..=formal + ABOVE_FORMAL).contains(&order);
    let [safety, least] = if is_reliable {
        [SAFETY, 0.0]
    } else {
        [SAFETY_WITHOUT_ORDER, range / (values.len() - 1) as f64]
    };
    // The law of a free order has three constants, that of a given one two.
    let constants = if is_believed { 3 } else { 2 };
    let n = values.len();
    let deviation = scatter(fit.square, n, constants);
    let error = (fit.slope * h.powf(fit.order)).abs();
    let off = (q - fit.limit - fit.slope * h.powf(fit.order)).abs();
    let per_mesh = range / (n - 1) as f64;
    let uncertainty = match deviation < per_mesh {
        true => safety * error + deviation + off,
        false => SAFETY_WITHOUT_ORDER * deviation / per_mesh * (error + deviation + off),
    };
    Some(Extrapolation {
        uncertainty: uncertainty.max(least),
        order: Some(order),
        limit: is_reliable.then_some(fit.limit),
    })
}

/// Standard deviation of `n` values about a law that was fitted to them, from the mean square of
/// what it leaves over: each constant of the law takes one value's share of the scatter away.
fn scatter(square: f64, n: usize, constants: usize) -> f64 {
    match n > constants {
        true => (n as f64 * square / (n - constants) as f64).sqrt(),
        false => 0.0,
    }
}

/// Largest less smallest value.
fn range(values: &[(f64, f64)]) -> f64 {
    let of = |pick: fn(f64, f64) -> f64| values.iter().map(|v| v.1).reduce(pick).unwrap_or(0.0);
    of(f64::max) - of(f64::min)
}

/// The orders that are tried; not zero, which is no law.
fn orders() -> Vec<f64> {
    let [low, high] = SOUGHT;
    let step = (high - low) / STEPS as f64;
    let all = (0..STEPS).map(|i| low + step * (i as f64 + 0.5));
    all.collect()
}

/// A law `q = limit + slope h^order` and the weighted mean of its squared deviations.
#[derive(Debug, Clone, Copy)]
struct FittedLaw {
    order: f64,
    slope: f64,
    limit: f64,
    square: f64,
}

/// The law that fits best, of these orders and both weightings; between two neighbouring orders by
/// the parabola through their deviations.
fn best(values: &[(f64, f64)], orders: &[f64]) -> FittedLaw {
    let total: f64 = values.iter().map(|(h, _)| 1.0 / h).sum();
    let equal = |_: f64| 1.0 / values.len() as f64;
    let finer = |h: f64| 1.0 / h / total;
    let of = |order: f64| {
        let fits = [fit(values, order, equal), fit(values, order, finer)];
        if fits[1].square < fits[0].square {
            fits[1]
        } else {
            fits[0]
        }
    };
    let all: Vec<FittedLaw> = orders.iter().map(|order| of(*order)).collect();
    let mut least = 0;
    for (i, fit) in all.iter().enumerate() {
        if fit.square < all[least].square {
            least = i;
        }
    }
    let neighbours = least.checked_sub(1).zip(all.get(least + 1));
    let Some((before, after)) = neighbours.filter(|_| orders.len() > 2) else {
        return all[least];
    };
    let deviation = |order: f64| -of(order).square;
    of(root::maximum(deviation, all[before].order, after.order, 1).0)
}

/// Weighted least squares with a given order.
fn fit(values: &[(f64, f64)], order: f64, weight: impl Fn(f64) -> f64) -> FittedLaw {
    let mean = |f: &dyn Fn(f64, f64) -> f64| -> f64 {
        values
            .iter()
            .map(|(h, q)| weight(*h) * f(h.powf(order), *q))
            .sum()
    };
    let (mean_x, mean_q) = (mean(&|x, _| x), mean(&|_, q| q));
    let slope = mean(&|x, q| (x - mean_x) * (q - mean_q)) / mean(&|x, _| (x - mean_x).powi(2));
    let limit = mean_q - slope * mean_x;
    FittedLaw {
        order,
        slope,
        limit,
        square: mean(&|x, q| (q - limit - slope * x).powi(2)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sampled(sizes: &[f64], q: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        sizes.iter().map(|&h| (h, q(h))).collect()
    }

    /// Three meshes determine a power law: its error comes out with the factor of safety of a
    /// believed order.
    #[test]
    fn a_power_law_is_found_with_its_order_error_and_limit() {
        for order in [0.7, 1.0, 1.5, 2.0] {
            for sizes in [&[1.0, 1.5, 2.0][..], &[1.0, 1.4, 2.2, 3.1]] {
                let values = sampled(sizes, |h| 7.0 - 0.3 * h.powf(order));
                let found = extrapolate(&values, 2.0).unwrap();
                assert!((found.order.unwrap() - order).abs() < 1e-5, "{found:?}");
                assert!((found.limit.unwrap() - 7.0).abs() < 1e-5, "{found:?}");
                let wanted = 1.25 * 0.3;
                assert!((found.uncertainty / wanted - 1.0).abs() < 1e-4, "{found:?}");
            }
        }
    }

    /// Where the order is not believed the law of first or formal order has the larger factor.
    #[test]
    fn an_order_out_of_bounds_costs_the_larger_factor() {
        for order in [0.2, 3.5, -0.5] {
            let values = sampled(&[1.0, 1.5, 2.0], |h| 7.0 - 0.3 * h.powf(order));
            let found = extrapolate(&values, 2.0).unwrap();
            assert!((found.order.unwrap() - order).abs() < 1e-5, "{found:?}");
            assert_eq!(found.limit, None);
            let slopes = [1.0, 2.0].map(|p| fit(&values, p, |_| 1.0 / 3.0).slope.abs());
            let least = 3.0 * slopes[0].min(slopes[1]) * 0.8;
            assert!(found.uncertainty >= least, "{order}: {found:?}");
        }
    }

    #[test]
    fn two_meshes_state_three_times_the_error_of_the_formal_order() {
        let found = extrapolate(&[(1.0, 3.0), (2.0, 3.6)], 2.0).unwrap();
        assert!((found.uncertainty - 3.0 * 0.2).abs() < 1e-15);
        let finer = extrapolate(&[(1.0, 3.0), (0.5, 3.6)], 2.0).unwrap();
        assert!((finer.uncertainty - 3.0 * 0.8).abs() < 1e-15);
        assert_eq!((found.order, found.limit), (None, None));
        assert_eq!(extrapolate(&[(1.0, 3.0)], 2.0), None);
        assert_eq!(extrapolate(&[(1.0, 3.0), (1.0, 4.0)], 2.0), None);
        assert_eq!(extrapolate(&[(1.0, 3.0), (2.0, f64::NAN)], 2.0), None);
    }

    /// Values that agree on two meshes by chance have at least the range that the third shows, per
    /// mesh.
    #[test]
    fn agreement_by_chance_is_no_accuracy() {
        let found = extrapolate(&[(1.0, 7.0), (1.5, 7.0 + 1e-9), (2.0, 7.4)], 2.0).unwrap();
        assert!(found.uncertainty >= 0.2, "{found:?}");
        let same = extrapolate(&[(1.0, 7.0), (1.5, 7.0), (2.0, 7.0)], 2.0).unwrap();
        assert_eq!((same.uncertainty, same.limit), (0.0, Some(7.0)));
    }

    /// No power law: up and down. The deviation of the best line is in the statement, and more than
    /// the range per mesh.
    #[test]
    fn scatter_enters_the_uncertainty() {
        let found = extrapolate(&[(1.0, 0.0), (1.5, 1.0), (2.0, -1.0), (2.5, 1.0)], 2.0).unwrap();
        assert!(found.uncertainty > 2.0, "{found:?}");
        // Units and offsets are no matter.
        let scaled = [
            (2.0, 10.0),
            (3.0, 10.0 + 1e-3),
            (4.0, 10.0 - 1e-3),
            (5.0, 10.0 + 1e-3),
        ];
        let other = extrapolate(&scaled, 2.0).unwrap();
        assert!((1e3 * other.uncertainty / found.uncertainty - 1.0).abs() < 1e-6);
    }
    /// Sums of evenly distributed numbers about a straight line: over many sets of five values the
    /// mean square of the scatter is the variance of the noise, whose relative error is
    /// `sqrt(2 / (3 N))`, 1.3 %. Without the line's two constants it would be 0.6 of that.
    #[test]
    fn the_scatter_about_a_line_is_that_of_the_noise() {
        const N: usize = 4000;
        let mut seed = 1u64;
        let mut noise = || {
            let mut even = || {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                (seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5
            };
            (0..12).map(|_| even()).sum::<f64>()
        };
        let mut sum = 0.0;
        for _ in 0..N {
            let values: Vec<(f64, f64)> = (1..=5)
                .map(|h| (f64::from(h), 3.0 + 0.7 * f64::from(h) + noise()))
                .collect();
            let line = fit(&values, 1.0, |_| 0.2);
            sum += scatter(line.square, 5, 2).powi(2);
        }
        let variance = sum / N as f64;
        assert!((variance - 1.0).abs() < 4.0 * 0.013, "{variance}");
    }
}
