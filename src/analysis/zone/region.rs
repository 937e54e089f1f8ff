//! The region round a contact in which yielding is looked for.

use crate::model::images::Images;
use crate::model::{ContactSurface, Model};
use crate::space::{Vector, difference, length};

/// How far a region round a contact reaches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::analysis) enum Reach {
    /// As deep as first yield may lie.
    OfFirstYield,
    /// A distance beyond which yielding rarely spreads.
    OfZone,
}

impl Reach {
    /// Multiple of the contact surface's extent in a plane model. The value for the zone leaves
    /// room for loads well beyond first yield; in a plane model a larger zone takes no more
    /// operations to factor.
    fn in_plane(self) -> f64 {
        match self {
            Reach::OfFirstYield => 1.2,
            Reach::OfZone => 3.0,
        }
    }
}

/// Distance that a solid model's region reaches from the centre of the contact surface, for either
/// reach, as a multiple of half the surface's smaller width. It leaves room for first yield, which
/// lies 0.79 half widths deep under a line contact and 0.48 under a point (K. Johnson, Contact
/// Mechanics, 1985, sections 4.2 and 3.4).
///
/// The region need not hold the zone of the program's largest loads: this zone is known after first
/// yield and is factored then. A larger region would not make its factor cheaper, and each plastic
/// iteration would go through the whole zone.
const IN_SOLID: f64 = 1.2;

/// The points within a distance of a box.
pub(in crate::analysis) struct Region {
    low: Vector,
    high: Vector,
    distance: f64,
}

impl Region {
    /// The region round a contact. In the plane, the box is that of the contact's nodes. In a
    /// solid, it is the box of the nodes and their mirror images at planes of symmetry, reduced by
    /// half its smaller width on all sides: the middle of a round surface, the middle line of a
    /// long one. The cost of a trailing solve in a solid grows with the size of the zone.
    pub(in crate::analysis) fn round(
        model: &Model,
        contact: &ContactSurface,
        reach: Reach,
    ) -> Self {
        let solid = model.mesh.is_solid();
        let planes = contact.mirrors.iter().filter(|_| solid);
        let (planes, opposite) = Images::planes(planes.copied());
        let images = Images::of(&planes);
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let mut take = |x: Vector| {
            for d in 0..3 {
                low[d] = low[d].min(x[d]);
                high[d] = high[d].max(x[d]);
            }
        };
        for pair in &model.pairs[contact.range.clone()] {
            for node in pair.nodes() {
                let x = model.mesh.point(node);
                images.iter().for_each(|image| take(image.of(x)));
            }
        }
        // A contact between two opposite planes of symmetry has no end and no width in their
        // direction.
        let far = length(difference(high, low));
        for (d, mirror) in opposite.iter().flat_map(|m| [(0, m), (1, m), (2, m)]) {
            let reach = mirror.normal()[d].abs() * far;
            (low[d], high[d]) = (low[d] - reach, high[d] + reach);
        }
        let extent = difference(high, low);
        if !solid {
            let distance = reach.in_plane() * length(extent);
            return Region {
                low,
                high,
                distance,
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
        let distance = IN_SOLID * half;
        Region {
            low,
            high,
            distance,
        }
    }

    /// Whether a point lies in the region.
    pub(in crate::analysis) fn holds(&self, x: Vector) -> bool {
        self.off(x) <= self.distance
    }

    /// Distance of a point from the box of the region.
    fn off(&self, x: Vector) -> f64 {
        let off = |d: usize| (self.low[d] - x[d]).max(x[d] - self.high[d]).max(0.0);
        length([off(0), off(1), off(2)])
    }
}
