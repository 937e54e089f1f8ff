//! Thermal expansion (`*EXPANSION`).
//!
//! The coefficient `a` is a secant from a reference temperature `T_z` (`ZERO`). From an initial
//! temperature `T_0` to `T` a material strains by
//!
//! ```text
//! eps = a(T) (T - T_z) - a(T_0) (T_0 - T_z)
//! ```
//!
//! and by `a (T - T_0)` if `a` is the same at all temperatures. A scene has one coefficient. Its
//! changes of temperature are chosen so that they give the same strain with this coefficient.
//!
//! # Source
//! G. Dhondt, *CalculiX CrunchiX User's Manual* 2.20, `*EXPANSION`.

use super::series::Series;
use crate::interpolation::interpolate;

/// Secant coefficients of expansion by temperature, constant beyond the first and the last row.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Expansion {
    /// Rows of temperature, ascending, and coefficient; at least one.
    rows: Vec<[f64; 2]>,
    /// The reference temperature of the secants.
    zero: f64,
}

impl Expansion {
    pub(super) fn new(rows: Vec<[f64; 2]>, zero: f64) -> Self {
        Expansion { rows, zero }
    }

    /// The coefficient used in the scene: the one with the largest absolute value.
    pub(super) fn coefficient(&self) -> f64 {
        let all = self.rows.iter().map(|row| row[1]);
        all.fold(0.0, |most, a| if a.abs() > most.abs() { a } else { most })
    }

    /// Whether the coefficient is the same at all temperatures.
    pub(super) fn is_constant(&self) -> bool {
        self.rows.iter().all(|row| row[1] == self.rows[0][1])
    }

    /// The change of temperature that gives, with the scene's coefficient, the strain from the
    /// initial temperature to another.
    fn equivalent(&self, initial: f64, temperature: f64) -> f64 {
        let coefficient = self.coefficient();
        if coefficient == 0.0 {
            return 0.0;
        }
        let share = |t: f64| interpolate(&self.rows, t) / coefficient * (t - self.zero);
        share(temperature) - share(initial)
    }

    /// Changes of temperature that give the same strains with the scene's coefficient as `change`
    /// since the initial temperature; linear between the times of `change` and the given times.
    pub(super) fn equivalents(&self, initial: f64, change: &Series, times: &[f64]) -> Series {
        let mut all: Vec<f64> = change.times().chain(times.iter().copied()).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        let mut out = Series::default();
        for time in all {
            out.push(time, self.equivalent(initial, initial + change.at(time)));
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: 1.2e-5 at 20 and 1.4e-5 at 200, for a change from 20 to 120 with secants from 20.
    #[test]
    fn strains_are_differences_of_secants() {
        let rows = vec![[20.0, 1.2e-5], [200.0, 1.4e-5]];
        let of = |zero: f64, initial: f64, t: f64| {
            let expansion = Expansion::new(rows.clone(), zero);
            expansion.coefficient() * expansion.equivalent(initial, t)
        };
        let at_120 = 1.2e-5 + 2e-6 * 100.0 / 180.0;
        assert!((of(20.0, 20.0, 120.0) - 100.0 * at_120).abs() < 1e-18);
        assert!((of(0.0, 20.0, 120.0) - (120.0 * at_120 - 20.0 * 1.2e-5)).abs() < 1e-18);
        assert!((of(0.0, 300.0, 0.0) + 300.0 * 1.4e-5).abs() < 1e-18);
        let mut ramp = Series::starting(0.0);
        ramp.push(2.0, 100.0);
        let expansion = Expansion::new(rows, 20.0);
        let series = expansion.equivalents(20.0, &ramp, &[1.0]);
        let expected = expansion.equivalent(20.0, 70.0);
        assert!((series.at(1.0) - expected).abs() < 1e-12 && expected < 50.0);
    }
}
