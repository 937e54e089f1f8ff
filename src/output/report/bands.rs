//! The scale of colours beside a picture.

use super::drawing::{Area, failed, nice_step, stroke, tick, units, write};
use super::theme::{INK, Scale};
use crate::error::Result;
use crate::number::with_unit;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

/// Bands of equal colour between nice numbers.
pub(super) struct Bands {
    low: f64,
    step: f64,
    count: usize,
    scale: Scale,
    /// Name of the unit of the numbers.
    unit: String,
}

impl Bands {
    /// Creates bands that cover `values`.
    pub(super) fn new(values: [f64; 2], scale: Scale, unit: &str) -> Self {
        let [low, high] = values;
        let extent = if high > low {
            high - low
        } else {
            1.0_f64.max(high.abs())
        };
        let step = nice_step(extent, 14);
        let low = (low / step + 1e-9).floor() * step;
        let count = ((high - low) / step - 1e-9).ceil().clamp(1.0, 24.0) as usize;
        Bands {
            low,
            step,
            count,
            scale,
            unit: unit.to_string(),
        }
    }

    /// Returns the lower ends of the bands and their colours, from the lowest band on.
    pub(super) fn levels(&self) -> impl Iterator<Item = (f64, RGBColor)> {
        (0..self.count).map(|band| (self.low + band as f64 * self.step, self.color(band)))
    }

    /// Describes a band in words by its two ends.
    pub(super) fn words(&self, band: usize) -> String {
        let from = self.low + band as f64 * self.step;
        let [from, to] = [from, from + self.step].map(tick);
        with_unit(&format!("{from} to {to}"), &self.unit)
    }

    fn color(&self, band: usize) -> RGBColor {
        let middle = self.low + (band as f64 + 0.5) * self.step;
        let last = 0.5 * self.step;
        let high = self.low + self.count as f64 * self.step;
        match self.scale {
            Scale::Diverging => self.scale.color(middle, self.low, high),
            _ => self.scale.color(middle, self.low + last, high - last),
        }
    }

    /// Draws a column of the colours with the numbers between them, from `at` downwards.
    pub(super) fn draw(&self, area: &Area, at: [f64; 2], height: f64) -> Result<()> {
        let (left, right) = (at[0] + 14.0, at[0] + 28.0);
        let line = 18.0;
        let (top, bottom) = (at[1] + line, at[1] + height);
        write(
            area,
            &self.unit,
            [left - 4.0, at[1] - 4.0],
            (HPos::Left, VPos::Top),
            INK,
        )?;
        let band = (bottom - top) / self.count as f64;
        // Numbers that would touch each other are left out.
        let every = (line / band).ceil().max(1.0) as usize;
        for i in 0..=self.count {
            let y = bottom - i as f64 * band;
            if i < self.count {
                let corners = [(units(left), units(y - band)), (units(right), units(y))];
                area.draw(&Rectangle::new(corners, self.color(i).filled()))
                    .map_err(failed)?;
            }
            if i % every == 0 {
                let value = self.low + i as f64 * self.step;
                let value = if value.abs() < 1e-9 * self.step {
                    0.0
                } else {
                    value
                };
                write(
                    area,
                    &tick(value),
                    [right + 5.0, y],
                    (HPos::Left, VPos::Center),
                    INK,
                )?;
            }
        }
        let frame = [(units(left), units(top)), (units(right), units(bottom))];
        area.draw(&Rectangle::new(frame, stroke(INK, 0.75)))
            .map_err(failed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_cover_all_values_between_nice_numbers() {
        for values in [
            [0.0, 1.0],
            [-3.7, 911.3],
            [5.0, 5.0],
            [0.0, 0.0],
            [1e-7, 3e-7],
        ] {
            let bands = Bands::new(values, Scale::Rising, "MPa");
            assert!(
                bands.count >= 1 && bands.count <= 16,
                "{values:?}: {}",
                bands.count
            );
            let high = bands.low + bands.count as f64 * bands.step;
            let round_off = 1e-8 * bands.step;
            assert!(bands.low <= values[0] + round_off, "{values:?}");
            assert!(high >= values[1] - round_off, "{values:?}");
            let levels: Vec<f64> = bands.levels().map(|(level, _)| level).collect();
            assert!(levels.len() == bands.count && levels.is_sorted_by(|a, b| a < b));
        }
    }
}
