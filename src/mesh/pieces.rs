//! Connectedness of each body: its elements must be joined to one piece.

use super::Mesh;
use crate::classes::Classes;
use crate::{Error, Result};

/// Checks that the elements of a body are joined by nodes, either the body's own or nodes shared
/// with other bodies. Rigid body modes are handled body by body, and a support of one piece would
/// not hold another.
///
/// # Errors
/// `Input`, naming the body and a node of each of two pieces.
pub(super) fn check(mesh: &Mesh) -> Result<()> {
    let mut classes = Classes::new(mesh.n_nodes());
    for element in 0..mesh.n_elements() {
        let nodes = mesh.nodes(element);
        for pair in nodes.windows(2) {
            classes.join(pair[0] as usize, pair[1] as usize);
        }
    }
    let mut seen: Vec<Option<usize>> = vec![None; mesh.bodies.len()];
    for element in 0..mesh.n_elements() {
        let body = mesh.element_body[element] as usize;
        let node = mesh.nodes(element)[0] as usize;
        let first = *seen[body].get_or_insert(node);
        if classes.first(first) != classes.first(node) {
            let place = |node: usize| format!("{} at {}", mesh.node_label(node), mesh.place(node));
            return Err(Error::input(format!(
                "body `{}` is in several pieces: its elements do not join node {} and node {}; \
                 make each piece a body of its own",
                mesh.bodies[body],
                place(first),
                place(node)
            )));
        }
    }
    Ok(())
}
