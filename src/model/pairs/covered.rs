//! Parts of the faces of a slave surface that the other surface covers.

use super::Pair;
use crate::mesh::{Mesh, Surface};
use crate::space::{Vector, difference, dot, length};
use std::collections::BTreeMap;

/// Covered parts of those facets of the slave surface that are covered only partly, by the number
/// of the facet.
pub(super) type Covered = BTreeMap<usize, CoveredFacet>;

/// Covered polygons of a facet, for each piece of the facet between its nodes.
pub(super) type CoveredFacet = Vec<Vec<Vec<Vector>>>;

/// Pieces of faces of a solid's slave surface; see [`super::ContactSurface`].
#[derive(Default)]
pub(super) struct Pieces {
    pub(super) faces: Vec<Vec<usize>>,
    pub(super) covered: BTreeMap<usize, Vec<Vec<Vector>>>,
    pub(super) slivers: Vec<(Vec<usize>, Vec<Vec<Vector>>)>,
}

impl Pieces {
    /// Splits a surface into pieces with the pairs from number `start` on. A linear face is one
    /// piece; the nodes of a quadratic face are the corners of several pieces.
    pub(super) fn new(
        mesh: &Mesh,
        surface: &Surface,
        found: &Covered,
        (pairs, start): (&[Pair], usize),
    ) -> Self {
        let mut out = Pieces::default();
        if !mesh.is_solid() {
            return out;
        }
        let numbers = start..start + pairs.len();
        let of_node: BTreeMap<usize, usize> = pairs.iter().map(|p| p.slave).zip(numbers).collect();
        for (number, facet) in surface.facets.iter().enumerate() {
            let nodes: Vec<usize> = mesh.facet_nodes(*facet).collect();
            let known = |node: &usize| of_node.get(node).copied();
            let all: Vec<usize> = nodes.iter().filter_map(known).collect();
            if all.is_empty() {
                continue;
            }
            for (k, piece) in mesh.facet_reference(*facet).pieces().iter().enumerate() {
                let corners: Vec<usize> = piece.iter().filter_map(|&i| known(&nodes[i])).collect();
                let of_piece = |pieces: &Vec<_>| pieces.get(k).cloned().unwrap_or_default();
                let parts: Option<Vec<Vec<Vector>>> = found.get(&number).map(of_piece);
                match parts {
                    parts if corners.len() == piece.len() => {
                        out.covered
                            .extend(parts.map(|parts| (out.faces.len(), parts)));
                        out.faces.push(corners);
                    }
                    Some(parts) if !parts.is_empty() => {
                        let near = if corners.is_empty() {
                            all.clone()
                        } else {
                            corners
                        };
                        out.slivers.push((near, parts));
                    }
                    _ => {}
                }
            }
        }
        out
    }
}

/// Finds [`super::ContactSurface::extent`]: for partly covered facets from the ends of the covered
/// part, for other facets from the ends of their pairs.
pub(super) fn extent(
    mesh: &Mesh,
    surface: &Surface,
    pairs: &[Pair],
    found: &Covered,
) -> Option<[f64; 2]> {
    if mesh.is_solid() || found.is_empty() {
        return None;
    }
    let arc_of: BTreeMap<usize, f64> = pairs.iter().map(|p| (p.slave, p.arc)).collect();
    let [first_arc, last_arc] = [pairs.first()?, pairs.last()?].map(|pair| pair.arc);
    let mut arcs = Vec::new();
    for (number, facet) in surface.facets.iter().enumerate() {
        let nodes = mesh.facet_nodes(*facet);
        let known = nodes.filter_map(|node| Some((arc_of.get(&node).copied()?, mesh.point(node))));
        let mut known: Vec<(f64, Vector)> = known.collect();
        known.sort_by(|a, b| a.0.total_cmp(&b.0));
        let [Some(&low), Some(&high)] = [known.first(), known.last()] else {
            continue;
        };
        let Some(parts) = found.get(&number) else {
            arcs.extend([low.0, high.0]);
            continue;
        };
        let way = difference(high.1, low.1);
        arcs.extend(parts.iter().flatten().flatten().filter_map(|&point| {
            let from = difference(point, low.1);
            match low.0 < high.0 {
                true => Some(low.0 + dot(from, way) / dot(way, way) * (high.0 - low.0)),
                // The covered part reaches beyond the last pair.
                false if low.0 == last_arc && low.0 > first_arc => Some(low.0 + length(from)),
                false if low.0 == first_arc && low.0 < last_arc => Some(low.0 - length(from)),
                false => None,
            }
        }));
    }
    let low = arcs.iter().copied().reduce(f64::min)?;
    let high = arcs.iter().copied().reduce(f64::max)?;
    (low < high).then_some([low, high])
}
