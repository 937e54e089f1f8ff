//! The viewpoint from which solids are drawn.

use super::contact_frame::global;
use super::window::{extent, mirrors};
use crate::model::Model;
use crate::space::{Vector, along, cross, difference, direction, dot};

/// Distance of the eye, in half diagonals of the part that is shown.
pub(super) const DISTANCE: f64 = 5.0;
/// Direction of the eye: degrees round from the first axis, and degrees up.
const ROUND: f64 = 36.0;
const UP: f64 = 24.0;
/// Overlap in height up to which a body counts as lying on another one, as a fraction of the
/// smaller height of the two.
const OVERLAP: f64 = 0.1;

/// A viewpoint with the axes of the picture.
pub(super) struct Camera {
    /// Position of the eye.
    pub eye: Vector,
    /// Axes of the picture: to the right, up, and towards the eye.
    pub axes: [Vector; 3],
}

impl Camera {
    /// Makes a camera that looks at `center` from `distance`, with `up` upwards, from a direction
    /// between the two axes `across`.
    pub(super) fn new(center: Vector, distance: f64, up: Vector, across: [Vector; 2]) -> Self {
        let [round, high] = [ROUND, UP].map(f64::to_radians);
        let level = along(across[0].map(|x| x * round.cos()), round.sin(), across[1]);
        let toward = direction(along(level.map(|x| x * high.cos()), high.sin(), up));
        let right = direction(cross(up, toward));
        Camera {
            eye: along(center, distance, toward),
            axes: [right, cross(toward, right), toward],
        }
    }

    /// Projects a point. Returns its offsets to the right and up, divided by its distance along the
    /// line of sight, and that distance.
    pub(super) fn project(&self, x: Vector) -> ([f64; 2], f64) {
        let way = difference(x, self.eye);
        let depth = -dot(way, self.axes[2]);
        ([0, 1].map(|d| dot(way, self.axes[d]) / depth), depth)
    }
}

/// The upward direction and the axes across it, which point towards the eye.
pub(super) struct Stand {
    /// Upward direction, a unit vector.
    pub up: Vector,
    /// Directions across the upward direction.
    pub across: [Vector; 2],
}

impl Stand {
    /// Takes a normal of the contact as upward direction; planes of symmetry face the eye.
    pub(super) fn new(model: &Model, up: Vector, across: [Vector; 2]) -> Self {
        let mirror = mirrors(model);
        let [low, high] = extent(model);
        let toward = |axis: Vector| {
            let half = global(axis).filter(|&d| mirror[d]);
            let is_above = half.is_some_and(|d| low[d] + high[d] > 0.0);
            let sign = if is_above { -1.0 } else { 1.0 };
            axis.map(|x| x * sign)
        };
        Stand {
            up,
            across: across.map(toward),
        }
    }
}

/// Ranks the bodies from the lowest to the highest along a direction. Bodies that overlap in height
/// by more than [`OVERLAP`] get the same rank.
pub(super) fn ranks(model: &Model, up: Vector) -> Vec<usize> {
    let mesh = &model.mesh;
    let mut heights = vec![[f64::INFINITY, f64::NEG_INFINITY]; mesh.bodies.len()];
    for element in 0..mesh.n_elements() {
        let [low, high] = &mut heights[mesh.element_body[element] as usize];
        for &node in mesh.nodes(element) {
            let height = dot(up, mesh.point(node as usize));
            (*low, *high) = (low.min(height), high.max(height));
        }
    }
    let mut order: Vec<usize> = (0..heights.len()).collect();
    let middle = |body: usize| heights[body][0] + heights[body][1];
    order.sort_by(|&a, &b| middle(a).total_cmp(&middle(b)));
    let mut ranks = vec![0; heights.len()];
    let (mut rank, mut top, mut least) = (0, f64::NEG_INFINITY, f64::INFINITY);
    for body in order {
        let [low, high] = heights[body];
        least = least.min(high - low);
        if top - low <= OVERLAP * least {
            (rank, least) = (rank + 1, high - low);
        }
        ranks[body] = rank;
        top = top.max(high);
    }
    ranks
}
