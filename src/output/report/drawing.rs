//! A drawing: SVG text made by the plotting library, with additional paths under and over it.
//!
//! The library places everything on whole units. Drawings are therefore made [`FINE`] times as
//! large as they are shown, which makes the positions of lines accurate to an eighth of a pixel.

use super::theme::{self, FAINT, INK, PAPER};
use crate::error::{Error, Result};
use crate::number::trimmed;
use crate::text::shown;
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Units of a drawing per pixel of its intended size.
pub(super) const FINE: u32 = 8;
/// Size of letters in pixels.
pub(super) const LETTERS: f64 = 13.0;
const FONT: &str = "system-ui, -apple-system, Segoe UI, Roboto, Helvetica, Arial, sans-serif";

/// The area that the plotting library draws on.
pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// A finished drawing.
pub(super) struct Drawing {
    /// Everything between the opening and the closing tag.
    content: String,
    width: u32,
    height: u32,
}

impl Drawing {
    /// Draws on an area of `width` by `height` pixels.
    ///
    /// # Errors
    /// `Internal` if the plotting library fails.
    pub(super) fn new(
        [width, height]: [u32; 2],
        draw: impl FnOnce(&Area) -> Result<()>,
    ) -> Result<Self> {
        let mut text = String::new();
        {
            let size = (width * FINE, height * FINE);
            let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
            draw(&root)?;
            root.present().map_err(failed)?;
        }
        let begin = text.find('>').map_or(0, |at| at + 1);
        let end = text.rfind("</svg>").unwrap_or(text.len());
        let content = compact(text.get(begin..end).unwrap_or(""));
        Ok(Drawing {
            content,
            width,
            height,
        })
    }

    /// Puts SVG elements under the drawing.
    pub(super) fn underlay(&mut self, elements: &str) {
        self.content.insert_str(0, elements);
    }

    /// Puts SVG elements over the drawing.
    pub(super) fn overlay(&mut self, elements: &str) {
        self.content.push_str(elements);
    }

    /// Returns the text of a separate file: fixed colours on a background of its own.
    pub(super) fn file(&self) -> String {
        let ground = format!(
            "<rect width=\"100%\" height=\"100%\" fill=\"{}\"/>\n",
            theme::hex(PAPER)
        );
        let size = format!(" width=\"{}\" height=\"{}\"", self.width, self.height);
        format!("{}{ground}{}</svg>\n", self.tag(&size), self.content)
    }

    /// Returns the text for the page: colours by name, as wide as there is room. `label` describes
    /// the drawing for readers who do not see it, `id` is its name within the page.
    pub(super) fn inline(&self, label: &str, id: &str) -> String {
        let label = label
            .replace('&', "&amp;")
            .replace('<', "&lt;")
            .replace('"', "&quot;");
        let told = format!(" id=\"{id}\" role=\"img\" aria-label=\"{label}\"");
        format!("{}{}</svg>", self.tag(&told), theme::themed(&self.content))
    }

    /// Width and height of the drawing, in units.
    pub(super) fn size(&self) -> [u32; 2] {
        [self.width * FINE, self.height * FINE]
    }

    fn tag(&self, attributes: &str) -> String {
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\"{}{attributes}>\n",
            self.width * FINE,
            self.height * FINE,
            font()
        )
    }
}

/// Removes from the library's text the font, which is set for the whole drawing, and attributes
/// with their default values.
fn compact(text: &str) -> String {
    text.replace(&font(), "")
        .replace(" opacity=\"1\"", "")
        .replace(" stroke-width=\"1\"", "")
        .replace(" dx=\"0\" dy=\"0\"", "")
}

/// Returns the attributes of the usual letters as the library writes them: its font size is the
/// height of a line, 1.24 times that of the letters.
fn font() -> String {
    let size = LETTERS * f64::from(FINE) / 1.24;
    format!(" font-family=\"{FONT}\" font-size=\"{size}\"")
}

/// Escapes a text for XML, with control characters (which a terminal would obey) written out.
pub(super) fn escaped(text: &str) -> String {
    shown(text).replace('&', "&amp;").replace('<', "&lt;")
}

/// Returns the element whose text is shown when a pointer rests on its parent.
pub(super) fn title(text: &str) -> String {
    format!("<title>{}</title>", escaped(text))
}

/// Wraps an error of the plotting library.
pub(super) fn failed(cause: impl std::error::Error + Send + Sync + 'static) -> Error {
    Error::internal("a figure of the report cannot be drawn").because(cause)
}

/// Returns the style of letters of the usual size.
pub(super) fn letters(color: RGBColor) -> TextStyle<'static> {
    (FONT, LETTERS * f64::from(FINE)).into_font().color(&color)
}

/// Returns the style of a line `width` pixels wide.
pub(super) fn stroke(color: RGBColor, width: f64) -> ShapeStyle {
    color.stroke_width((width * f64::from(FINE)).round() as u32)
}

/// Converts pixels to units of the drawing.
pub(super) fn units(pixels: f64) -> i32 {
    (pixels * f64::from(FINE)).round() as i32
}

/// Writes `text` with its `anchor` at a place in pixels.
///
/// # Errors
/// `Internal` if the plotting library fails.
pub(super) fn write(
    area: &Area,
    text: &str,
    at: [f64; 2],
    anchor: (HPos, VPos),
    color: RGBColor,
) -> Result<()> {
    let style = letters(color).pos(Pos::new(anchor.0, anchor.1));
    area.draw_text(text, &style, (units(at[0]), units(at[1])))
        .map_err(failed)
}

/// The area between the axes of a chart.
pub(super) type Axes<'a> =
    ChartContext<'a, SVGBackend<'a>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// Draws a chart's axes, ticks and grid.
///
/// # Errors
/// `Internal` if the plotting library fails.
pub(super) fn axes<'a>(chart: &mut Axes<'a>, labels: [&str; 2], grid: bool) -> Result<()> {
    // The round-off that is left of a zero is small compared with the other ticks.
    let extent = |range: std::ops::Range<f64>| 1e-9 * (range.end - range.start).abs();
    let small = [extent(chart.x_range()), extent(chart.y_range())];
    let text = |value: f64, small: f64| tick(if value.abs() < small { 0.0 } else { value });
    let formatters = small.map(|small| move |value: &f64| text(*value, small));
    let mut mesh = chart.configure_mesh();
    if !grid {
        mesh.disable_mesh();
    }
    mesh.x_desc(labels[0])
        .y_desc(labels[1])
        .x_labels(6)
        .y_labels(6)
        .x_label_formatter(&formatters[0])
        .y_label_formatter(&formatters[1])
        .axis_desc_style(letters(INK))
        .label_style(letters(INK))
        .axis_style(stroke(INK, 1.0))
        .light_line_style(TRANSPARENT)
        .bold_line_style(ShapeStyle {
            color: FAINT.mix(0.3),
            filled: false,
            stroke_width: FINE,
        })
        .set_all_tick_mark_size(units(4.0))
        .draw()
        .map_err(failed)
}

/// Formats a number at a tick as briefly as possible.
pub(super) fn tick(value: f64) -> String {
    let text = trimmed(value, 5);
    match text.strip_prefix('-') {
        Some(size) => format!("\u{2212}{size}"),
        None => text,
    }
}

/// Returns a step of 1, 2, 2.5 or 5 times a power of ten: the finest that covers `extent` with at
/// most `most` steps.
pub(super) fn nice_step(extent: f64, most: usize) -> f64 {
    let rough = (extent / most as f64).max(f64::MIN_POSITIVE);
    let power = 10f64.powf(rough.log10().floor());
    [1.0, 2.0, 2.5, 5.0, 10.0]
        .into_iter()
        .map(|m| m * power)
        .find(|step| *step >= rough * (1.0 - 1e-9))
        .unwrap_or(10.0 * power)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_short() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (0.5, "0.5"),
            (-1250.0, "−1250"),
            (100.0, "100"),
            (2.5e-6, "2.5e\u{2212}6"),
            (1e8, "1e8"),
        ] {
            let expected = text.replace("e\u{2212}", "e-");
            assert_eq!(tick(value), expected, "{value}");
        }
    }

    #[test]
    fn steps_are_nice_and_suffice() {
        for extent in [1e-9, 0.37, 1.0, 7.3, 1250.0] {
            let step = nice_step(extent, 10);
            assert!(step * 10.0 >= extent * (1.0 - 1e-9) && step * 4.0 <= extent * 1.0001);
        }
    }

    #[test]
    fn a_drawing_is_well_formed_in_both_forms() {
        let mut drawing = Drawing::new([200, 100], |area| {
            write(
                area,
                "p < q & \"r\"",
                [10.0, 10.0],
                (HPos::Left, VPos::Top),
                INK,
            )
        })
        .unwrap();
        drawing.underlay(&format!(
            "<path fill=\"{}\" d=\"M0 0l1 0 0 1z\"/>",
            theme::hex(INK)
        ));
        for text in [drawing.file(), drawing.inline("a & \"b\" <c>", "svg-a")] {
            roxmltree::Document::parse(&text).unwrap();
            // The font size is stated once, for the whole drawing.
            assert_eq!(text.matches("font-size").count(), 1, "{text}");
        }
        assert!(drawing.inline("", "svg-a").contains("var(--ink)"));
        assert!(!drawing.file().contains("var("));
    }
}
