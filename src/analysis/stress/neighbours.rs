//! Elements that share a node.

use crate::mesh::{Facet, Mesh};

/// The elements of a list, found by the nodes that they share.
pub struct Neighbours {
    /// Index in `places` at which the elements of each node begin.
    first: Vec<u32>,
    /// Indices of elements in the list, node by node.
    places: Vec<u32>,
}

impl Neighbours {
    /// Sets up the neighbourhood relation for a list of elements.
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

    /// Pairs of opposite facets of a listed element that both belong to no other element of the
    /// list, each facet as its nodes. Between such a pair the body is one element thick.
    pub fn free_sides(&self, mesh: &Mesh, list: &[usize], element: usize) -> Vec<[Vec<usize>; 2]> {
        let facets = (0..mesh.shapes[element].n_facets()).map(|local| Facet { element, local });
        let facets = facets.map(|facet| mesh.facet_nodes(facet).collect::<Vec<usize>>());
        let is_free = |nodes: &Vec<usize>| {
            let [first, end] = [0, 1].map(|i| self.first[nodes[0] + i] as usize);
            let around = self.places[first..end]
                .iter()
                .map(|&place| list[place as usize]);
            let mut others = around.filter(|&other| other != element);
            others.all(|other| {
                let has = |node: &usize| mesh.nodes(other).contains(&(*node as u32));
                !nodes.iter().all(has)
            })
        };
        let free: Vec<Vec<usize>> = facets.filter(is_free).collect();
        let mut sides = Vec::new();
        for (i, one) in free.iter().enumerate() {
            let is_opposite = |other: &&Vec<usize>| one.iter().all(|node| !other.contains(node));
            let opposite = free[i + 1..].iter().find(is_opposite);
            sides.extend(opposite.map(|other| [one.clone(), other.clone()]));
        }
        sides
    }

    /// Finds the elements that have any of the given nodes, as ascending indices in the list.
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
