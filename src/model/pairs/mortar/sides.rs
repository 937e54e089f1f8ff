//! Both surfaces of a mortar coupling, and where lines along normals meet their true shapes.

use super::super::contact_input::ContactInput;
use super::face::{FacePlane, MortarFace};
use crate::balls::Balls;
use crate::mesh::Curve;
use crate::space::{Vector, along, difference, dot, length};
use std::collections::BTreeMap;

/// Fraction of a facet by which a point on the border of two facets may lie outside either.
const BORDER: f64 = 1e-6;

/// Facets of both surfaces with their true shapes.
pub(super) struct Sides<'a> {
    pub(super) entries: &'a ContactInput<'a>,
    pub(super) slaves: Vec<MortarFace>,
    pub(super) masters: Vec<MortarFace>,
    /// Balls around the masters, to find the masters near a line.
    pub(super) near: Balls,
    /// Exact shapes of slave and master, if known.
    pub(super) curves: [Option<Curve>; 2],
    /// Unit normal of each slave node.
    pub(super) normals: BTreeMap<usize, Vector>,
}

/// Place at which the line along a slave's normal meets a master facet: the gap, and the nodes of
/// the facet with their weights.
pub(super) struct Met {
    pub gap: f64,
    pub masters: Vec<(usize, f64)>,
}

impl Sides<'_> {
    /// Finds the nearest of some master facets that the line along a slave's normal meets, and the
    /// gap there.
    pub(super) fn meet(&self, node: usize, normal: Vector, faced: &[usize]) -> Option<Met> {
        let mesh = self.entries.mesh;
        let x = mesh.point(node);
        let plane = FacePlane::new(x, normal, mesh.is_solid());
        let mut nearest: Option<(f64, Met)> = None;
        for &number in faced {
            let face = &self.masters[number];
            if dot(face.normal, normal) >= 0.0 {
                continue;
            }
            let Some(place) = face
                .locate(&plane, [0.0; 2])
                .filter(|&place| face.holds(place, BORDER))
            else {
                continue;
            };
            let (y, values) = face.at(place);
            let far = dot(difference(y, x), normal).abs();
            if nearest.as_ref().is_none_or(|(known, _)| far < *known) {
                let [own, other] = [(0, x), (1, y)].map(|(side, x)| self.truly(side, x, normal));
                let met = Met {
                    gap: dot(difference(other, own), normal),
                    masters: face.nodes.iter().copied().zip(values).collect(),
                };
                nearest = Some((far, met));
            }
        }
        nearest.map(|(_, met)| met)
    }

    /// Point at which the line through a point of a mesh's surface along a direction meets the true
    /// surface of the slave (0) or of the master (1).
    pub(super) fn truly(&self, side: usize, x: Vector, way: Vector) -> Vector {
        let Some(curve) = self.curves[side] else {
            return x;
        };
        let mut at = x;
        // Newton's method for the distance from the surface; it starts close, on a facet.
        for _ in 0..20 {
            let Some((from, radius, outward)) = curve.spine(at) else {
                return x;
            };
            let out = difference(at, from);
            let off = length(out) - radius;
            let sign = if outward { 1.0 } else { -1.0 };
            let slope = sign * dot(curve.normal(at), way);
            if slope.abs() < 0.1 {
                return x;
            }
            at = along(at, -off / slope, way);
            if off.abs() <= 4.0 * f64::EPSILON * radius {
                break;
            }
        }
        at
    }
}
