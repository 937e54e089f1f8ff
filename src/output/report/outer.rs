//! The boundary of bodies: facets that belong to only one element; and sides of elements joined to
//! long lines.

use crate::mesh::{Facet, Mesh};
use std::collections::BTreeMap;

/// Returns the facets of some elements that belong to only one element of their body.
pub(super) fn facets(mesh: &Mesh, elements: impl Iterator<Item = usize>) -> Vec<Facet> {
    let mut all: Vec<((u32, [usize; 4]), Facet)> = Vec::new();
    for element in elements {
        for local in 0..mesh.shapes[element].n_facets() {
            let facet = Facet { element, local };
            let mut key = [usize::MAX; 4];
            let corners = mesh.facet_nodes(facet).take(mesh.facet_corners(facet));
            key.iter_mut().zip(corners).for_each(|(k, node)| *k = node);
            key.sort_unstable();
            all.push(((mesh.element_body[element], key), facet));
        }
    }
    all.sort_unstable();
    let alone = all
        .chunk_by(|a, b| a.0 == b.0)
        .filter(|same| same.len() == 1);
    let mut facets: Vec<Facet> = alone.map(|same| same[0].1).collect();
    facets.sort_unstable();
    facets
}

/// Joins sides between nodes to long lines; each line continues along the straightest side that is
/// left.
pub(super) fn long_lines(
    mut sides: Vec<[usize; 2]>,
    place: impl Fn(usize) -> [f64; 2],
) -> Vec<Vec<[f64; 2]>> {
    sides.iter_mut().for_each(|side| side.sort_unstable());
    sides.sort_unstable();
    sides.dedup();
    let mut at: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (index, side) in sides.iter().enumerate() {
        side.iter()
            .for_each(|&node| at.entry(node).or_default().push(index));
    }
    let mut used = vec![false; sides.len()];
    let straight = |a: usize, b: usize, c: usize| {
        let [a, b, c] = [a, b, c].map(&place);
        let (p, q) = ([b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]]);
        (p[0] * q[0] + p[1] * q[1]) / (p[0].hypot(p[1]) * q[0].hypot(q[1]))
    };
    let mut out = Vec::new();
    for first in 0..sides.len() {
        if used[first] {
            continue;
        }
        used[first] = true;
        let mut line = sides[first].to_vec();
        // The line is extended from one end, then from the other.
        for _ in 0..2 {
            while let [.., a, b] = line[..] {
                let other = |side: usize| sides[side][usize::from(sides[side][0] == b)];
                let free = at[&b].iter().copied().filter(|&side| !used[side]);
                let best = free
                    .map(|side| (straight(a, b, other(side)), side))
                    .filter(|(cosine, _)| *cosine > STRAIGHT)
                    .max_by(|p, q| p.0.total_cmp(&q.0));
                let Some((_, side)) = best else { break };
                used[side] = true;
                line.push(other(side));
            }
            line.reverse();
        }
        out.push(line.into_iter().map(&place).collect());
    }
    out
}

/// Smallest cosine of the angle between a side of a line and the next.
const STRAIGHT: f64 = 0.7;

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of `n` by `n` cells has `n + 1` lines each way, and every side once.
    #[test]
    fn the_sides_of_a_grid_are_its_lines() {
        let n = 5;
        let node = |i: usize, j: usize| j * (n + 1) + i;
        let place = |k: usize| [(k % (n + 1)) as f64, (k / (n + 1)) as f64];
        let mut sides = Vec::new();
        for k in 0..n * (n + 1) {
            let (i, j) = (k % n, k / n);
            sides.extend([[node(i, j), node(i + 1, j)], [node(j, i + 1), node(j, i)]]);
        }
        // A side between two cells is listed by both.
        sides.extend(sides.clone());
        let lines = long_lines(sides, place);
        assert_eq!(lines.len(), 2 * (n + 1));
        assert!(lines.iter().all(|line| line.len() == n + 1));
    }
}
