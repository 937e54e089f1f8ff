//! A run of closed pairs of a plane contact: its ends, and values between its pairs.

use super::contact_edge::{EdgePoint, Tail};
use crate::model::{AxisPoint, ContactSurface, Mirror, Model};
use crate::results::EdgeReading;
use crate::scene::Kind;
use crate::space::{Vector, dot};
use std::f64::consts::PI;

/// Number of pairs at the edge whose pressures are not trusted one by one.
const EDGE_SKIP: isize = EdgeReading::AT_EDGE as isize;
/// Number of pairs before the edge pairs to which the pressure near the edge is fitted.
const EDGE_POINTS: isize = 4;
/// Angle of the sector between two planes of symmetry below which they count as parallel, so that
/// the contact with its images is endless.
const PARALLEL: f64 = 1e-2;

/// The end of a contact along its surface.
#[derive(Clone, Copy)]
pub(super) struct LineEdge {
    /// Arc length along the surface.
    pub arc: f64,
    /// Estimated error of the edge's position.
    pub reading: f64,
}

/// Data from which the position of an edge is read.
struct EdgeTail {
    /// Place of the last closed pair; `way` is the direction from there in which the contact ends.
    last: usize,
    way: isize,
    /// Arc length of the centre of the contact.
    middle: f64,
    /// Distance from the last closed pair to the first open one.
    spacing: f64,
    /// Distances from the middle that bracket the edge.
    bracket: [f64; 2],
}

/// A pair of a contact, placed along its surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PlacedPair {
    /// Number of the pair in the model.
    pub pair: usize,
    /// Arc length of the pair along the surface.
    pub arc: f64,
}

/// The pairs of a contact in order along its surface. A closed surface begins with a pair that does
/// not press, and ends with the same pair one turn further, so that no run of pressing pairs
/// crosses its ends.
pub(super) fn line_of(
    model: &Model,
    contact: &ContactSurface,
    presses: impl Fn(usize) -> bool,
) -> Vec<PlacedPair> {
    let place = |pair: usize| PlacedPair {
        pair,
        arc: model.pairs[pair].arc,
    };
    let mut line: Vec<PlacedPair> = contact.range.clone().map(place).collect();
    let first_open = line.iter().position(|place| !presses(place.pair));
    if let (Some(turn), Some(first_open)) = (contact.turn, first_open) {
        let further = |place: &PlacedPair| PlacedPair {
            arc: place.arc + turn,
            ..*place
        };
        let behind: Vec<PlacedPair> = line[..=first_open].iter().map(further).collect();
        line.drain(..first_open);
        line.extend(behind);
    }
    line
}

/// A run of closed pairs `begin..end` of a contact.
pub(super) struct ClosedRun<'a> {
    pub model: &'a Model,
    /// Pressure of each pair of the model.
    pub pressure: &'a [f64],
    pub contact: &'a ContactSurface,
    /// Pairs of the contact along its surface.
    pub line: &'a [PlacedPair],
    /// First closed place of the line; `end` is the first place after the closed ones.
    pub begin: usize,
    pub end: usize,
}

impl ClosedRun<'_> {
    /// Arc length at which the surface ends beyond place `k` of the line, if `k` is its first or
    /// last place: on the axis, where the other surface ends, or at the place itself.
    pub(super) fn end_arc(&self, k: usize) -> f64 {
        match (self.axis_beside(k), self.contact.extent) {
            (Some(axis), _) => axis.pair.arc,
            (None, Some([low, _])) if k == 0 => low,
            (None, Some([_, high])) if k + 1 == self.line.len() => high,
            _ => self.line[k].arc,
        }
    }

    /// The point on the axis next to a place, if there is one.
    pub(super) fn axis_beside(&self, k: usize) -> Option<&AxisPoint> {
        let axis = self.contact.axis.as_ref()?;
        let next = if axis.begins {
            k == 0
        } else {
            k + 1 == self.line.len()
        };
        next.then_some(axis)
    }

    /// Whether the patch takes up the whole surface.
    pub(super) fn is_whole(&self) -> bool {
        self.begin == 0 && self.end == self.line.len()
    }

    /// The pressure of the pair at a place.
    pub(super) fn pressure_of(&self, k: usize) -> f64 {
        self.pressure[self.line[k].pair]
    }

    /// Whether the surface ends at a place on a plane of symmetry or beside the axis.
    pub(in crate::analysis) fn is_symmetric(&self, k: usize) -> bool {
        if self.axis_beside(k).is_some() {
            return true;
        }
        self.mirror(k).is_some()
    }

    /// The plane of symmetry on which the surface ends at a place.
    fn mirror(&self, k: usize) -> Option<&Mirror> {
        let x = self.point(k);
        let mut mirrors = self.contact.mirrors_at(x);
        mirrors
            .next()
            .filter(|_| k == 0 || k + 1 == self.line.len())
    }

    fn point(&self, k: usize) -> Vector {
        self.model
            .mesh
            .point(self.model.pairs[self.line[k].pair].slave)
    }

    /// Half width of the whole patch, images included, divided by the width of the modelled run of
    /// pairs: 1/2 away from planes of symmetry; 1 if the run ends on one plane, or on two parallel
    /// planes; otherwise, between two planes, half the number of images (with the model itself)
    /// that close the turn.
    pub(super) fn half_widths(&self) -> f64 {
        match [self.begin, self.end - 1].map(|k| (self.is_symmetric(k), self.mirror(k))) {
            [(false, _), (false, _)] => 0.5,
            [(_, Some(a)), (_, Some(b))] => {
                let between = dot(a.normal(), b.normal()).clamp(-1.0, 1.0).acos();
                let sector = PI - between;
                if sector > PARALLEL { PI / sector } else { 1.0 }
            }
            _ => 1.0,
        }
    }

    /// Area of the whole patch, images included, between two arc lengths. In the plane it is the
    /// width; under revolution `int 2 pi r ds`, with the radius between nodes linear in the arc
    /// length.
    pub(super) fn area_between(&self, [from, to]: [f64; 2]) -> f64 {
        let width = match self.model.kind {
            Kind::Axisymmetric => 2.0 * PI * self.moment([from, to]),
            _ => to - from,
        };
        let on_mirror = |k: &usize| self.mirror(*k).is_some() && self.point(*k)[0] != 0.0;
        let images = match [self.begin, self.end - 1]
            .iter()
            .filter(|k| on_mirror(k))
            .count()
        {
            _ if self.model.kind != Kind::Axisymmetric => 2.0 * self.half_widths(),
            0 => 1.0,
            1 => 2.0,
            _ => 2.0 * self.half_widths(),
        };
        images * width
    }

    /// Integrates `int r ds` between two arc lengths of a surface of revolution.
    fn moment(&self, [from, to]: [f64; 2]) -> f64 {
        let axis = self.contact.axis.as_ref().map(|axis| (axis.pair.arc, 0.0));
        let mut radii: Vec<(f64, f64)> = (0..self.line.len())
            .map(|k| (self.line[k].arc, self.point(k)[0]))
            .chain(axis)
            .collect();
        radii.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut sum = 0.0;
        for (i, ends) in radii.windows(2).enumerate() {
            let [(a, r), (b, s)] = [ends[0], ends[1]];
            // The first and the last piece extend beyond the nodes.
            let low = if i == 0 { from } else { from.max(a) };
            let high = if i + 2 == radii.len() { to } else { to.min(b) };
            if high > low && b > a {
                let middle = 0.5 * (low + high);
                sum += (high - low) * (r + (s - r) * (middle - a) / (b - a)).max(0.0);
            }
        }
        sum
    }

    /// Finds the edge of the contact beyond the place `last`, along the surface in direction `way`,
    /// from the force of the last [`EDGE_SKIP`] pairs: see [`Tail`]. The error of the reading is
    /// its difference from a second reading with one more pair. If there are too few pairs for
    /// that, or if the reading lies at an end of its bracket, the error is half a spacing.
    pub(in crate::analysis) fn edge(&self, last: usize, way: isize, middle: f64) -> LineEdge {
        let arc = |k: usize| self.line[k].arc;
        let Some(beyond) = self.neighbour(last, way) else {
            return LineEdge {
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
        LineEdge {
            arc: middle + way as f64 * edge,
            reading,
        }
    }

    /// The place `step` places along the surface from place `k`, if there is one.
    fn neighbour(&self, k: usize, step: isize) -> Option<usize> {
        k.checked_add_signed(step).filter(|i| *i < self.line.len())
    }

    /// Distance of the edge from the middle, from the force of the last `skip` pairs and the
    /// pressures before them.
    fn read_edge(&self, tail: &EdgeTail, skip: isize) -> Option<f64> {
        let &EdgeTail {
            last,
            way,
            middle,
            spacing,
            bracket,
        } = tail;
        let arc = |k: usize| self.line[k].arc;
        let closed = |step: isize| {
            self.neighbour(last, -step * way)
                .filter(|k| (self.begin..self.end).contains(k))
        };
        // Only pairs on this side of the middle count, as in half a model, and no pair on the axis,
        // which has almost no area.
        let beside =
            |k: &usize| way as f64 * (arc(*k) - middle) > -0.25 * spacing && self.width(*k) > 0.0;
        let inner = (skip..skip + EDGE_POINTS).filter_map(closed).filter(beside);
        let mut points = [EdgePoint::default(); EDGE_POINTS as usize];
        let mut n = 0;
        for k in inner {
            points[n] = EdgePoint {
                squared: (arc(k) - middle).powi(2),
                pressure_squared: self.pressure_of(k).powi(2),
                weight: self.width(k),
            };
            n += 1;
        }
        let first = closed(skip - 1).filter(|_| n > 0)?;
        let force: f64 = (0..skip)
            .filter_map(closed)
            .map(|k| self.pressure_of(k) * self.area(k))
            .sum();
        let tail = Tail {
            points: &points[..n],
            from: (arc(first) - middle).abs(),
            near: [first, last].map(|k| ((arc(k) - middle).abs(), self.width(k))),
            length: self.area(first) / self.width(first),
        };
        // The last closed pair may carry the force of the remaining, partly covered facet.
        Some(tail.edge(force, bracket))
    }

    fn area(&self, k: usize) -> f64 {
        self.model.pairs[self.line[k].pair].area
    }

    /// Area of the surface at a place, per length along the surface.
    fn width(&self, k: usize) -> f64 {
        match self.model.kind {
            Kind::Axisymmetric => 2.0 * PI * self.point(k)[0],
            _ => 1.0,
        }
    }

    /// Pressure at an arc length, linear between pairs.
    pub(super) fn pressure_at(&self, arc: f64) -> f64 {
        let places = &self.line[self.begin..self.end];
        let next = places
            .partition_point(|p| p.arc <= arc)
            .clamp(1, places.len().max(2) - 1);
        match (places.get(next - 1), places.get(next)) {
            (Some(a), Some(b)) => {
                let t = ((arc - a.arc) / (b.arc - a.arc)).clamp(0.0, 1.0);
                self.pressure[a.pair] * (1.0 - t) + self.pressure[b.pair] * t
            }
            _ => self.pressure_of(self.begin),
        }
    }
}
