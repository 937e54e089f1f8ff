//! Surfaces as curves: their nodes in order, their normals.

use super::{Curve, Facet, Mesh, Surface};
use crate::{Error, Result};
use std::collections::BTreeMap;

/// Two nodes pair if their distance across the normal is below this share of a facet's length.
pub const PAIRING: f64 = 1e-5;

/// The nodes of a surface along its arc, mid-side nodes included, with the body on the left (a hole
/// is run through clockwise). A closed surface begins at its smallest node index and does not
/// repeat it.
///
/// # Errors
/// An input error if the surface is empty, branches, or has several pieces; it names nodes.
pub fn ordered_nodes(mesh: &Mesh, surface: &Surface) -> Result<Vec<usize>> {
    let ends = |facet: Facet| {
        let mut nodes = mesh.facet_nodes(facet);
        (nodes.next(), nodes.next())
    };
    let mut leaving: BTreeMap<usize, Facet> = BTreeMap::new();
    let mut entered: BTreeMap<usize, Facet> = BTreeMap::new();
    for &facet in &surface.facets {
        let (Some(from), Some(to)) = ends(facet) else {
            continue;
        };
        for (node, other) in [
            (from, leaving.insert(from, facet)),
            (to, entered.insert(to, facet)),
        ] {
            if let Some(other) = other {
                return Err(Error::input(format!(
                    "the surface branches at node {} (elements {} and {}): \
                     a surface must be one curve",
                    mesh.node_label(node),
                    mesh.element_label(other.element),
                    mesh.element_label(facet.element)
                )));
            }
        }
    }
    let starts: Vec<usize> = leaving
        .keys()
        .filter(|node| !entered.contains_key(node))
        .copied()
        .collect();
    let Some(&start) = starts.first().or_else(|| leaving.keys().next()) else {
        return Err(Error::input("the surface is empty"));
    };
    let mut nodes = vec![start];
    let mut at = start;
    while let Some(facet) = leaving.remove(&at) {
        if let (_, Some(to)) = ends(facet) {
            nodes.extend(mesh.facet_nodes(facet).nth(2));
            at = to;
            if at != start {
                nodes.push(at);
            }
        }
    }
    match leaving.keys().next() {
        None => Ok(nodes),
        Some(&rest) => Err(Error::input(format!(
            "the surface has several pieces ({} of {} edges belong to the one that begins at node {}, \
             another holds node {}): make each piece a surface of its own",
            surface.facets.len() - leaving.len(),
            surface.facets.len(),
            mesh.node_label(start),
            mesh.node_label(
                starts
                    .iter()
                    .find(|&&n| n != start)
                    .copied()
                    .unwrap_or(rest)
            )
        ))),
    }
}

/// Outward unit normals of a surface at some of its nodes.
///
/// Exact where the surface's [`Curve`] is known. Otherwise the mean of the normals of the facets
/// that meet at the node, weighted with their lengths; the normal of a facet with a mid-side node
/// is that of its parabola at the node. The body lies on the left of a facet, so the normal of a
/// facet from `p` to `q` is `(q - p)` turned clockwise by 90 degrees. A node that is not on the
/// surface gets `[0, 0]`.
pub fn normals(mesh: &Mesh, surface: &Surface, nodes: &[usize]) -> Vec<[f64; 2]> {
    match surface.curve {
        Some(Curve::Line { normal }) => vec![unit(normal); nodes.len()],
        Some(Curve::Circle {
            center, outward, ..
        }) => {
            let sign = if outward { 1.0 } else { -1.0 };
            nodes
                .iter()
                .map(|&node| {
                    let [x, y] = mesh.point(node);
                    unit([sign * (x - center[0]), sign * (y - center[1])])
                })
                .collect()
        }
        None => {
            let mut sums: BTreeMap<usize, [f64; 2]> = BTreeMap::new();
            for &facet in &surface.facets {
                add_tangents(mesh, facet, &mut sums);
            }
            nodes
                .iter()
                .map(|node| match sums.get(node) {
                    Some(&[tx, ty]) => unit([ty, 0.0 - tx]),
                    None => [0.0, 0.0],
                })
                .collect()
        }
    }
}

/// Adds the tangents of a facet at its nodes, with the length of the facet.
fn add_tangents(mesh: &Mesh, facet: Facet, sums: &mut BTreeMap<usize, [f64; 2]>) {
    let mut add = |node: usize, tangent: [f64; 2]| {
        let sum = sums.entry(node).or_default();
        sum[0] += tangent[0];
        sum[1] += tangent[1];
    };
    let mut nodes = mesh.facet_nodes(facet);
    let (Some(a), Some(b)) = (nodes.next(), nodes.next()) else {
        return;
    };
    let (p, q) = (mesh.point(a), mesh.point(b));
    let chord = [q[0] - p[0], q[1] - p[1]];
    let Some(m) = nodes.next() else {
        add(a, chord);
        add(b, chord);
        return;
    };
    // The parabola through p, m, q has the tangents chord + 4 sag at p, chord at m, chord - 4 sag
    // at q.
    let at = mesh.point(m);
    let sag = [0, 1].map(|k| at[k] - 0.5 * (p[k] + q[k]));
    add(a, [0, 1].map(|k| chord[k] + 4.0 * sag[k]));
    add(m, chord);
    add(b, [0, 1].map(|k| chord[k] - 4.0 * sag[k]));
}

/// The index of the node of `candidates` on the line through `x` along the unit vector `normal`,
/// off it by `tolerance` at most; the nearest if there are several.
pub fn facing(
    mesh: &Mesh,
    x: [f64; 2],
    normal: [f64; 2],
    candidates: &[usize],
    tolerance: f64,
) -> Option<usize> {
    let mut best: Option<(f64, usize)> = None;
    for (i, &node) in candidates.iter().enumerate() {
        let y = mesh.point(node);
        let d = [y[0] - x[0], y[1] - x[1]];
        let across = (d[0] * normal[1] - d[1] * normal[0]).abs();
        let along = (d[0] * normal[0] + d[1] * normal[1]).abs();
        if across <= tolerance && best.is_none_or(|(b, _)| along < b) {
            best = Some((along, i));
        }
    }
    best.map(|(_, i)| i)
}

/// Length of the longest facet of a surface.
pub fn longest_facet(mesh: &Mesh, surface: &Surface) -> f64 {
    surface
        .facets
        .iter()
        .map(|&f| {
            let ends: Vec<[f64; 2]> = mesh.facet_nodes(f).take(2).map(|n| mesh.point(n)).collect();
            (ends[1][0] - ends[0][0]).hypot(ends[1][1] - ends[0][1])
        })
        .fold(0.0, f64::max)
}

fn unit([x, y]: [f64; 2]) -> [f64; 2] {
    let length = x.hypot(y);
    if length > 0.0 {
        [x / length, y / length]
    } else {
        [0.0, 0.0]
    }
}

#[cfg(test)]
mod tests;
