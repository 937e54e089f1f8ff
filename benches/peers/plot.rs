//! The work-precision plot: error over processor seconds, both logarithmic, a curve for each
//! program.

use plotters::prelude::*;
use serde_json::Value;
use std::error::Error;

const FONT: &str = "Helvetica, Arial, sans-serif";
const CURVES: [(&str, &str, RGBColor); 2] = [
    ("brinell", "brinell", RGBColor(31, 98, 173)),
    ("CalculiX", "CalculiX (ccx)", RGBColor(196, 54, 48)),
];

/// The plot as SVG: the larger error of the pressures at 0.8 and at 2 times the yield load, in per
/// cent.
///
/// # Errors
/// Where a row lacks a figure or the plotting library fails.
pub fn work_precision(rows: &[Value]) -> Result<String, Box<dyn Error>> {
    let point = |row: &Value| -> Option<(f64, f64)> {
        let error = row["error_elastic"]
            .as_f64()?
            .max(row["error_twice"].as_f64()?);
        Some((row["processor_seconds"].as_f64()?, 100.0 * error))
    };
    let points: Vec<(f64, f64)> = rows.iter().filter_map(point).collect();
    let range = |of: fn(&(f64, f64)) -> f64| {
        let values = points.iter().map(of);
        let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(l, h), v| (l.min(v), h.max(v)));
        10f64.powf(low.log10().floor())..10f64.powf(high.log10().ceil())
    };
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, (760, 480)).into_drawing_area();
        root.fill(&WHITE)?;
        let mut chart = ChartBuilder::on(&root)
            .margin(16)
            .x_label_area_size(48)
            .y_label_area_size(74)
            .caption("Line contact to twice the yield load and back", (FONT, 18))
            .build_cartesian_2d(range(|p| p.0).log_scale(), range(|p| p.1).log_scale())?;
        chart
            .configure_mesh()
            .x_desc("processor seconds, one thread")
            .y_desc("larger error of the pressures at 0.8 P* and at 2 P* [%]")
            .label_style((FONT, 13))
            .light_line_style(TRANSPARENT)
            .draw()?;
        for (program, name, color) in CURVES {
            let own = rows.iter().filter(|row| row["program"] == program);
            let curve: Vec<(f64, f64)> = own.filter_map(point).collect();
            chart
                .draw_series(LineSeries::new(curve.clone(), color.stroke_width(2)))?
                .label(name)
                .legend(move |(x, y)| {
                    PathElement::new([(x, y), (x + 22, y)], color.stroke_width(2))
                });
            chart.draw_series(curve.into_iter().map(|p| Circle::new(p, 4, color.filled())))?;
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperRight)
            .label_font((FONT, 14))
            .border_style(BLACK.mix(0.3))
            .background_style(WHITE)
            .draw()?;
        root.present()?;
    }
    Ok(text)
}
