//! A displacement that follows others by a condition of the scene.

use super::freedoms::{Freedoms, Slot};
use super::names::SceneEntry;
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::scene::{Direction, Scene};
use crate::space::{Vector, dot, unit};

/// A displacement that follows others: `u . e_direction = sum v_k . u_k + value`.
#[derive(Debug, Clone)]
pub(super) struct Following {
    /// Node whose displacement along `direction` follows.
    pub node: usize,
    pub direction: usize,
    /// Nodes on the right-hand side, each with its vector `v`.
    pub terms: Vec<(usize, Vector)>,
    /// Prescribed values that are added to the sum, each with the number of its load.
    pub moved: Vec<(usize, f64)>,
    /// Entry of the scene from which the equation comes: the name of the list (`"equation"` or
    /// `"load"`) and the index of the entry in it, from 0.
    pub of: (&'static str, usize),
}

impl Following {
    /// All nodes of the equation.
    pub(super) fn nodes(&self) -> impl Iterator<Item = usize> + '_ {
        let others = self.terms.iter().map(|(node, _)| *node);
        others.chain([self.node])
    }

    /// Returns the local axis of the node that follows, and its sign relative to the direction.
    ///
    /// # Errors
    /// Something else already holds the axis: a support, a load, a contact normal.
    pub(super) fn axis(
        &self,
        scene: &Scene,
        mesh: &Mesh,
        freedoms: &Freedoms,
        is_taken: impl Fn((usize, usize)) -> bool,
    ) -> Result<(usize, f64)> {
        let Following {
            node, direction, ..
        } = *self;
        let refused = |why: &str| {
            let (list, index) = self.of;
            let entry = SceneEntry::of_list(scene, list, index);
            let (number, node) = (index + 1, mesh.node_label(node));
            let along = Direction::ALL[direction].name();
            entry.refused(Error::input(match self.terms.is_empty() {
                true => {
                    format!("{list} {number}: node {node} cannot be moved along {along}: {why}")
                }
                false => format!(
                    "{list} {number}: the displacement of node {node} along {along} cannot follow \
                     others: {why}; put another term first"
                ),
            }))
        };
        let axis = freedoms.local_axis(node, direction);
        let axis = axis.ok_or_else(|| refused("a contact normal or a turned support is there"))?;
        if self
            .terms
            .iter()
            .any(|term| term.0 == node && dot(term.1, unit(direction)) != 0.0)
        {
            return Err(refused("it is among the others too"));
        }
        if !matches!(freedoms.slots[node][axis], Slot::Free(_)) || is_taken((node, axis)) {
            return Err(refused(
                "a support, a load, a contact, a tie or another equation has it already",
            ));
        }
        let sense = dot(freedoms.local(node)[axis], unit(direction)).signum();
        Ok((axis, sense))
    }
}
