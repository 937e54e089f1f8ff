//! The highest point of a smooth function on a square, from few values.
//!
//! Nine values on a stencil of points `spacing` apart lead, by least squares, to a quadratic whose
//! highest point on the stencil is tried, too. The place then is right to the square of the
//! spacing, so that the next spacing may be the square of this one; the value is right to the
//! square of the place's error. Stencils lie on a lattice: where a function that differs little is
//! searched again it is asked for at the same points.

/// Spacings of one search after the other, on a square of side 2: the whole square first.
pub const SPACINGS: [f64; 4] = [1.0, 1.0 / 4.0, 1.0 / 16.0, 1.0 / 256.0];
/// Stencils of one spacing that may follow one another uphill.
const MOST_MOVES: usize = 50;
/// A place this near to the edge of its stencil, in spacings, is on it.
const ON_EDGE: f64 = 1e-9;

/// The highest point that was found on `[-1, 1]^2`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summit {
    /// The function's value there.
    pub value: f64,
    /// Where it is.
    pub at: [f64; 2],
}

impl Summit {
    /// The middle of the square, not looked at yet.
    pub fn unknown() -> Self {
        Summit {
            value: f64::NEG_INFINITY,
            at: [0.0; 2],
        }
    }

    /// Looks round the point for a higher one, and goes on from stencil to stencil while that leads
    /// uphill. `f` is told, too, whether a point lies on the lattice.
    pub fn look_around(&mut self, spacing: f64, f: &mut impl FnMut([f64; 2], bool) -> f64) {
        for _ in 0..MOST_MOVES {
            let from = *self;
            let center = from.at.map(|x| {
                let nearest = (x / spacing).round() * spacing;
                nearest.clamp(spacing - 1.0, 1.0 - spacing)
            });
            let place = |x: [f64; 2]| [0, 1].map(|d| center[d] + spacing * x[d]);
            let mut values = [[0.0; 3]; 3];
            for (a, row) in values.iter_mut().enumerate() {
                for (b, value) in row.iter_mut().enumerate() {
                    let at = place([a as f64 - 1.0, b as f64 - 1.0]);
                    *value = f(at, true);
                    self.rise(*value, at);
                }
            }
            let highest = Quadratic::of(&values).highest();
            if highest.iter().any(|x| x.fract() != 0.0) {
                let at = place(highest);
                self.rise(f(at, false), at);
            }
            let leads_on = (0..2).any(|d| {
                let beside = (self.at[d] - center[d]).abs() / spacing;
                beside > 1.0 - ON_EDGE && self.at[d].abs() < 1.0
            });
            if !(leads_on && self.value > from.value) {
                break;
            }
        }
    }

    fn rise(&mut self, value: f64, at: [f64; 2]) {
        if value > self.value {
            *self = Summit { value, at };
        }
    }
}

/// `q(x, y) = gx x + gy y + (hxx x^2 + hyy y^2) / 2 + hxy x y` on a stencil, up to a constant.
struct Quadratic {
    gradient: [f64; 2],
    /// `hxx, hyy, hxy`.
    hessian: [f64; 3],
}

impl Quadratic {
    /// The least-squares fit to the values at `{-1, 0, 1}^2`, whose normal equations are diagonal
    /// up to the constant.
    fn of(values: &[[f64; 3]; 3]) -> Self {
        let sum = |weight: &dyn Fn(f64, f64) -> f64| -> f64 {
            let rows = values.iter().zip([-1.0, 0.0, 1.0]);
            rows.map(|(row, x)| {
                let terms = row.iter().zip([-1.0, 0.0, 1.0]);
                terms.map(|(value, y)| weight(x, y) * value).sum::<f64>()
            })
            .sum()
        };
        Quadratic {
            gradient: [sum(&|x, _| x) / 6.0, sum(&|_, y| y) / 6.0],
            hessian: [
                sum(&|x, _| x * x - 2.0 / 3.0),
                sum(&|_, y| y * y - 2.0 / 3.0),
                sum(&|x, y| x * y) / 4.0,
            ],
        }
    }

    fn value(&self, [x, y]: [f64; 2]) -> f64 {
        let ([gx, gy], [hxx, hyy, hxy]) = (self.gradient, self.hessian);
        gx * x + gy * y + 0.5 * (hxx * x * x + hyy * y * y) + hxy * x * y
    }

    /// Its highest point on `[-1, 1]^2`: inside, on a side or at a corner.
    fn highest(&self) -> [f64; 2] {
        let ([gx, gy], [hxx, hyy, hxy]) = (self.gradient, self.hessian);
        let mut best = [0.0; 2];
        let mut try_out = |x: [f64; 2]| {
            let inside = x.iter().all(|x| x.abs() <= 1.0);
            if inside && self.value(x) > self.value(best) {
                best = x;
            }
        };
        let determinant = hxx * hyy - hxy * hxy;
        try_out([
            (hxy * gy - hyy * gx) / determinant,
            (hxy * gx - hxx * gy) / determinant,
        ]);
        for side in [-1.0, 1.0] {
            try_out([side, -(gy + hxy * side) / hyy]);
            try_out([-(gx + hxy * side) / hxx, side]);
            try_out([side, -1.0]);
            try_out([side, 1.0]);
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(f: impl Fn([f64; 2]) -> f64) -> (Summit, usize) {
        let mut summit = Summit::unknown();
        let mut asked = 0;
        for spacing in SPACINGS {
            summit.look_around(spacing, &mut |x, _| {
                asked += 1;
                f(x)
            });
        }
        (summit, asked)
    }

    /// Inside, on a side, at a corner, a ridge; the place is as near as the square of the last
    /// spacing, and the value as the square of that.
    #[test]
    fn finds_the_highest_point_from_few_values() {
        let near = SPACINGS[3] * SPACINGS[3];
        for (x0, y0) in [(0.3, -0.2), (0.123, 0.987), (-1.7, 0.4), (1.3, 1.2)] {
            let f = |[x, y]: [f64; 2]| {
                let (dx, dy): (f64, f64) = (x - x0, y - y0);
                1.0 - 0.1 * (dx * dx + 0.5 * dx * dy + dy * dy) + 0.01 * dx.powi(3)
                    - 0.02 * (dy * dy * dy * dy)
            };
            let (summit, asked) = found(f);
            assert!(asked <= 60, "{asked}");
            // Against the highest of a fine grid: no lower than what is left to gain within the
            // error of the place.
            let steps = |n: i32| (-n..=n).map(move |i| f64::from(i) / f64::from(n));
            let grid = steps(400).flat_map(|x| steps(400).map(move |y| [x, y]));
            let highest = grid.map(|x| (f(x), x)).max_by(|a, b| a.0.total_cmp(&b.0));
            let (value, at) = highest.unwrap();
            let left = near * near;
            assert!(summit.value >= value - left, "{summit:?} {value} {at:?}");
            assert_eq!(summit.value, f(summit.at));
            if x0.abs() < 1.0 && y0.abs() < 1.0 {
                let off = (summit.at[0] - x0).hypot(summit.at[1] - y0);
                assert!(off < near, "{summit:?}");
            }
        }
        let ridge = |[x, y]: [f64; 2]| -(x - y - 0.1) * (x - y - 0.1) + 1e-3 * x;
        let (summit, asked) = found(ridge);
        assert!(
            (summit.value - 1e-3).abs() < 1e-6 && asked < 200,
            "{summit:?} {asked}"
        );
    }

    #[test]
    fn what_is_flat_or_no_number_ends_the_search() {
        let (summit, asked) = found(|_| 2.0);
        assert_eq!((summit.value, asked), (2.0, 36));
        assert_eq!(found(|_| f64::NAN).0, Summit::unknown());
    }

    /// The quadratic of least squares goes through values that are quadratic.
    #[test]
    fn a_quadratic_is_its_own_fit() {
        let given = Quadratic {
            gradient: [0.3, -0.7],
            hessian: [-2.0, -1.0, 0.4],
        };
        let values = [-1.0, 0.0, 1.0].map(|x| [-1.0, 0.0, 1.0].map(|y| 5.0 + given.value([x, y])));
        let fit = Quadratic::of(&values);
        for x in [[0.2, 0.9], [-1.0, 0.5]] {
            assert!((fit.value(x) - given.value(x)).abs() < 1e-14);
        }
        let at = fit.highest();
        let slope = 0.3 - 2.0 * at[0] + 0.4 * at[1];
        assert!(slope.abs() < 1e-14 && at[1] < 0.0, "{at:?}");
    }
}
