//! Linear equations of the scene: which displacement follows which others.

use super::freedoms::{Freedoms, Slot};
use super::names::Entry;
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::scene::{Equation, Scene};
use crate::space::{Vector, dot, unit};

/// A displacement that follows others: `u . e_direction = sum v_k . u_k`.
#[derive(Debug, Clone)]
pub(super) struct Following {
    /// The node that follows, and its direction.
    pub node: usize,
    pub direction: usize,
    /// Nodes with `v`.
    pub terms: Vec<(usize, Vector)>,
    /// Which of the scene's equations it is of.
    pub equation: usize,
}

/// The equations of a scene, one for each node that follows.
///
/// # Errors
/// Input errors: sets that there are not, sets of different sizes.
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
            // A node that all of a set follow may belong to it.
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
    /// The axis of its node that follows, with the sense that it has along the direction.
    ///
    /// # Errors
    /// Something else stands there already: a support, a load, a contact normal.
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
