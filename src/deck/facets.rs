//! Faces of elements, and which of them belong to a single element.

use super::mesh::DeckMesh;
use crate::space::{Vector, along, cross, difference, direction};
use std::collections::HashMap;

/// A face: an element and its local facet.
pub(crate) type Face = (u32, u8);

/// A node and its degree of freedom counted from 0, or an element and its local facet.
pub(super) type Key = Face;

/// The corners of a face in ascending order, padded to four.
type FaceCorners = [u32; 4];

impl DeckMesh {
    /// The nodes of a face, corners first.
    fn face_nodes(&self, (element, local): Face) -> impl Iterator<Item = u32> {
        let nodes = self.element_nodes(element as usize);
        let own = self.shape(element as usize).facet(local as usize);
        own.iter().map(|&k| nodes[k])
    }

    /// The corners of a face.
    pub(super) fn corners(&self, face: Face) -> impl Iterator<Item = u32> {
        let reference = self.shape(face.0 as usize).facet_reference(face.1 as usize);
        self.face_nodes(face).take(reference.n_corners)
    }

    /// Coordinates of the corners of a face.
    pub(super) fn corner_points(&self, face: Face) -> Vec<Vector> {
        let corners = self.corners(face);
        corners.map(|node| self.point(node as usize)).collect()
    }

    fn sorted_corners(&self, face: Face) -> FaceCorners {
        let mut out = [u32::MAX; 4];
        for (out, corner) in out.iter_mut().zip(self.corners(face)) {
            *out = corner;
        }
        out.sort_unstable();
        out
    }

    /// The centre of the corners of a face, and the unit vector out of its element.
    pub(super) fn center_and_normal(&self, face: Face) -> (Vector, Vector) {
        let x = self.corner_points(face);
        let share = 1.0 / x.len() as f64;
        let center = x.iter().fold([0.0; 3], |sum, &x| along(sum, share, x));
        let outward = match x[..] {
            [a, b] => [b[1] - a[1], a[0] - b[0], 0.0],
            [a, b, c] => cross(difference(b, a), difference(c, a)),
            [a, b, c, d, ..] => cross(difference(c, a), difference(d, b)),
            _ => [0.0; 3],
        };
        (center, direction(outward))
    }

    /// Whether the given faces include both sides of a face between two elements.
    pub(super) fn look_both_ways(&self, faces: &[Face]) -> bool {
        let corners = faces.iter().map(|face| self.sorted_corners(*face));
        let mut corners: Vec<FaceCorners> = corners.collect();
        corners.sort_unstable();
        corners.windows(2).any(|pair| pair[0] == pair[1])
    }

    /// The nodes of the given faces, in ascending order without duplicates.
    pub(super) fn nodes_of(&self, faces: &[Face]) -> Vec<u32> {
        let nodes = faces.iter().flat_map(|&face| self.face_nodes(face));
        let mut nodes: Vec<u32> = nodes.collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

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
        self.free_faces(nodes, |face, is_given| self.corners(face).all(is_given))
    }

    /// The faces all of whose nodes, those between corners too, are among the given nodes and that
    /// belong to a single element.
    pub(super) fn whole_free_faces_among(&self, nodes: impl IntoIterator<Item = u32>) -> Vec<Face> {
        self.free_faces(nodes, |face, is_given| self.face_nodes(face).all(is_given))
    }

    /// The faces any of whose nodes is among the given nodes and that belong to a single element.
    pub(super) fn free_faces_at(&self, nodes: impl IntoIterator<Item = u32>) -> Vec<Face> {
        self.free_faces(nodes, |face, is_given| self.face_nodes(face).any(is_given))
    }

    /// The faces that belong to a single element and that `is_chosen` selects. `is_chosen` gets a
    /// face and a function that tells whether a node is given.
    fn free_faces(
        &self,
        nodes: impl IntoIterator<Item = u32>,
        is_chosen: impl Fn(Face, &dyn Fn(u32) -> bool) -> bool,
    ) -> Vec<Face> {
        let mut marked = vec![false; self.n_nodes()];
        nodes
            .into_iter()
            .for_each(|node| marked[node as usize] = true);
        let mut found: HashMap<FaceCorners, (Face, usize)> = HashMap::new();
        for element in 0..self.n_elements() {
            for local in 0..self.shape(element).n_facets() {
                let face = (element as u32, local as u8);
                if is_chosen(face, &|node| marked[node as usize]) {
                    let corners = self.sorted_corners(face);
                    found.entry(corners).or_insert((face, 0)).1 += 1;
                }
            }
        }
        let alone = found.into_values().filter(|(_, count)| *count == 1);
        let mut faces: Vec<Face> = alone.map(|(face, _)| face).collect();
        faces.sort_unstable();
        faces
    }
}
