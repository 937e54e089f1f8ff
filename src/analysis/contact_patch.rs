//! A run of closed pairs: where it ends, and what is read off between its pairs.

use super::contact_edge::{EdgePoint, Tail};
use crate::model::{AxisPoint, Model};
use crate::scene::Kind;

/// Pairs at the edge, the last closed one included, whose pressures are not believed one by one,
/// only their force together: how they share it depends on where in the facet the contact ends (on
/// Hertz' line contact the last two put the edge off by 0.08 and -0.06 elements, those before by
/// 0.01).
const EDGE_SKIP: isize = 2;
/// Pairs before those from which the pressure near the edge is fitted.
const EDGE_POINTS: isize = 4;
/// Where a contact ends.
#[derive(Clone, Copy)]
pub(super) struct Edge {
    /// Arc length along the surface.
    pub arc: f64,
    /// Measured error of its reading.
    pub reading: f64,
}

/// What an edge is read off.
struct EdgeTail {
    /// The last closed pair, and the direction in which the contact ends.
    last: usize,
    way: isize,
    /// Arc length of the middle of the contact.
    middle: f64,
    /// To the first open pair.
    spacing: f64,
    /// Distances from the middle between which the edge lies.
    bracket: [f64; 2],
}

/// A run of closed pairs `begin..end` of a contact.
pub(super) struct Patch<'a> {
    pub model: &'a Model,
    /// Of each pair.
    pub pressure: &'a [f64],
    /// Pairs of the contact.
    pub range: std::ops::Range<usize>,
    /// First closed pair, and the first beyond the last.
    pub begin: usize,
    pub end: usize,
}

impl Patch<'_> {
    /// Where the surface ends beyond its last pair `k`: there, or on the axis, or where the other
    /// surface does.
    pub(super) fn end_arc(&self, k: usize) -> f64 {
        let pair = &self.model.pairs[k];
        let extent = self.model.contacts[pair.contact].extent;
        match (self.axis_beside(k), extent) {
            (Some(axis), _) => axis.pair.arc,
            (None, Some([low, _])) if k == self.range.start => low,
            (None, Some([_, high])) if k + 1 == self.range.end => high,
            _ => pair.arc,
        }
    }

    /// The point on the axis that a pair is next to.
    fn axis_beside(&self, k: usize) -> Option<&AxisPoint> {
        let axis = self.model.contacts[self.model.pairs[k].contact]
            .axis
            .as_ref()?;
        let next = if axis.begins {
            k == self.range.start
        } else {
            k + 1 == self.range.end
        };
        next.then_some(axis)
    }

    /// Whether a pair ends its surface on a plane of symmetry or beside the axis.
    pub(super) fn is_symmetric(&self, k: usize) -> bool {
        if self.axis_beside(k).is_some() {
            return true;
        }
        let pair = &self.model.pairs[k];
        let x = self.model.mesh.point(pair.slave);
        let mut mirrors = self.model.contacts[pair.contact].mirrors_at(x);
        (k == self.range.start || k + 1 == self.range.end) && mirrors.next().is_some()
    }

    /// Where contact ends beyond pair `last`, along the surface in direction `way`, read from the
    /// force of the last [`EDGE_SKIP`] pairs: see [`Tail`]. Its error is measured by a second
    /// reading with one pair more; where the pairs are too few for that, or a reading leaves its
    /// bracket, it is half a spacing.
    pub(super) fn edge(&self, last: usize, way: isize, middle: f64) -> Edge {
        let arc = |k: usize| self.model.pairs[k].arc;
        let Some(beyond) = self.neighbour(last, way) else {
            return Edge {
                arc: self.end_arc(last),
                reading: 0.0,
            };
        };
        let spacing = (arc(beyond) - arc(last)).abs();
        let distance = (arc(last) - middle).abs();
        let bracket = [distance - 0.5 * spacing, distance + spacing];
        let tail = EdgeTail {
            last,
            way,
            middle,
            spacing,
            bracket,
        };
        let [found, other] = [EDGE_SKIP, EDGE_SKIP + 1].map(|skip| self.read_edge(&tail, skip));
        let at_bracket = |edge: f64| {
            bracket
                .iter()
                .any(|end| (edge - end).abs() < 1e-9 * spacing)
        };
        let reading = match (found, other) {
            (Some(found), Some(other)) if !at_bracket(found) => (found - other).abs(),
            _ => 0.5 * spacing,
        };
        let edge = found.unwrap_or(distance + 0.5 * spacing);
        Edge {
            arc: middle + way as f64 * edge,
            reading,
        }
    }

    /// The pair `step` pairs along its surface from another.
    fn neighbour(&self, k: usize, step: isize) -> Option<usize> {
        k.checked_add_signed(step)
            .filter(|i| self.range.contains(i))
    }

    /// Distance of the edge from the middle, by the force of the last `skip` pairs and the
    /// pressures before them.
    fn read_edge(&self, tail: &EdgeTail, skip: isize) -> Option<f64> {
        let &EdgeTail {
            last,
            way,
            middle,
            spacing,
            bracket,
        } = tail;
        let arc = |k: usize| self.model.pairs[k].arc;
        let closed = |step: isize| {
            self.neighbour(last, -step * way)
                .filter(|k| (self.begin..self.end).contains(k))
        };
        // This side of the middle, as in half a model, and not on an axis, where next to no area
        // belongs to a pair.
        let beside =
            |k: &usize| way as f64 * (arc(*k) - middle) > -0.25 * spacing && self.width(*k) > 0.0;
        let inner = (skip..skip + EDGE_POINTS).filter_map(closed).filter(beside);
        let mut points = [EdgePoint::default(); EDGE_POINTS as usize];
        let mut n = 0;
        for k in inner {
            points[n] = EdgePoint {
                squared: (arc(k) - middle).powi(2),
                pressure_squared: self.pressure[k].powi(2),
                weight: self.width(k),
            };
            n += 1;
        }
        let first = closed(skip - 1).filter(|_| n > 0)?;
        let force: f64 = (0..skip)
            .filter_map(closed)
            .map(|k| self.pressure[k] * self.model.pairs[k].area)
            .sum();
        let tail = Tail {
            points: &points[..n],
            from: (arc(first) - middle).abs(),
            near: [first, last].map(|k| ((arc(k) - middle).abs(), self.width(k))),
            length: self.model.pairs[first].area / self.width(first),
        };
        // The last closed pair may carry the rest of a partly covered facet.
        Some(tail.edge(force, bracket))
    }

    /// Area of the surface at a pair over the length along it.
    fn width(&self, k: usize) -> f64 {
        match self.model.scene.kind {
            Kind::Axisymmetric => {
                2.0 * std::f64::consts::PI * self.model.mesh.point(self.model.pairs[k].slave)[0]
            }
            _ => 1.0,
        }
    }

    /// Pressure between pairs, linear.
    pub(super) fn pressure_at(&self, arc: f64) -> f64 {
        let pairs = &self.model.pairs[self.begin..self.end];
        let next = pairs
            .partition_point(|p| p.arc <= arc)
            .clamp(1, pairs.len().max(2) - 1);
        match (pairs.get(next - 1), pairs.get(next)) {
            (Some(a), Some(b)) => {
                let t = ((arc - a.arc) / (b.arc - a.arc)).clamp(0.0, 1.0);
                self.pressure[self.begin + next - 1] * (1.0 - t)
                    + self.pressure[self.begin + next] * t
            }
            _ => self.pressure[self.begin],
        }
    }
}
