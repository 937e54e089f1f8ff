//! Element sizes along a line: even, biased, or even at first and then growing.
//!
//! Positions are given as `2 n + 1` values for `n` elements: even entries are corners, odd entries
//! the mid-side positions halfway between them.

use crate::root;
use crate::{Error, Result};

/// Even spacing from `from` to `to`. Symmetric ranges give exactly symmetric positions.
pub(super) fn even(key: &str, from: f64, to: f64, n: usize) -> Result<Vec<f64>> {
    let count = n as f64;
    let corners = (0..=n)
        .map(|i| match i {
            0 => from,
            i if i == n => to,
            i => (from * (n - i) as f64 + to * i as f64) / count,
        })
        .collect();
    with_midpoints(key, corners)
}

/// Geometric spacing in which the last element is `bias` times as long as the first.
pub(super) fn biased(key: &str, from: f64, to: f64, n: usize, bias: f64) -> Result<Vec<f64>> {
    if bias == 1.0 || n < 2 {
        return even(key, from, to, n);
    }
    let ratio = bias.powf(1.0 / (n - 1) as f64);
    let sizes: Vec<f64> = (0..n).map(|i| ratio.powi(i as i32)).collect();
    let sum: f64 = sizes.iter().sum();
    let mut at = 0.0;
    let mut corners = Vec::with_capacity(n + 1);
    corners.push(from);
    for size in &sizes[..n - 1] {
        at += size;
        corners.push(from + (to - from) * (at / sum));
    }
    corners.push(to);
    with_midpoints(key, corners)
}

/// Growth of elements with the distance `r` from a point of interest: each element is
/// `near^((r/r0)^s)` times as large as the one before. The factor rises from `near` at the
/// beginning `r0` of the growing part to `far` at its end. With `far = near` the growth is
/// geometric.
#[derive(Debug, Clone, Copy)]
pub(super) struct Growth {
    pub near: f64,
    pub far: f64,
    /// Distance of the line's origin from the point of interest.
    pub origin: f64,
}

/// Bound on the number of growing elements along a line: no mesh within the limits has as many.
const MOST_ON_A_LINE: usize = 1_000_000;

impl Growth {
    /// Growth from `near` to `far` along a line; `near` everywhere if `far` is not given.
    pub fn new(near: f64, far: Option<f64>, origin: f64) -> Self {
        Growth {
            near,
            far: far.unwrap_or(near),
            origin,
        }
    }

    /// Number of elements from `start` to `length` if the first has size `first`. A float, because
    /// a wrong input can ask for more elements than an integer can hold.
    pub fn count(&self, first: f64, start: f64, length: f64) -> f64 {
        if self.far == self.near || length <= start {
            return grown_count(first, length - start, self.near);
        }
        let law = self.law(start, length);
        let (mut at, mut step, mut n) = (start, first, 0usize);
        while at + 0.5 * step < length && n < MOST_ON_A_LINE {
            at += step;
            step *= law.ratio(at, 1.0);
            n += 1;
        }
        n.max(1) as f64
    }

    fn law(&self, start: f64, length: f64) -> Law {
        let (begin, end) = (self.origin + start, self.origin + length);
        Law {
            near: self.near.ln(),
            begin,
            origin: self.origin,
            power: (self.far.ln() / self.near.ln()).ln() / (end / begin).ln(),
        }
    }
}

/// The law `ln near (r/r0)^s`, the logarithm of the growth factor.
struct Law {
    near: f64,
    begin: f64,
    origin: f64,
    power: f64,
}

impl Law {
    /// Ratio of the size of the element that begins at `at` to the size of the one before, with the
    /// law's logarithm multiplied by `share`.
    fn ratio(&self, at: f64, share: f64) -> f64 {
        let distance = (self.origin + at) / self.begin;
        (share * self.near * distance.powf(self.power)).exp()
    }

    /// Sizes of `n` elements relative to the first. The law's logarithm is multiplied by the factor
    /// for which the sizes add up to `sum`.
    fn sizes(&self, start: f64, first: f64, n: usize, sum: f64) -> Vec<f64> {
        let sizes = |share: f64| {
            let (mut at, mut size) = (0.0f64, 1.0);
            let mut out = Vec::with_capacity(n);
            for _ in 0..n {
                out.push(size);
                at += size;
                // Limited to the end of the line, beyond which the law would overflow.
                size *= self.ratio(start + first * at.min(sum), share);
            }
            (out, at)
        };
        let (mut low, mut high) = (-1.0, 2.0);
        while sizes(high).1 < sum && high < 1e6 {
            high *= 2.0;
        }
        while sizes(low).1 > sum && low > -1e6 {
            low *= 2.0;
        }
        sizes(root::of(|share| sizes(share).1 - sum, low, high)).0
    }
}

/// Corners from 0 on: `n_even` elements of `size`, then elements that grow by `ratio` until they
/// reach `until`.
pub(super) fn even_then_slow(size: f64, n_even: usize, until: f64, ratio: f64) -> Vec<f64> {
    let mut corners: Vec<f64> = (0..=n_even).map(|i| size * i as f64).collect();
    let (mut at, mut step) = (size * n_even as f64, size);
    // Because of rounding to whole elements, the even part may end up to half an element short of
    // its length.
    while at + 0.5 * size < until && corners.len() < MOST_ON_A_LINE {
        step *= ratio;
        at += step;
        corners.push(at);
    }
    corners
}

/// Positions from 0 to `length`: `n_even` elements of `size`, then elements that grow by about
/// `growth`, slightly adjusted so that the last one ends exactly at `length`.
pub(super) fn even_then_grown(
    key: &str,
    size: f64,
    n_even: usize,
    length: f64,
    growth: Growth,
) -> Result<Vec<f64>> {
    let corners = (0..=n_even).map(|i| size * i as f64).collect();
    let first = if n_even > 0 { size * growth.near } else { size };
    then_grown(key, corners, first, length, growth)
}

/// Positions from 0 to `length` that continue the given `corners`: the added elements grow by about
/// `growth`, the first of them is about `first` long, and all are slightly adjusted so that the
/// last one ends exactly at `length`.
pub(super) fn then_grown(
    key: &str,
    mut corners: Vec<f64>,
    first: f64,
    length: f64,
    growth: Growth,
) -> Result<Vec<f64>> {
    let start = corners.last().copied().unwrap_or(0.0);
    let n = if length > start {
        growth.count(first, start, length) as usize
    } else {
        0
    };
    if n > 0 {
        let sum = (length - start) / first;
        if growth.far == growth.near {
            let ratio = ratio_that_fills(sum, n, growth.near);
            let mut step = first;
            let mut at = start;
            for _ in 1..n {
                at += step;
                step *= ratio;
                corners.push(at);
            }
        } else {
            let sizes = growth.law(start, length).sizes(start, first, n, sum);
            let mut at = start;
            for size in &sizes[..n - 1] {
                at += first * size;
                corners.push(at);
            }
        }
        corners.push(length);
    }
    with_midpoints(key, corners)
}

/// Number of elements of geometric growth over `length`, of which the first has size `first`.
fn grown_count(first: f64, length: f64, growth: f64) -> f64 {
    if length <= 0.0 {
        return 0.0;
    }
    let sizes = length / first;
    let count = if growth - 1.0 > 1e-9 {
        (sizes * (growth - 1.0)).ln_1p() / growth.ln()
    } else {
        sizes
    };
    count.round().max(1.0)
}

/// Solves `1 + q + ... + q^(n-1) = sum` for the ratio `q`.
fn ratio_that_fills(sum: f64, n: usize, guess: f64) -> f64 {
    if n < 2 {
        return 1.0;
    }
    let series = |q: f64| (1..n).fold(1.0, |s, _| 1.0 + q * s);
    let mut high = guess.max(1.0);
    while series(high) < sum {
        high *= 2.0;
    }
    root::of(|q| series(q) - sum, 0.0, high)
}

/// Inserts the mid-side positions between the corners, and refuses neighbours that are equal in
/// floating point.
fn with_midpoints(key: &str, corners: Vec<f64>) -> Result<Vec<f64>> {
    let mut positions = Vec::with_capacity(2 * corners.len());
    for pair in corners.windows(2) {
        positions.push(pair[0]);
        positions.push(0.5 * (pair[0] + pair[1]));
    }
    positions.extend(corners.last());
    if let Some(pair) = positions.windows(2).find(|pair| pair[0] >= pair[1]) {
        return Err(Error::input(format!(
            "{key}: neighbouring nodes coincide at {}: the elements are too small to be told \
             apart; ask for fewer elements or a weaker bias",
            pair[0]
        )));
    }
    Ok(positions)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn even_spacing_is_exactly_symmetric_and_ends_exactly() {
        let x = even("x", -0.3, 0.3, 7).unwrap();
        assert_eq!(x.len(), 15);
        for i in 0..15 {
            assert_eq!(x[i], -x[14 - i]);
        }
        let x = even("x", 0.1, 0.7, 3).unwrap();
        assert_eq!((x[0], x[6]), (0.1, 0.7));
    }

    #[test]
    fn bias_is_the_ratio_of_the_last_size_to_the_first() {
        for bias in [0.2, 1.0, 7.0] {
            let x = biased("x", 1.0, 3.0, 9, bias).unwrap();
            let ratio = (x[18] - x[16]) / (x[2] - x[0]);
            // Sizes are differences of numbers near 3, so their error is a few ulps of 3 relative
            // to the smallest size.
            assert!((ratio / bias - 1.0).abs() < 1e-12, "{ratio}");
        }
        assert_eq!(biased("x", 0.0, 1.0, 1, 5.0).unwrap(), [0.0, 0.5, 1.0]);
    }

    #[test]
    fn a_bias_too_strong_for_floating_point_is_an_input_error() {
        let error = biased("block.x", 1.0, 2.0, 40, 1e-40).unwrap_err();
        assert!(error.message().contains("block.x"), "{error}");
        assert!(error.message().contains("coincide"), "{error}");
    }

    proptest! {
        #[test]
        fn growth_ends_exactly_and_stays_near_the_ratio_asked_for(
            n_even in 0usize..30, length in 40.0..4000.0f64, growth in 1.0..1.5f64
        ) {
            let law = Growth::new(growth, None, 0.0);
            let x = even_then_grown("x", 1.0, n_even, length, law).unwrap();
            prop_assert_eq!(x[0], 0.0);
            prop_assert_eq!(x[x.len() - 1], length);
            for i in 0..n_even {
                prop_assert_eq!(x[2 * i + 2] - x[2 * i], 1.0);
            }
            let grown = n_even.max(1)..x.len() / 2;
            let sizes: Vec<f64> = grown.map(|i| x[2 * i + 2] - x[2 * i]).collect();
            // Rounding the count to an integer changes the filled length by at most half the last
            // element, and therefore the ratio by a fraction that decreases with the count.
            let n = sizes.len() as f64;
            for pair in sizes.windows(2) {
                prop_assert!((pair[1] / pair[0] / growth - 1.0).abs() < 1.5 / n, "{:?}", sizes);
            }
        }
    }

    #[test]
    fn a_growth_rises_with_the_distance_to_that_of_the_far_end() {
        for (origin, n_even) in [(0.0, 20), (0.0, 8), (10.0, 0)] {
            let law = Growth::new(1.2, Some(4.0), origin);
            let x = even_then_grown("x", 1.0, n_even, 20e3, law).unwrap();
            assert_eq!(x[x.len() - 1], 20e3);
            let sizes: Vec<f64> = (n_even.max(1)..x.len() / 2)
                .map(|i| x[2 * i + 2] - x[2 * i])
                .collect();
            let ratios: Vec<f64> = sizes.windows(2).map(|p| p[1] / p[0]).collect();
            assert!(ratios.windows(2).all(|r| r[1] > r[0]), "{ratios:?}");
            // The whole line is stretched by less than half of the last element, which is about an
            // eighth of the law's logarithm.
            assert!(
                (ratios[0].ln() / 1.2f64.ln() - 1.0).abs() < 0.3,
                "{ratios:?}"
            );
            let plain = even_then_grown("x", 1.0, n_even, 20e3, Growth::new(1.2, None, origin));
            let plain = plain.unwrap().len() / 2 - n_even.max(1);
            assert!(4 * sizes.len() < 3 * plain, "{} {plain}", sizes.len());
        }
    }
}
