//! Discs: a nearly square core with bulged sides, inside a ring of layers that ends on the circle.
//!
//! In the first quadrant, with `n` elements over the quarter circle, the core has `n/2 x n/2`
//! elements. The side of the core at an angle `t <= 45 degrees` is the mean of a square's side and
//! a circle,
//!
//! ```text
//!   x(t) = a ((1 - b) + b cos t),   y(t) = a ((1 - b) tan t + b sin t),   a = R/2, b = 1/2,
//! ```
//!
//! With this shape the three angles at the core's corner are about 120 degrees. The transfinite
//! interpolation between the axes and these sides is the product `(s_i x_j, s_j x_i)` with
//! `s = y/y(45 degrees)`: exactly symmetric, and exactly zero on the axes. Spokes between core and
//! circle are radial, at equally spaced angles.

use super::angle::{direction, directions, turned};
use super::grading;
use super::grid::{BodyBuilder, PatchGrid, Side};
use super::polar::Sector;
use crate::Result;
use crate::mesh::Facet;

/// Half the side of the core divided by the radius of the disc.
const CORE: f64 = 0.5;
/// Weight of the circle in the shape of the core's sides.
const BULGE: f64 = 0.5;
/// Arc spacing at the circle divided by the spacing at the core's side: `(pi/2)/(2 CORE)`.
const SPREAD: f64 = std::f64::consts::FRAC_PI_2 / (2.0 * CORE);

/// A disc or a sector of 90 or 180 degrees, with its named parts.
pub(super) struct OGrid {
    /// Facets on the circle, beginning at the start angle.
    pub outer: Vec<Facet>,
    /// Facets on the radius at the start angle; empty for a full disc.
    pub start: Vec<Facet>,
    /// Facets on the radius at the end angle; empty for a full disc.
    pub end: Vec<Facet>,
    /// The node at the centre of the disc.
    pub center: u32,
    /// The node on the circle at the end angle.
    pub pole: u32,
}

/// Number of layers between core and circle, each about as thick as the elements there are wide.
fn n_layers(per_quarter: usize) -> usize {
    let mean_size = 0.5 * (2.0 * CORE + std::f64::consts::FRAC_PI_2) / per_quarter as f64;
    (((1.0 - CORE) / mean_size).round() as usize).max(1)
}

/// Number of cells of a disc with `per_quarter` elements over each of `quarters` quarter circles.
pub(super) fn n_cells(per_quarter: usize, quarters: usize) -> f64 {
    let n = per_quarter as f64;
    quarters as f64 * (0.25 * n * n + n * n_layers(per_quarter) as f64)
}

/// Adds the grid of a disc sector; `sector.n_angle` is `quarters` times an even number.
pub(super) fn disc_grid(
    builder: &mut BodyBuilder,
    sector: &Sector,
    quarters: usize,
    radius: f64,
) -> Result<OGrid> {
    let per_quarter = sector.n_angle / quarters;
    let side = per_quarter / 2;
    let core_shape = Core::new(per_quarter, radius);
    let axis = direction(sector.start);
    let [cx, cy] = sector.center;
    let place = |local: [f64; 2]| {
        let [x, y] = turned(local, axis);
        [cx + x, cy + y]
    };

    // The core covers the quadrants of the sector; the origin of its indices is its lower left
    // corner.
    let (left, below) = match quarters {
        1 => (0, 0),
        2 => (side, 0),
        _ => (side, side),
    };
    let core = builder.patch(
        [side + left, side + below],
        false,
        |i, j| {
            let signed = |k: usize, shift: usize| k as isize - 2 * shift as isize;
            place(core_shape.point(signed(i, left), signed(j, below)))
        },
        |_, _| None,
    );
    let core_node = |[i, j]: [isize; 2]| {
        core.node(
            (i + 2 * left as isize) as usize,
            (j + 2 * below as isize) as usize,
        )
    };

    let layers = grading::biased("disc", 0.0, 1.0, n_layers(per_quarter), SPREAD)?;
    let last = layers.len() - 1;
    let circle = directions(sector.start, sector.span, sector.n_angle);
    let ring = builder.patch(
        [last / 2, sector.n_angle],
        quarters == 4,
        |i, k| {
            let [c, s] = circle[k];
            let outer = [cx + radius * c, cy + radius * s];
            if i == last {
                return outer;
            }
            let [a, b] = core_shape.rim(k);
            let inner = place(core_shape.point(a, b));
            let f = layers[i];
            [
                inner[0] + f * (outer[0] - inner[0]),
                inner[1] + f * (outer[1] - inner[1]),
            ]
        },
        |i, k| (i == 0).then(|| core_node(core_shape.rim(k))),
    );

    let (start, end) = radii(&core, &ring, quarters, side);
    Ok(OGrid {
        outer: ring.side(Side::Right),
        start,
        end,
        center: core_node([0, 0]),
        pole: ring.node(last, 2 * sector.n_angle),
    })
}

/// Facets on the straight sides of a disc sector.
fn radii(
    core: &PatchGrid,
    ring: &PatchGrid,
    quarters: usize,
    side: usize,
) -> (Vec<Facet>, Vec<Facet>) {
    let (mut start, mut end) = match quarters {
        1 => (core.side(Side::Bottom), core.side(Side::Left)),
        2 => (
            core.side_range(Side::Bottom, side..2 * side),
            core.side_range(Side::Bottom, 0..side),
        ),
        _ => return (Vec::new(), Vec::new()),
    };
    start.extend(ring.side(Side::Bottom));
    end.extend(ring.side(Side::Top));
    (start, end)
}

/// Positions in the core, addressed by signed half steps from the centre.
struct Core {
    /// Number of half steps from the centre to a side.
    half: isize,
    /// Relative heights `s_k` of the points on the core's side.
    height: Vec<f64>,
    /// Distances `x_k` of the points on the core's side from the axis along which they run.
    distance: Vec<f64>,
}

impl Core {
    fn new(per_quarter: usize, radius: f64) -> Core {
        let a = CORE * radius;
        let side: Vec<[f64; 2]> = directions(0.0, 45.0, per_quarter / 2)
            .into_iter()
            .map(|[c, s]| {
                [
                    a * ((1.0 - BULGE) + BULGE * c),
                    a * ((1.0 - BULGE) * (s / c) + BULGE * s),
                ]
            })
            .collect();
        let top = side[side.len() - 1][1];
        Core {
            half: per_quarter as isize,
            height: side.iter().map(|p| p[1] / top).collect(),
            distance: side.iter().map(|p| p[0]).collect(),
        }
    }

    fn point(&self, i: isize, j: isize) -> [f64; 2] {
        let (a, b) = (i.unsigned_abs(), j.unsigned_abs());
        [
            i.signum() as f64 * (self.height[a] * self.distance[b]),
            j.signum() as f64 * (self.height[b] * self.distance[a]),
        ]
    }

    /// Indices of the point of the core's rim on spoke `k` (half steps counter-clockwise from the
    /// start).
    fn rim(&self, k: usize) -> [isize; 2] {
        let (k, m) = (k as isize, self.half);
        match k / m {
            0 => [m, k],
            1 | 2 => [2 * m - k, m],
            3 | 4 => [-m, 4 * m - k],
            5 | 6 => [k - 6 * m, -m],
            _ => [m, k - 8 * m],
        }
    }
}
