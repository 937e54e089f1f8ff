//! The highest point of a smooth function on a square or cube, from few values.
//!
//! Three values along each axis, on a stencil of points `spacing` apart, give a quadratic by least
//! squares. The highest point of the quadratic on the stencil is tried as well. The position is
//! then accurate to the square of the spacing, so the next spacing may be the square of this one.
//! The value is accurate to the square of the error in position. Stencils lie on a lattice: if a
//! function that differs little is searched again, it is evaluated at the same points.

/// Spacings of successive searches on a square of side 2; the first stencil covers the whole
/// square.
pub const SPACINGS: [f64; 4] = [1.0, 1.0 / 4.0, 1.0 / 16.0, 1.0 / 256.0];
/// Largest number of stencils of one spacing that may follow one another uphill.
const MOST_MOVES: usize = 50;
/// Distance from the edge of a stencil, in spacings, below which a position counts as on it.
const ON_EDGE: f64 = 1e-9;

/// The highest point found on `[-1, 1]^D`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Maximum<const D: usize> {
    /// Value of the function at its highest point.
    pub value: f64,
    /// Coordinates of the highest point.
    pub at: [f64; D],
}

impl<const D: usize> Maximum<D> {
    /// The start of a search: the middle of the square, not evaluated yet.
    pub fn unknown() -> Self {
        Maximum {
            value: f64::NEG_INFINITY,
            at: [0.0; D],
        }
    }

    /// Looks for a higher point around the highest one so far, and moves from stencil to stencil as
    /// long as that leads uphill. `f` is also told whether a point lies on the lattice.
    pub fn look_around(&mut self, spacing: f64, f: &mut impl FnMut([f64; D], bool) -> f64) {
        for _ in 0..MOST_MOVES {
            let from = *self;
            let center = from.at.map(|x| {
                let nearest = (x / spacing).round() * spacing;
                nearest.clamp(spacing - 1.0, 1.0 - spacing)
            });
            let place = |x: [f64; D]| std::array::from_fn(|d| center[d] + spacing * x[d]);
            let mut values = [0.0; MOST_VALUES];
            for (k, value) in values.iter_mut().enumerate().take(3usize.pow(D as u32)) {
                let at = place(on_stencil(k));
                *value = f(at, true);
                self.rise(*value, at);
            }
            let highest = StencilQuadratic::of(&values).highest();
            if highest.iter().any(|x| x.fract() != 0.0) {
                let at = place(highest);
                self.rise(f(at, false), at);
            }
            let leads_on = (0..D).any(|d| {
                let beside = (self.at[d] - center[d]).abs() / spacing;
                beside > 1.0 - ON_EDGE && self.at[d].abs() < 1.0
            });
            if !(leads_on && self.value > from.value) {
                break;
            }
        }
    }

    fn rise(&mut self, value: f64, at: [f64; D]) {
        if value > self.value {
            *self = Maximum { value, at };
        }
    }
}

/// Largest number of values on a stencil.
const MOST_VALUES: usize = 27;

/// Point `k` of the stencil `{-1, 0, 1}^D`, the last coordinate running fastest.
fn on_stencil<const D: usize>(k: usize) -> [f64; D] {
    std::array::from_fn(|d| (k / 3usize.pow((D - 1 - d) as u32) % 3) as f64 - 1.0)
}

/// The quadratic `q(x) = g . x + x . H x / 2` on a stencil, up to a constant.
struct StencilQuadratic<const D: usize> {
    gradient: [f64; D],
    hessian: [[f64; D]; D],
}

impl<const D: usize> StencilQuadratic<D> {
    /// The least-squares fit to the values at `{-1, 0, 1}^D`. Its normal equations are diagonal
    /// except for the constant.
    fn of(values: &[f64; MOST_VALUES]) -> Self {
        let n = 3usize.pow(D as u32);
        let sum = |weight: &dyn Fn([f64; D]) -> f64| -> f64 {
            let points = values.iter().enumerate().take(n);
            points.map(|(k, value)| weight(on_stencil(k)) * value).sum()
        };
        // The sums of the squares of x, of x^2 - 2/3 (times two) and of x y over the stencil.
        let (first, square, mixed) = (n / 3 * 2, n / 9, n / 9 * 4);
        StencilQuadratic {
            gradient: std::array::from_fn(|d| sum(&|x| x[d]) / first as f64),
            hessian: std::array::from_fn(|a| {
                std::array::from_fn(|b| match a == b {
                    true => sum(&|x| x[a] * x[a] - 2.0 / 3.0) / square as f64,
                    false => sum(&|x| x[a] * x[b]) / mixed as f64,
                })
            }),
        }
    }

    fn value(&self, x: [f64; D]) -> f64 {
        let linear: f64 = (0..D).map(|a| self.gradient[a] * x[a]).sum();
        let square = |a: usize| -> f64 { (0..D).map(|b| self.hessian[a][b] * x[a] * x[b]).sum() };
        linear + 0.5 * (0..D).map(square).sum::<f64>()
    }

    /// Highest point of the quadratic on `[-1, 1]^D`: inside, on a side or at a corner.
    fn highest(&self) -> [f64; D] {
        let mut best = [0.0; D];
        for sides in 0..3usize.pow(D as u32) {
            // Each coordinate is fixed at -1, free, or fixed at 1.
            let side: [f64; D] = on_stencil(sides);
            let x = self.stationary(side);
            let inside = x.iter().all(|x| x.abs() <= 1.0);
            if inside && self.value(x) > self.value(best) {
                best = x;
            }
        }
        best
    }

    /// The point at which the gradient along all coordinates with `side` 0 vanishes, with the other
    /// coordinates fixed at their sides.
    fn stationary(&self, side: [f64; D]) -> [f64; D] {
        let mut matrix = self.hessian;
        let mut x: [f64; D] = self.gradient.map(|g| -g);
        for a in 0..D {
            if side[a] != 0.0 {
                matrix[a] = [0.0; D];
                matrix[a][a] = 1.0;
                x[a] = side[a];
            }
        }
        // Gauss elimination: a system without a solution leaves NaN, which does not count as
        // inside.
        for a in 0..D {
            let pivot = (a..D).max_by(|&i, &j| matrix[i][a].abs().total_cmp(&matrix[j][a].abs()));
            let pivot = pivot.unwrap_or(a);
            matrix.swap(a, pivot);
            x.swap(a, pivot);
            for i in a + 1..D {
                let share = matrix[i][a] / matrix[a][a];
                for j in a..D {
                    matrix[i][j] -= share * matrix[a][j];
                }
                x[i] -= share * x[a];
            }
        }
        for a in (0..D).rev() {
            let known: f64 = (a + 1..D).map(|b| matrix[a][b] * x[b]).sum();
            x[a] = (x[a] - known) / matrix[a][a];
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found<const D: usize>(f: impl Fn([f64; D]) -> f64) -> (Maximum<D>, usize) {
        let mut maximum = Maximum::unknown();
        let mut asked = 0;
        for spacing in SPACINGS {
            maximum.look_around(spacing, &mut |x, _| {
                asked += 1;
                f(x)
            });
        }
        (maximum, asked)
    }

    /// The highest point is found inside, on a side, at a corner and on a ridge. Its position is
    /// accurate to the square of the last spacing, and its value to the square of that.
    #[test]
    fn finds_the_highest_point_from_few_values() {
        let near = SPACINGS[3] * SPACINGS[3];
        for (x0, y0) in [(0.3, -0.2), (0.123, 0.987), (-1.7, 0.4), (1.3, 1.2)] {
            let f = |[x, y]: [f64; 2]| {
                let (dx, dy): (f64, f64) = (x - x0, y - y0);
                1.0 - 0.1 * (dx * dx + 0.5 * dx * dy + dy * dy) + 0.01 * dx.powi(3)
                    - 0.02 * (dy * dy * dy * dy)
            };
            let (maximum, asked) = found(f);
            assert!(asked <= 60, "{asked}");
            // The result is compared with the highest point of a fine grid: it may be lower by no
            // more than the error in position allows.
            let steps = |n: i32| (-n..=n).map(move |i| f64::from(i) / f64::from(n));
            let grid = steps(400).flat_map(|x| steps(400).map(move |y| [x, y]));
            let highest = grid.map(|x| (f(x), x)).max_by(|a, b| a.0.total_cmp(&b.0));
            let (value, at) = highest.unwrap();
            let left = near * near;
            assert!(maximum.value >= value - left, "{maximum:?} {value} {at:?}");
            assert_eq!(maximum.value, f(maximum.at));
            if x0.abs() < 1.0 && y0.abs() < 1.0 {
                let off = (maximum.at[0] - x0).hypot(maximum.at[1] - y0);
                assert!(off < near, "{maximum:?}");
            }
        }
        let ridge = |[x, y]: [f64; 2]| -(x - y - 0.1) * (x - y - 0.1) + 1e-3 * x;
        let (maximum, asked) = found(ridge);
        assert!(
            (maximum.value - 1e-3).abs() < 1e-6 && asked < 200,
            "{maximum:?} {asked}"
        );
    }

    #[test]
    fn what_is_flat_or_no_number_ends_the_search() {
        let (maximum, asked) = found(|_: [f64; 2]| 2.0);
        assert_eq!((maximum.value, asked), (2.0, 36));
        assert_eq!(found(|_: [f64; 2]| f64::NAN).0, Maximum::unknown());
    }

    /// The least-squares quadratic reproduces values that are quadratic.
    #[test]
    fn a_quadratic_is_its_own_fit() {
        let given = StencilQuadratic {
            gradient: [0.3, -0.7],
            hessian: [[-2.0, 0.4], [0.4, -1.0]],
        };
        let mut values = [0.0; MOST_VALUES];
        for (k, value) in values.iter_mut().enumerate().take(9) {
            *value = 5.0 + given.value(on_stencil(k));
        }
        let fit = StencilQuadratic::of(&values);
        for x in [[0.2, 0.9], [-1.0, 0.5]] {
            assert!((fit.value(x) - given.value(x)).abs() < 1e-14);
        }
        let at = fit.highest();
        let slope = 0.3 - 2.0 * at[0] + 0.4 * at[1];
        assert!(slope.abs() < 1e-14 && at[1] < 0.0, "{at:?}");
    }
    /// In a cube the highest point is found inside, on a face, on an edge and at a corner.
    #[test]
    fn finds_the_highest_point_of_a_cube() {
        let near = SPACINGS[3] * SPACINGS[3];
        for at in [
            [0.3, -0.2, 0.61],
            [0.123, 1.4, -0.3],
            [-1.7, 0.4, 2.0],
            [1.3, 1.2, -1.1],
        ] {
            let f = |x: [f64; 3]| {
                let [a, b, c] = [0, 1, 2].map(|d| x[d] - at[d]);
                1.0 - 0.1 * (a * a + 0.4 * a * b + b * b + 0.7 * c * c) + 0.01 * a.powi(3)
            };
            let (maximum, asked) = found(f);
            assert!(asked <= 4 * 28 + 28, "{asked}");
            // No point of a fine grid is higher than the one found.
            let steps = |n: i32| (-n..=n).map(move |i| f64::from(i) / f64::from(n));
            let grid = steps(40)
                .flat_map(|x| steps(40).flat_map(move |y| steps(40).map(move |z| [x, y, z])));
            let highest = grid.map(f).fold(f64::NEG_INFINITY, f64::max);
            assert!(
                maximum.value >= highest - near * near,
                "{maximum:?} {highest}"
            );
        }
    }
}
