//! A facet for mortar integrals: projected along a direction, and mapped back.

use super::overlap::{self, Point};
use crate::mesh::{Facet, Mesh};
use crate::shape::{FacetReference, MAX_FACET_NODES, Place};
use crate::space::{Vector, along, cross, difference, direction, dot, length, unit};

/// Cosine by which the normals of facets that face each other must be opposed: a facet seen more
/// obliquely is no surface to press on.
const OPPOSED: f64 = 0.2;
/// Largest number of Newton steps to locate a point; a straight facet needs one step.
const STEPS: usize = 30;

/// A facet of a surface with its outward normal.
pub(super) struct MortarFace {
    pub reference: &'static FacetReference,
    pub nodes: Vec<usize>,
    pub x: Vec<Vector>,
    pub center: Vector,
    /// Outward unit normal at the centre.
    pub normal: Vector,
    /// Radius of a ball around the centre that contains the nodes.
    pub radius: f64,
}

/// A plane at right angles to a direction; in plane models a line.
pub(super) struct FacePlane {
    pub origin: Vector,
    pub normal: Vector,
    axes: [Vector; 2],
}

impl FacePlane {
    pub(super) fn new(origin: Vector, normal: Vector, is_solid: bool) -> Self {
        let axes = if is_solid {
            let least = (0..3).min_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs()));
            let first = direction(cross(unit(least.unwrap_or(0)), normal));
            [first, cross(normal, first)]
        } else {
            // The nodes of a facet run with the body on the left.
            [cross(unit(2), normal), [0.0; 3]]
        };
        FacePlane {
            origin,
            normal,
            axes,
        }
    }

    /// Position in space of a point of the plane.
    pub(super) fn position(&self, point: Point) -> Vector {
        let first = along(self.origin, point[0], self.axes[0]);
        along(first, point[1], self.axes[1])
    }

    pub(super) fn project(&self, x: Vector) -> Point {
        self.axes.map(|axis| dot(difference(x, self.origin), axis))
    }
}

impl MortarFace {
    pub(super) fn new(mesh: &Mesh, facet: Facet) -> Self {
        let reference = mesh.facet_reference(facet);
        let nodes: Vec<usize> = mesh.facet_nodes(facet).collect();
        let x: Vec<Vector> = nodes.iter().map(|&node| mesh.point(node)).collect();
        let at = (reference.functions)(reference.center());
        let center = position(&at.values, &x);
        let normal = direction(reference.area(&at, &x));
        let radius = x
            .iter()
            .map(|&x| length(difference(x, center)))
            .fold(0.0, f64::max);
        MortarFace {
            reference,
            nodes,
            x,
            center,
            normal,
            radius,
        }
    }

    /// Centre and radius of a ball around the facet.
    pub(super) fn ball(&self) -> (Vector, f64) {
        (self.center, self.radius)
    }

    pub(super) fn is_solid(&self) -> bool {
        self.reference.dimension() == 2
    }

    /// Whether slaves of the facet have the basis of control points: quadratic facets of solids.
    pub(super) fn is_transformed(&self) -> bool {
        self.is_solid() && self.nodes.len() > self.reference.n_corners
    }

    /// Whether another facet may lie opposite this one.
    pub(super) fn may_face(&self, other: &MortarFace) -> bool {
        if dot(self.normal, other.normal) > -OPPOSED {
            return false;
        }
        let way = difference(other.center, self.center);
        let off = dot(way, self.normal);
        let reach = self.radius + other.radius;
        // The other facet must not lie far behind, on the far side of another body.
        off >= -2.0 * reach && dot(way, way) - off * off <= reach * reach
    }

    /// Position and shape functions at a place in the reference facet.
    pub(super) fn at(&self, place: Place) -> (Vector, [f64; MAX_FACET_NODES]) {
        let at = (self.reference.functions)(place);
        (
            position(&at.values, &self.x),
            std::array::from_fn(|k| at.values[k]),
        )
    }

    /// Place in the reference facet that projects to a point of a plane.
    pub(super) fn locate(&self, plane: &FacePlane, point: Point) -> Option<Place> {
        let mut place = self.reference.center();
        let mut nodes = [[0.0; 2]; MAX_FACET_NODES];
        for (node, &x) in nodes.iter_mut().zip(&self.x) {
            *node = plane.project(x);
        }
        for _ in 0..STEPS {
            let at = (self.reference.functions)(place);
            let (mut off, mut slopes) = (point, [[0.0; 2]; 2]);
            let each = at.values.iter().zip(&at.gradients).zip(&nodes);
            for ((value, gradient), x) in each.take(self.x.len()) {
                for i in 0..2 {
                    off[i] -= value * x[i];
                    for j in 0..2 {
                        slopes[i][j] += gradient[j] * x[i];
                    }
                }
            }
            let step = if self.is_solid() {
                let det = slopes[0][0] * slopes[1][1] - slopes[0][1] * slopes[1][0];
                [
                    (slopes[1][1] * off[0] - slopes[0][1] * off[1]) / det,
                    (slopes[0][0] * off[1] - slopes[1][0] * off[0]) / det,
                ]
            } else {
                [off[0] / slopes[0][0], 0.0]
            };
            if !step.iter().all(|s| s.is_finite()) {
                return None;
            }
            place[0] += step[0];
            place[1] += step[1];
            let size = step[0].abs().max(step[1].abs());
            if size <= 1e-14 {
                return Some(place);
            }
            if size > 1e3 {
                return None;
            }
        }
        // The remaining error is the round-off of a slender facet.
        Some(place)
    }

    /// Whether a place lies in the reference facet, within a tolerance `off`.
    pub(super) fn holds(&self, place: Place, off: f64) -> bool {
        let [a, b, _] = place;
        match (self.reference.dimension(), self.reference.n_corners) {
            (1, _) => a.abs() <= 1.0 + off,
            (_, 3) => a >= -off && b >= -off && a + b <= 1.0 + off,
            _ => a.abs() <= 1.0 + off && b.abs() <= 1.0 + off,
        }
    }

    /// Pieces of the facet projected into a plane, counter-clockwise as seen against the plane's
    /// normal: the facet itself if its edges are straight in the plane, otherwise triangles and a
    /// quadrilateral between all of its nodes.
    pub(super) fn pieces(&self, plane: &FacePlane) -> Vec<Vec<Point>> {
        let points: Vec<Point> = self.x.iter().map(|&x| plane.project(x)).collect();
        let n = self.reference.n_corners;
        let mut pieces: Vec<Vec<Point>> = if self.is_straight(&points) {
            vec![points[..n].to_vec()]
        } else {
            let pieces = self.reference.pieces().iter();
            pieces
                .map(|piece| piece.iter().map(|&k| points[k]).collect())
                .collect()
        };
        if self.is_solid() && dot(self.normal, plane.normal) < 0.0 {
            pieces.iter_mut().for_each(|piece| piece.reverse());
        }
        pieces
    }

    /// Cuts a polygon to each piece between the nodes of the facet, in the order of
    /// [`FacetReference::pieces`]; a line is one piece.
    pub(super) fn by_pieces(&self, plane: &FacePlane, polygon: &[Point]) -> Vec<Vec<Point>> {
        if !self.is_solid() {
            return vec![polygon.to_vec()];
        }
        let points: Vec<Point> = self.x.iter().map(|&x| plane.project(x)).collect();
        let pieces = self.reference.pieces().iter();
        let of_piece = |piece: &&[usize]| -> Vec<Point> {
            let mut corners: Vec<Point> = piece.iter().map(|&k| points[k]).collect();
            if dot(self.normal, plane.normal) < 0.0 {
                corners.reverse();
            }
            overlap::common(&corners, polygon)
        };
        pieces.map(of_piece).collect()
    }

    /// Whether middle nodes lie on the chords of their edges.
    fn is_straight(&self, points: &[Point]) -> bool {
        let n = self.reference.n_corners;
        let off = |(k, middle): (usize, &Point)| {
            let [a, b] = [points[k], points[(k + 1) % n]];
            let way = [b[0] - a[0], b[1] - a[1]];
            let across = way[0] * (middle[1] - a[1]) - way[1] * (middle[0] - a[0]);
            across.abs() / (way[0] * way[0] + way[1] * way[1])
        };
        !self.is_solid()
            || points[n..]
                .iter()
                .enumerate()
                .map(off)
                .all(|off| off <= STRAIGHT)
    }
}

/// Fraction of an edge's length by which its middle may deviate from the chord.
const STRAIGHT: f64 = 1e-9;

fn position(values: &[f64], x: &[Vector]) -> Vector {
    let each = values.iter().zip(x);
    each.fold([0.0; 3], |sum, (&value, &x)| along(sum, value, x))
}
