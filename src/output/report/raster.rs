//! Pixels: elements are painted into an image of a fixed size, so that a picture costs its pixels
//! and not its mesh.

use crate::error::{Error, Result};
use base64::Engine as _;
use plotters::style::RGBColor;

/// Nothing painted here.
pub(super) const EMPTY: u8 = 0;
/// Most colours of an image.
const MOST_COLORS: usize = 256;

/// A point of the image: right and down, in pixels.
pub(super) type Spot = [f64; 2];

/// An image of palette indices, with a second layer that says which body (or part) a pixel belongs
/// to.
pub(super) struct Raster {
    /// Pixels across.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
    color: Vec<u8>,
    part: Vec<u16>,
}

impl Raster {
    /// An empty image.
    pub(super) fn new(width: usize, height: usize) -> Self {
        Raster {
            width,
            height,
            color: vec![EMPTY; width * height],
            part: vec![0; width * height],
        }
    }

    /// Paints the pixels whose middle lies in a triangle. `color` gets the weights of the corners.
    pub(super) fn triangle(
        &mut self,
        corners: [Spot; 3],
        part: u16,
        color: impl Fn([f64; 3]) -> u8,
    ) {
        let [a, b, c] = corners;
        let double_area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if double_area == 0.0 || !double_area.is_finite() {
            return;
        }
        let range = |axis: usize, size: usize| {
            let low = a[axis].min(b[axis]).min(c[axis]) - 0.5;
            let high = a[axis].max(b[axis]).max(c[axis]) - 0.5;
            // A cast of a float to an integer saturates: triangles far outside give empty ranges.
            let from = low.ceil().max(0.0) as usize;
            let to = (high.floor() + 1.0).max(0.0) as usize;
            from..to.min(size)
        };
        // Round-off must not leave gaps between neighbours.
        let edge = -1e-9;
        for row in range(1, self.height) {
            let y = row as f64 + 0.5;
            for column in range(0, self.width) {
                let x = column as f64 + 0.5;
                let wb = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / double_area;
                let wc = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / double_area;
                let wa = 1.0 - wb - wc;
                if wa >= edge && wb >= edge && wc >= edge {
                    let at = row * self.width + column;
                    self.color[at] = color([wa, wb, wc]);
                    self.part[at] = part;
                }
            }
        }
    }

    /// The colour of a pixel.
    #[cfg(test)]
    pub(super) fn color_at(&self, column: usize, row: usize) -> u8 {
        self.color[row * self.width + column]
    }

    /// Draws a line one pixel wide.
    pub(super) fn line(&mut self, from: Spot, to: Spot, color: u8) {
        let length = (to[0] - from[0]).abs().max((to[1] - from[1]).abs());
        if !length.is_finite() || length > 4.0 * (self.width + self.height) as f64 {
            return;
        }
        let steps = length.ceil().max(1.0) as usize;
        for step in 0..=steps {
            let share = step as f64 / steps as f64;
            let x = from[0] + share * (to[0] - from[0]);
            let y = from[1] + share * (to[1] - from[1]);
            if x >= 0.0 && y >= 0.0 && (x as usize) < self.width && (y as usize) < self.height {
                self.color[y as usize * self.width + x as usize] = color;
            }
        }
    }

    /// Paints the pixels within `reach` of another part (or of nothing) in `color`: contours
    /// without edges of elements.
    pub(super) fn outline(&mut self, reach: usize, color: u8) {
        let mut border = Vec::new();
        for row in 0..self.height {
            for column in 0..self.width {
                let here = self.part[row * self.width + column];
                let differs = |r: usize, c: usize| {
                    r < self.height && c < self.width && self.part[r * self.width + c] != here
                };
                let near = (1..=reach).any(|d| {
                    differs(row + d, column)
                        || differs(row, column + d)
                        || row.checked_sub(d).is_some_and(|r| differs(r, column))
                        || column.checked_sub(d).is_some_and(|c| differs(row, c))
                });
                if here != 0 && near {
                    border.push(row * self.width + column);
                }
            }
        }
        for at in border {
            self.color[at] = color;
        }
    }

    /// The image as a `data:` address of a PNG; `palette[0]` is [`EMPTY`].
    ///
    /// # Errors
    /// None that can occur with a palette of at most 256 colours.
    pub(super) fn data_url(&self, palette: &Palette) -> Result<String> {
        let failed = |cause: png::EncodingError| {
            Error::internal("an image of the report cannot be encoded").because(cause)
        };
        let mut bytes = Vec::new();
        {
            let mut encoder = png::Encoder::new(&mut bytes, self.width as u32, self.height as u32);
            encoder.set_color(png::ColorType::Indexed);
            encoder.set_depth(png::BitDepth::Eight);
            encoder.set_palette(palette.colors.as_slice());
            encoder.set_trns(palette.opacity.as_slice());
            encoder.set_compression(png::Compression::Balanced);
            // Flat areas: rows as they are compress best.
            encoder.set_filter(png::Filter::NoFilter);
            let mut writer = encoder.write_header().map_err(failed)?;
            writer.write_image_data(&self.color).map_err(failed)?;
            writer.finish().map_err(failed)?;
        }
        let text = base64::engine::general_purpose::STANDARD.encode(&bytes);
        Ok(format!("data:image/png;base64,{text}"))
    }
}

/// Colours by index; index 0 is transparent.
pub(super) struct Palette {
    colors: Vec<u8>,
    opacity: Vec<u8>,
}

impl Palette {
    /// Nothing but the transparent colour.
    pub(super) fn new() -> Self {
        Palette {
            colors: vec![0; 3],
            opacity: vec![0],
        }
    }

    /// Adds a colour and returns its index; beyond 256 colours the last one.
    pub(super) fn add(&mut self, color: RGBColor, opacity: f64) -> u8 {
        if self.opacity.len() < MOST_COLORS {
            self.colors.extend([color.0, color.1, color.2]);
            self.opacity.push((255.0 * opacity).round() as u8);
        }
        (self.opacity.len() - 1) as u8
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_triangles_fill_their_square_without_gap_or_overlap_outside() {
        let mut raster = Raster::new(10, 8);
        let square = [[1.0, 1.0], [6.0, 1.0], [6.0, 5.0], [1.0, 5.0]];
        raster.triangle([square[0], square[1], square[2]], 1, |_| 1);
        raster.triangle([square[0], square[2], square[3]], 1, |_| 1);
        assert_eq!(raster.color.iter().filter(|c| **c == 1).count(), 5 * 4);
        raster.outline(1, 2);
        assert_eq!(raster.color.iter().filter(|c| **c == 1).count(), 3 * 2);
        // Far away, without area, not a number: nothing happens.
        for far in [1e300, -1e300, f64::NAN] {
            raster.triangle([[far, 0.0], [0.0, far], [far, far]], 1, |_| 7);
            raster.line([far, 0.0], [0.0, far], 7);
        }
        assert!(!raster.color.contains(&7));
    }

    #[test]
    fn weights_reproduce_a_linear_field() {
        let mut raster = Raster::new(16, 16);
        let corners: [Spot; 3] = [[0.0, 0.0], [16.0, 0.0], [0.0, 16.0]];
        let values = [0.0, 160.0, 32.0];
        raster.triangle(corners, 1, |w| {
            (w[0] * values[0] + w[1] * values[1] + w[2] * values[2]).round() as u8
        });
        for (row, column) in [(0, 0), (3, 7), (10, 2)] {
            let expected = 10.0 * (column as f64 + 0.5) + 2.0 * (row as f64 + 0.5);
            assert_eq!(raster.color[row * 16 + column], expected.round() as u8);
        }
    }

    #[test]
    fn the_image_is_a_png_that_decodes_to_its_pixels() {
        let mut raster = Raster::new(7, 3);
        raster.line([0.5, 1.5], [6.5, 1.5], 1);
        let mut palette = Palette::new();
        assert_eq!(palette.add(RGBColor(10, 20, 30), 0.5), 1);
        let url = raster.data_url(&palette).unwrap();
        let text = url.strip_prefix("data:image/png;base64,").unwrap();
        let bytes = base64::engine::general_purpose::STANDARD
            .decode(text)
            .unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
            .read_info()
            .unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        assert_eq!(pixels, raster.color);
        assert_eq!(reader.info().trns.as_deref(), Some([0, 128].as_slice()));
    }
}
