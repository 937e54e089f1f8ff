//! Linear equations of the scene, by which one displacement follows others, and prescribed
//! differences of displacements.

use super::carried::Carried;
use super::freedoms::{Freedoms, Slot};
use super::names::Entry;
use super::on_mesh::OnMesh;
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::scene::{EquationTerm, Scene};
use crate::space::{Vector, dot, unit};

/// A displacement that follows others: `u . e_direction = sum v_k . u_k + value`.
#[derive(Debug, Clone)]
pub(super) struct Following {
    /// Node whose displacement along `direction` follows.
    pub node: usize,
    pub direction: usize,
    /// Nodes on the right-hand side, each with its vector `v`.
    pub terms: Vec<(usize, Vector)>,
    /// The values that loads prescribe, which are added, with the numbers of the loads.
    pub moved: Vec<(usize, f64)>,
    /// The list of the scene in which the equation stands, and its number there.
    of: (&'static str, usize),
}

/// Resolves the equations of a scene, with one entry for each following node.
///
/// # Errors
/// Input errors: sets that do not exist, sets of different sizes.
pub(super) fn resolve(
    scene: &Scene,
    mesh: &Mesh,
    carried: Option<&Carried>,
) -> Result<Vec<Following>> {
    let mut out = match carried {
        Some(carried) => on_their_way(scene, mesh, carried)?,
        None => Vec::new(),
    };
    for ((list, index), terms, moved) in all(scene) {
        let entry = Entry::of_list(scene, list, index);
        let nodes = nodes_of_terms(&entry, mesh, (list, index), &terms)?;
        let [first, rest @ ..] = terms.as_slice() else {
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
            if moved.is_some() || terms[..] != [(node, unit(direction))] {
                out.push(Following {
                    node,
                    direction,
                    terms,
                    moved: moved.map(|value| (index, value)).into_iter().collect(),
                    of: (list, index),
                });
            }
        }
    }
    Ok(out)
}

/// Prescribed displacements whose nodes come from where an earlier leg of the program left them: a
/// share of that place and a share of the prescribed value are added.
fn on_their_way(scene: &Scene, mesh: &Mesh, carried: &Carried) -> Result<Vec<Following>> {
    let mut out = Vec::new();
    for (index, load) in scene.load.iter().enumerate() {
        let (Some(origin), Some(given)) = (carried.origin_case(scene, index), &load.displacement)
        else {
            continue;
        };
        let entry = Entry::of_list(scene, "load", index);
        let within = |error: Error| entry.refused(error.within(entry.on(&load.on)));
        for (direction, field) in given.components().into_iter().enumerate() {
            let Some(field) = field else { continue };
            let field = OnMesh::new(field, "displacement", scene, mesh).map_err(within)?;
            for node in entry.nodes(mesh, &load.on)? {
                let value = field.at_node(node).map_err(within)?;
                out.push(Following {
                    node,
                    direction,
                    terms: Vec::new(),
                    moved: vec![(index, value), (origin, carried.of_node(node)[direction])],
                    of: ("load", index),
                });
            }
        }
    }
    Ok(out)
}

/// A list of the scene, and the number of an entry.
type Numbered = (&'static str, usize);

/// All equations with their terms, the one that follows first; of a prescribed difference the value
/// too.
fn all(scene: &Scene) -> impl Iterator<Item = (Numbered, Vec<EquationTerm>, Option<f64>)> {
    let equations = scene.equation.iter().enumerate();
    let equations =
        equations.map(|(index, equation)| (("equation", index), equation.terms.clone(), None));
    let loads = scene.load.iter().enumerate();
    let relative = loads.filter_map(|(index, load)| {
        let relative = load.relative.as_ref()?;
        let first = EquationTerm {
            on: load.on.clone(),
            direction: relative.direction,
            coefficient: 1.0,
        };
        let rest = relative.terms.iter().map(|term| EquationTerm {
            coefficient: -term.coefficient,
            ..term.clone()
        });
        let terms = std::iter::once(first).chain(rest).collect();
        Some((("load", index), terms, Some(relative.value)))
    });
    equations.chain(relative)
}

fn nodes_of_terms(
    entry: &Entry,
    mesh: &Mesh,
    (list, index): Numbered,
    terms: &[EquationTerm],
) -> Result<Vec<Vec<usize>>> {
    let mut nodes: Vec<Vec<usize>> = Vec::new();
    for (k, term) in terms.iter().enumerate() {
        let of_term = entry.nodes(mesh, &term.on)?;
        if let Some(first) = nodes.first()
            && of_term.len() != 1
            && of_term.len() != first.len()
        {
            return Err(entry.refused(Error::input(format!(
                "{list} {}: term {} is on the {} nodes of `{}`, the first on {} of `{}`; give it \
                 as many, or one",
                index + 1,
                k + 1,
                of_term.len(),
                term.on,
                first.len(),
                terms[0].on
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
            let (list, index) = self.of;
            let entry = Entry::of_list(scene, list, index);
            let (number, node) = (index + 1, mesh.node_label(node));
            let along = crate::scene::Direction::ALL[direction].name();
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
