//! Conformity of the elements: shared edges agree, elements do not overlap, no node hangs on an
//! edge.

use super::{Facet, Mesh};
use crate::space::{self, Vector, cross, difference, dot, length};
use crate::{Error, Result};
use rayon::prelude::*;

/// Least number of facets per thread: fewer facets take less time than waking the thread.
const GRAIN: usize = 512;

/// A facet identified by its corners, in ascending order and padded.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct FacetCorners {
    corners: [u32; MOST_CORNERS],
    facet: Facet,
}

/// Largest number of corners of a facet.
const MOST_CORNERS: usize = 4;

/// Checks that each facet belongs to one element, or to two on opposite sides with the same
/// mid-side nodes, and that no corner of a body's boundary lies inside another boundary edge of
/// that body.
///
/// # Errors
/// `Input`, naming the elements, nodes and body.
pub(super) fn check(mesh: &Mesh) -> Result<()> {
    let mut sides: Vec<FacetCorners> = (0..mesh.n_elements())
        .flat_map(|element| {
            (0..mesh.shapes[element].n_facets()).map(move |local| Facet { element, local })
        })
        .map(|facet| {
            let mut corners = [u32::MAX; MOST_CORNERS];
            for (place, corner) in corners.iter_mut().zip(corners_of(mesh, facet)) {
                *place = corner;
            }
            corners.sort_unstable();
            FacetCorners { corners, facet }
        })
        .collect();
    sides.par_sort_unstable();
    let mut boundary = Vec::new();
    for group in sides.chunk_by(|a, b| a.corners == b.corners) {
        match group {
            [only] => boundary.push(only.facet),
            [first, second] => check_pair(mesh, first.facet, second.facet)?,
            [first, second, third, ..] => {
                // Two of three facets lie on the same side; comparing all three pairs gives the
                // better message for duplicate elements.
                check_pair(mesh, first.facet, second.facet)?;
                check_pair(mesh, second.facet, third.facet)?;
                check_pair(mesh, first.facet, third.facet)?;
            }
            [] => {}
        }
    }
    check_hanging(mesh, &boundary)
}

/// The corners of a facet, in the facet's own order.
fn corners_of(mesh: &Mesh, facet: Facet) -> impl Iterator<Item = u32> + Clone + '_ {
    let corners = mesh.facet_corners(facet);
    mesh.facet_nodes(facet)
        .take(corners)
        .map(|node| node as u32)
}

/// The mid-side nodes of a facet, in ascending order.
fn middles(mesh: &Mesh, facet: Facet) -> Vec<u32> {
    let corners = mesh.facet_corners(facet);
    let nodes = mesh.facet_nodes(facet).skip(corners);
    let mut middles: Vec<u32> = nodes.map(|node| node as u32).collect();
    middles.sort_unstable();
    middles
}

/// Whether two facets with the same corners run through them in opposite directions, as the facets
/// of elements on opposite sides do.
fn are_opposite(mesh: &Mesh, first: Facet, second: Facet) -> bool {
    let (one, mut other): (Vec<u32>, Vec<u32>) = (
        corners_of(mesh, first).collect(),
        corners_of(mesh, second).collect(),
    );
    other.reverse();
    if let [.., _, _, _] = one[..]
        && let Some(start) = other.iter().position(|node| *node == one[0])
    {
        other.rotate_left(start);
    }
    one == other
}

fn name(mesh: &Mesh, element: usize) -> String {
    format!(
        "element {} (body `{}`)",
        mesh.element_label(element),
        mesh.bodies[mesh.element_body[element] as usize]
    )
}

/// Checks that two elements sharing a facet lie on opposite sides of it and have the same mid-side
/// nodes there.
fn check_pair(mesh: &Mesh, first: Facet, second: Facet) -> Result<()> {
    let same_side = !are_opposite(mesh, first, second);
    let (m, n) = (middles(mesh, first), middles(mesh, second));
    if !same_side && m == n {
        return Ok(());
    }
    let edge = described(mesh, first);
    let (one, two) = (name(mesh, first.element), name(mesh, second.element));
    if same_side {
        let corners = |element: usize| {
            let n = mesh.shapes[element].n_corners();
            let mut corners = mesh.nodes(element)[..n].to_vec();
            corners.sort_unstable();
            corners
        };
        return Err(Error::input(
            if corners(first.element) == corners(second.element) {
                format!("{one} and {two} have the same corners: remove one of them")
            } else {
                format!("{one} and {two} overlap: both lie on the same side of {edge}")
            },
        ));
    }
    let differing = m.iter().find(|node| !n.contains(node));
    match (differing, n.iter().find(|node| !m.contains(node))) {
        (Some(m), Some(n)) => Err(Error::input(format!(
            "{one} and {two} share {edge} but have different mid-side nodes {} and {} there: merge \
             them",
            mesh.node_label(*m as usize),
            mesh.node_label(*n as usize)
        ))),
        _ => Err(Error::input(format!(
            "{one} ({}) and {two} ({}) share {edge} but only one has a mid-side node there: \
             mesh both with the same order",
            mesh.shapes[first.element].name(),
            mesh.shapes[second.element].name()
        ))),
    }
}

/// Describes a facet in words by its corners.
fn described(mesh: &Mesh, facet: Facet) -> String {
    let labels: Vec<String> = corners_of(mesh, facet)
        .map(|node| mesh.node_label(node as usize).to_string())
        .collect();
    match &labels[..] {
        [a, b] => format!("the edge between nodes {a} and {b}"),
        _ => format!("the face of nodes {}", labels.join(", ")),
    }
}

/// Distance from an edge, as a fraction of the edge's length, within which a corner of the boundary
/// counts as lying on the edge.
const ON_EDGE: f64 = 1e-8;

/// Finds boundary corners in the interior of a boundary edge of the same body.
fn check_hanging(mesh: &Mesh, boundary: &[Facet]) -> Result<()> {
    // Few boundary nodes share a coordinate along this skew direction, even if the boundary is
    // parallel to an axis. Sorting by the skew coordinate therefore finds neighbours.
    let skew = |[x, y, z]: Vector| x + 0.618_033_988_749_895 * y + 0.381_966_011_250_105 * z;
    let mut edges: Vec<(u32, [u32; 2], usize)> = boundary
        .iter()
        .flat_map(|&facet| {
            let corners: Vec<u32> = corners_of(mesh, facet).collect();
            let n = corners.len();
            let body = mesh.element_body[facet.element];
            // A facet with two corners is a single edge.
            let edge = move |k: usize| (body, [corners[k], corners[(k + 1) % n]], facet.element);
            (0..if n == 2 { 1 } else { n }).map(edge)
        })
        .collect();
    if mesh.is_solid() {
        // In a solid, two faces meet at each edge, so duplicates are removed.
        edges
            .iter_mut()
            .for_each(|(_, ends, _)| ends.sort_unstable());
        edges.par_sort_unstable();
        edges.dedup_by_key(|(body, ends, _)| (*body, *ends));
    }
    let mut corners: Vec<(u32, f64, u32)> = edges
        .iter()
        .flat_map(|&(body, ends, _)| ends.map(|node| (body, node)))
        .map(|(body, node)| (body, skew(mesh.point(node as usize)), node))
        .collect();
    corners
        .par_sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
    corners.dedup();
    let hanging = edges.par_iter().with_min_len(GRAIN);
    let hanging = hanging.find_map_first(|&(body, ends, element)| {
        let [p, q] = ends.map(|node| mesh.point(node as usize));
        let d = difference(q, p);
        let length = length(d);
        let (s, t) = (skew(p), skew(q));
        let slack = 2.0 * ON_EDGE * length;
        let (low, high) = (s.min(t) - slack, s.max(t) + slack);
        let start = corners.partition_point(|c| (c.0, c.1) < (body, low));
        corners[start..]
            .iter()
            .take_while(|c| c.0 == body && c.1 <= high)
            .find(|c| {
                let e = difference(mesh.point(c.2 as usize), p);
                let along = dot(e, d) / length;
                let across = space::length(cross(e, d)) / length;
                across <= ON_EDGE * length
                    && along > ON_EDGE * length
                    && along < (1.0 - ON_EDGE) * length
            })
            .map(|c| (ends, element, c.2))
    });
    let Some(([a, b], element, node)) = hanging else {
        return Ok(());
    };
    Err(Error::input(format!(
        "node {} hangs on the edge between nodes {} and {} of {}: refine that element or join the \
         node with others, so that neighbouring elements share whole edges",
        mesh.node_label(node as usize),
        mesh.node_label(a as usize),
        mesh.node_label(b as usize),
        name(mesh, element)
    )))
}
