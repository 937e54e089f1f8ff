//! Charts of curves, as SVG.

use crate::{Outcome, runs};
use plotters::prelude::*;
use plotters::series::DashedLineSeries;

pub const BLUE: RGBColor = RGBColor(31, 98, 173);
pub const RED: RGBColor = RGBColor(196, 54, 48);
pub const GREEN: RGBColor = RGBColor(42, 138, 84);
pub const ORANGE: RGBColor = RGBColor(214, 128, 22);
pub const GREY: RGBColor = RGBColor(110, 110, 110);
pub const FONT: &str = "Helvetica, Arial, sans-serif";

/// How a curve is drawn.
#[derive(Clone, Copy)]
pub enum Pen {
    Dashes,
    LineAndDots,
    DashesAndDots,
}

pub struct Curve {
    pub label: String,
    pub color: RGBColor,
    pub pen: Pen,
    pub points: Vec<(f64, f64)>,
}

impl Curve {
    pub fn new(label: &str, color: RGBColor, pen: Pen, points: Vec<(f64, f64)>) -> Curve {
        Curve {
            label: label.to_string(),
            color,
            pen,
            points,
        }
    }
}

pub struct Axis {
    pub label: &'static str,
    pub from: f64,
    pub to: f64,
}

pub struct Chart {
    pub file: &'static str,
    pub title: &'static str,
    pub x: Axis,
    pub y: Axis,
    pub legend: SeriesLabelPosition,
    pub curves: Vec<Curve>,
}

impl Chart {
    pub fn write(self) -> Outcome<()> {
        let mut text = String::new();
        {
            let root = SVGBackend::with_string(&mut text, (760, 500)).into_drawing_area();
            root.fill(&WHITE)?;
            let mut chart = ChartBuilder::on(&root)
                .caption(self.title, (FONT, 18).into_font().color(&BLACK))
                .margin(14)
                .margin_right(24)
                .x_label_area_size(48)
                .y_label_area_size(64)
                .build_cartesian_2d(self.x.from..self.x.to, self.y.from..self.y.to)?;
            chart
                .configure_mesh()
                .x_desc(self.x.label)
                .y_desc(self.y.label)
                .axis_desc_style((FONT, 16))
                .label_style((FONT, 14))
                .light_line_style(TRANSPARENT)
                .bold_line_style(BLACK.mix(0.12))
                .draw()?;
            for curve in self.curves {
                let (color, pen) = (curve.color, curve.pen);
                let style = color.stroke_width(2);
                let drawn = match pen {
                    Pen::LineAndDots => {
                        chart.draw_series(LineSeries::new(curve.points.clone(), style))?
                    }
                    Pen::Dashes | Pen::DashesAndDots => chart
                        .draw_series(DashedLineSeries::new(curve.points.clone(), 7, 5, style))?,
                };
                if !curve.label.is_empty() {
                    drawn.label(curve.label).legend(move |at| {
                        let line = |[from, to]: [i32; 2]| {
                            PathElement::new(vec![(from, 0), (to, 0)], style)
                        };
                        let radius = if matches!(pen, Pen::Dashes) { 0 } else { 3 };
                        let [a, b, c] = strokes(pen);
                        EmptyElement::at(at)
                            + line(a)
                            + line(b)
                            + line(c)
                            + Circle::new((14, 0), radius, color.filled())
                    });
                }
                if matches!(pen, Pen::LineAndDots | Pen::DashesAndDots) {
                    chart.draw_series(dots(&curve.points, color))?;
                }
            }
            chart
                .configure_series_labels()
                .position(self.legend)
                .margin(14)
                .legend_area_size(34)
                .label_font((FONT, 14))
                .background_style(WHITE.mix(0.85))
                .border_style(BLACK.mix(0.25))
                .draw()?;
            root.present()?;
        }
        save(self.file, &text)
    }
}

fn dots(points: &[(f64, f64)], color: RGBColor) -> Vec<Circle<(f64, f64), i32>> {
    points
        .iter()
        .map(|&p| Circle::new(p, 3, color.filled()))
        .collect()
}

/// The strokes beside a curve's name, from and to.
fn strokes(pen: Pen) -> [[i32; 2]; 3] {
    match pen {
        Pen::LineAndDots => [[0, 28], [28, 28], [28, 28]],
        Pen::Dashes | Pen::DashesAndDots => [[0, 7], [11, 17], [21, 28]],
    }
}

/// Writes a figure under `data/figures`.
pub fn save(file: &str, text: &str) -> Outcome<()> {
    let path = runs::data("figures").join(file);
    std::fs::write(&path, text)?;
    println!("{}", path.display());
    Ok(())
}
