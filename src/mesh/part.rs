//! Parts of a mesh: nodes grouped by their position, and meshes of selected elements.
//!
//! Space is bisected recursively along the longest extent of the nodes in it.
//!
//! # Source
//! M. J. Berger, S. H. Bokhari, *A partitioning strategy for nonuniform problems on
//! multiprocessors*, IEEE Trans. Computers C-36 (1987) 570, doi:10.1109/TC.1987.1676942.

use super::Mesh;
use std::collections::BTreeMap;
use std::ops::Range;

impl Mesh {
    /// The elements of each of `n` parts of space; an element belongs to the part of its first
    /// node.
    pub fn elements_among(&self, n: usize) -> Vec<Vec<usize>> {
        let part = self.shared_among(n);
        let mut elements = vec![Vec::new(); n];
        for e in 0..self.n_elements() {
            elements[part[self.nodes(e)[0] as usize] as usize].push(e);
        }
        elements
    }

    /// The elements of each given part, together with all elements that share a node with the part,
    /// in ascending order.
    pub fn with_neighbours(&self, parts: &[Vec<usize>]) -> Vec<Vec<usize>> {
        const NONE: u32 = u32::MAX;
        let mut part_of = vec![NONE; self.n_elements()];
        for (part, elements) in (0..).zip(parts) {
            elements.iter().for_each(|&e| part_of[e] = part);
        }
        // The first part that holds each node; nodes held by several parts are listed separately,
        // each with all its parts.
        let mut first = vec![NONE; self.n_nodes()];
        let mut several: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        let mut is_shared = vec![false; self.n_nodes()];
        for (e, &part) in part_of.iter().enumerate() {
            for &node in self.nodes(e) {
                let holder = &mut first[node as usize];
                if *holder == NONE {
                    *holder = part;
                } else if *holder != part {
                    is_shared[node as usize] = true;
                    let parts = several.entry(node).or_insert_with(|| vec![*holder]);
                    if !parts.contains(&part) {
                        parts.push(part);
                    }
                }
            }
        }
        let mut out = vec![Vec::new(); parts.len()];
        let mut near = Vec::new();
        for (e, &part) in part_of.iter().enumerate() {
            near.clear();
            near.push(part);
            let shared = self
                .nodes(e)
                .iter()
                .filter(|node| is_shared[**node as usize]);
            near.extend(shared.flat_map(|node| &several[node]));
            near.sort_unstable();
            near.dedup();
            near.iter().for_each(|&part| out[part as usize].push(e));
        }
        out
    }

    /// A mesh of the selected elements (ascending) with their own nodes, and the indices of these
    /// nodes, ascending. Bodies keep their numbers; sets, surfaces and labels are not copied.
    pub fn part(&self, elements: &[usize]) -> (Mesh, Vec<u32>) {
        let mut number = vec![0; self.n_nodes()];
        for &node in elements.iter().flat_map(|&e| self.nodes(e)) {
            number[node as usize] = 1;
        }
        let held = (0..self.n_nodes() as u32).filter(|&node| number[node as usize] == 1);
        let nodes: Vec<u32> = held.collect();
        let mut part = Mesh {
            dimension: self.dimension,
            offsets: vec![0],
            integration: self.integration.clone(),
            ..Mesh::default()
        };
        for (own, &node) in (0..).zip(&nodes) {
            number[node as usize] = own;
            let at = self.dimension * node as usize;
            let place = &self.coordinates[at..at + self.dimension];
            part.coordinates.extend_from_slice(place);
        }
        for &e in elements {
            part.shapes.push(self.shapes[e]);
            part.element_body.push(self.element_body[e]);
            let own = self.nodes(e).iter().map(|node| number[*node as usize]);
            part.connectivity.extend(own);
            part.offsets.push(part.connectivity.len());
        }
        (part, nodes)
    }

    /// The part of each node when space is divided into `n` parts with equal numbers of nodes.
    pub fn shared_among(&self, n: usize) -> Vec<u32> {
        let mut owners = vec![0; self.n_nodes()];
        let nodes = (0..self.n_nodes() as u32).collect();
        // Groups of nodes, each with the range of parts to which it is still to be distributed.
        let mut open: Vec<(Vec<u32>, Range<usize>)> = vec![(nodes, 0..n)];
        while let Some((mut nodes, parts)) = open.pop() {
            if parts.len() <= 1 || nodes.is_empty() {
                for &node in &nodes {
                    owners[node as usize] = parts.start as u32;
                }
                continue;
            }
            let place = |node: &u32| self.point(*node as usize);
            let length = |axis: usize| {
                let along = nodes.iter().map(|node| place(node)[axis]);
                let bounds = along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
                    [low.min(x), high.max(x)]
                });
                bounds[1] - bounds[0]
            };
            let lengths = [0, 1, 2].map(length);
            let axis = (1..3).fold(
                0,
                |best, k| if lengths[k] > lengths[best] { k } else { best },
            );
            let half = parts.len() / 2;
            let cut = nodes.len() * half / parts.len();
            // Nodes with equal coordinates are ordered by number.
            let order = |a: &u32, b: &u32| place(a)[axis].total_cmp(&place(b)[axis]).then(a.cmp(b));
            if cut > 0 {
                nodes.select_nth_unstable_by(cut, order);
            }
            let upper = nodes.split_off(cut);
            let middle = parts.start + half;
            open.push((nodes, parts.start..middle));
            open.push((upper, middle..parts.end));
        }
        owners
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Shape;

    #[test]
    fn every_part_has_its_share_of_the_nodes() {
        let mut mesh = Mesh {
            dimension: 2,
            ..Mesh::default()
        };
        for i in 0..30 {
            for j in 0..7 {
                mesh.coordinates.extend([f64::from(i), f64::from(j)]);
            }
        }
        for ranks in [1, 2, 3, 5, 8, 300] {
            let owners = mesh.shared_among(ranks);
            let mut counts = vec![0usize; ranks];
            owners.iter().for_each(|&rank| counts[rank as usize] += 1);
            let (least, most) = (counts.iter().min().unwrap(), counts.iter().max().unwrap());
            assert!(most - least <= 2, "{ranks}: {counts:?}");
        }
        // The longer side of the mesh is cut.
        let owners = mesh.shared_among(2);
        assert!(owners[..15 * 7].iter().all(|rank| *rank == 0));
    }

    #[test]
    fn parts_know_the_elements_around_them() {
        let mut mesh = Mesh {
            dimension: 2,
            ..Mesh::default()
        };
        let n = 9u32;
        for i in 0..=n {
            for j in 0..=n {
                mesh.coordinates.extend([f64::from(i), f64::from(j)]);
            }
        }
        for i in 0..n {
            for j in 0..n {
                let [a, b] = [i, i + 1].map(|i| i * (n + 1) + j);
                mesh.push_element(Shape::Quad4, 0, &[a, b, b + 1, a + 1]);
            }
        }
        for n in [1, 2, 5, 200] {
            let parts = mesh.elements_among(n);
            let mut all: Vec<usize> = parts.concat();
            all.sort_unstable();
            assert_eq!(all, (0..mesh.n_elements()).collect::<Vec<_>>());
            for (own, found) in parts.iter().zip(mesh.with_neighbours(&parts)) {
                let nodes: Vec<u32> = own.iter().flat_map(|&e| mesh.nodes(e)).copied().collect();
                let touches = |e: &usize| mesh.nodes(*e).iter().any(|node| nodes.contains(node));
                let expected: Vec<usize> = (0..mesh.n_elements()).filter(touches).collect();
                assert_eq!(found, expected);
                let (part, numbers) = mesh.part(&found);
                for (i, &e) in found.iter().enumerate() {
                    let whole = part.nodes(i).iter().map(|&node| numbers[node as usize]);
                    assert_eq!(whole.collect::<Vec<_>>(), mesh.nodes(e));
                }
                for (i, &node) in numbers.iter().enumerate() {
                    assert_eq!(part.point(i), mesh.point(node as usize));
                }
            }
        }
    }
}
