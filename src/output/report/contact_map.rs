//! The pressure over a contact of solids, in plan view.

use super::bands::Bands;
use super::contact_frame::{ContactFrame, global};
use super::contours::TriangleSheet;
use super::drawing::{Drawing, tick};
use super::patchwork::Patchwork;
use super::path;
use super::picture::Picture;
use super::theme::{INK, PAPER, Scale};
use super::window::{Window, negligible};
use crate::error::Result;
use crate::model::Model;
use crate::number::significant;
use crate::output::Labels;
use crate::results::{ContactPatch, State};
use crate::space::{Vector, along, cross, dot};

/// Half width and half height of the map, in half axes of the largest patch of all states.
const REACH: f64 = 1.3;
/// Number of straight segments in a patch's outline.
const PIECES: usize = 180;
/// Half length of a patch without end, in half widths.
const ENDLESS: f64 = 1e4;

/// Draws the pressures of states in the plane across the normal of the contact that carries the
/// largest force.
pub(super) struct ContactMap<'m> {
    model: &'m Model,
    frame: &'m ContactFrame,
    labels: [String; 2],
    patchwork: Patchwork,
    window: Window,
    bands: Bands,
    /// The pair of each node of the second surface.
    pairs: Vec<Option<usize>>,
}

impl<'m> ContactMap<'m> {
    /// Returns the map of a run, mirrored in the axes along which the model is a half; `None` if
    /// there is nothing to show.
    pub(super) fn new(
        model: &'m Model,
        frame: &'m ContactFrame,
        mirror: [bool; 3],
        states: &[State],
        labels: &Labels,
    ) -> Option<Self> {
        let contact = &model.contacts[frame.contact];
        let mirror = frame
            .axes
            .map(|axis| global(axis).is_some_and(|d| mirror[d]));
        let mut pairs = vec![None; model.mesh.n_nodes()];
        for pair in contact.range.clone() {
            pairs[model.pairs[pair].slave] = Some(pair);
        }
        let node = |&pair: &usize| model.pairs[pair].slave;
        let faces: Vec<Vec<usize>> = (contact.faces.iter())
            .map(|face| face.iter().map(node).collect())
            .collect();
        let faces = faces.iter().map(Vec::as_slice);
        let patchwork = Patchwork::of_polygons(frame.axes, faces).mirrored(
            &model.mesh,
            mirror,
            negligible(model),
        );
        // The window does not extend beyond the pairs.
        let all = Window::round(patchwork.places(&model.mesh, None).into_iter())?;
        let center = frame.axes.map(|axis| dot(axis, frame.center));
        let mut window = all;
        for d in 0..2 {
            let reach = REACH * frame.reach[d];
            window.low[d] = window.low[d].max(center[d] - reach);
            window.high[d] = window.high[d].min(center[d] + reach);
        }
        let largest = states.iter().map(|s| s.max_pressure).fold(0.0, f64::max);
        let [w, h] = window.size();
        (w > 0.0 && h > 0.0 && largest > 0.0).then(|| ContactMap {
            model,
            frame,
            labels: frame.axes.map(|axis| ContactFrame::label(axis, labels)),
            patchwork,
            window: window.framed(0.0),
            bands: Bands::new([0.0, largest], Scale::Rising, labels.stress()),
            pairs,
        })
    }

    /// Returns the ellipse of a patch's half axes.
    fn outline(&self, patch: &ContactPatch) -> Vec<[f64; 2]> {
        let other = cross(self.frame.normal, patch.direction);
        let place = |x: Vector| self.frame.axes.map(|axis| dot(axis, x));
        let at = |k: usize| {
            let (s, c) = (2.0 * std::f64::consts::PI * k as f64 / PIECES as f64).sin_cos();
            // A strip without end shows its sides; its ends lie outside the picture.
            let long = patch.semi_axes[0].min(ENDLESS * patch.semi_axes[1]);
            let x = along(patch.centroid, long * c, patch.direction);
            place(along(x, patch.semi_axes[1] * s, other))
        };
        (0..PIECES).map(at).collect()
    }

    /// Returns the pressures of a state by pair. An open pair next to closed ones gets the negative
    /// of the largest pressure among the pairs with which it shares a face: then the interpolated
    /// pressure between a closed and an open pair vanishes in the middle or before.
    fn pressures(&self, state: &State) -> Vec<f64> {
        let mut pressure = vec![0.0; self.model.pairs.len()];
        for pair in &state.pairs {
            if let Some(of_pair) = pressure.get_mut(pair.pair) {
                *of_pair = pair.pressure;
            }
        }
        let mut out = pressure.clone();
        for face in &self.model.contacts[self.frame.contact].faces {
            let top = face.iter().map(|&k| pressure[k]).fold(0.0, f64::max);
            for &pair in face.iter().filter(|&&k| pressure[k] <= 0.0) {
                out[pair] = out[pair].min(-top);
            }
        }
        out
    }

    fn at_nodes(&self, value: impl Fn(usize) -> f64) -> Vec<f64> {
        self.patchwork
            .of_nodes(|node| self.pairs[node].map_or(0.0, &value))
    }

    /// Draws the pressures of a state.
    ///
    /// # Errors
    /// `Internal` if the plotting library fails.
    pub(super) fn draw(&self, state: &State) -> Result<Drawing> {
        let places = self.patchwork.places(&self.model.mesh, None);
        let pressures = self.pressures(state);
        let sheet = self
            .patchwork
            .sheet(places, self.at_nodes(|pair| pressures[pair]));
        // The outline lies half way between closed and open pairs, like the areas of the pairs.
        let touches = self.at_nodes(|pair| f64::from(u8::from(pressures[pair] > 0.0)));
        let touches = TriangleSheet {
            places: sheet.places.clone(),
            values: touches,
            ..sheet
        };
        let mut picture = Picture::new(self.window);
        for (band, (level, color)) in self.bands.levels().enumerate() {
            match band {
                0 => picture.fill(&touches.above(0.5), color, 1.0),
                _ => picture.fill(&sheet.above(level), color, 1.0),
            }
        }
        picture.outline(sheet.above(f64::NEG_INFINITY), INK, 0.6);
        let patches = state
            .patches
            .iter()
            .filter(|p| p.contact == self.frame.contact);
        let ellipses: Vec<_> = patches.map(|p| path::closed(self.outline(p))).collect();
        picture.stroke(&ellipses, PAPER, 3.0);
        picture.stroke(&ellipses, INK, 1.25);
        if let Some(top) = sheet.largest(|_| true).filter(|&k| sheet.values[k] > 0.0) {
            let value = significant(sheet.values[top], 3)
                .parse()
                .unwrap_or(sheet.values[top]);
            picture.mark(sheet.places[top], &tick(value));
        }
        let labels = [self.labels[0].as_str(), self.labels[1].as_str()];
        picture.finish(labels, Some(&self.bands), |_| Ok(()))
    }
}
