//! Faces of elements that belong to a single element.

use super::Deck;
use crate::shape::Shape;
use std::collections::HashMap;

/// A face: an element and its local facet.
pub(crate) type Face = (u32, u8);

/// The corners of a face in ascending order, padded to four.
type FaceCorners = [u32; 4];

fn corners(nodes: &[u32], shape: Shape, local: usize) -> FaceCorners {
    let mut out = [u32::MAX; 4];
    let n = shape.facet_reference(local).n_corners;
    for (out, &corner) in out.iter_mut().zip(&shape.facet(local)[..n]) {
        *out = nodes[corner];
    }
    out.sort_unstable();
    out
}

/// How many corners and nodes of a face are among given ones.
struct NodesGiven {
    corners: usize,
    n_corners: usize,
    nodes: usize,
    n_nodes: usize,
}

impl Deck {
    /// The faces of the given elements that belong to no other element of the deck.
    pub(super) fn free_faces_of(&self, elements: &[u32]) -> Vec<Face> {
        let nodes = elements
            .iter()
            .flat_map(|&e| self.element_nodes(e as usize));
        let faces = self.free_faces_among(nodes.copied());
        let is_of_these = |face: &Face| elements.binary_search(&face.0).is_ok();
        faces.into_iter().filter(is_of_these).collect()
    }

    /// The faces all of whose corners are among the given nodes and that belong to a single
    /// element.
    pub(super) fn free_faces_among(&self, nodes: impl IntoIterator<Item = u32>) -> Vec<Face> {
        self.free_faces(nodes, |given| given.corners == given.n_corners)
    }

    /// The faces all of whose nodes, those between corners too, are among the given nodes and that
    /// belong to a single element.
    pub(super) fn whole_free_faces_among(&self, nodes: impl IntoIterator<Item = u32>) -> Vec<Face> {
        self.free_faces(nodes, |given| given.nodes == given.n_nodes)
    }

    /// The faces any of whose nodes is among the given nodes and that belong to a single element.
    pub(super) fn free_faces_at(&self, nodes: impl IntoIterator<Item = u32>) -> Vec<Face> {
        self.free_faces(nodes, |given| given.nodes > 0)
    }

    /// The faces that belong to a single element, chosen by how many of their nodes are given.
    fn free_faces(
        &self,
        nodes: impl IntoIterator<Item = u32>,
        is_chosen: impl Fn(NodesGiven) -> bool,
    ) -> Vec<Face> {
        let mut marked = vec![false; self.n_nodes()];
        nodes
            .into_iter()
            .for_each(|node| marked[node as usize] = true);
        let mut found: HashMap<FaceCorners, (Face, usize)> = HashMap::new();
        for element in 0..self.n_elements() {
            let nodes = self.element_nodes(element);
            let shape = self.elements.types[element].shape;
            for local in 0..shape.n_facets() {
                let corners = corners(nodes, shape, local);
                let facet = shape.facet(local);
                let n_corners = shape.facet_reference(local).n_corners;
                let n_given = |own: &[usize]| {
                    let given = own.iter().filter(|&&k| marked[nodes[k] as usize]);
                    given.count()
                };
                let given = NodesGiven {
                    corners: n_given(&facet[..n_corners]),
                    n_corners,
                    nodes: n_given(facet),
                    n_nodes: facet.len(),
                };
                if is_chosen(given) {
                    let new = ((element as u32, local as u8), 0);
                    found.entry(corners).or_insert(new).1 += 1;
                }
            }
        }
        let alone = found.into_values().filter(|(_, count)| *count == 1);
        let mut faces: Vec<Face> = alone.map(|(face, _)| face).collect();
        faces.sort_unstable();
        faces
    }
}
