//! Roots and maxima of functions of one variable by bracketing, to round-off and always finite.

/// Root of `f` in `[low, high]` by bisection until the bracket has no double strictly inside.
///
/// `f` must change sign once in the interval; where it does not, the end at which `f` is closer to
/// that change is returned (a monotone `f` that is all of one sign yields an end of the interval).
pub(crate) fn root(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let rising = f(high) >= f(low);
    loop {
        let middle = low + 0.5 * (high - low);
        if middle <= low || middle >= high {
            return middle;
        }
        if (f(middle) < 0.0) == rising {
            low = middle;
        } else {
            high = middle;
        }
    }
}

/// `(x, f(x))` at the greatest value of `f` on `[low, high]`: a scan of `samples` equal steps, then
/// golden section round the best sample.
///
/// The value is good to round-off, the place to its square root (a maximum is flat).
pub(super) fn maximum(f: impl Fn(f64) -> f64, low: f64, high: f64, samples: usize) -> (f64, f64) {
    let step = (high - low) / samples as f64;
    let mut best = (low, f(low));
    for i in 1..=samples {
        let x = low + step * i as f64;
        let value = f(x);
        if value > best.1 {
            best = (x, value);
        }
    }
    let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut a, mut b) = ((best.0 - step).max(low), (best.0 + step).min(high));
    let (mut c, mut d) = (b - ratio * (b - a), a + ratio * (b - a));
    let (mut fc, mut fd) = (f(c), f(d));
    // The golden ratio to the 80th is below the spacing of doubles relative to the first bracket.
    for _ in 0..80 {
        if fc > fd {
            (b, d, fd) = (d, c, fc);
            c = b - ratio * (b - a);
            fc = f(c);
        } else {
            (a, c, fc) = (c, d, fd);
            d = a + ratio * (b - a);
            fd = f(d);
        }
        for candidate in [(c, fc), (d, fd)] {
            if candidate.1 > best.1 {
                best = candidate;
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_roots_to_the_last_digit() {
        let rising = root(|x| x * x - 2.0, 0.0, 2.0);
        let falling = root(|x| 2.0 - x * x, 0.0, 2.0);
        assert!((rising - 2.0_f64.sqrt()).abs() <= 2.0 * f64::EPSILON);
        assert!((falling - rising).abs() <= 4.0 * f64::EPSILON);
    }

    #[test]
    fn finds_maxima_inside_and_at_the_ends() {
        let (x, value) = maximum(|x| x.sin(), 0.0, 3.0, 10);
        assert!((x - std::f64::consts::FRAC_PI_2).abs() < 1e-7);
        assert!((value - 1.0).abs() <= f64::EPSILON);
        assert_eq!(maximum(|x| -x, 0.0, 3.0, 10), (0.0, 0.0));
        assert_eq!(maximum(|x| x, 0.0, 3.0, 10).1, 3.0);
    }
}
