//! Roots and maxima of functions of one variable.
//!
//! # Source
//! R. P. Brent, *Algorithms for Minimization Without Derivatives* (1973), chapter 4: inverse
//! quadratic interpolation, with bisection if that is slow. J. Kiefer, Proc. Amer. Math. Soc. 4
//! (1953) 502-506: golden section.

use std::convert::Infallible;

/// Largest number of evaluations: bisection to round-off takes some 60, and at most [`PATIENCE`]
/// interpolations fail before each bisection.
const MOST: usize = 300;
/// Number of steps that may leave more than half of the bracket before it is bisected.
const PATIENCE: usize = 3;
/// Number of steps of golden section that reduce a bracket to nothing: the golden ratio to the 80th
/// is below the spacing of doubles.
const GOLDEN_STEPS: usize = 80;

/// Tolerance at which a search for a root ends.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RootTolerance {
    /// Absolute value of the function that counts as zero.
    pub value: f64,
    /// Width of the bracket relative to the size of its ends.
    pub place: f64,
}

impl RootTolerance {
    /// Ends only when no double lies within the bracket, so that the root does not depend on how it
    /// is found.
    pub(crate) const ROUND_OFF: RootTolerance = RootTolerance {
        value: f64::NEG_INFINITY,
        place: 0.0,
    };

    /// Uses one accuracy for the value and the place.
    pub(crate) const fn both(accuracy: f64) -> Self {
        RootTolerance {
            value: accuracy,
            place: accuracy,
        }
    }
}

/// Finds the root of `f` in `[low, high]` to round-off.
///
/// `f` must change sign once in the interval. If its values at the two ends do not have opposite
/// signs, the end at which `f` is closer to zero is returned; for a monotone `f` this is the end
/// nearer to the root.
pub(crate) fn of(f: impl Fn(f64) -> f64, low: f64, high: f64) -> f64 {
    let ends = [(low, f(low)), (high, f(high))];
    between(ends, RootTolerance::ROUND_OFF, f)
}

/// Finds a root as [`try_between`] does, for a function that cannot fail.
pub(crate) fn between(
    ends: [(f64, f64); 2],
    accuracy: RootTolerance,
    f: impl Fn(f64) -> f64,
) -> f64 {
    let Ok(root) = try_between(ends, accuracy, |x| Ok::<_, Infallible>(f(x)));
    root
}

/// Finds the root of `f` between two places, each given with its value; the values have opposite
/// signs.
///
/// Except with [`RootTolerance::ROUND_OFF`], the result is the last place at which `f` was
/// evaluated. If the signs are not opposite, the end nearer to a change of sign is returned. NaN
/// counts as positive.
///
/// # Errors
/// The first error that the function returns.
pub(crate) fn try_between<E>(
    mut ends: [(f64, f64); 2],
    accuracy: RootTolerance,
    mut f: impl FnMut(f64) -> Result<f64, E>,
) -> Result<f64, E> {
    if ends[1].1 < ends[0].1 {
        ends.reverse();
    }
    // The function is negative at a and positive at b.
    let [(mut a, mut fa), (mut b, mut fb)] = ends;
    if fa >= 0.0 {
        return Ok(a);
    }
    if fb <= 0.0 {
        return Ok(b);
    }
    // The previous end, and the number of steps that have not halved the bracket.
    let (mut c, mut fc) = (b, fb);
    let mut slow = 0;
    let mut x = b;
    for _ in 0..MOST {
        let (low, high) = (a.min(b), a.max(b));
        let middle = low + 0.5 * (high - low);
        if middle <= low || middle >= high {
            return Ok(middle);
        }
        x = if fc != fa && fc != fb {
            a * fb / (fa - fb) * fc / (fa - fc)
                + b * fa / (fb - fa) * fc / (fb - fc)
                + c * fa / (fc - fa) * fb / (fc - fb)
        } else {
            b - fb * (b - a) / (fb - fa)
        };
        if slow == PATIENCE || !(x > low && x < high) {
            x = middle;
        }
        // A step shorter than the accuracy would never move the other end.
        let size = low.abs().max(high.abs());
        let least = 0.5 * size * accuracy.place.max(f64::EPSILON);
        x = x.max(low + least).min(high - least);
        if !(x > low && x < high) {
            x = middle;
        }
        let width = accuracy.place * size;
        let y = f(x)?;
        if y.abs() <= accuracy.value || high - low <= width {
            break;
        }
        if y < 0.0 {
            (c, fc) = (a, fa);
            (a, fa) = (x, y);
        } else {
            (c, fc) = (b, fb);
            (b, fb) = (x, y);
        }
        slow = if (b - a).abs() <= 0.5 * (high - low) || slow == PATIENCE {
            0
        } else {
            slow + 1
        };
    }
    Ok(x)
}

/// Returns `(x, f(x))` at the maximum of `f` on `[low, high]`, found by a scan of `samples` equal
/// steps and by golden section around the best sample.
///
/// The value is accurate to round-off, the place to its square root (a maximum is flat).
pub(crate) fn maximum(f: impl Fn(f64) -> f64, low: f64, high: f64, samples: usize) -> (f64, f64) {
    let greater = |a: (f64, f64), b: (f64, f64)| if b.1 > a.1 { b } else { a };
    let at = |x: f64| (x, f(x));
    let step = (high - low) / samples as f64;
    let mut best = (1..=samples)
        .map(|i| at(low + step * i as f64))
        .fold(at(low), greater);
    let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut a, mut b) = ((best.0 - step).max(low), (best.0 + step).min(high));
    let (mut c, mut d) = (at(b - ratio * (b - a)), at(a + ratio * (b - a)));
    for _ in 0..GOLDEN_STEPS {
        if c.1 > d.1 {
            (b, d) = (d.0, c);
            c = at(b - ratio * (b - a));
        } else {
            (a, c) = (c.0, d);
            d = at(a + ratio * (b - a));
        }
        best = greater(greater(best, c), d);
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    #[test]
    fn roots_to_the_last_digit_rising_and_falling() {
        let rising = of(|x| x * x - 2.0, 0.0, 2.0);
        let falling = of(|x| 2.0 - x * x, 0.0, 2.0);
        assert!((rising - 2.0_f64.sqrt()).abs() <= 2.0 * f64::EPSILON);
        assert!((falling - rising).abs() <= 4.0 * f64::EPSILON);
        // A small root in a wide bracket.
        let small = of(|x| x - 1e-9, 0.0, 1e3);
        assert!((small / 1e-9 - 1.0).abs() <= 4.0 * f64::EPSILON);
    }

    #[test]
    fn without_a_change_of_sign_the_end_nearer_to_it() {
        assert_eq!(of(|x| x + 1.0, 0.0, 2.0), 0.0);
        assert_eq!(of(|x| x - 3.0, 0.0, 2.0), 2.0);
        assert_eq!(of(|x| 3.0 - x, 0.0, 2.0), 2.0);
        assert_eq!(of(|x| x, 0.0, 1.0), 0.0);
    }

    #[test]
    fn calls_are_few_where_the_function_is_smooth_and_bounded_where_it_jumps() {
        let root = |f: &dyn Fn(f64) -> f64| {
            let calls = Cell::new(0);
            let counted = |x| {
                calls.set(calls.get() + 1);
                f(x)
            };
            let accuracy = RootTolerance::both(1e-15);
            let x = between([(0.0, f(0.0)), (1.0, f(1.0))], accuracy, counted);
            (x, calls.get())
        };
        let (x, _) = root(&|x: f64| if x < 0.3 { x - 0.5 } else { 20.0 * (x - 0.31) });
        assert!((x - 0.31).abs() < 1e-14, "{x}");
        assert_eq!(root(&|x| x), (0.0, 0));
        assert_eq!(root(&|x| x - 2.0), (1.0, 0));
        let (x, calls) = root(&|x: f64| x.exp() - 1.5);
        assert!((x - 1.5f64.ln()).abs() < 1e-14 && calls <= 7, "{x} {calls}");
        // Bisection takes 50 calls.
        let (x, calls) = root(&|x: f64| if x < 0.31 { -1e-3 } else { 1.0 });
        assert!((x - 0.31).abs() < 1e-14 && calls <= 200, "{x} {calls}");
        let (x, _) = root(&|x: f64| if x < 0.31 { -1.0 } else { f64::NAN });
        assert!((x - 0.31).abs() < 1e-14, "{x}");
    }

    #[test]
    fn maxima_inside_and_at_the_ends() {
        let (x, value) = maximum(|x| x.sin(), 0.0, 3.0, 10);
        assert!((x - std::f64::consts::FRAC_PI_2).abs() < 1e-7);
        assert!((value - 1.0).abs() <= f64::EPSILON);
        assert_eq!(maximum(|x| -x, 0.0, 3.0, 10), (0.0, 0.0));
        assert_eq!(maximum(|x| x, 0.0, 3.0, 10).1, 3.0);
    }
}
