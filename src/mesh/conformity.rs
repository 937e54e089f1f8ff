//! Do elements fit together? Shared edges agree, elements do not overlap, no node hangs on an edge.

use super::{Facet, Mesh};
use crate::{Error, Result};
use rayon::prelude::*;

/// Facets that a thread takes at a time: fewer take less than waking it.
const GRAIN: usize = 512;

/// A facet by its two end nodes, the smaller first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Edge {
    low: u32,
    high: u32,
    facet: Facet,
}

/// Checks that each edge belongs to one element, or to two on opposite sides with the same mid-side
/// node, and that no corner of a body's boundary lies inside another boundary edge of that body.
///
/// # Errors
/// Input errors name elements, nodes and body.
pub(super) fn check(mesh: &Mesh) -> Result<()> {
    let mut edges: Vec<Edge> = (0..mesh.n_elements())
        .flat_map(|element| {
            (0..mesh.shapes[element].n_facets()).map(move |local| Facet { element, local })
        })
        .map(|facet| {
            let [a, b] = ends(mesh, facet);
            Edge {
                low: a.min(b),
                high: a.max(b),
                facet,
            }
        })
        .collect();
    edges.par_sort_unstable();
    let mut boundary = Vec::new();
    for group in edges.chunk_by(|e, f| (e.low, e.high) == (f.low, f.high)) {
        match group {
            [only] => boundary.push(only.facet),
            [first, second] => check_pair(mesh, first.facet, second.facet)?,
            [first, second, third, ..] => {
                // Two of three lie on the same side; a duplicate has the better message.
                check_pair(mesh, first.facet, second.facet)?;
                check_pair(mesh, second.facet, third.facet)?;
                check_pair(mesh, first.facet, third.facet)?;
            }
            [] => {}
        }
    }
    check_hanging(mesh, &boundary)
}

fn ends(mesh: &Mesh, facet: Facet) -> [u32; 2] {
    let local = mesh.shapes[facet.element].facet(facet.local);
    let nodes = mesh.nodes(facet.element);
    [nodes[local[0]], nodes[local[1]]]
}

fn middle(mesh: &Mesh, facet: Facet) -> Option<u32> {
    let local = mesh.shapes[facet.element].facet(facet.local);
    local.get(2).map(|&i| mesh.nodes(facet.element)[i])
}

fn name(mesh: &Mesh, element: usize) -> String {
    format!(
        "element {} (body `{}`)",
        mesh.element_label(element),
        mesh.bodies[mesh.element_body[element] as usize]
    )
}

/// Two elements at one edge must lie on its two sides and agree on its mid-side node.
fn check_pair(mesh: &Mesh, first: Facet, second: Facet) -> Result<()> {
    let [a, b] = ends(mesh, first);
    let same_side = ends(mesh, second) == [a, b];
    let middles = (middle(mesh, first), middle(mesh, second));
    if !same_side && middles.0 == middles.1 {
        return Ok(());
    }
    let edge = format!(
        "the edge between nodes {} and {}",
        mesh.node_label(a as usize),
        mesh.node_label(b as usize)
    );
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
    match middles {
        (Some(m), Some(n)) => Err(Error::input(format!(
            "{one} and {two} share {edge} but have different mid-side nodes {} and {} there: merge them",
            mesh.node_label(m as usize),
            mesh.node_label(n as usize)
        ))),
        _ => Err(Error::input(format!(
            "{one} ({}) and {two} ({}) share {edge} but only one has a mid-side node there: \
             mesh both with the same order",
            mesh.shapes[first.element].name(),
            mesh.shapes[second.element].name()
        ))),
    }
}

/// Corners of the boundary within this share of an edge's length from it count as lying on it.
const ON_EDGE: f64 = 1e-8;

/// Finds boundary corners in the inside of a boundary edge of the same body.
fn check_hanging(mesh: &Mesh, boundary: &[Facet]) -> Result<()> {
    // Along this skew direction few boundary nodes share a value even where the boundary is
    // parallel to an axis, so that sorting by it finds neighbours.
    let skew = |[x, y]: [f64; 2]| x + 0.618_033_988_749_895 * y;
    let body = |facet: &Facet| mesh.element_body[facet.element];
    let mut corners: Vec<(u32, f64, u32)> = boundary
        .iter()
        .flat_map(|facet| ends(mesh, *facet).map(|node| (body(facet), node)))
        .map(|(body, node)| (body, skew(mesh.point(node as usize)), node))
        .collect();
    corners
        .par_sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
    corners.dedup();
    let facets = boundary.par_iter().with_min_len(GRAIN);
    let hanging = facets.find_map_first(|facet| {
        let [a, b] = ends(mesh, *facet);
        let (p, q) = (mesh.point(a as usize), mesh.point(b as usize));
        let d = [q[0] - p[0], q[1] - p[1]];
        let length = d[0].hypot(d[1]);
        let (s, t) = (skew(p), skew(q));
        let slack = 2.0 * ON_EDGE * length;
        let (low, high) = (s.min(t) - slack, s.max(t) + slack);
        let start = corners.partition_point(|c| (c.0, c.1) < (body(facet), low));
        corners[start..]
            .iter()
            .take_while(|c| c.0 == body(facet) && c.1 <= high)
            .find(|c| {
                let r = mesh.point(c.2 as usize);
                let e = [r[0] - p[0], r[1] - p[1]];
                let along = (e[0] * d[0] + e[1] * d[1]) / length;
                let across = (e[0] * d[1] - e[1] * d[0]).abs() / length;
                across <= ON_EDGE * length
                    && along > ON_EDGE * length
                    && along < (1.0 - ON_EDGE) * length
            })
            .map(|c| (*facet, c.2))
    });
    let Some((facet, node)) = hanging else {
        return Ok(());
    };
    let [a, b] = ends(mesh, facet);
    Err(Error::input(format!(
        "node {} hangs on the edge between nodes {} and {} of {}: refine that element or join the \
         node with others, so that neighbouring elements share whole edges",
        mesh.node_label(node as usize),
        mesh.node_label(a as usize),
        mesh.node_label(b as usize),
        name(mesh, facet.element)
    )))
}
