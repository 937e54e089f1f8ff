//! Nodes that move like a rigid body (`*RIGID BODY`, `*COUPLING` with `*KINEMATIC`).
//!
//! With the displacement `u_r` of the reference node, the rotation `w` and the position `x` of a
//! node,
//!
//! ```text
//! u = u_r + w x (x - x_r)
//! ```
//!
//! along the axes that follow. The rotation is either the displacement of a rotation node
//! (`ROT NODE`), or given by the degrees of freedom 4 to 6 of the reference node.
//!
//! # Source
//! G. Dhondt, *CalculiX CrunchiX User's Manual* 2.20, `*RIGID BODY`, `*KINEMATIC`.

use super::Deck;
use super::data::{EntitySelection, RigidNodes};
use super::history::Key;
use super::linear::{FreedomCoefficients, LinearRow};
use super::sets::{At, What};
use super::source::LinePlace;
use crate::error::Result;
use crate::space::difference;

/// A rigid body, with nodes given by their indices.
pub(super) struct DeckRigidBody {
    /// Nodes of the body in ascending order, without the reference node and the rotation node.
    nodes: Vec<u32>,
    reference: u32,
    /// The node whose displacement is the rotation; an index beyond all nodes if the deck has no
    /// such node.
    rotation: u32,
    follows: [bool; 3],
    place: LinePlace,
    keyword: &'static str,
}

impl Deck {
    /// All rigid bodies of the deck.
    ///
    /// # Errors
    /// `Input` for undefined names and numbers, and for a reference that is not a single node.
    pub(super) fn rigid_bodies(&self) -> Result<Vec<DeckRigidBody>> {
        let all = self.properties.rigid.iter().enumerate();
        all.map(|(number, rigid)| {
            let at = (rigid.place, rigid.keyword);
            let reference = self.one_node(&rigid.reference, at)?;
            let rotation = match &rigid.rotation {
                Some(node) => self.one_node(node, at)?,
                None => (self.n_nodes() + number) as u32,
            };
            let mut nodes = match &rigid.nodes {
                RigidNodes::Set(name) => {
                    self.indices(What::Nodes, &EntitySelection::Set(name.clone()), at)?
                }
                RigidNodes::Elements(name) => {
                    let elements =
                        self.indices(What::Elements, &EntitySelection::Set(name.clone()), at)?;
                    let nodes = elements.iter().map(|e| self.element_nodes(*e as usize));
                    nodes.flatten().copied().collect()
                }
                RigidNodes::Surface(name) => self.nodes_of(&self.surface(name, at)?),
            };
            nodes.sort_unstable();
            nodes.dedup();
            nodes.retain(|node| *node != reference && *node != rotation);
            Ok(DeckRigidBody {
                nodes,
                reference,
                rotation,
                follows: rigid.follows,
                place: rigid.place,
                keyword: rigid.keyword,
            })
        })
        .collect()
    }

    fn one_node(&self, target: &EntitySelection, at: At) -> Result<u32> {
        match self.indices(What::Nodes, target, at)?[..] {
            [node] => Ok(node),
            ref nodes => {
                let message = format!(
                    "the reference is {} nodes; name one node, or a set of one",
                    nodes.len()
                );
                Err(self.error(at.0, at.1, message))
            }
        }
    }

    /// The rotations among a range of degrees of freedom of some nodes: 4 to 6 of a reference node,
    /// or 3 of a rotation node in the plane.
    pub(super) fn rotations_among(
        &self,
        nodes: &[u32],
        [first, last]: [usize; 2],
    ) -> Result<Vec<Key>> {
        let mut out = Vec::new();
        if self.properties.rigid.is_empty() {
            return Ok(out);
        }
        for body in self.rigid_bodies()? {
            if nodes.contains(&body.reference) {
                let freedoms = first.max(4)..=last.min(6);
                out.extend(freedoms.map(|freedom| (body.rotation, freedom as u8 - 4)));
            }
            if self.dimension() == 2 && nodes.contains(&body.rotation) && first <= 3 && last >= 3 {
                out.push((body.rotation, 2));
            }
        }
        out.sort_unstable();
        out.dedup();
        Ok(out)
    }
}

impl DeckRigidBody {
    /// The equations of the body's nodes along the axes of the model.
    pub(super) fn rows(&self, deck: &Deck) -> impl Iterator<Item = (u32, usize, LinearRow)> {
        let dimension = deck.dimension();
        let origin = deck.point(self.reference as usize);
        self.nodes.iter().flat_map(move |&node| {
            let r = difference(deck.point(node as usize), origin);
            let axes = (0..dimension).filter(|axis| self.follows[*axis]);
            axes.map(move |axis| {
                let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
                // The component of the cross product: w_next r_last - w_last r_next.
                let mut terms = FreedomCoefficients::from([((self.reference, axis as u8), -1.0)]);
                for (of, c) in [(next, -r[last]), (last, r[next])] {
                    // In the plane only the rotation about the normal exists.
                    if dimension == 3 || of == 2 {
                        terms.insert((self.rotation, of as u8), c);
                    }
                }
                let row = LinearRow {
                    terms,
                    first: None,
                    place: self.place,
                    keyword: self.keyword,
                };
                (node, axis, row)
            })
        })
    }
}
