//! Parts of a mesh: which nodes lie together, and some elements by themselves.
//!
//! Space is halved along the longest side of what is there, again and again.
//!
//! # Source
//! M. J. Berger, S. H. Bokhari, *A partitioning strategy for nonuniform problems on
//! multiprocessors*, IEEE Trans. Computers C-36 (1987) 570, doi:10.1109/TC.1987.1676942.

use super::Mesh;
use std::ops::Range;

impl Mesh {
    /// The elements of each of `n` parts of space: those whose first node lies there.
    pub fn elements_among(&self, n: usize) -> Vec<Vec<usize>> {
        let part = self.shared_among(n);
        let mut elements = vec![Vec::new(); n];
        for e in 0..self.n_elements() {
            elements[part[self.nodes(e)[0] as usize] as usize].push(e);
        }
        elements
    }

    /// Some elements, ascending, on their own nodes, and which nodes these are, ascending. Bodies
    /// keep their numbers; sets, surfaces and labels are left behind.
    pub fn part(&self, elements: &[usize]) -> (Mesh, Vec<u32>) {
        let mut nodes: Vec<u32> = (elements.iter())
            .flat_map(|&e| self.nodes(e))
            .copied()
            .collect();
        nodes.sort_unstable();
        nodes.dedup();
        let mut part = Mesh {
            dimension: self.dimension,
            offsets: vec![0],
            ..Mesh::default()
        };
        for &node in &nodes {
            let at = self.dimension * node as usize;
            let place = &self.coordinates[at..at + self.dimension];
            part.coordinates.extend_from_slice(place);
        }
        for &e in elements {
            part.shapes.push(self.shapes[e]);
            part.element_body.push(self.element_body[e]);
            let own = |node: &u32| nodes.partition_point(|other| other < node) as u32;
            part.connectivity.extend(self.nodes(e).iter().map(own));
            part.offsets.push(part.connectivity.len());
        }
        (part, nodes)
    }

    /// The part of each node, of `n` parts of space with as many nodes each.
    pub fn shared_among(&self, n: usize) -> Vec<u32> {
        let mut owners = vec![0; self.n_nodes()];
        let nodes = (0..self.n_nodes() as u32).collect();
        // Nodes, and the parts among which they are to be shared.
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
            // Of equals the one with the lower number.
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
        // The longer side is cut.
        let owners = mesh.shared_among(2);
        assert!(owners[..15 * 7].iter().all(|rank| *rank == 0));
    }
}
