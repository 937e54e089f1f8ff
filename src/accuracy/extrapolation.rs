//! The error of a value from the values on coarser meshes.
//!
//! A quantity that converges with order `p` in the element size `h` obeys `q(h) = q0 + a h^p` and what the mesh leaves out.
//! Both constants come from a weighted least-squares fit over the meshes (weights `1/h`: the finer mesh counts
//! more), `p` is the order within the believed range that fits best, and the stated error is
//!
//! ```text
//!     |a| h^p + s,      s the standard deviation of the fit:
//! ```
//!
//! where a contact ends inside an element the error is as irregular as the meshes are, and `s` says by how much.
//!
//! # Source
//! L. Eca, M. Hoekstra, A procedure for the estimation of the numerical uncertainty of CFD calculations based on grid
//! refinement studies, J. Comput. Phys. 262 (2014) 104-130, doi:10.1016/j.jcp.2014.01.006; P. J. Roache, *Verification and
//! Validation in Computational Science and Engineering*, Hermosa 1998, chapter 5.

/// Steps in which the order is sought.
const ORDERS: usize = 60;
/// Three meshes follow a law where they deviate from it by no more than this share of the error that it states.
const REGULAR: f64 = 0.2;

/// What a family of meshes says about its finest member.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extrapolation {
    /// Estimated error of the first value, not negative.
    pub error: f64,
    /// The order that fits best; `None` where two meshes leave it open and the lowest was taken, and where nothing changes.
    pub order: Option<f64>,
    /// The value extrapolated to an element size of zero.
    pub limit: f64,
    /// Whether three meshes or more follow the law: they deviate from it by a fifth of the error at most.
    pub regular: bool,
}

/// Extrapolates values `(h, q)`, finest first, with orders in `orders`. `None` for fewer than two.
pub fn extrapolate(values: &[(f64, f64)], orders: [f64; 2]) -> Option<Extrapolation> {
    if values.len() < 2 || values.iter().any(|v| !v.1.is_finite()) {
        return None;
    }
    let [low, high] = orders;
    // Two meshes determine no order: the lowest gives the largest error.
    let n = if values.len() == 2 { 0 } else { ORDERS };
    // From order to order the powers grow by the same factors.
    let step = (high - low) / ORDERS as f64;
    let to = |order: f64| -> Vec<f64> { values.iter().map(|(h, _)| h.powf(order)).collect() };
    let total: f64 = values.iter().map(|(h, _)| 1.0 / h).sum();
    let points = values.iter().zip(to(low));
    let mut points: Vec<Point> = points
        .map(|(&(h, q), x)| Point {
            x,
            q,
            weight: 1.0 / h / total,
        })
        .collect();
    let factors = to(step);
    let best = (0..=n)
        .map(|i| {
            let fit = fit(&points);
            for (point, factor) in points.iter_mut().zip(&factors) {
                point.x *= factor;
            }
            (low + step * i as f64, fit)
        })
        // Of equal fits the first: the lower order.
        .reduce(|best, next| {
            if next.1.deviation < best.1.deviation {
                next
            } else {
                best
            }
        })?;
    let (order, fit) = best;
    let error = fit.slope.abs() * values[0].0.powf(order) + fit.deviation;
    Some(Extrapolation {
        error,
        regular: values.len() > 2 && fit.deviation <= REGULAR * error,
        // Equal values have no order.
        order: (values.len() > 2 && fit.slope != 0.0).then_some(order),
        limit: fit.limit,
    })
}

/// The error of the first value where the others are from meshes at least twice as fine: how far it is from where these lead with an order. What is wrong with
/// a mesh that resolves nothing follows no law, but they are out of its reach. The lowest order that may be leads too far at most: for an order
/// of two instead of one by a sixth of the error, with meshes twice and three times as fine.
pub(super) fn beside_finer(values: &[(f64, f64)], order: f64) -> Option<Extrapolation> {
    let [own, finer @ ..] = values else {
        return None;
    };
    let is_beyond_reach = |(h, _): &(f64, f64)| *h <= 0.5 * own.0;
    if finer.len() < 2 || !own.1.is_finite() || !finer.iter().all(is_beyond_reach) {
        return None;
    }
    let there = extrapolate(finer, [order, order])?;
    let error = (own.1 - there.limit).abs();
    Some(Extrapolation {
        error,
        order: None,
        regular: false,
        ..there
    })
}

/// A value `q` at `x = h^order`.
struct Point {
    x: f64,
    q: f64,
    /// All together are 1.
    weight: f64,
}

struct Fit {
    slope: f64,
    limit: f64,
    deviation: f64,
}

/// Least squares of `q = limit + slope x`.
fn fit(points: &[Point]) -> Fit {
    let n = points.len() as f64;
    let weighted = |f: &dyn Fn(f64, f64) -> f64| -> f64 {
        points.iter().map(|p| p.weight * f(p.x, p.q)).sum()
    };
    let (mean_x, mean_q) = (weighted(&|x, _| x), weighted(&|_, q| q));
    let slope =
        weighted(&|x, q| (x - mean_x) * (q - mean_q)) / weighted(&|x, _| (x - mean_x).powi(2));
    let limit = mean_q - slope * mean_x;
    let square = weighted(&|x, q| (q - limit - slope * x).powi(2));
    let deviation = if n > 2.0 {
        (n * square / (n - 2.0)).sqrt()
    } else {
        0.0
    };
    Fit {
        slope,
        limit,
        deviation,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sampled(sizes: &[f64], q: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        sizes.iter().map(|&h| (h, q(h))).collect()
    }

    #[test]
    fn a_power_law_is_found_with_its_order_error_and_limit() {
        for order in [1.0, 1.5, 2.0] {
            let values = sampled(&[1.0, 2.0, 8.0 / 3.0], |h| 7.0 - 0.3 * h.powf(order));
            let found = extrapolate(&values, [1.0, 2.0]).unwrap();
            // The orders tried are 1/60 apart: the error is right to the change of 2^p over half of that.
            assert!(
                (found.order.unwrap() - order).abs() <= 0.5 / 60.0 + 1e-12,
                "{found:?}"
            );
            assert!((found.error / 0.3 - 1.0).abs() < 0.03, "{found:?}");
            assert!(
                (found.limit - 7.0).abs() < 0.01 && found.regular,
                "{found:?}"
            );
        }
    }

    #[test]
    fn two_meshes_give_the_error_of_the_lowest_order() {
        let found = extrapolate(&[(1.0, 3.0), (2.0, 3.5)], [1.0, 2.0]).unwrap();
        assert_eq!(found.order, None);
        assert!((found.limit - 2.5).abs() < 1e-15);
        assert!((found.error - 0.5).abs() < 1e-15);
        assert_eq!(extrapolate(&[(1.0, 3.0)], [1.0, 2.0]), None);
    }

    #[test]
    fn a_mesh_that_resolves_nothing_is_judged_by_finer_ones() {
        for (order, stated) in [(1.0, 1.0), (2.0, 7.0 / 6.0), (3.0, 1.14)] {
            let law = |h: f64| 7.0 - 0.3 * h.powf(order);
            let mut values = sampled(&[1.0, 0.5, 1.0 / 3.0], law);
            for own in [6.7, 7.3] {
                values[0].1 = own;
                let error = beside_finer(&values, 1.0).unwrap().error;
                // What the law of first order makes of the finer two is off by `stated - 1` of 0.3.
                let off = 0.3 * (stated - 1.0) + 1e-3;
                assert!((error - 0.3).abs() <= off, "{order}: {error}");
            }
        }
        let near = sampled(&[1.0, 0.5, 2.0 / 3.0], |h| h);
        assert_eq!(beside_finer(&near, 1.0), None);
        assert_eq!(beside_finer(&near[..2], 1.0), None);
        let unknown = [(1.0, f64::NAN), (0.5, 2.0), (0.25, 2.1)];
        assert_eq!(beside_finer(&unknown, 1.0), None);
    }

    #[test]
    fn scatter_enters_the_error() {
        // No power law: up and down by 1. The best line leaves a deviation of that size.
        let found = extrapolate(&[(1.0, 0.0), (2.0, 1.0), (2.5, -1.0)], [1.0, 2.0]).unwrap();
        assert!(found.error > 0.5 && !found.regular, "{found:?}");
    }

    #[test]
    fn equal_values_have_no_error() {
        let found = extrapolate(&[(1.0, 2.0), (2.0, 2.0), (2.5, 2.0)], [1.0, 2.0]).unwrap();
        assert_eq!((found.error, found.order), (0.0, None));
    }
}
