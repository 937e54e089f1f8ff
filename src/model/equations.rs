//! Linear equations of the scene, by which one displacement follows others.

use super::freedoms::{Freedoms, Slot};
use super::names::Entry;
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::scene::{Equation, Scene};
use crate::space::{Vector, dot, unit};

/// A displacement that follows others: `u . e_direction = sum v_k . u_k`.
#[derive(Debug, Clone)]
pub(super) struct Following {
    /// Node whose displacement along `direction` follows.
    pub node: usize,
    pub direction: usize,
    /// Nodes on the right-hand side, each with its vector `v`.
    pub terms: Vec<(usize, Vector)>,
    /// Number of the scene's equation to which this displacement belongs.
    pub equation: usize,
}

/// Resolves the equations of a scene, with one entry for each following node.
///
/// # Errors
/// Input errors: sets that do not exist, sets of different sizes.
pub(super) fn resolve(scene: &Scene, mesh: &Mesh) -> Result<Vec<Following>> {
    let mut out = Vec::new();
    for (index, equation) in scene.equation.iter().enumerate() {
        let entry = Entry::of_list(scene, "equation", index);
        let nodes = nodes_of_terms(&entry, mesh, index, equation)?;
        let [first, rest @ ..] = equation.terms.as_slice() else {
            continue;
        };
        for (i, &node) in nodes[0].iter().enumerate() {
            let terms = rest.iter().zip(&nodes[1..]).map(|(term, on)| {
                let share = -term.coefficient / first.coefficient;
                let node = if on.len() == 1 { on[0] } else { on[i] };
                (node, unit(term.direction.axis()).map(|e| share * e))
            });
            let (direction, terms) = (first.direction.axis(), terms.collect::<Vec<_>>());
            // A node that a whole set follows may itself belong to the set.
            if terms[..] != [(node, unit(direction))] {
                out.push(Following {
                    node,
                    direction,
                    terms,
                    equation: index,
                });
            }
        }
    }
    Ok(out)
}

fn nodes_of_terms(
    entry: &Entry,
    mesh: &Mesh,
    index: usize,
    equation: &Equation,
) -> Result<Vec<Vec<usize>>> {
    let mut nodes: Vec<Vec<usize>> = Vec::new();
    for (k, term) in equation.terms.iter().enumerate() {
        let of_term = entry.nodes(mesh, &term.on)?;
        if let Some(first) = nodes.first()
            && of_term.len() != 1
            && of_term.len() != first.len()
        {
            return Err(entry.refused(Error::input(format!(
                "equation {}: term {} is on the {} nodes of `{}`, the first on {} of `{}`; give it \
                 as many, or one",
                index + 1,
                k + 1,
                of_term.len(),
                term.on,
                first.len(),
                equation.terms[0].on
            ))));
        }
        nodes.push(of_term);
    }
    Ok(nodes)
}

impl Following {
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
            let entry = Entry::of_list(scene, "equation", self.equation);
            entry.refused(Error::input(format!(
                "equation {}: the displacement of node {} along {} cannot follow others: {why}; \
                 put another term first",
                self.equation + 1,
                mesh.node_label(node),
                crate::scene::Direction::ALL[direction].name(),
            )))
        };
        if freedoms.basis.ends(node).is_some() {
            return Err(refused("it is the middle of an edge in contact or tied"));
        }
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
