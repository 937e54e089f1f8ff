//! Work-precision plots: the error of each run over its time, both logarithmic.

use crate::accuracy::{Knob, QuantityStudy, Study, foremost};
use crate::error::{Error, Result};
use crate::text::shown;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::series::DashedLineSeries;

const FONT: &str = "Helvetica, Arial, sans-serif";
const SIZE: (u32, u32) = (960, 540);
/// Width of the names beside the plot.
const LEGEND: u32 = 190;
/// Colours of the series, which readers with a colour vision deficiency can tell apart (P. Wong,
/// Nature Methods 8 (2011) 441, doi:10.1038/nmeth.1618).
const COLORS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(90, 90, 90),
];
/// Errors below this value, which are round-off, are drawn at it.
const FLOOR: f64 = 1e-9;
/// Largest error that is drawn.
const CEILING: f64 = 10.0;

/// Returns the quantities that get a plot.
pub(super) fn plotted(study: &Study) -> Vec<&QuantityStudy> {
    let mut out = foremost(&study.quantities);
    out.retain(|q| q.errors.iter().flatten().any(|e| *e <= CEILING));
    out
}

/// Draws the work-precision plot of a quantity of a study as SVG: the error of each run over its
/// time.
///
/// # Errors
/// `Internal` if drawing fails.
pub fn plot(study: &Study, quantity: &QuantityStudy) -> Result<String> {
    let mut text = String::new();
    draw(study, quantity, &mut text)
        .map_err(|e| Error::internal(format!("plot of {}: {e}", quantity.quantity)))?;
    Ok(shown(&text).into_owned())
}

type PlottedPoint = (f64, f64);

/// A curve of the plot.
struct PlottedCurve<'s> {
    name: &'s str,
    /// Whether the curve is a series of meshes.
    is_mesh: bool,
    points: Vec<PlottedPoint>,
}

/// Returns a curve for each series, with its runs in the order of their element sizes, the finest
/// first.
fn curves<'s>(study: &'s Study, quantity: &QuantityStudy) -> Vec<PlottedCurve<'s>> {
    let mut order: Vec<usize> = (0..study.runs.len()).collect();
    order.sort_by(|&a, &b| study.runs[a].ratio.total_cmp(&study.runs[b].ratio));
    let mut out: Vec<PlottedCurve> = Vec::new();
    for i in order {
        let (run, error) = (&study.runs[i], quantity.errors[i]);
        let Some(error) = error.filter(|e| *e <= CEILING) else {
            continue;
        };
        let point = (run.usage.undisturbed_seconds(), error.max(FLOOR));
        match out.iter_mut().find(|c| c.name == run.series) {
            Some(curve) => curve.points.push(point),
            None => out.push(PlottedCurve {
                name: &run.series,
                is_mesh: matches!(run.knob, Knob::Resolution | Knob::Element),
                points: vec![point],
            }),
        }
    }
    out
}

/// Returns the runs that no other run beats in both time and error.
fn front(study: &Study, quantity: &QuantityStudy) -> Vec<PlottedPoint> {
    let point = |&i: &usize| {
        Some((
            study.runs[i].usage.undisturbed_seconds(),
            quantity.errors[i]?.max(FLOOR),
        ))
    };
    let points = quantity.pareto.iter().filter_map(point);
    points.filter(|p| p.1 <= CEILING).collect()
}

/// Returns the range of some positive values, extended by an eighth of a decade on either side.
fn range(values: impl Iterator<Item = f64>) -> std::ops::Range<f64> {
    let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(l, h), v| (l.min(v), h.max(v)));
    let wider = 10f64.powf(0.125);
    low / wider..(high * wider).max(low * wider * wider)
}

fn draw(
    study: &Study,
    quantity: &QuantityStudy,
    text: &mut String,
) -> std::result::Result<(), Box<dyn std::error::Error>> {
    let curves = curves(study, quantity);
    let points = || curves.iter().flat_map(|c| c.points.iter().copied());
    if points().next().is_none() {
        return Err("no run has an error to draw".into());
    }
    let root = SVGBackend::with_string(text, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let (left, beside) = root.split_horizontally(SIZE.0 - LEGEND);
    let mut chart = ChartBuilder::on(&left)
        .caption(&quantity.quantity, (FONT, 18).into_font().color(&BLACK))
        .margin(14)
        .x_label_area_size(48)
        .y_label_area_size(76)
        .build_cartesian_2d(
            range(points().map(|p| p.0)).log_scale(),
            range(points().map(|p| p.1)).log_scale(),
        )?;
    chart
        .configure_mesh()
        .x_desc("time [s] (wall, or processor where less)")
        .y_desc("relative error")
        .axis_desc_style((FONT, 16))
        .label_style((FONT, 13))
        .x_label_formatter(&|v| tick(*v, |v| format!("{v}")))
        .y_label_formatter(&|v| tick(*v, |v| format!("{v:e}")))
        .light_line_style(TRANSPARENT)
        .bold_line_style(BLACK.mix(0.12))
        .draw()?;
    // A front of a single run is left out: its own curve shows that point.
    let front = front(study, quantity);
    if front.len() > 1 {
        let grey = RGBColor(150, 150, 150);
        chart.draw_series(DashedLineSeries::new(front, 6, 5, grey.stroke_width(5)))?;
        let [x, y] = place(0);
        beside.draw(&Rectangle::new(
            [(x - 12, y - 2), (x + 12, y + 2)],
            grey.filled(),
        ))?;
        beside.draw(&name("Pareto front", [x, y]))?;
    }
    for (i, curve) in curves.iter().enumerate() {
        draw_curve(curve, i, &mut chart, &beside)?;
    }
    root.present()?;
    drop(chart);
    drop((left, beside));
    drop(root);
    Ok(())
}

/// Draws curve `i` in the chart, and its mark and name beside it.
fn draw_curve<'a>(
    curve: &PlottedCurve,
    i: usize,
    chart: &mut ChartContext<'a, SVGBackend<'a>, Cartesian2d<LogCoord<f64>, LogCoord<f64>>>,
    beside: &DrawingArea<SVGBackend<'a>, Shift>,
) -> std::result::Result<(), Box<dyn std::error::Error>> {
    let color = COLORS[i % COLORS.len()];
    // Runs with one knob turned are points round the run of the scene itself: a line would
    // suggest an order.
    let (style, radius) = match curve.is_mesh {
        true => (color.filled(), 4),
        false => (color.stroke_width(2), 3),
    };
    // If colours are used a second time, the marks differ.
    let again = i >= COLORS.len();
    let [x, y] = place(i + 1);
    if curve.is_mesh {
        let line = LineSeries::new(curve.points.iter().copied(), color.stroke_width(2));
        chart.draw_series(line)?;
        beside.draw(&PathElement::new(
            [(x - 12, y), (x + 12, y)],
            color.stroke_width(2),
        ))?;
    }
    if again {
        let marks = curve
            .points
            .iter()
            .map(|&p| TriangleMarker::new(p, radius + 2, style));
        chart.draw_series(marks)?;
        beside.draw(&TriangleMarker::new((x, y), radius + 2, style))?;
    } else {
        let marks = curve.points.iter().map(|&p| Circle::new(p, radius, style));
        chart.draw_series(marks)?;
        beside.draw(&Circle::new((x, y), radius, style))?;
    }
    beside.draw(&name(curve.name, [x, y]))?;
    Ok(())
}

/// Returns the place at which the mark of a legend entry is drawn.
fn place(entry: usize) -> [i32; 2] {
    [20, 52 + 22 * entry as i32]
}

/// Returns the name of a legend entry, placed beside its mark.
fn name(text: &str, [x, y]: [i32; 2]) -> Text<'_, (i32, i32), &str> {
    Text::new(text, (x + 18, y - 7), (FONT, 13).into_font())
}

/// Returns the label of a tick of a logarithmic axis, rounded to one digit. Only 1, 2 and 5 of each
/// decade get a label, so that labels do not run into each other.
fn tick(value: f64, label: impl Fn(f64) -> String) -> String {
    let rounded = format!("{value:.0e}");
    match rounded.parse() {
        Ok(value) if rounded.starts_with(['1', '2', '5']) => label(value),
        _ => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::tick;

    #[test]
    fn ticks_are_round() {
        let plain = |v: f64| tick(v, |v| format!("{v}"));
        let labels = [0.1 + 0.1, 0.1 * 3.0, 0.5000000001, 20.0, 700.0].map(plain);
        assert_eq!(labels, ["0.2", "", "0.5", "20", ""]);
        assert_eq!(tick(2e-3, |v| format!("{v:e}")), "2e-3");
    }
}
