//! Surfaces as curves: their nodes in order, their normals.

use super::{Curve, Facet, Mesh, Surface};
use crate::space::{Vector, cross, dot, in_space, length};
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
/// that meet at the node, weighted with their areas; the normal of a curved facet is that at the
/// node. The body lies on the left of a facet, so the normal of a facet from `p` to `q` is
/// `(q - p)` turned clockwise by 90 degrees. A node that is not on the surface gets `[0, 0]`.
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
            let mut sums: BTreeMap<usize, Vector> = BTreeMap::new();
            for &facet in &surface.facets {
                add_areas(mesh, facet, &mut sums);
            }
            nodes
                .iter()
                .map(|node| sums.get(node).map_or([0.0; 2], |&[x, y, _]| unit([x, y])))
                .collect()
        }
    }
}

/// Adds the area vectors of a facet at its nodes: the product of its tangents there, the second
/// of which is out of the plane.
fn add_areas(mesh: &Mesh, facet: Facet, sums: &mut BTreeMap<usize, Vector>) {
    const OUT_OF_PLANE: Vector = [0.0, 0.0, 1.0];
    let reference = mesh.shapes[facet.element].reference().facet;
    let nodes = || mesh.facet_nodes(facet);
    let Some(first) = nodes().next() else { return };
    let origin = mesh.place(first);
    for (node, &s) in nodes().zip(reference.nodes) {
        let (_, slopes) = (reference.functions)(s);
        let mut tangent = [0.0; 3];
        for (other, slope) in nodes().zip(slopes) {
            let place = mesh.place(other);
            (0..3).for_each(|d| tangent[d] += slope * (place[d] - origin[d]));
        }
        let area = cross(tangent, OUT_OF_PLANE);
        let sum = sums.entry(node).or_default();
        (0..3).for_each(|d| sum[d] += area[d]);
    }
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
    let (x, normal) = (in_space(x), in_space(normal));
    let mut best: Option<(f64, usize)> = None;
    for (i, &node) in candidates.iter().enumerate() {
        let place = mesh.place(node);
        let way: Vector = std::array::from_fn(|d| place[d] - x[d]);
        let across = length(cross(way, normal));
        let along = dot(way, normal).abs();
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
