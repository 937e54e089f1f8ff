//! Pictures: areas and lines under axes with one scale.

use super::bands::Bands;
use super::drawing::{Area, Drawing, FINE, LETTERS, axes, escaped, failed, title};
use super::path::{self, Spot};
use super::theme::{INK, PAPER, hex};
use super::window::Window;
use crate::error::Result;
use plotters::prelude::*;
use std::fmt::Write as _;

/// Room for axes and colours, in pixels.
const LEFT: u32 = 66;
const RIGHT: u32 = 82;
const TOP: u32 = 12;
const BOTTOM: u32 = 46;

/// A picture under construction.
pub(super) struct Picture {
    window: Window,
    /// Width in pixels without axes and colours.
    across: u32,
    /// Room for the scale of colours, in pixels.
    right: u32,
    /// The paths drawn so far, as SVG.
    elements: String,
}

impl Picture {
    /// Creates an empty picture of a window with room for a scale of colours. Three such pictures
    /// fit beside each other on a screen.
    pub(super) fn new(window: Window) -> Self {
        Picture {
            window,
            across: 292,
            right: RIGHT,
            elements: String::new(),
        }
    }

    /// Creates a larger empty picture without a scale of colours.
    pub(super) fn large(window: Window) -> Self {
        Picture {
            across: 430,
            right: 20,
            ..Self::new(window)
        }
    }

    /// Returns the number of pixels per unit of length.
    fn scale(&self) -> f64 {
        f64::from(self.across) / self.window.size()[0]
    }

    /// Returns the height of the picture in pixels.
    fn down(&self) -> f64 {
        self.scale() * self.window.size()[1]
    }

    /// Returns the position of a point in the drawing, in pixels as shown.
    pub(super) fn place_of(&self, point: [f64; 2]) -> Spot {
        [
            f64::from(LEFT) + self.scale() * (point[0] - self.window.low[0]),
            f64::from(TOP) + self.scale() * (self.window.high[1] - point[1]),
        ]
    }

    /// Converts lines to units of the drawing; also returns the rectangle that is visible.
    fn drawn(&self, lines: &[Vec<[f64; 2]>]) -> (Vec<Vec<Spot>>, Window) {
        let place = |p: &[f64; 2]| self.place_of(*p).map(|x| x * f64::from(FINE));
        let lines = lines.iter().map(|line| line.iter().map(place).collect());
        let [left, top] = [LEFT, TOP].map(f64::from);
        let shows = Window {
            low: [left, top].map(|x| x * f64::from(FINE)),
            high: [left + f64::from(self.across), top + self.down()].map(|x| x * f64::from(FINE)),
        };
        (lines.collect(), shows)
    }

    /// Fills the area inside closed lines.
    pub(super) fn fill(&mut self, rings: &[Vec<[f64; 2]>], color: RGBColor, opacity: f64) {
        self.fill_told(rings, color, opacity, "");
    }

    /// Fills an area like [`Picture::fill`], with words that appear when a pointer rests on it.
    pub(super) fn fill_told(
        &mut self,
        rings: &[Vec<[f64; 2]>],
        color: RGBColor,
        opacity: f64,
        told: &str,
    ) {
        let (rings, shows) = self.drawn(rings);
        let data = path::area(&rings, shows);
        let opacity = match opacity < 1.0 {
            true => format!(" fill-opacity=\"{opacity}\""),
            false => String::new(),
        };
        if !data.is_empty() {
            let color = hex(color);
            match told {
                "" => self.element(format_args!(
                    "<path fill=\"{color}\"{opacity} d=\"{data}\"/>"
                )),
                told => self.element(format_args!(
                    "<path fill=\"{color}\"{opacity} d=\"{data}\">{}</path>",
                    title(told)
                )),
            }
        }
    }

    /// Draws lines with a width in pixels.
    pub(super) fn stroke(&mut self, lines: &[Vec<[f64; 2]>], color: RGBColor, width: f64) {
        let (lines, shows) = self.drawn(lines);
        let data = path::line(&lines, shows);
        if !data.is_empty() {
            let (color, width) = (hex(color), width * f64::from(FINE));
            self.element(format_args!(
                "<path fill=\"none\" stroke=\"{color}\" stroke-width=\"{width}\" \
                 stroke-linejoin=\"round\" d=\"{data}\"/>"
            ));
        }
    }

    /// Draws closed lines.
    pub(super) fn outline(&mut self, rings: Vec<Vec<[f64; 2]>>, color: RGBColor, width: f64) {
        let lines: Vec<_> = rings.into_iter().map(path::closed).collect();
        self.stroke(&lines, color, width);
    }

    /// Marks a point with a small ring and words beside it, which are legible on any colour.
    pub(super) fn mark(&mut self, point: [f64; 2], words: &str) {
        let fine = f64::from(FINE);
        let [x, y] = self.place_of(point);
        let middle = f64::from(LEFT) + 0.5 * f64::from(self.across);
        let (anchor, beside) = match x < middle + 20.0 {
            true => ("start", 8.0),
            false => ("end", -8.0),
        };
        // Labels stay off the lower border, where they would cover the axis numbers.
        let below = (y + 4.5)
            .min(f64::from(TOP) + self.down() - 4.0)
            .max(f64::from(TOP) + LETTERS);
        let (ink, paper) = (hex(INK), hex(PAPER));
        let (cx, cy) = ((x * fine).round(), (y * fine).round());
        for (color, width) in [(&paper, 3.0), (&ink, 1.25)] {
            let (r, width) = (3.5 * fine, width * fine);
            self.element(format_args!(
                "<circle cx=\"{cx}\" cy=\"{cy}\" r=\"{r}\" fill=\"none\" stroke=\"{color}\" \
                 stroke-width=\"{width}\"/>"
            ));
        }
        let (tx, ty) = (((x + beside) * fine).round(), (below * fine).round());
        let width = 3.0 * fine;
        let words = escaped(words);
        self.element(format_args!(
            "<text x=\"{tx}\" y=\"{ty}\" text-anchor=\"{anchor}\" fill=\"{ink}\" \
             stroke=\"{paper}\" stroke-width=\"{width}\" stroke-linejoin=\"round\" \
             paint-order=\"stroke\">{words}</text>"
        ));
    }

    fn element(&mut self, element: std::fmt::Arguments) {
        // Writing to a string does not fail.
        let _ = writeln!(self.elements, "{element}");
    }

    /// Returns the drawing: the painted areas and lines under axes, a scale of colours if there is
    /// one, and the additions of `over` on top.
    ///
    /// # Errors
    /// `Internal` if the plotting library fails.
    pub(super) fn finish(
        &self,
        labels: [&str; 2],
        bands: Option<&Bands>,
        over: impl FnOnce(&Area) -> Result<()>,
    ) -> Result<Drawing> {
        let height = self.down();
        let total = TOP + BOTTOM + height.ceil() as u32;
        let mut drawing = Drawing::new([LEFT + self.across + self.right, total], |area| {
            let bare = area.margin(
                TOP * FINE,
                ((f64::from(total - TOP - BOTTOM) - height) * f64::from(FINE)) as u32,
                0,
                self.right * FINE,
            );
            let (low, high) = (self.window.low, self.window.high);
            let mut chart = ChartBuilder::on(&bare)
                .x_label_area_size(BOTTOM * FINE)
                .y_label_area_size(LEFT * FINE)
                .build_cartesian_2d(low[0]..high[0], low[1]..high[1])
                .map_err(failed)?;
            axes(&mut chart, labels, false)?;
            if let Some(bands) = bands {
                let right = f64::from(LEFT + self.across);
                bands.draw(area, [right, f64::from(TOP)], height)?;
            }
            over(area)
        })?;
        drawing.underlay(&self.elements);
        Ok(drawing)
    }
}
