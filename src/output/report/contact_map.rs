//! The pressure over a contact of solids, in plan view.

use super::bands::Bands;
use super::drawing::{Drawing, FINE, Place, axes, failed, stroke};
use super::raster::{Palette, Raster};
use super::theme::{INK, Scale};
use super::units::{Units, labelled};
use crate::error::Result;
use crate::model::Model;
use crate::results::{ContactPatch, State};
use crate::space::{Vector, along, cross, direction, dot, unit};
use plotters::prelude::*;

/// Margins for axes and the scale of colours, in pixels.
const LEFT: u32 = 66;
const RIGHT: u32 = 82;
const TOP: u32 = 12;
const BOTTOM: u32 = 46;
/// Pixels across, and down at least and at most.
const ACROSS: f64 = 420.0;
const DOWN: [f64; 2] = [120.0, 460.0];
/// Pixels of the image per pixel as shown.
const SHARP: f64 = 2.0;
/// How far the map reaches, in half axes of the largest patch of all states.
const REACH: f64 = 1.3;
/// Pieces of the line round a patch.
const PIECES: usize = 180;

/// Draws the pressures of states in the plane across the normal of the contact that carries most.
pub(super) struct ContactMap<'m> {
    model: &'m Model,
    contact: usize,
    normal: Vector,
    axes: [Vector; 2],
    labels: [String; 2],
    /// Lowest and highest coordinates shown.
    window: [[f64; 2]; 2],
    largest: f64,
    unit: String,
}

impl<'m> ContactMap<'m> {
    /// The map of a run; `None` where no patch carries force.
    pub(super) fn new(model: &'m Model, states: &[State], units: &Units) -> Option<Self> {
        let patches = states.iter().flat_map(|state| &state.patches);
        let strongest = patches.max_by(|a, b| a.force.total_cmp(&b.force))?;
        let contact = strongest.contact;
        let pairs = &model.pairs[model.contacts.get(contact)?.range.clone()];
        let sum = |sum, pair: &crate::model::Pair| along(sum, pair.area, pair.normal);
        let normal = direction(pairs.iter().fold([0.0; 3], sum));
        // The first axis is the global one that is most nearly in the plane.
        let off = |d: &usize| normal[*d].abs();
        let first = (0..3).min_by(|a, b| off(a).total_cmp(&off(b)))?;
        let across = direction(along(unit(first), -normal[first], normal));
        let axes = [across, cross(normal, across)];
        let name = |axis: Vector| {
            let global = (0..3).find(|&d| dot(axis, unit(d)).abs() > 1.0 - 1e-9);
            labelled(
                global.map_or("along the contact", |d| ["x", "y", "z"][d]),
                units.length(),
            )
        };
        let labels = axes.map(name);
        let mut map = ContactMap {
            model,
            contact,
            normal,
            axes,
            labels,
            window: [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]],
            largest: 0.0,
            unit: units.stress().to_string(),
        };
        for state in states {
            map.largest = map.largest.max(state.max_pressure);
            for patch in state.patches.iter().filter(|p| p.contact == contact) {
                let center = map.place(patch.centroid);
                for at in map.outline(patch) {
                    for d in 0..2 {
                        let off = REACH * (at[d] - center[d]);
                        map.window[0][d] = map.window[0][d].min(center[d] + off);
                        map.window[1][d] = map.window[1][d].max(center[d] + off);
                    }
                }
            }
        }
        // No further than there are pairs.
        let places: Vec<[f64; 2]> = (pairs.iter())
            .map(|pair| map.place(model.mesh.point(pair.second)))
            .collect();
        for d in 0..2 {
            let low = places.iter().map(|at| at[d]).fold(f64::INFINITY, f64::min);
            let high = places
                .iter()
                .map(|at| at[d])
                .fold(f64::NEG_INFINITY, f64::max);
            map.window[0][d] = map.window[0][d].max(low);
            map.window[1][d] = map.window[1][d].min(high);
        }
        let shows = |d: usize| map.window[1][d] > map.window[0][d];
        (shows(0) && shows(1) && map.largest > 0.0).then_some(map)
    }

    fn place(&self, x: Vector) -> [f64; 2] {
        self.axes.map(|axis| dot(axis, x))
    }

    /// The ellipse of a patch's half axes.
    fn outline(&self, patch: &ContactPatch) -> Vec<[f64; 2]> {
        let other = cross(self.normal, patch.direction);
        let at = |k: usize| {
            let angle = 2.0 * std::f64::consts::PI * k as f64 / PIECES as f64;
            let x = along(
                patch.centroid,
                patch.semi_axes[0] * angle.cos(),
                patch.direction,
            );
            self.place(along(x, patch.semi_axes[1] * angle.sin(), other))
        };
        (0..=PIECES).map(at).collect()
    }

    /// The pressures of a state.
    ///
    /// # Errors
    /// `Internal` where the plotting library or the image encoder fails.
    pub(super) fn draw(&self, state: &State) -> Result<Drawing> {
        let [low, high] = self.window;
        let ratio = (high[1] - low[1]) / (high[0] - low[0]);
        // One scale for both axes.
        let width = ACROSS.min(DOWN[1] / ratio).max(DOWN[0]);
        let height = (width * ratio).clamp(DOWN[0], DOWN[1]);
        let mut palette = Palette::new();
        let bands = Bands::new([0.0, self.largest], Scale::Rising, &self.unit, &mut palette);
        let mut raster = Raster::new((SHARP * width) as usize, (SHARP * height) as usize);
        let spot = |x: [f64; 2]| {
            let across = (x[0] - low[0]) / (high[0] - low[0]);
            let down = (high[1] - x[1]) / (high[1] - low[1]);
            [SHARP * width * across, SHARP * height * down]
        };
        let first = self.model.contacts[self.contact].range.start;
        let mut pressure = vec![0.0; self.model.pairs.len()];
        for pair in &state.pairs {
            if let Some(value) = pressure.get_mut(pair.pair) {
                *value = pair.pressure;
            }
        }
        for face in &self.model.contacts[self.contact].faces {
            for k in 2..face.len() {
                let corners = [face[0], face[k - 1], face[k]];
                let values = corners.map(|pair| pressure[pair]);
                if corners.iter().any(|pair| *pair < first) || values == [0.0; 3] {
                    continue;
                }
                let spots = corners.map(|pair| {
                    let node = self.model.pairs[pair].second;
                    spot(self.place(self.model.mesh.point(node)))
                });
                raster.triangle(spots, 0, |w| {
                    bands.index(w.iter().zip(values).map(|(w, p)| w * p).sum())
                });
            }
        }
        let size = [
            LEFT + width.ceil() as u32 + RIGHT,
            TOP + height.ceil() as u32 + BOTTOM,
        ];
        let mut drawing = Drawing::new(size, |area| {
            let bare = area.margin(TOP * FINE, 0, 0, RIGHT * FINE);
            let mut chart = ChartBuilder::on(&bare)
                .x_label_area_size(BOTTOM * FINE)
                .y_label_area_size(LEFT * FINE)
                .build_cartesian_2d(low[0]..high[0], low[1]..high[1])
                .map_err(failed)?;
            axes(&mut chart, [&self.labels[0], &self.labels[1]], false)?;
            for patch in state.patches.iter().filter(|p| p.contact == self.contact) {
                let inside = |at: &[f64; 2]| (0..2).all(|d| low[d] <= at[d] && at[d] <= high[d]);
                let outline = self.outline(patch);
                for piece in outline.windows(2).filter(|ends| ends.iter().all(inside)) {
                    let ends = [(piece[0][0], piece[0][1]), (piece[1][0], piece[1][1])];
                    chart
                        .draw_series(LineSeries::new(ends, stroke(INK, 1.25)))
                        .map_err(failed)?;
                }
            }
            bands.draw(area, [f64::from(LEFT) + width, f64::from(TOP)], height)
        })?;
        let place = Place {
            x: f64::from(LEFT),
            y: f64::from(TOP),
            width,
            height,
        };
        drawing.underlay(place, &raster.data_url(&palette)?);
        Ok(drawing)
    }
}
