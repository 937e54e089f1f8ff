//! Values over time that are piecewise linear.

use crate::interpolation::interpolate;

/// Relative difference, from sums and products, below which two values count as equal.
const SAME: f64 = 1e-12;

/// Rows of time and value, from time 0 on; constant after the last row.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Series(Vec<[f64; 2]>);

impl Series {
    /// A series that begins with a value at time 0.
    pub(super) fn starting(value: f64) -> Series {
        Series(vec![[0.0, value]])
    }

    /// Whether there is a value yet.
    pub(super) fn is_begun(&self) -> bool {
        !self.0.is_empty()
    }

    /// The last value; 0 if there is none yet.
    pub(super) fn last(&self) -> f64 {
        self.0.last().map_or(0.0, |row| row[1])
    }

    /// Keeps the last value up to a time.
    pub(super) fn stay(&mut self, time: f64) {
        if self.0.last().is_none_or(|row| row[0] < time) {
            self.push(time, self.last());
        }
    }

    /// Continues linearly to a value at a later time.
    pub(super) fn push(&mut self, time: f64, value: f64) {
        if let [.., [t0, v0], [t1, v1]] = self.0[..] {
            let on_line = v0 + (value - v0) * (t1 - t0) / (time - t0);
            let size = v0.abs().max(v1.abs()).max(value.abs());
            if (on_line - v1).abs() <= SAME * size {
                self.0.pop();
            }
        }
        self.0.push([time, value]);
    }

    /// The value with the largest absolute value, with its sign.
    pub(super) fn largest(&self) -> f64 {
        let values = self.0.iter().map(|row| row[1]);
        values.fold(0.0, |m: f64, v| if v.abs() > m.abs() { v } else { m })
    }

    pub(super) fn is_finite(&self) -> bool {
        self.0.as_flattened().iter().all(|x| x.is_finite())
    }

    pub(super) fn is_zero(&self) -> bool {
        self.largest() == 0.0
    }

    /// The times of the rows.
    pub(super) fn times(&self) -> impl Iterator<Item = f64> {
        self.0.iter().map(|row| row[0])
    }

    /// The value at a time.
    pub(super) fn at(&self, time: f64) -> f64 {
        interpolate(&self.0, time)
    }

    /// The rows of time and value.
    pub(super) fn rows(&self) -> &[[f64; 2]] {
        &self.0
    }

    /// The rows divided by the largest value; ones if all values are zero.
    pub(super) fn shape(&self) -> Vec<[f64; 2]> {
        let largest = self.largest();
        let rows = self.0.iter();
        if largest == 0.0 {
            return rows.map(|&[time, _]| [time, 1.0]).collect();
        }
        rows.map(|&[time, value]| [time, value / largest]).collect()
    }

    /// The series with all values multiplied by a factor.
    pub(super) fn multiplied(&self, factor: f64) -> Series {
        let rows = self.0.iter();
        Series(rows.map(|&[time, value]| [time, factor * value]).collect())
    }

    /// Adds another series, multiplied by a factor.
    pub(super) fn add(&mut self, other: &Series, factor: f64) {
        let mut times: Vec<f64> = self.0.iter().chain(&other.0).map(|row| row[0]).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        let mut sum = Series::default();
        for time in times {
            sum.push(time, self.at(time) + factor * other.at(time));
        }
        *self = sum;
    }

    /// The bits of all numbers in the series, as a key for equal series.
    pub(super) fn bits(&self) -> Vec<u64> {
        let numbers = self.0.as_flattened().iter();
        // Adding zero makes zeros of either sign equal.
        numbers.map(|x| (x + 0.0).to_bits()).collect()
    }
}

/// Whether two shapes are equal except for round-off.
pub(super) fn are_alike(a: &[[f64; 2]], b: &[[f64; 2]]) -> bool {
    let close = |x: f64, y: f64| (x - y).abs() <= SAME * x.abs().max(y.abs()).max(1.0);
    let numbers = a.as_flattened().iter().zip(b.as_flattened());
    a.len() == b.len() && numbers.into_iter().all(|(x, y)| close(*x, *y))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_on_a_line_are_one() {
        let mut series = Series::starting(0.0);
        for time in 1..5 {
            series.push(f64::from(time), 0.1 * f64::from(time));
        }
        series.push(6.0, 0.0);
        assert_eq!(series.0.len(), 3);
        assert_eq!(series.largest(), 0.4);
        assert!((series.at(5.0) - 0.2).abs() < 1e-15);
        let mut sum = series.clone();
        sum.add(&series, -2.0);
        assert!((sum.at(2.5) + series.at(2.5)).abs() < 1e-15);
        assert!(are_alike(&sum.shape(), &series.shape()));
        assert!(!are_alike(&sum.shape(), &Series::starting(1.0).shape()));
    }
}
