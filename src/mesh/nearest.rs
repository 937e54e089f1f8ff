//! Search for the node nearest to a point.

use super::Mesh;
use crate::space::{Vector, difference, length};

/// The node nearest to a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct NearestNode {
    pub node: usize,
    /// Distance of the node from the point.
    pub distance: f64,
    /// Length of the longest edge of the elements at the node.
    pub edge: f64,
}

impl NearestNode {
    /// The node nearest to `x`, among the nodes of all bodies or of one body; `None` if there is no
    /// such body.
    pub(crate) fn of(mesh: &Mesh, body: Option<&str>, x: Vector) -> Option<NearestNode> {
        let name = |e: usize| &mesh.bodies[mesh.element_body[e] as usize];
        let is_of = |e: usize| body.is_none_or(|body| name(e) == body);
        let elements = || (0..mesh.n_elements()).filter(|&e| is_of(e));
        let distance = |node: usize| length(difference(mesh.point(node), x));
        let nodes = elements().flat_map(|e| mesh.nodes(e).iter().map(|&node| node as usize));
        let (node, distance) = nodes
            .map(|node| (node, distance(node)))
            .min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)))?;
        let around = elements().filter(|&e| mesh.nodes(e).contains(&(node as u32)));
        let edges = around.flat_map(|e| {
            let nodes = mesh.nodes(e);
            let edges = mesh.shapes[e].reference().edges.iter();
            edges.map(|&[a, b]| {
                let [a, b] = [a, b].map(|corner| mesh.point(nodes[corner] as usize));
                length(difference(a, b))
            })
        });
        Some(NearestNode {
            node,
            distance,
            edge: edges.fold(0.0, f64::max),
        })
    }
}
