//! Elements that share a node.

use crate::mesh::Mesh;

/// Some elements of a mesh, by their nodes.
pub struct Neighbours {
    /// Where the elements at each node begin.
    first: Vec<u32>,
    /// Places in the list of elements.
    places: Vec<u32>,
}

impl Neighbours {
    /// Of a list of elements.
    pub fn new(mesh: &Mesh, elements: impl Iterator<Item = usize> + Clone) -> Self {
        let mut first = vec![0; mesh.n_nodes() + 1];
        for &node in elements.clone().flat_map(|e| mesh.nodes(e)) {
            first[node as usize + 1] += 1;
        }
        for node in 0..mesh.n_nodes() {
            first[node + 1] += first[node];
        }
        let mut next = first.clone();
        let mut places = vec![0; first[mesh.n_nodes()] as usize];
        for (place, e) in (0..).zip(elements) {
            for &node in mesh.nodes(e) {
                let at = &mut next[node as usize];
                places[*at as usize] = place;
                *at += 1;
            }
        }
        Neighbours { first, places }
    }

    /// The places in the list of the elements that have one of some nodes, ascending.
    pub fn at(&self, nodes: &[u32], out: &mut Vec<u32>) {
        out.clear();
        for &node in nodes {
            let [first, end] = [0, 1].map(|i| self.first[node as usize + i] as usize);
            out.extend_from_slice(&self.places[first..end]);
        }
        out.sort_unstable();
        out.dedup();
    }
}
