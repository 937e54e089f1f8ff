//! The region round a contact in which yielding is looked for.

use super::mirror::Mirror;
use crate::model::Model;
use crate::space::{Vector, difference, length};
use std::ops::Range;

/// How far a region reaches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Reach {
    /// As deep as first yield may lie.
    OfFirstYield,
    /// As far as yielding rarely spreads beyond.
    OfZone,
}

impl Reach {
    /// Multiple of the contact surface's extent in a plane model. Measured on the cylinder scene
    /// loaded to 1.5 b*: a zone of 2.0 is too small, and the factorisation takes no more operations
    /// with 5 than with 1.2.
    fn in_plane(self) -> f64 {
        match self {
            Reach::OfFirstYield => 1.2,
            Reach::OfZone => 3.0,
        }
    }

    /// Multiple of half the contact surface's smaller width in a solid one, from the middle; `round`
    /// is the smaller width over the larger. Under line contact yielding begins at 0.79 times the
    /// half width, under a point at 0.48 times (K. Johnson, Contact Mechanics, 1985, sections 4.2
    /// and 3.4); once it has come up round a point it reaches as deep as 2.3 times the contact
    /// radius (section 6.3), under a line as in a plane model: a half width and the reach there.
    fn in_solid(self, round: f64) -> f64 {
        match self {
            Reach::OfFirstYield => 1.2,
            Reach::OfZone => 2.3 * round + (1.0 + self.in_plane()) * (1.0 - round),
        }
    }
}

/// Rings of a region of solids, and the radius of each in that of the next.
const RINGS: i32 = 4;
const NEXT_RING: f64 = 0.75;

/// What lies within a distance of a box.
pub(super) struct Region {
    low: Vector,
    high: Vector,
    distance: f64,
    rings: i32,
}

impl Region {
    /// Round the pairs of a contact. In the plane round the box of their nodes. In space round what
    /// is left of it, mirror images at planes of symmetry included, when half its smaller width is
    /// taken off on all sides: the middle of a round surface, the middle line of a long one. A
    /// trailing solve of solids costs by the size of the zone.
    pub(super) fn round(model: &Model, pairs: Range<usize>, reach: Reach) -> Self {
        let solid = model.mesh.is_solid();
        let mirrors = if solid {
            Mirror::of_pairs(model, pairs.clone())
        } else {
            Vec::new()
        };
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let mut take = |x: Vector| {
            for d in 0..3 {
                low[d] = low[d].min(x[d]);
                high[d] = high[d].max(x[d]);
            }
        };
        for pair in &model.pairs[pairs] {
            for node in [pair.first, pair.second] {
                let x = model.mesh.point(node);
                take(x);
                mirrors.iter().for_each(|mirror| take(mirror.image(x)));
            }
        }
        let extent = difference(high, low);
        if !solid {
            let distance = reach.in_plane() * length(extent);
            return Region {
                low,
                high,
                distance,
                rings: 1,
            };
        }
        let mut sides = extent;
        sides.sort_by(f64::total_cmp);
        let half = 0.5 * sides[1];
        for d in 0..3 {
            let off = half.min(0.5 * extent[d]);
            low[d] += off;
            high[d] -= off;
        }
        let distance = reach.in_solid(sides[1] / sides[2]) * half;
        Region {
            low,
            high,
            distance,
            rings: RINGS,
        }
    }

    /// Whether a point lies in it.
    pub(super) fn holds(&self, x: Vector) -> bool {
        self.off(x) <= self.distance
    }

    /// The ring that a point lies in, the outermost 0.
    pub(super) fn ring(&self, x: Vector) -> u8 {
        let off = self.off(x);
        let within = |k: &i32| off <= self.distance * NEXT_RING.powi(*k);
        (1..self.rings).filter(within).count() as u8
    }

    /// Distance of a point from the box.
    fn off(&self, x: Vector) -> f64 {
        let off = |d: usize| (self.low[d] - x[d]).max(x[d] - self.high[d]).max(0.0);
        length([off(0), off(1), off(2)])
    }
}
