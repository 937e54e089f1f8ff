//! Charts of curves.

use super::drawing::{Axes, Drawing, axes, failed, letters, nice_step, stroke, title, units};
use super::theme::{CURVES, FAINT, INK, PAPER};
use crate::error::Result;
use crate::number::significant;
use plotters::prelude::*;
use plotters::series::DashedLineSeries;

/// Size of a chart in pixels: two fit beside each other on a screen, and one is still legible on a
/// phone.
const SIZE: [u32; 2] = [520, 330];
/// Largest number of points of a curve that a chart shows.
const MOST_POINTS: usize = 600;

/// Style in which a curve is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Pen {
    /// A solid line.
    Line,
    /// A line with a dot at every point.
    Dotted,
    /// Dots at the points alone.
    Dots,
    /// A dashed line with a dot at every point.
    Dashed,
}

/// A curve of a chart.
pub(super) struct ChartCurve {
    /// Name in the legend; empty if there is none.
    pub label: String,
    /// Index of the colour; `None` for a faint curve.
    pub color: Option<usize>,
    /// Line and dots that draw the curve.
    pub pen: Pen,
    /// Points of the curve, in order.
    pub points: Vec<[f64; 2]>,
}

/// A chart of some curves.
pub(super) struct Chart {
    /// Labels of the axes, with units.
    pub labels: [String; 2],
    /// Curves of the chart.
    pub curves: Vec<ChartCurve>,
    /// Whether each axis includes 0 even if no value does.
    pub from_zero: [bool; 2],
    /// Share by which the horizontal axis is longer than the curves, to make room for the legend.
    pub widened: f64,
    /// Position of the legend.
    pub legend: SeriesLabelPosition,
}

impl ChartCurve {
    /// Draws the curve, with its entry in the legend if it has a name.
    fn draw<'a>(&self, chart: &mut Axes<'a>) -> Result<()> {
        let color = match self.color {
            Some(number) => CURVES[number % CURVES.len()],
            None => FAINT,
        };
        let points: Vec<(f64, f64)> = thinned(&self.points)
            .into_iter()
            .map(|[x, y]| (x, y))
            .collect();
        let line = stroke(color, 2.0);
        let pen = self.pen;
        let dots = matches!(pen, Pen::Dots | Pen::Dotted | Pen::Dashed);
        let lines = points.iter().copied();
        let drawn = match pen {
            Pen::Dashed => chart.draw_series(DashedLineSeries::new(
                lines,
                units(6.0) as u32,
                units(4.0) as u32,
                line,
            )),
            Pen::Dots => chart.draw_series(LineSeries::new([], line)),
            _ => chart.draw_series(LineSeries::new(lines, line)),
        }
        .map_err(failed)?;
        if !self.label.is_empty() {
            let radius = if dots { units(3.5) } else { 0 };
            drawn.label(&self.label).legend(move |at| {
                let [a, b] = strokes(pen)
                    .map(|ends| PathElement::new(ends.map(|x| (units(x), 0)).to_vec(), line));
                let dot = Circle::new((units(12.0), 0), radius, color.filled());
                EmptyElement::at(at) + a + b + dot
            });
        }
        if dots {
            let dot = |&p: &(f64, f64)| Circle::new(p, units(3.5), color.filled());
            chart.draw_series(points.iter().map(dot)).map_err(failed)?;
        }
        Ok(())
    }
}

impl Chart {
    /// Draws the chart.
    ///
    /// # Errors
    /// `Internal` if the plotting library fails.
    pub(super) fn draw(&self) -> Result<Drawing> {
        let mut x = range(&self.curves, 0, self.from_zero[0]);
        x[1] += self.widened * (x[1] - x[0]);
        let y = range(&self.curves, 1, self.from_zero[1]);
        let mut values = String::new();
        let mut drawing = Drawing::new(SIZE, |area| {
            let mut chart = ChartBuilder::on(area)
                .margin_top(units(14.0))
                .margin_right(units(22.0))
                .margin_left(units(4.0))
                .margin_bottom(units(4.0))
                .x_label_area_size(units(46.0))
                .y_label_area_size(units(78.0))
                .build_cartesian_2d(x[0]..x[1], y[0]..y[1])
                .map_err(failed)?;
            axes(&mut chart, [&self.labels[0], &self.labels[1]], true)?;
            for curve in &self.curves {
                curve.draw(&mut chart)?;
                for &[x, y] in told(&curve.points).iter() {
                    let at = chart.backend_coord(&(x, y));
                    values.push_str(&self.value(&curve.label, [x, y], at));
                }
            }
            if self.curves.iter().any(|curve| !curve.label.is_empty()) {
                chart
                    .configure_series_labels()
                    .position(self.legend.clone())
                    .margin(units(8.0))
                    .legend_area_size(units(30.0))
                    .label_font(letters(INK))
                    .background_style(PAPER.mix(0.8))
                    .border_style(TRANSPARENT)
                    .draw()
                    .map_err(failed)?;
            }
            Ok(())
        })?;
        drawing.overlay(&values);
        Ok(drawing)
    }

    /// Returns a spot that shows the values of a point when a pointer rests on it.
    fn value(&self, label: &str, point: [f64; 2], at: (i32, i32)) -> String {
        let number = |k: usize| format!("{}: {}", self.labels[k], significant(point[k], 5));
        let label = if label.is_empty() {
            String::new()
        } else {
            format!("{label}\n")
        };
        format!(
            "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"none\" \
             pointer-events=\"all\">{}</circle>\n",
            at.0,
            at.1,
            units(7.0),
            title(&format!("{label}{}\n{}", number(0), number(1)))
        )
    }
}

/// Largest number of points of a curve that show their values.
const MOST_TOLD: usize = 60;

/// Returns the points of a curve that show their values: all of them, or [`MOST_TOLD`] in equal
/// steps.
fn told(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let finite = points
        .iter()
        .copied()
        .filter(|p| p.iter().all(|v| v.is_finite()));
    let finite: Vec<[f64; 2]> = finite.collect();
    let step = finite.len().div_ceil(MOST_TOLD).max(1);
    let last = finite.last().copied();
    let mut out: Vec<[f64; 2]> = finite.into_iter().step_by(step).collect();
    out.extend(last.filter(|last| out.last() != Some(last)));
    out
}

/// Returns the strokes beside a curve's name in the legend, each as its start and its end in
/// pixels.
fn strokes(pen: Pen) -> [[f64; 2]; 2] {
    match pen {
        Pen::Line | Pen::Dotted => [[0.0, 24.0], [24.0, 24.0]],
        Pen::Dashed => [[0.0, 9.0], [15.0, 24.0]],
        Pen::Dots => [[12.0, 12.0], [12.0, 12.0]],
    }
}

/// Returns a range that contains all values and ends at nice numbers.
fn range(curves: &[ChartCurve], axis: usize, from_zero: bool) -> [f64; 2] {
    let values = curves.iter().flat_map(|c| &c.points).map(|p| p[axis]);
    let finite = values.filter(|v| v.is_finite());
    let (mut low, mut high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
        (l.min(v), h.max(v))
    });
    if low > high {
        return [0.0, 1.0];
    }
    if from_zero {
        (low, high) = (low.min(0.0), high.max(0.0));
    }
    let size = low.abs().max(high.abs());
    if high - low <= 1e-9 * size || size == 0.0 {
        let room = if size == 0.0 { 1.0 } else { 0.1 * size };
        (low, high) = (low - room, high + room);
    }
    let step = nice_step(high - low, 20);
    // A curve that ends at a tick gets room for the width of its line.
    let (begin, end) = ((low / step).floor() * step, (high / step).ceil() * step);
    let room = 0.02 * (high - low);
    [
        if low - begin < room && low != 0.0 {
            begin - step
        } else {
            begin
        },
        if end - high < room && high != 0.0 {
            end + step
        } else {
            end
        },
    ]
}

/// Thins a curve to at most [`MOST_POINTS`] finite points; ends and extremes are kept.
fn thinned(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let points: Vec<[f64; 2]> = points
        .iter()
        .copied()
        .filter(|p| p[0].is_finite() && p[1].is_finite())
        .collect();
    if points.len() <= MOST_POINTS {
        return points;
    }
    // The lowest and the highest point of each stretch stay, in order.
    let stretch = points.len().div_ceil(MOST_POINTS / 2);
    let mut out = Vec::with_capacity(MOST_POINTS + 2);
    for part in points.chunks(stretch) {
        let by_height = |a: &usize, b: &usize| part[*a][1].total_cmp(&part[*b][1]);
        let low = (0..part.len()).min_by(by_height).unwrap_or(0);
        let high = (0..part.len()).max_by(by_height).unwrap_or(0);
        out.push(part[low.min(high)]);
        if low != high {
            out.push(part[low.max(high)]);
        }
    }
    out.extend(points.last());
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(points: Vec<[f64; 2]>) -> ChartCurve {
        ChartCurve {
            label: "a".into(),
            color: Some(0),
            pen: Pen::Line,
            points,
        }
    }

    #[test]
    fn a_range_holds_all_values_whatever_they_are() {
        for values in [
            vec![],
            vec![0.0],
            vec![3.0, 3.0],
            vec![-1e-9, 2e-9],
            vec![1e12, 1e12 + 1.0],
            vec![f64::NAN, 1.0],
        ] {
            let points = values.iter().map(|v| [*v, *v]).collect();
            let [low, high] = range(&[curve(points)], 1, false);
            assert!(low < high && low.is_finite() && high.is_finite());
            assert!(
                values
                    .iter()
                    .all(|v| v.is_nan() || (low <= *v && *v <= high)),
                "{values:?}: {low} {high}"
            );
        }
    }

    #[test]
    fn a_long_curve_keeps_ends_and_extremes() {
        let mut points: Vec<[f64; 2]> = (0..100_000).map(|i| [f64::from(i), 0.0]).collect();
        points[77_777][1] = 5.0;
        points[3][1] = -5.0;
        let thin = thinned(&points);
        assert!(thin.len() <= MOST_POINTS + 2);
        assert_eq!(thin.last(), points.last());
        assert!(thin.contains(&points[77_777]) && thin.contains(&points[3]));
        assert!(thin.windows(2).all(|p| p[0][0] <= p[1][0]));
    }
}
