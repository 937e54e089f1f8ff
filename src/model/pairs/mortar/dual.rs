//! Integrals over a slave facet, with the functions dual to its trace basis.
//!
//! The dual functions come from an orthogonal factorisation at the points of the covered part,
//! `sqrt(w) phi = Q R`, so that `psi = D R^-1 Q' / sqrt(w)`. If little is covered, this loses only
//! half of the digits that the inverse of `int phi_j phi_l` would lose.

use super::super::covered::CoveredFacet;
use super::face::{FacePlane, MortarFace};
use super::overlap::{self, Point};
use super::sides::Sides;
use crate::error::{Error, Result};
use crate::shape::MAX_FACET_NODES;
use crate::space::{Vector, along, difference, direction, dot, length};
use nalgebra::DMatrix;
use std::collections::BTreeMap;
use std::ops::Range;

/// Ratio of the smallest to the largest diagonal entry of `R` at which a facet counts as covered.
const SLIVER: f64 = 1e-7;
/// Uncovered share of a facet above which it counts as partly covered; below it is round-off.
const PARTLY: f64 = 1e-9;
/// Fraction of a facet that may be covered twice: polygons deviate by less from facets with curved
/// edges.
const TWICE: f64 = 0.05;
/// Fraction of a facet's weight below which a master is dropped.
const NOTHING: f64 = 1e-13;
/// Weight of each end of an edge at its middle, as in [`crate::model::ContactBasis`].
const ALPHA: f64 = crate::model::ContactBasis::ALPHA;

/// Integrals of the functions of a slave node over its facets.
pub(super) struct Integrals {
    /// Integral `int phi` over those facets of the node that the other surface covers at least in
    /// part.
    pub whole: f64,
    /// Integral `D = int psi` over the covered part.
    pub covered: f64,
    /// Integrals `M` by master nodes.
    masters: BTreeMap<usize, f64>,
    /// Integral of `psi` times the vector from the slave to the master.
    pub gap: Vector,
    /// Integral of `psi` times the unit normal.
    pub normal: Vector,
    /// Smallest gap at any point of the node's facets.
    pub least: f64,
    /// Numbers of the master facets that facets of the node face.
    pub faced: Vec<usize>,
    /// Covered area of the node's facets; `largest` is the radius of the largest facet.
    pub of_facet: f64,
    pub largest: f64,
    /// Whether the node's displacement is that of a control point.
    pub is_transformed: bool,
}

impl Default for Integrals {
    fn default() -> Self {
        Integrals {
            whole: 0.0,
            covered: 0.0,
            masters: BTreeMap::new(),
            gap: [0.0; 3],
            normal: [0.0; 3],
            least: f64::INFINITY,
            faced: Vec::new(),
            of_facet: 0.0,
            largest: 0.0,
            is_transformed: false,
        }
    }
}

impl Integrals {
    pub(super) fn add(&mut self, other: &Integrals) {
        self.whole += other.whole;
        self.covered += other.covered;
        for (&node, m) in &other.masters {
            *self.masters.entry(node).or_default() += m;
        }
        self.gap = along(self.gap, 1.0, other.gap);
        self.normal = along(self.normal, 1.0, other.normal);
        self.least = self.least.min(other.least);
        self.faced.extend(&other.faced);
        self.of_facet = self.of_facet.max(other.of_facet);
        self.largest = self.largest.max(other.largest);
        self.is_transformed |= other.is_transformed;
    }

    /// Weights `w_k = M_k / D`, which add up to 1.
    pub(super) fn weights(&self) -> Vec<(usize, f64)> {
        let counts = |(_, m): &(&usize, &f64)| m.abs() > NOTHING * self.covered;
        let sum: f64 = self.masters.iter().filter(counts).map(|(_, m)| m).sum();
        let masters = self.masters.iter().filter(counts);
        masters.map(|(&node, m)| (node, m / sum)).collect()
    }
}

/// An integration point of the covered part of a facet.
struct CoveredPoint {
    root_weight: f64,
    /// Basis functions `phi` of the slave's nodes.
    slave: [f64; MAX_FACET_NODES],
    /// Shape functions `N` of the master's nodes.
    master: [f64; MAX_FACET_NODES],
    gap: Vector,
    normal: Vector,
}

/// Result of the integration over a slave facet.
pub(super) struct OfFacet {
    /// Integrals of each node of the facet; empty if the facet faces no master.
    pub nodes: Vec<(usize, Integrals)>,
    /// Part of the facet that masters cover; `None` if they cover all of it.
    pub covered: Option<CoveredFacet>,
}

/// Part of a slave facet that masters cover.
struct Coverage {
    /// Integration points of the covered part, master by master.
    samples: Vec<CoveredPoint>,
    /// Polygons of the covered part, in the plane of the facet.
    polygons: Vec<Vec<Point>>,
    /// Numbers of the master facets, and ranges of their integration points.
    faced: Vec<(usize, Range<usize>)>,
}

impl Coverage {
    /// Intersects a slave facet with the masters near it, in the slave's plane.
    fn new(sides: &Sides, face: &MortarFace, plane: &FacePlane) -> Self {
        let pieces = face.pieces(plane);
        let mut out = Coverage {
            samples: Vec::new(),
            polygons: Vec::new(),
            faced: Vec::new(),
        };
        for number in sides.near.near(face.center, face.normal, face.radius) {
            let master = &sides.masters[number];
            if !face.may_face(master) {
                continue;
            }
            let start = out.samples.len();
            let are_quadratic = face.is_transformed() || master.is_transformed();
            for piece in &pieces {
                for other in master.pieces(plane) {
                    let common = overlap::common(piece, &other);
                    for (point, weight) in overlap::points(&common, are_quadratic) {
                        let found = sample(sides, [face, master], plane, point, weight);
                        out.samples.extend(found);
                    }
                    out.polygons.push(common);
                }
            }
            if out.samples.len() > start {
                out.faced.push((number, start..out.samples.len()));
            }
        }
        out
    }

    /// Covered area of the facet.
    fn area(&self) -> f64 {
        let weights = self.samples.iter().map(|s| s.root_weight * s.root_weight);
        weights.sum()
    }

    /// Smallest gap at any integration point.
    fn least_gap(&self) -> f64 {
        let gaps = self.samples.iter().map(|s| dot(s.gap, s.normal));
        gaps.fold(f64::INFINITY, f64::min)
    }
}

/// Orthogonal factorisation `sqrt(w) phi = Q R` of the trace basis at the integration points.
struct TraceFactor<'a> {
    samples: &'a [CoveredPoint],
    q: DMatrix<f64>,
    r: DMatrix<f64>,
}

impl<'a> TraceFactor<'a> {
    /// Factors the trace basis of `n` nodes; `None` if so little is covered that the functions are
    /// not independent.
    fn new(samples: &'a [CoveredPoint], n: usize) -> Option<Self> {
        let basis = DMatrix::from_fn(samples.len(), n, |g, l| {
            samples[g].root_weight * samples[g].slave[l]
        });
        let qr = basis.qr();
        let r = qr.r();
        let size = |pick: fn(f64, f64) -> f64, from: f64| {
            r.diagonal().iter().map(|d| d.abs()).fold(from, pick)
        };
        if samples.len() < n || size(f64::min, f64::INFINITY) <= SLIVER * size(f64::max, 0.0) {
            return None;
        }
        let q = qr.q();
        Some(TraceFactor { samples, q, r })
    }

    /// Coefficients in the basis `phi` of functions `f` that are given at the integration points of
    /// `range`: `R^-1 Q' sqrt(w) f`, one column for each function.
    fn coefficients(
        &self,
        columns: usize,
        range: Range<usize>,
        of: impl Fn(&CoveredPoint, usize) -> f64,
    ) -> DMatrix<f64> {
        let values = DMatrix::from_fn(range.len(), columns, |g, k| {
            let sample = &self.samples[range.start + g];
            sample.root_weight * of(sample, k)
        });
        let mut out = self.q.rows(range.start, range.len()).tr_mul(&values);
        self.r.solve_upper_triangular_mut(&mut out);
        out
    }
}

/// Integrates over a slave facet that faces masters, for each of its nodes.
///
/// # Errors
/// A facet that masters cover twice.
pub(super) fn integrate(sides: &Sides, face: &MortarFace) -> Result<OfFacet> {
    let plane = FacePlane::new(face.center, face.normal, face.is_solid());
    let coverage = Coverage::new(sides, face, &plane);
    let parts = || by_pieces(face, &plane, &coverage.polygons);
    let none = || OfFacet {
        nodes: Vec::new(),
        covered: Some(parts()),
    };
    if coverage.samples.is_empty() {
        return Ok(none());
    }
    let (whole, area) = whole(sides, face);
    let covered_area = coverage.area();
    if covered_area > (1.0 + TWICE) * area {
        let mesh = sides.entries.mesh;
        return Err(Error::input(format!(
            "the other surface lies {:.3} times over the facet at node {} ({}): make contacts of \
             its parts",
            covered_area / area,
            mesh.node_label(face.nodes[0]),
            mesh.place(face.nodes[0])
        )));
    }
    let samples = &coverage.samples;
    let Some(basis) = TraceFactor::new(samples, face.nodes.len()) else {
        return Ok(none());
    };
    let all = 0..samples.len();
    let gap = basis.coefficients(3, all.clone(), |s, d| s.gap[d]);
    let normal = basis.coefficients(3, all, |s, d| s.normal[d]);
    let least = coverage.least_gap();
    let mut out: Vec<(usize, Integrals)> = (face.nodes.iter().enumerate())
        .map(|(l, &node)| {
            let covered = (samples.iter())
                .map(|s| s.root_weight * s.root_weight * s.slave[l])
                .sum();
            let integrals = Integrals {
                whole: whole[l],
                covered,
                masters: BTreeMap::new(),
                gap: std::array::from_fn(|d| covered * gap[(l, d)]),
                normal: std::array::from_fn(|d| covered * normal[(l, d)]),
                least,
                faced: coverage.faced.iter().map(|(number, _)| *number).collect(),
                of_facet: covered_area,
                largest: face.radius,
                is_transformed: face.is_transformed(),
            };
            (node, integrals)
        })
        .collect();
    for (number, range) in &coverage.faced {
        let master = &sides.masters[*number];
        let of_masters = basis.coefficients(master.nodes.len(), range.clone(), |s, k| s.master[k]);
        for (l, (_, integrals)) in out.iter_mut().enumerate() {
            for (k, &node) in master.nodes.iter().enumerate() {
                *integrals.masters.entry(node).or_default() +=
                    integrals.covered * of_masters[(l, k)];
            }
        }
    }
    Ok(OfFacet {
        nodes: out,
        covered: (covered_area < (1.0 - PARTLY) * area).then(parts),
    })
}

/// Cuts polygons in the plane of a facet to its pieces, and returns them in space.
fn by_pieces(face: &MortarFace, plane: &FacePlane, polygons: &[Vec<Point>]) -> CoveredFacet {
    let mut out = Vec::new();
    for polygon in polygons.iter().filter(|polygon| !polygon.is_empty()) {
        let parts = face.by_pieces(plane, polygon);
        out.resize(parts.len(), Vec::new());
        for (out, part) in out.iter_mut().zip(parts) {
            if !part.is_empty() {
                out.push(
                    part.into_iter()
                        .map(|point| plane.position(point))
                        .collect(),
                );
            }
        }
    }
    out
}

/// Integrals `int phi` of each node over a whole facet, and the area of the facet.
fn whole(sides: &Sides, face: &MortarFace) -> ([f64; MAX_FACET_NODES], f64) {
    let mut out = [0.0; MAX_FACET_NODES];
    let mut area = 0.0;
    for point in crate::element::facet_points(sides.entries.space, face.reference, &face.x) {
        area += point.weight;
        for (sum, value) in out.iter_mut().zip(trace(face, point.values)) {
            *sum += point.weight * value;
        }
    }
    (out, area)
}

/// Trace basis of a slave facet, computed from its shape functions.
fn trace(face: &MortarFace, values: [f64; MAX_FACET_NODES]) -> [f64; MAX_FACET_NODES] {
    if !face.is_transformed() {
        return values;
    }
    let n = face.reference.n_corners;
    let mut out = values;
    for k in 0..n {
        let middle = values[n + k];
        out[n + k] = (1.0 - 2.0 * ALPHA) * middle;
        out[k] += ALPHA * middle;
        out[(k + 1) % n] += ALPHA * middle;
    }
    out
}

/// Evaluates the integrands at a point of a slave's plane.
fn sample(
    sides: &Sides,
    [face, master]: [&MortarFace; 2],
    plane: &FacePlane,
    point: Point,
    weight: f64,
) -> Option<CoveredPoint> {
    let [here, there] = [face.locate(plane, point)?, master.locate(plane, point)?];
    let at = (face.reference.functions)(here);
    let area = face.reference.area(&at, &face.x);
    let (x, values) = face.at(here);
    let (y, of_master) = master.at(there);
    let measure = length(area) / dot(area, plane.normal) * sides.entries.space.measure(x[0]);
    let normal = face
        .nodes
        .iter()
        .zip(values)
        .fold([0.0; 3], |sum, (node, value)| {
            let normal = sides.normals.get(node).copied().unwrap_or_default();
            along(sum, value, normal)
        });
    let [own, other] = [(0, x), (1, y)].map(|(side, x)| sides.truly(side, x, plane.normal));
    Some(CoveredPoint {
        root_weight: (weight * measure).sqrt(),
        slave: trace(face, values),
        master: of_master,
        gap: difference(other, own),
        normal: direction(normal),
    })
}
