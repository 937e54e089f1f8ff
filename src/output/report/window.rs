//! The part of the plane that a picture shows.

use crate::model::Model;
use crate::results::{Results, Status};
use crate::space::Vector;

/// A rectangle of the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Window {
    /// Smallest x and y.
    pub low: [f64; 2],
    /// Largest x and y.
    pub high: [f64; 2],
}

/// Half width and half height of a picture of the contact, in half widths of the pairs that are or
/// were closed.
const REACH: [f64; 2] = [2.4, 2.0];
/// Room round the content of a picture, as a fraction of its size.
const ROOM: f64 = 0.03;
/// Room round the drawing of the whole model: for arrows and supports.
const WIDE_ROOM: f64 = 0.1;
/// Smallest and largest height over width.
const SHAPE: [f64; 2] = [0.55, 1.1];

impl Window {
    /// Returns the smallest window round some points; `None` without points.
    pub(super) fn round(points: impl Iterator<Item = [f64; 2]>) -> Option<Self> {
        points.fold(None, |window: Option<Window>, p| {
            let mut window = window.unwrap_or(Window { low: p, high: p });
            for k in 0..2 {
                window.low[k] = window.low[k].min(p[k]);
                window.high[k] = window.high[k].max(p[k]);
            }
            Some(window)
        })
    }

    /// Returns width and height.
    pub(super) fn size(&self) -> [f64; 2] {
        [0, 1].map(|k| self.high[k] - self.low[k])
    }

    /// Whether the bounding box of some points may be visible.
    pub(super) fn sees(&self, points: &[[f64; 2]]) -> bool {
        (0..2).all(|k| {
            points.iter().any(|p| p[k] >= self.low[k])
                && points.iter().any(|p| p[k] <= self.high[k])
        })
    }

    /// Returns the window with its mirror images.
    pub(super) fn mirrored(mut self, mirror: [bool; 2]) -> Self {
        for k in 0..2 {
            if mirror[k] {
                let far = self.low[k].abs().max(self.high[k].abs());
                (self.low[k], self.high[k]) = (-far, far);
            }
        }
        self
    }

    /// Returns the window around this patch of contact, cut to the window `all` of the model and
    /// framed with some room. `facet` is the length of the contact's facets, from which a small
    /// patch gets a least size.
    pub(super) fn surroundings(self, all: Window, facet: f64) -> Window {
        let [w, h] = self.size();
        let size = (0.5 * w.max(h)).max(3.0 * facet);
        let mut window = self;
        for k in 0..2 {
            let middle = 0.5 * (self.low[k] + self.high[k]);
            window.low[k] = (middle - REACH[k] * size).max(all.low[k]);
            window.high[k] = (middle + REACH[k] * size).min(all.high[k]);
        }
        window.framed(ROOM)
    }

    /// Adds room on all sides and limits the ratio of height to width by letting the shorter side
    /// grow.
    pub(super) fn framed(mut self, room: f64) -> Self {
        let [w, h] = self.size();
        let least = w.max(h).max(f64::MIN_POSITIVE);
        let width = (w + 2.0 * room * least).max(h / SHAPE[1]);
        let height = (h + 2.0 * room * least).max(width * SHAPE[0]);
        let width = width.max(height / SHAPE[1]);
        for (k, size) in [width, height].into_iter().enumerate() {
            let middle = 0.5 * (self.low[k] + self.high[k]);
            (self.low[k], self.high[k]) = (middle - 0.5 * size, middle + 0.5 * size);
        }
        self
    }
}

/// Returns for each axis whether the model is a half of the whole, mirrored at coordinate 0.
///
/// A support that only holds x, all of whose nodes lie on x = 0 with the model on one side, is a
/// plane of symmetry; so is the axis of an axisymmetric model that reaches it.
pub(super) fn mirrors(model: &Model) -> [bool; 3] {
    let mesh = &model.mesh;
    let [low, high] = extent(model);
    let small = negligible(model);
    let one_sided = |k: usize| low[k].abs() <= small || high[k].abs() <= small;
    let is_held = |k: usize| {
        model.scene.support.iter().any(|support| {
            matches!(support.fix[..], [only] if only.axis() == k)
                && support.angle.is_none_or(|a| a == 0.0)
                && mesh.set_nodes(&support.on).is_some_and(|nodes| {
                    nodes.len() > 1 && nodes.iter().all(|&n| mesh.point(n)[k].abs() <= small)
                })
        })
    };
    let axis = |k: usize| k == 0 && model.kind.is_axisymmetric();
    let mirrors = |k: usize| k < mesh.dimension && one_sided(k) && (is_held(k) || axis(k));
    [0, 1, 2].map(mirrors)
}

/// Returns the smallest and largest coordinates of the mesh.
pub(super) fn extent(model: &Model) -> [Vector; 2] {
    let start = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    (0..model.mesh.n_nodes()).fold(start, |[low, high], node| {
        let x = model.mesh.point(node);
        [0, 1].map(|side| {
            [0, 1, 2].map(|d| match side {
                0 => low[d].min(x[d]),
                _ => high[d].max(x[d]),
            })
        })
    })
}

/// Returns a length that is negligible compared with the mesh.
pub(super) fn negligible(model: &Model) -> f64 {
    let [low, high] = extent(model);
    (0..3)
        .map(|d| 1e-9 * (high[d] - low[d]))
        .fold(0.0, f64::max)
}

/// Returns the window of the whole mesh.
pub(super) fn whole(model: &Model, mirror: [bool; 2]) -> Option<Window> {
    let mesh = &model.mesh;
    let all = Window::round((0..mesh.n_nodes()).map(|n| mesh.in_plane(n)))?;
    Some(all.mirrored(mirror).framed(WIDE_ROOM))
}

/// Returns the surroundings of the pairs that are closed in any state, or the whole mesh if there
/// is no contact.
pub(super) fn near_contact(model: &Model, results: &Results, mirror: [bool; 2]) -> Option<Window> {
    let mesh = &model.mesh;
    let all = Window::round((0..mesh.n_nodes()).map(|n| mesh.in_plane(n)))?.mirrored(mirror);
    let pairs = results.states.iter().flat_map(|state| &state.pairs);
    let closed = pairs
        .filter(|pair| pair.status == Status::Closed)
        .map(|pair| [pair.position[0], pair.position[1]]);
    let candidates = model.pairs.iter().map(|pair| mesh.in_plane(pair.slave));
    let Some(patch) = Window::round(closed).or_else(|| Window::round(candidates)) else {
        return Some(all.framed(ROOM));
    };
    let facet = model
        .contacts
        .iter()
        .fold(0.0f64, |m, c| m.max(c.facet_length));
    Some(patch.mirrored(mirror).surroundings(all, facet))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_has_room_and_is_neither_slit_nor_tower() {
        for high in [[10.0, 0.1], [0.1, 10.0], [1.0, 1.0]] {
            let window = Window {
                low: [0.0; 2],
                high,
            }
            .framed(ROOM);
            let [w, h] = window.size();
            assert!(w > high[0] && h > high[1], "{window:?}");
            let shape = h / w;
            let round_off = 1e-12;
            assert!(
                shape >= SHAPE[0] - round_off && shape <= SHAPE[1] + round_off,
                "{window:?}"
            );
        }
    }

    #[test]
    fn a_window_sees_what_crosses_it() {
        let window = Window {
            low: [0.0; 2],
            high: [1.0; 2],
        };
        assert!(window.sees(&[[-1.0, -1.0], [2.0, 2.0]]));
        assert!(!window.sees(&[[1.5, 0.0], [2.0, 1.0]]));
    }
}
