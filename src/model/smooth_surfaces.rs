//! Smooth surfaces, along which bodies slide: planes along themselves, round surfaces if their body
//! turns about their centre.
//!
//! Facets deviate from a round shape, and nodes in places of few digits deviate from planes, too.
//! These deviations hold a motion a little that the shapes would leave free.

use super::Pair;
use super::motions::{FREE, Mode, Motions};
use super::pairs::mortar::roundness::true_shape;
use crate::mesh::{Curve, Facet, Mesh, Surface, rounding};
use crate::space::{Vector, along, cross, difference, direction, length, unit};
use std::collections::BTreeSet;

/// Largest angle between a facet and the plane of its surface, if each corner may be off by the
/// last decimal place: this many times the decimal place over the shortest edge.
const FLAT: f64 = 4.0;
/// Largest angle between a facet and the plane of its surface by round-off.
const ROUND_OFF: f64 = 1e-10;
/// Angle beyond which a surface is not flat, however small its facets are.
const BENT: f64 = 1e-3;
/// Fraction of a free mode's largest entry by which the nodes of a round surface may leave the
/// surface.
const SLIDES: f64 = 1e-6;
/// Share of the hold of pairs that may be left if they had the normals of smooth shapes.
const LEFT: f64 = 0.5;

/// The surfaces of a mesh that are round or flat.
pub(super) struct SmoothSurfaces<'m> {
    mesh: &'m Mesh,
    surfaces: Vec<SmoothSurface>,
}

struct SmoothSurface {
    shape: SmoothShape,
    nodes: BTreeSet<usize>,
    /// Share of a load that is spread over the facets which a motion along the shape may feel: of a
    /// round surface the largest deviation of a facet over the radius, of a plane `turn`.
    deviation: f64,
    /// Largest angle between a facet and the shape; of a plane the angle that is allowed.
    turn: f64,
}

enum SmoothShape {
    Round(Curve),
    /// A plane with its normal.
    Plane(Vector),
}

impl SmoothShape {
    /// Normal of the shape at a place, of either sign.
    fn normal(&self, x: Vector) -> Option<Vector> {
        match self {
            SmoothShape::Round(curve) => {
                let (center, ..) = curve.spine(x)?;
                Some(direction(difference(x, center)))
            }
            SmoothShape::Plane(normal) => Some(*normal),
        }
    }
}

impl<'m> SmoothSurfaces<'m> {
    pub(super) fn of(mesh: &'m Mesh) -> Self {
        let off = rounding(mesh);
        let surfaces = mesh.surfaces.values().filter_map(|surface| {
            let round = || SmoothSurface::round(mesh, surface, true_shape(mesh, surface)?);
            SmoothSurface::flat(mesh, surface, off).or_else(round)
        });
        SmoothSurfaces {
            mesh,
            surfaces: surfaces.collect(),
        }
    }

    /// Largest work of a load on a free mode, over the size of the load, that facets may cause
    /// because they are not exactly round: a load that is spread over them does not act exactly
    /// through the centre. Zero if no round surface slides along itself in the mode.
    pub(super) fn work_of_facets(&self, motions: &Motions, mode: &Mode) -> f64 {
        let moved = motions.moved(mode);
        let stays = |node: usize, out: Vector| {
            motions.along(mode, node, out, 0.0).abs() <= SLIDES * mode.largest()
        };
        let slides = |surface: &&SmoothSurface| {
            matches!(surface.shape, SmoothShape::Round(_))
                && surface.nodes.iter().all(|&node| {
                    let out = surface.shape.normal(self.mesh.point(node));
                    moved.contains(&motions.group_of_node[node])
                        && out.is_some_and(|out| stays(node, out))
                })
        };
        let sliding = self.surfaces.iter().filter(slides);
        sliding.map(|s| s.deviation).fold(0.0, f64::max)
    }

    /// Whether pairs hold a mode only because their surfaces deviate from smooth shapes: if each
    /// node had the normal of a round shape, and the normals of planes deviated no more than their
    /// facets do, at least half of the hold would vanish. Returns the largest deviation of these
    /// surfaces: no larger share of a load's size can drive the mode because of them.
    pub(super) fn holding(&self, motions: &Motions, mode: &Mode, pairs: &[Pair]) -> Option<f64> {
        let [mut held, mut left, mut deviation] = [0.0f64; 3];
        for pair in pairs {
            let opening = motions.opening(mode, pair, &|_| pair.normal).abs();
            if opening <= FREE * mode.largest() {
                continue;
            }
            let mut least = opening;
            for surface in self.at(pair) {
                let normal = |node: usize| {
                    let of_shape = surface.shape.normal(self.mesh.point(node));
                    of_shape.unwrap_or(pair.normal)
                };
                let left = match surface.shape {
                    SmoothShape::Round(_) => motions.opening(mode, pair, &normal).abs(),
                    // The normals of a plane's facets deviate by its turn, and so open the gap.
                    SmoothShape::Plane(_) => {
                        let axes = (0..3).map(|d| motions.opening(mode, pair, &|_| unit(d)));
                        let moved = axes.map(|u| u * u).sum::<f64>().sqrt();
                        (opening - 2.0 * surface.turn * moved).max(0.0)
                    }
                };
                if left < least {
                    least = left;
                    deviation = deviation.max(surface.deviation);
                }
            }
            held += opening * opening;
            left += least * least;
        }
        (left <= LEFT * LEFT * held && held > 0.0).then_some(deviation)
    }

    /// The smooth surfaces of a pair from whose normal at the slave the pair's normal deviates no
    /// more than the facets do.
    fn at(&self, pair: &Pair) -> impl Iterator<Item = &SmoothSurface> {
        self.surfaces.iter().filter(|surface| {
            let normal = surface.shape.normal(self.mesh.point(pair.slave));
            let turn = normal.map_or(1.0, |normal| length(cross(normal, pair.normal)));
            turn <= 2.0 * surface.turn && pair.nodes().any(|node| surface.nodes.contains(&node))
        })
    }
}

impl SmoothSurface {
    /// A round surface; `None` if it has no facets, or the curve is no round shape there.
    fn round(mesh: &Mesh, surface: &Surface, curve: Curve) -> Option<Self> {
        let mut nodes = BTreeSet::new();
        let [mut deviation, mut turn] = [0.0f64; 2];
        for &facet in &surface.facets {
            let points: Vec<Vector> = mesh.facet_nodes(facet).map(|n| mesh.point(n)).collect();
            let sum = points.iter().fold([0.0; 3], |sum, x| along(sum, 1.0, *x));
            let middle = sum.map(|s| s / points.len() as f64);
            let (_, radius, _) = curve.spine(middle)?;
            let reach = points.iter().map(|x| length(difference(*x, middle)));
            let half = reach.fold(0.0, f64::max) / radius;
            // A chord of half length `half`, in units of the radius, lies `half^2 / 2` below the
            // arc; a parabola through the middle node leaves about the square of this.
            let order = if mesh.shapes[facet.element].is_quadratic() {
                2
            } else {
                1
            };
            deviation = deviation.max((half * half / 2.0).powi(order));
            turn = turn.max(half);
            nodes.extend(mesh.facet_nodes(facet));
        }
        let shape = SmoothShape::Round(curve);
        SmoothSurface::new(shape, nodes, [deviation, turn])
    }

    /// A flat surface; `None` if its facets are not in one plane, to within what places of nodes
    /// that are off by `off` explain.
    fn flat(mesh: &Mesh, surface: &Surface, off: f64) -> Option<Self> {
        let normals = surface.facets.iter().map(|&facet| area_normal(mesh, facet));
        let sum = normals.clone().fold([0.0; 3], |sum, n| along(sum, 1.0, n));
        // The normals of a closed surface have no mean.
        let size: f64 = normals.clone().map(length).sum();
        if length(sum) < 0.5 * size {
            return None;
        }
        let normal = direction(sum);
        let mut turn = 0.0f64;
        for (&facet, own) in surface.facets.iter().zip(normals) {
            let most = (FLAT * off / shortest_edge(mesh, facet) + ROUND_OFF).min(BENT);
            if length(cross(direction(own), normal)) > most {
                return None;
            }
            turn = turn.max(most);
        }
        let nodes = surface
            .facets
            .iter()
            .flat_map(|&facet| mesh.facet_nodes(facet));
        let shape = SmoothShape::Plane(normal);
        SmoothSurface::new(shape, nodes.collect(), [turn, turn])
    }

    fn new(
        shape: SmoothShape,
        nodes: BTreeSet<usize>,
        [deviation, turn]: [f64; 2],
    ) -> Option<Self> {
        (!nodes.is_empty()).then_some(SmoothSurface {
            shape,
            nodes,
            deviation,
            turn,
        })
    }
}

/// Least distance between neighbouring corners of a facet.
fn shortest_edge(mesh: &Mesh, facet: Facet) -> f64 {
    let n = mesh.facet_corners(facet);
    let corners: Vec<Vector> = mesh
        .facet_nodes(facet)
        .take(n)
        .map(|c| mesh.point(c))
        .collect();
    let edges = (0..n).map(|k| length(difference(corners[k], corners[(k + 1) % n])));
    edges.fold(f64::INFINITY, f64::min)
}

/// Normal at the centre of a facet, times its size.
fn area_normal(mesh: &Mesh, facet: Facet) -> Vector {
    let points: Vec<Vector> = mesh.facet_nodes(facet).map(|n| mesh.point(n)).collect();
    let reference = mesh.facet_reference(facet);
    reference.area(&(reference.functions)(reference.center()), &points)
}
