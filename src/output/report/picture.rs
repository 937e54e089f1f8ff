//! Pictures of the mesh: elements painted in their place under axes of one scale.

use super::bands::Bands;
use super::drawing::{Drawing, FINE, Place, axes, failed};
use super::raster::{Palette, Raster, Spot};
use super::window::Window;
use crate::error::Result;
use crate::mesh::Mesh;
use crate::model::Pair;
use plotters::prelude::*;

/// Room for axes and colours, in pixels.
const LEFT: u32 = 66;
const RIGHT: u32 = 82;
const TOP: u32 = 12;
const BOTTOM: u32 = 46;
/// Pixels of the image per pixel shown: sharp on paper and on fine screens.
const SHARP: f64 = 2.5;
/// Pixels across an element (the root of its area) from which on its sides are drawn.
const SMALLEST_SIDE: f64 = 3.0;

/// A picture in the making.
pub(super) struct Picture<'a> {
    mesh: &'a Mesh,
    /// The displacements, where the deformed mesh is shown.
    displacement: Option<&'a [f64]>,
    window: Window,
    mirror: [bool; 2],
    /// Pixels across without axes and colours.
    across: u32,
    /// Room for colours.
    right: u32,
    /// The pixels.
    pub raster: Raster,
    /// Their colours.
    pub palette: Palette,
}

impl<'a> Picture<'a> {
    /// An empty picture of what lies in a window, with its mirror images. Three fit beside each
    /// other on a screen.
    pub(super) fn new(
        mesh: &'a Mesh,
        displacement: Option<&'a [f64]>,
        window: Window,
        mirror: [bool; 2],
    ) -> Self {
        Self::wide(mesh, displacement, window, mirror, 292, RIGHT)
    }

    /// An empty picture, larger, without a scale of colours.
    pub(super) fn large(mesh: &'a Mesh, window: Window) -> Self {
        Self::wide(mesh, None, window, [false; 2], 430, 20)
    }

    fn wide(
        mesh: &'a Mesh,
        displacement: Option<&'a [f64]>,
        window: Window,
        mirror: [bool; 2],
        across: u32,
        right: u32,
    ) -> Self {
        let [w, h] = window.size();
        let down = (f64::from(across) * h / w).round();
        Picture {
            across,
            right,
            mesh,
            displacement,
            window,
            mirror,
            raster: Raster::new(
                (SHARP * f64::from(across)) as usize,
                (SHARP * down) as usize,
            ),
            palette: Palette::new(),
        }
    }

    /// Where a node is shown in the plane.
    pub(super) fn node(&self, node: usize) -> [f64; 2] {
        let [x, y] = self.mesh.in_plane(node);
        match self.displacement {
            Some(u) => [x + u[2 * node], y + u[2 * node + 1]],
            None => [x, y],
        }
    }

    /// Elements that reach into the window or whose mirror image does.
    pub(super) fn visible(&self) -> Vec<usize> {
        let mut corners = [[0.0; 2]; 4];
        (0..self.mesh.n_elements())
            .filter(|&element| {
                let n = self.mesh.shapes[element].n_corners();
                for (corner, &node) in corners.iter_mut().zip(self.mesh.nodes(element)).take(n) {
                    *corner = self.node(node as usize);
                }
                self.signs().any(|sign| {
                    let image = corners.map(|p| [sign[0] * p[0], sign[1] * p[1]]);
                    self.window.sees(&image[..n])
                })
            })
            .collect()
    }

    /// The model and its mirror images, as factors on the coordinates.
    fn signs(&self) -> impl Iterator<Item = [f64; 2]> + use<> {
        let mirror = self.mirror;
        [[1.0, 1.0], [-1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]]
            .into_iter()
            .filter(move |s| (s[0] > 0.0 || mirror[0]) && (s[1] > 0.0 || mirror[1]))
    }

    /// A point of the plane in the image.
    fn spot(&self, point: [f64; 2]) -> Spot {
        let [w, h] = self.window.size();
        [
            (point[0] - self.window.low[0]) / w * self.raster.width as f64,
            (self.window.high[1] - point[1]) / h * self.raster.height as f64,
        ]
    }

    /// A point of the plane in the drawing, in pixels as shown.
    pub(super) fn place_of(&self, point: [f64; 2]) -> [f64; 2] {
        let at = self.spot(point);
        [
            f64::from(LEFT) + at[0] / SHARP,
            f64::from(TOP) + at[1] / SHARP,
        ]
    }

    /// Paints an element and its mirror images: `values` at its nodes round its border (corners and
    /// mid-side nodes in turn) and in its middle become colours.
    pub(super) fn element(
        &mut self,
        element: usize,
        part: u16,
        at_node: impl Fn(usize) -> f64,
        middle: f64,
        color: impl Fn(f64) -> u8,
    ) {
        let (ring, n) = ring(self.mesh, element);
        let points = ring.map(|node| self.node(node));
        let mut center = [0.0; 2];
        for p in &points[..n] {
            center = [center[0] + p[0] / n as f64, center[1] + p[1] / n as f64];
        }
        for sign in self.signs() {
            let image = |p: [f64; 2]| self.spot([sign[0] * p[0], sign[1] * p[1]]);
            let (spots, c) = (points.map(image), image(center));
            for i in 0..n {
                let j = (i + 1) % n;
                let (a, b) = (at_node(ring[i]), at_node(ring[j]));
                let corners = [spots[i], spots[j], c];
                self.raster.triangle(corners, part, |w| {
                    color(w[0] * a + w[1] * b + w[2] * middle)
                });
            }
        }
    }

    /// Draws the surfaces from one pair of a contact to the next as far as they are less than a
    /// pixel apart: whether the middle of a pixel lies in a crack thinner than that is chance, and
    /// it would show in dashes.
    pub(super) fn crack(&mut self, pairs: [&Pair; 2], color: u8) {
        let pixel = self.window.size()[0] / self.raster.width as f64;
        let apart = pairs.map(|pair| {
            let (a, b) = (self.node(pair.first), self.node(pair.second));
            let along = (a[0] - b[0]) * pair.normal[0] + (a[1] - b[1]) * pair.normal[1];
            along.abs() / pixel
        });
        // Shares of the way between which it is thin.
        let border = (1.0 - apart[0]) / (apart[1] - apart[0]);
        let [from, to] = match apart.map(|gap| gap < 1.0) {
            [true, true] => [0.0, 1.0],
            [true, false] => [0.0, border],
            [false, true] => [border, 1.0],
            [false, false] => return,
        };
        for ends in [pairs.map(|p| p.first), pairs.map(|p| p.second)] {
            let [a, b] = ends.map(|node| self.node(node));
            for sign in self.signs() {
                let at = |share: f64| {
                    self.spot([0, 1].map(|d| sign[d] * (a[d] + share * (b[d] - a[d]))))
                };
                self.raster.line(at(from), at(to), color);
            }
        }
    }

    /// Draws the sides of elements. Of those that are smaller than a few pixels only a grey would
    /// be seen: they are left out. Returns the share of the elements' area whose sides are drawn.
    pub(super) fn sides(&mut self, elements: &[usize], color: u8) -> f64 {
        let (mut drawn, mut all) = (0.0, 0.0);
        for &element in elements {
            let (ring, n) = ring(self.mesh, element);
            let points = ring.map(|node| self.spot(self.node(node)));
            let size = [0, 1].map(|k| {
                let values = points[..n].iter().map(|p| p[k]);
                let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
                    (l.min(v), h.max(v))
                });
                high - low
            });
            let area = self.area_inside(element);
            all += area;
            if size[0] * size[1] < (SMALLEST_SIDE * SHARP).powi(2) {
                continue;
            }
            drawn += area;
            for i in 0..n {
                let (p, q) = (self.node(ring[i]), self.node(ring[(i + 1) % n]));
                for sign in self.signs() {
                    let image = |p: [f64; 2]| self.spot([sign[0] * p[0], sign[1] * p[1]]);
                    self.raster.line(image(p), image(q), color);
                }
            }
        }
        if all > 0.0 { drawn / all } else { 0.0 }
    }

    /// Area of an element's bounding box inside the window.
    fn area_inside(&self, element: usize) -> f64 {
        let mut low = [f64::INFINITY; 2];
        let mut high = [f64::NEG_INFINITY; 2];
        for &node in self.mesh.nodes(element) {
            let p = self.node(node as usize);
            for k in 0..2 {
                low[k] = low[k].min(p[k].max(self.window.low[k]));
                high[k] = high[k].max(p[k].min(self.window.high[k]));
            }
        }
        (high[0] - low[0]).max(0.0) * (high[1] - low[1]).max(0.0)
    }

    /// The drawing: the image under axes, a scale of colours where there is one, and what `over`
    /// draws on top.
    ///
    /// # Errors
    /// `Internal` where the plotting library or the image encoder fails.
    pub(super) fn finish(
        &self,
        labels: [&str; 2],
        bands: Option<&Bands>,
        over: impl FnOnce(&super::drawing::Area) -> Result<()>,
    ) -> Result<Drawing> {
        let width = f64::from(self.across);
        let height = self.raster.height as f64 / SHARP;
        let total = TOP + BOTTOM + height.ceil() as u32;
        let mut drawing = Drawing::new([LEFT + self.across + self.right, total], |area| {
            let bare = area.margin(
                TOP * FINE,
                (f64::from(total - TOP) - height) as u32 * FINE - BOTTOM * FINE,
                0,
                self.right * FINE,
            );
            let mut chart = ChartBuilder::on(&bare)
                .x_label_area_size(BOTTOM * FINE)
                .y_label_area_size(LEFT * FINE)
                .build_cartesian_2d(
                    self.window.low[0]..self.window.high[0],
                    self.window.low[1]..self.window.high[1],
                )
                .map_err(failed)?;
            axes(&mut chart, labels, false)?;
            if let Some(bands) = bands {
                bands.draw(area, [f64::from(LEFT) + width, f64::from(TOP)], height)?;
            }
            over(area)
        })?;
        let place = Place {
            x: f64::from(LEFT),
            y: f64::from(TOP),
            width,
            height,
        };
        drawing.underlay(place, &self.raster.data_url(&self.palette)?);
        Ok(drawing)
    }
}

/// The nodes round an element, corners and mid-side nodes in turn, and how many they are.
fn ring(mesh: &Mesh, element: usize) -> ([usize; 8], usize) {
    let nodes = mesh.nodes(element);
    let corners = mesh.shapes[element].n_corners();
    let mut out = [0; 8];
    if !mesh.shapes[element].is_quadratic() {
        for (o, &node) in out.iter_mut().zip(nodes) {
            *o = node as usize;
        }
        return (out, corners);
    }
    for i in 0..corners {
        out[2 * i] = nodes[i] as usize;
        out[2 * i + 1] = nodes[corners + i] as usize;
    }
    (out, 2 * corners)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Model;
    use crate::scene::Scene;

    /// The gap beside a contact opens slowly: as long as it is thinner than a pixel, pixels in it
    /// would be empty here and there.
    #[test]
    fn a_gap_is_shown_from_one_place_on_and_not_in_dashes() {
        let text = include_str!("../../../data/scenes/cylinder_on_half_plane.toml");
        let model = Model::new(&Scene::parse(text, "scene.toml").unwrap()).unwrap();
        let window = Window {
            low: [0.0, -0.2],
            high: [0.3, 0.2],
        };
        // Both surfaces fall across the rows of pixels, as they do round a dent.
        let tilted: Vec<f64> = (0..model.mesh.n_nodes())
            .flat_map(|node| [0.0, -0.15 * model.mesh.in_plane(node)[0]])
            .collect();
        let mut picture = Picture::new(&model.mesh, Some(&tilted), window, [false; 2]);
        for element in picture.visible() {
            let part = 1 + model.mesh.element_body[element] as u16;
            picture.element(element, part, |_| 0.0, 0.0, |_| 1);
        }
        picture.raster.outline(1, 2);
        let [width, height] = [picture.raster.width, picture.raster.height];
        // Where the gap shows, from left to right.
        let open = |picture: &Picture| -> Vec<bool> {
            let shows = |x: usize| (0..height).any(|y| picture.raster.color_at(x, y) == 0);
            (0..width).map(shows).collect()
        };
        let changes = |open: &[bool]| open.windows(2).filter(|p| p[0] != p[1]).count();
        let dashes = changes(&open(&picture));
        assert!(dashes > 1, "{dashes}");
        for pairs in model.pairs.windows(2) {
            picture.crack([&pairs[0], &pairs[1]], 2);
        }
        let after = open(&picture);
        assert_eq!(
            (changes(&after), after[0], after[width - 1]),
            (1, false, true)
        );
    }
}
