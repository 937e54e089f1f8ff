//! Ring sectors, as a grid in radius (first index) and angle (second index).

use super::angle::directions;
use super::grid::{BodyBuilder, PatchGrid};

/// A sector of a ring.
pub(super) struct Sector {
    /// Centre of the ring.
    pub center: [f64; 2],
    /// Start angle in degrees.
    pub start: f64,
    /// Span in degrees, counter-clockwise.
    pub span: f64,
    /// Number of elements along the angle.
    pub n_angle: usize,
}

impl Sector {
    /// Whether the sector is the full circle, up to the round-off of angles in degrees.
    pub(super) fn is_closed(&self) -> bool {
        is_full_circle(self.span)
    }
}

/// Whether a span is 360 degrees, up to the round-off of angles in degrees.
pub(super) fn is_full_circle(span: f64) -> bool {
    (span - 360.0).abs() <= 1e-9
}

/// Adds the grid of a ring sector with the given radii by half steps. Mid-side nodes of every
/// circular grid line lie on the circle; otherwise thin layers of coarse arcs would overlap.
pub(super) fn ring_grid(builder: &mut BodyBuilder, sector: &Sector, radii: &[f64]) -> PatchGrid {
    let span = if sector.is_closed() {
        360.0
    } else {
        sector.span
    };
    let directions = directions(sector.start, span, sector.n_angle);
    let [x, y] = sector.center;
    builder.patch(
        [radii.len() / 2, sector.n_angle],
        sector.is_closed(),
        |i, j| {
            let [c, s] = directions[j];
            [x + radii[i] * c, y + radii[i] * s]
        },
        |_, _| None,
    )
}
