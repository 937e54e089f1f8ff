//! Surfaces: their ordered nodes and their normals.

use super::{Facet, Mesh, Surface};
use crate::space::{Vector, cross, difference, direction, dot, length};
use crate::{Error, Result};
use std::collections::BTreeMap;

/// Largest distance of two paired nodes across the normal, as a fraction of a facet's length.
pub const PAIRING: f64 = 1e-5;
/// Angle in degrees between two facets from which their common edge is an edge of the body: the
/// usual feature angle for telling such edges from those within a curved surface.
pub(crate) const FEATURE_ANGLE: f64 = 30.0;

/// Smallest cosine of the angle between neighbouring facets of a smooth line: the value for a
/// circle of ten facets.
const SMOOTH: f64 = 0.8;

/// The nodes of a surface, mid-side nodes included: in space in ascending order, in the plane in
/// order along the curve.
///
/// # Errors
/// `Input` if the surface is empty, if its faces look to different sides, or if a surface in the
/// plane is not a single curve.
pub fn nodes(mesh: &Mesh, surface: &Surface) -> Result<Vec<usize>> {
    if !mesh.is_solid() {
        return ordered_nodes(mesh, surface);
    }
    let facets = surface.facets.iter();
    let mut nodes: Vec<usize> = facets.flat_map(|&f| mesh.facet_nodes(f)).collect();
    if nodes.is_empty() {
        return Err(Error::input("the surface is empty"));
    }
    check_orientation(mesh, surface)?;
    nodes.sort_unstable();
    nodes.dedup();
    Ok(nodes)
}

/// Checks that all faces of a surface look to the same side: two such faces run through the edge
/// between them in opposite directions.
fn check_orientation(mesh: &Mesh, surface: &Surface) -> Result<()> {
    let mut seen: BTreeMap<[usize; 2], Facet> = BTreeMap::new();
    for &facet in &surface.facets {
        let n = mesh.facet_corners(facet);
        let corners: Vec<usize> = mesh.facet_nodes(facet).take(n).collect();
        for (k, &from) in corners.iter().enumerate() {
            let to = corners[(k + 1) % n];
            if let Some(other) = seen.insert([from, to], facet) {
                return Err(Error::input(format!(
                    "the faces of elements {} and {} look to different sides of the surface beside \
                     the edge from node {} to node {}: all faces of a surface must look out of one \
                     side",
                    mesh.element_label(other.element),
                    mesh.element_label(facet.element),
                    mesh.node_label(from),
                    mesh.node_label(to)
                )));
            }
        }
    }
    Ok(())
}

/// The nodes of a surface of a plane mesh along its arc, mid-side nodes included, with the body on
/// the left (a hole is traversed clockwise). A closed surface begins at its node with the smallest
/// index, which is not repeated at the end.
///
/// # Errors
/// `Input`, naming nodes, if the surface is empty, branches, or has several pieces.
pub(crate) fn ordered_nodes(mesh: &Mesh, surface: &Surface) -> Result<Vec<usize>> {
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
            "the surface has several pieces ({} of {} edges belong to the one that begins at node \
             {}, another holds node {}): make each piece a surface of its own",
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

/// Outward unit normals of a surface at the given nodes.
///
/// The normals are exact if the surface's [`Curve`](super::Curve) is known. They are also exact at
/// inner nodes of flat facets that lie on a circle or a sphere, whatever the lengths of the facets:
/// at a node where the edges `e` meet, the area vectors of straight facets have weights of
/// `1/|e|^2`, and those of flat faces `1/(|e_1|^2 |e_2|^2)`. At the end of a line of straight
/// facets a circle is continued. For a curved facet the normal at the node is taken, and several
/// curved facets are weighted with their areas. A node that is not on the surface gets zeros.
///
/// # Source
/// N. Max, *Weights for computing vertex normals from facet normals* (1999),
/// doi:10.1080/10867651.1999.10487501.
pub fn normals(mesh: &Mesh, surface: &Surface, nodes: &[usize]) -> Vec<Vector> {
    if let Some(curve) = surface.curve {
        let points = nodes.iter().map(|&node| mesh.point(node));
        return points.map(|x| curve.normal(x)).collect();
    }
    let mut sums: BTreeMap<usize, Vector> = BTreeMap::new();
    for &facet in &surface.facets {
        add_areas(mesh, facet, &mut sums);
    }
    let mut normals: BTreeMap<usize, Vector> = sums
        .into_iter()
        .map(|(node, sum)| (node, direction(sum)))
        .collect();
    if !mesh.is_solid() {
        continue_to_the_ends(mesh, surface, &mut normals);
    }
    let known = |node| normals.get(node).copied().unwrap_or_default();
    nodes.iter().map(known).collect()
}

/// Adds a facet's weighted area vectors at its nodes.
fn add_areas(mesh: &Mesh, facet: Facet, sums: &mut BTreeMap<usize, Vector>) {
    let reference = mesh.facet_reference(facet);
    let points: Vec<Vector> = mesh.facet_nodes(facet).map(|n| mesh.point(n)).collect();
    let n = mesh.facet_corners(facet);
    let is_flat = points.len() == n;
    for (i, (node, &place)) in mesh.facet_nodes(facet).zip(reference.nodes).enumerate() {
        let area = reference.area(&(reference.functions)(place), &points);
        let edge = |j: usize| difference(points[j % n], points[i]);
        let [next, last] = [edge(i + 1), edge(i + n - 1)];
        let squares = dot(next, next) * dot(last, last);
        let weight = match (is_flat, n) {
            (false, _) => 1.0,
            _ if squares == 0.0 => 0.0,
            (true, 2) => 1.0 / dot(next, next),
            (true, _) => length(cross(next, last)) / (length(area) * squares),
        };
        let sum = sums.entry(node).or_default();
        (0..3).for_each(|d| sum[d] += weight * area[d]);
    }
}

/// Continues the normals to the end of a line of straight facets: the end gets the mirrored normal
/// of the other end of its facet, which is the normal of a circle through both ends. This is done
/// only if the line has a similar curvature (angle of the turn over the length) at the next two
/// nodes.
fn continue_to_the_ends(mesh: &Mesh, surface: &Surface, normals: &mut BTreeMap<usize, Vector>) {
    let mut facets_at: BTreeMap<usize, Vec<Facet>> = BTreeMap::new();
    for &facet in &surface.facets {
        for node in mesh.facet_nodes(facet) {
            facets_at.entry(node).or_default().push(facet);
        }
    }
    // The node at the facet's other end, and the vector to it.
    let along = |facet: Facet, from: usize| {
        let ends: Vec<usize> = mesh.facet_nodes(facet).collect();
        let &[a, b] = ends.as_slice() else {
            return None;
        };
        let to = if a == from { b } else { a };
        Some((to, difference(mesh.point(to), mesh.point(from))))
    };
    let next = |facet: Facet, at: usize| match *facets_at[&at].as_slice() {
        [a, b] if a == facet => Some(b),
        [a, b] if b == facet => Some(a),
        _ => None,
    };
    // Sine of the angle between two facets divided by their mean length.
    let curvature = |a: Vector, b: Vector| {
        let mean = 0.5 * (length(a) + length(b));
        (dot(direction(a), direction(b)) >= SMOOTH)
            .then(|| cross(direction(a), direction(b))[2] / mean)
    };
    let mut mirrored = Vec::new();
    for (&end, facets) in facets_at.iter().filter(|(_, facets)| facets.len() == 1) {
        let find = || {
            let (inner, first) = along(facets[0], end)?;
            let second_facet = next(facets[0], inner)?;
            let (middle, second) = along(second_facet, inner)?;
            let (_, third) = along(next(second_facet, middle)?, middle)?;
            let (here, there) = (curvature(first, second)?, curvature(second, third)?);
            let alike = here == there || (0.5..2.0).contains(&(here / there));
            let (normal, way) = (normals[&inner], direction(first));
            let slope = 2.0 * dot(normal, way);
            alike.then(|| std::array::from_fn(|d| normal[d] - slope * way[d]))
        };
        mirrored.extend(find().map(|normal: Vector| (end, normal)));
    }
    normals.extend(mirrored);
}

/// The index of the node in `candidates` that lies on the line through `x` along the unit vector
/// `normal`, up to a distance of `tolerance` from the line. If there are several, the nearest to
/// `x` is taken.
pub(crate) fn facing(
    mesh: &Mesh,
    x: Vector,
    normal: Vector,
    candidates: &[usize],
    tolerance: f64,
) -> Option<usize> {
    let mut best: Option<(f64, usize)> = None;
    for (i, &node) in candidates.iter().enumerate() {
        let way = difference(mesh.point(node), x);
        let across = length(cross(way, normal));
        let along = dot(way, normal).abs();
        if across <= tolerance && best.is_none_or(|(b, _)| along < b) {
            best = Some((along, i));
        }
    }
    best.map(|(_, i)| i)
}

/// Length of the longest facet of a surface; in space the longest edge of a facet.
pub(crate) fn longest_facet(mesh: &Mesh, surface: &Surface) -> f64 {
    let longest_edge = |&facet: &Facet| {
        let n = mesh.facet_corners(facet);
        let corners: Vec<Vector> = (mesh.facet_nodes(facet).take(n))
            .map(|node| mesh.point(node))
            .collect();
        let edge = |k: usize| length(difference(corners[(k + 1) % n], corners[k]));
        (0..n).map(edge).fold(0.0, f64::max)
    };
    surface.facets.iter().map(longest_edge).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests;
