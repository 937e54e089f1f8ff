//! The uncertainty of a value from the values on other meshes.
//!
//! A quantity that converges with order `p` in the element size `h` obeys `q(h) = q0 + a h^p`. How
//! far the finest value may be from `q0` depends on the number of meshes.
//!
//! **Four meshes or more** leave a scatter about the law that can be measured. Both the error and
//! the scatter grow with `h^p`: a regression with weights `1/h^2p` gives `q0`, `a` and the standard
//! error `s0` of `q0`. Of the orders between [`LEAST_ORDER`] and the formal order of the elements,
//! the one is taken for which the values are the most likely. With the factor `t` of Student's
//! distribution for a confidence of 95 % the uncertainty is
//!
//! ```text
//!     F |q - q0| + t s0,     F = 1.25.
//! ```
//!
//! **Three meshes** do not show the scatter. The order follows from a least-squares fit, with equal
//! weights or with weights `1/h`, whichever leaves the smaller deviation. An order between
//! [`LEAST_ORDER`] and the formal one is believed; otherwise the better of the laws of first and of
//! formal order is taken. With `s` the standard deviation of the fit and `d` the range of the
//! values divided by the number of meshes less one, the uncertainty of the finest value `q` is
//!
//! ```text
//!     F |a| h^p + s + |q - q_fit|              where s < d,
//!     3 s/d (|a| h^p + s + |q - q_fit|)        else,
//! ```
//!
//! The factor of safety `F` is 1.25 if the order is believed and 3 otherwise; in the second case
//! the uncertainty is also no smaller than `d`, since values that agree by chance have no order.
//!
//! **Two meshes**, which leave the order open, state 3 times the error of the formal one.
//!
//! # Source
//! Three meshes: L. Eca, M. Hoekstra, A procedure for the estimation of the numerical uncertainty
//! of CFD calculations based on grid refinement studies, J. Comput. Phys. 262 (2014) 104-130,
//! doi:10.1016/j.jcp.2014.01.006. The factors: P. J. Roache, *Verification and Validation in
//! Computational Science and Engineering*, Hermosa 1998, chapter 5. More meshes: N. R. Draper,
//! H. Smith, *Applied Regression Analysis*, 3rd ed., Wiley 1998, sections 1.4 (confidence of the
//! intercept) and 9.2 (weights).

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
/// Range of orders in which the best one is sought, and (`STEPS`) the number of steps over it.
/// Meshes do not show orders beyond this range.
const SOUGHT: [f64; 2] = [-2.0, 8.0];
const STEPS: usize = 200;
/// Fewest meshes whose scatter about a law is measured.
const SCATTER: usize = 4;
/// Step between the orders among which the most likely one is sought.
const LIKELY_STEP: f64 = 0.05;
/// Two-sided 95 % points of Student's distribution for 2 to 8 degrees of freedom; for more, the
/// last one (Draper and Smith, table of the t-distribution).
const STUDENT: [f64; 7] = [4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306];

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

/// Estimates the uncertainty of the first of the values `q`, given as `(h, q)` with their element
/// sizes, by the `formal` order of the elements. `None` for fewer than two values, a second mesh of
/// the first one's size, or values that are not finite.
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
    let is_reliable = (LEAST_ORDER..=formal + ABOVE_FORMAL).contains(&free.order);
    let (uncertainty, limit) = match values.len() >= SCATTER {
        true => by_confidence(values, formal),
        false => by_fit(values, formal, &free, is_reliable),
    };
    Some(Extrapolation {
        uncertainty,
        order: Some(free.order),
        limit: is_reliable.then_some(limit),
    })
}

/// Uncertainty and limit of three values from the fit of a free order.
fn by_fit(values: &[(f64, f64)], formal: f64, free: &FittedLaw, is_reliable: bool) -> (f64, f64) {
    let [(h, q), ..] = *values else {
        return (f64::INFINITY, f64::NAN);
    };
    let is_believed = (LEAST_ORDER..=formal).contains(&free.order);
    let fit = if is_believed {
        *free
    } else {
        best(values, &[1.0, formal])
    };
    let n = values.len();
    let per_mesh = range(values) / (n - 1) as f64;
    let [safety, least] = if is_reliable {
        [SAFETY, 0.0]
    } else {
        [SAFETY_WITHOUT_ORDER, per_mesh]
    };
    // The law of a free order has three constants, that of a given one two.
    let constants = if is_believed { 3 } else { 2 };
    let deviation = scatter(fit.square, n, constants);
    let error = (fit.slope * h.powf(fit.order)).abs();
    let off = (q - fit.limit - fit.slope * h.powf(fit.order)).abs();
    let uncertainty = match deviation < per_mesh {
        true => safety * error + deviation + off,
        false => SAFETY_WITHOUT_ORDER * deviation / per_mesh * (error + deviation + off),
    };
    (uncertainty.max(least), fit.limit)
}

/// Uncertainty and limit for the first of at least four values. The uncertainty follows from the
/// distance of this value from the limit of the most likely law, and from the half width of the
/// limit's confidence interval.
fn by_confidence(values: &[(f64, f64)], formal: f64) -> (f64, f64) {
    let steps = ((formal - LEAST_ORDER) / LIKELY_STEP).round() as usize;
    let orders = (0..=steps).map(|i| LEAST_ORDER + LIKELY_STEP * i as f64);
    let laws = orders.map(|order| Regression::of(values, order));
    let likely = laws.reduce(|best, law| match law.misfit < best.misfit {
        true => law,
        false => best,
    });
    let Some(law) = likely else {
        return (f64::INFINITY, f64::NAN);
    };
    let student = STUDENT[(values.len() - SCATTER).min(STUDENT.len() - 1)];
    let off = (values[0].1 - law.limit).abs();
    (SAFETY * off + student * law.limit_deviation, law.limit)
}

/// A law of given order, fitted to values whose scatter grows with the same power of the element
/// size as their error.
struct Regression {
    limit: f64,
    /// Standard error of the limit.
    limit_deviation: f64,
    /// Twice the negative logarithm of the likelihood, without terms that all orders share.
    misfit: f64,
}

impl Regression {
    fn of(values: &[(f64, f64)], order: f64) -> Self {
        let n = values.len();
        let weights = values.iter().map(|(h, _)| h.powf(-2.0 * order));
        let total: f64 = weights.clone().sum();
        let fit = fit(values, order, |h| h.powf(-2.0 * order) / total);
        let powers = values.iter().map(|(h, _)| h.powf(order));
        // The weights are 1/x^2 with x = h^p, so the weighted sum of x is the sum of 1/x.
        let mean = powers.clone().map(|x| 1.0 / x).sum::<f64>() / total;
        let spread: f64 = (weights.zip(powers))
            .map(|(weight, x)| weight * (x - mean).powi(2))
            .sum();
        let variance = total * fit.square / (n - 2) as f64;
        let logarithms: f64 = values.iter().map(|(h, _)| h.ln()).sum();
        Regression {
            limit: fit.limit,
            limit_deviation: (variance * (1.0 / total + mean * mean / spread)).sqrt(),
            misfit: n as f64 * (total * fit.square).ln() + 2.0 * order * logarithms,
        }
    }
}

/// Standard deviation of `n` values about a law fitted to them, from the mean square of their
/// deviations. Each constant of the law takes one value's share of the scatter away.
fn scatter(square: f64, n: usize, constants: usize) -> f64 {
    match n > constants {
        true => (n as f64 * square / (n - constants) as f64).sqrt(),
        false => 0.0,
    }
}

/// Largest value minus smallest value.
fn range(values: &[(f64, f64)]) -> f64 {
    let of = |pick: fn(f64, f64) -> f64| values.iter().map(|v| v.1).reduce(pick).unwrap_or(0.0);
    of(f64::max) - of(f64::min)
}

/// The orders that are tried. Zero is left out, since it gives no law.
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

/// The law that fits best among these orders and both weightings. Between two neighbouring orders
/// the best one is found on the parabola through their deviations.
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

/// Weighted fit of `limit + slope h^order`.
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

    /// Pseudo-random numbers of mean 0 and variance 1: sums of twelve evenly distributed numbers.
    fn evenly() -> impl FnMut() -> f64 {
        let mut seed = 1u64;
        move || {
            let mut even = || {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                (seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5
            };
            (0..12).map(|_| even()).sum::<f64>()
        }
    }

    fn sampled(sizes: &[f64], q: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        sizes.iter().map(|&h| (h, q(h))).collect()
    }

    /// Three meshes determine a power law: its error comes out with the factor of safety of a
    /// believed order. Four show that it has no scatter.
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

    /// Values with an error of order `p` that scatters by a fraction of the error: counts how often
    /// the limit lies within the stated uncertainty. That is nearly always so. For an error of
    /// first order with little scatter, which meshes near each other can mistake for one of higher
    /// order, it is so in only two thirds of the cases.
    #[test]
    fn the_limit_is_within_the_uncertainty() {
        let mut noise = evenly();
        let cases = [
            (2.0, 4, 0.1, 0.95),
            (2.0, 6, 0.1, 0.95),
            (2.0, 5, 0.5, 0.95),
            (1.0, 4, 0.5, 0.85),
            (1.0, 5, 0.1, 0.67),
        ];
        for (order, n, scatter, least) in cases {
            let mut within = 0;
            for _ in 0..2000 {
                let sizes = (0..n).map(|i| 1.4f64.powi(i));
                let error = |h: f64, z: f64| 0.3 * h.powf(order) * (1.0 + scatter * z);
                let values: Vec<(f64, f64)> = sizes.map(|h| (h, 7.0 - error(h, noise()))).collect();
                let found = extrapolate(&values, 2.0).unwrap();
                within += usize::from((values[0].1 - 7.0).abs() <= found.uncertainty);
            }
            let share = within as f64 / 2000.0;
            assert!(share >= least, "{order}, {n}, {scatter}: {share}");
        }
    }

    /// A mesh that is far too coarse does not decide what the finer ones show.
    #[test]
    fn a_mesh_that_is_too_coarse_counts_little() {
        let values = |off: f64| {
            let mut values = sampled(&[1.0, 1.4, 2.0, 2.8, 4.0], |h| 7.0 - 0.003 * h * h);
            values[4].1 -= off;
            extrapolate(&values, 2.0).unwrap().uncertainty
        };
        assert!((values(0.0) / (1.25 * 0.003) - 1.0).abs() < 1e-4);
        // The coarsest value is off by twenty times its error: a quarter of the range is 0.25.
        let off = values(20.0 * 0.048);
        assert!(off < 0.2, "{off}");
    }

    /// If the order is not believed, the law of first or formal order has the larger factor.
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

    /// The uncertainty of values that agree by chance on two meshes is at least the range that the
    /// third mesh shows, divided by the number of meshes less one.
    #[test]
    fn agreement_by_chance_is_no_accuracy() {
        let found = extrapolate(&[(1.0, 7.0), (1.5, 7.0 + 1e-9), (2.0, 7.4)], 2.0).unwrap();
        assert!(found.uncertainty >= 0.2, "{found:?}");
        let same = extrapolate(&[(1.0, 7.0), (1.5, 7.0), (2.0, 7.0)], 2.0).unwrap();
        assert_eq!((same.uncertainty, same.limit), (0.0, Some(7.0)));
    }

    /// Values that go up and down follow no power law. The uncertainty includes their deviation
    /// from the best line and exceeds their range per mesh.
    #[test]
    fn scatter_enters_the_uncertainty() {
        let found = extrapolate(&[(1.0, 0.0), (1.5, 1.0), (2.0, -1.0), (2.5, 1.0)], 2.0).unwrap();
        assert!(found.uncertainty > 2.0, "{found:?}");
        // Units and offsets do not matter.
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
    /// mean square of the scatter is the variance of the noise, apart from a relative error of
    /// `sqrt(2 / (3 N))`, 1.3 %. If the two constants of the line were not counted, the mean square
    /// would be 0.6 of the variance.
    #[test]
    fn the_scatter_about_a_line_is_that_of_the_noise() {
        const N: usize = 4000;
        let mut noise = evenly();
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
