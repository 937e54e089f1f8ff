//! External force on each node: from loads, supports, prescribed displacements and equations.
//!
//! ```text
//!     f_node = sum_elements int B' sigma - contact forces
//! ```
//!
//! Forces that pass through a tie count on the nodes that the tied node follows; an equation acts
//! with its own force on each of its nodes, as a support does. Sums are taken on
//! the control points of quadratic faces in contact ([`crate::model::ContactBasis`]); the results
//! are consistent forces on the nodes.

use crate::model::{Model, Slot};
use crate::space::{Vector, along, dot};

/// External forces on all nodes in global axes, from the internal forces on control points and the
/// forces of the pairs.
pub(super) fn on_nodes(model: &Model, mut forces: Vec<Vector>, of_pairs: &[f64]) -> Vec<f64> {
    for (pair, &r) in model.pairs.iter().zip(of_pairs) {
        forces[pair.slave] = along(forces[pair.slave], r, pair.normal);
        for &(node, weight) in &pair.masters {
            forces[node] = along(forces[node], -weight * r, pair.normal);
        }
    }
    let freedoms = &model.freedoms;
    for node in 0..forces.len() {
        for (slot, axis) in freedoms.of_node(node).iter().zip(freedoms.local(node)) {
            let Slot::Sum(k) = *slot else { continue };
            if !freedoms.is_of_tie(k) {
                continue;
            }
            let force = dot(forces[node], axis);
            forces[node] = along(forces[node], -force, axis);
            for &(other, local, c) in freedoms.followed_axes(k) {
                let axis = freedoms.local(other as usize)[usize::from(local)];
                forces[other as usize] = along(forces[other as usize], c * force, axis);
            }
        }
    }
    freedoms.basis.gather(&mut forces);
    let d = model.mesh.dimension;
    forces.iter().flat_map(|f| &f[..d]).copied().collect()
}
