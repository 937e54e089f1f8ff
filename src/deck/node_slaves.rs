//! Slave surfaces that a deck gives by nodes (`TYPE=NODE`) which do not make up a connected surface
//! of whole faces: a single node, a row, or the corners of faces alone.
//!
//! Contact is computed on the faces around these nodes that face the master surface. Of the nodes
//! of these faces, only the given ones may touch.

use super::adjust::SurfacePieces;
use super::data::{ContactPair, SurfacePart};
use super::facets::Face;
use super::mesh::DeckMesh;
use super::sets::{Lookup, What};
use crate::classes::Classes;
use crate::error::Result;
use crate::space::{direction, dot};
use std::collections::{BTreeSet, HashMap};

/// Cosine of the angle between the outward normals of two faces below which they face each other.
/// Negative, so that perpendicular faces do not face each other in spite of round-off.
const FACING: f64 = -1e-3;

/// A slave surface of nodes.
pub(super) struct NodeSlaves {
    /// The nodes that may touch, in ascending order.
    pub(super) nodes: Vec<u32>,
    /// The faces around them.
    pub(super) faces: Vec<Face>,
}

impl Lookup<'_> {
    /// The slave nodes of a contact pair, in ascending order.
    ///
    /// # Errors
    /// `Input` for names and numbers that are not defined.
    pub(super) fn slave_nodes(self, pair: &ContactPair) -> Result<Vec<u32>> {
        if let Some(nodes) = self.loose_slaves(&pair.slave)? {
            return Ok(nodes);
        }
        let faces = self.surface(&pair.slave, (pair.place, "CONTACT PAIR"))?;
        Ok(self.mesh.nodes_of(&faces))
    }

    /// The nodes of a surface that is given by nodes, if some of its boundary nodes belong to no
    /// face whose nodes are all given, or if the faces are not connected. `None` for any other
    /// surface.
    fn loose_slaves(self, name: &str) -> Result<Option<Vec<u32>>> {
        let mut nodes = Vec::new();
        for (part, place) in self.sets.surfaces.get(name).into_iter().flatten() {
            let SurfacePart::OfNodes(on) = part else {
                return Ok(None);
            };
            nodes.extend(self.indices(What::Nodes, on, (*place, "SURFACE"))?);
        }
        if nodes.is_empty() {
            return Ok(None);
        }
        nodes.sort_unstable();
        nodes.dedup();
        let faces = self.mesh.whole_free_faces_among(nodes.iter().copied());
        let of_faces = self.mesh.nodes_of(&faces);
        let is_in = |of: &[u32], node: &u32| of.binary_search(node).is_ok();
        let in_pieces = n_pieces(self.mesh, &faces) > 1;
        if nodes.iter().all(|node| is_in(&of_faces, node)) {
            return Ok(in_pieces.then_some(nodes));
        }
        // Nodes inside the body touch nothing; a set of all nodes of the body has such nodes too.
        let boundary = self
            .mesh
            .nodes_of(&self.mesh.free_faces_at(nodes.iter().copied()));
        nodes.retain(|node| is_in(&boundary, node));
        let are_all = nodes.iter().all(|node| is_in(&of_faces, node));
        Ok((!are_all || in_pieces).then_some(nodes))
    }

    /// Whether a surface is given by nodes that make up no face at all. Only a contact may use such
    /// a surface.
    pub(super) fn is_of_nodes_alone(self, name: &str) -> bool {
        let slaves = self.loose_slaves(name).ok().flatten();
        slaves.is_some_and(|nodes| self.mesh.free_faces_among(nodes).is_empty())
    }

    /// The slave nodes of a contact pair that do not make up whole faces, with the faces around
    /// them; `None` for any other slave surface.
    ///
    /// # Errors
    /// `Input` for names and numbers that are not defined, and if no face around the nodes faces
    /// the master surface.
    pub(super) fn node_slaves(self, pair: &ContactPair) -> Result<Option<NodeSlaves>> {
        let Some(mut nodes) = self.loose_slaves(&pair.slave)? else {
            return Ok(None);
        };
        let at = (pair.place, "CONTACT PAIR");
        let master = SurfacePieces::new(self.mesh, &self.surface(&pair.master, at)?);
        let mut faces = self.mesh.free_faces_at(nodes.iter().copied());
        faces.retain(|&face| {
            let (center, outward) = self.mesh.center_and_normal(face);
            dot(outward, direction(master.nearest(center).1)) < FACING
        });
        if faces.is_empty() {
            let message = format!(
                "no face at the nodes of {} faces the surface {}: name nodes that look at it",
                pair.slave, pair.master
            );
            return Err(self.error(at, message));
        }
        let facing = self.mesh.nodes_of(&faces);
        nodes.retain(|node| facing.binary_search(node).is_ok());
        Ok(Some(NodeSlaves { nodes, faces }))
    }
}

/// Number of pieces of a surface that share no node.
fn n_pieces(mesh: &DeckMesh, faces: &[Face]) -> usize {
    let mut classes = Classes::new(faces.len());
    let mut face_at: HashMap<u32, usize> = HashMap::new();
    for (number, face) in faces.iter().enumerate() {
        for node in mesh.nodes_of(std::slice::from_ref(face)) {
            classes.join(number, *face_at.entry(node).or_insert(number));
        }
    }
    let firsts: BTreeSet<usize> = classes.firsts().into_iter().collect();
    firsts.len()
}
