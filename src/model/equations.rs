//! Linear equations of the scene, by which one displacement follows others, and prescribed
//! differences of displacements.

use super::carried::Carried;
use super::following::Following;
use super::names::SceneEntry;
use super::on_mesh::OnMesh;
use super::solved::solved;
use super::supports::Supports;
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::scene::{EquationTerm, Scene};
use crate::space::{dot, unit};
use std::collections::BTreeSet;

/// Resolves the equations of a scene, with one entry for each following node.
///
/// # Errors
/// Input errors: sets that do not exist, sets of different sizes.
pub(super) fn resolve(
    scene: &Scene,
    mesh: &Mesh,
    carried: Option<&Carried>,
) -> Result<Vec<Following>> {
    let all = of_entries(scene, mesh, carried)?;
    let is_of_leg = |following: &Following| {
        let (list, index) = following.of;
        list == "load" && !scene.load[index].span().is_whole()
    };
    let (mut of_leg, whole): (Vec<Following>, Vec<Following>) =
        all.into_iter().partition(is_of_leg);
    if of_leg.is_empty() {
        return Ok(whole);
    }
    // Conditions along the axes of one node are solved together.
    let nodes: BTreeSet<usize> = of_leg.iter().flat_map(Following::nodes).collect();
    let (along_axes, mut whole): (Vec<Following>, Vec<Following>) =
        whole.into_iter().partition(|following| {
            let mut of = following.nodes();
            of.all(|node| node == following.node) && nodes.contains(&following.node)
        });
    of_leg.extend(along_axes);
    let follows = whole
        .iter()
        .map(|following| (following.node, following.direction));
    let mut taken: BTreeSet<(usize, usize)> = follows.collect();
    taken.extend(held_in_leg(
        scene,
        mesh,
        carried.map_or(0.0, |carried| carried.at),
    )?);
    whole.extend(solved(of_leg, &taken, |(list, index), why| {
        let entry = SceneEntry::of_list(scene, list, index);
        entry.refused(Error::input(format!("{list} {} {why}", index + 1)))
    })?);
    Ok(whole)
}

/// Nodes and axes along which supports hold the displacement, or loads prescribe it, in the leg of
/// the program that begins at the load factor `start`.
fn held_in_leg(scene: &Scene, mesh: &Mesh, start: f64) -> Result<Vec<(usize, usize)>> {
    let mut out = Vec::new();
    let supports = Supports::resolve(scene, mesh)?.in_leg(scene, start);
    for &node in supports.of_node.keys() {
        let held = (0..mesh.dimension).filter(|&axis| supports.hold_along(node, unit(axis)));
        out.extend(held.map(|axis| (node, axis)));
    }
    let loads = scene.load.iter().enumerate();
    for (index, load) in loads.filter(|(_, load)| load.span().holds_from(start)) {
        let given = load.displacement.iter().flat_map(|d| d.components());
        let given: Vec<usize> = given
            .enumerate()
            .filter_map(|(a, f)| f.map(|_| a))
            .collect();
        if !given.is_empty() {
            for node in SceneEntry::of_list(scene, "load", index).nodes(mesh, &load.on)? {
                out.extend(given.iter().map(|&axis| (node, axis)));
            }
        }
    }
    Ok(out)
}

/// The equations of all entries of a scene, one for each following node.
fn of_entries(scene: &Scene, mesh: &Mesh, carried: Option<&Carried>) -> Result<Vec<Following>> {
    let mut out = match carried {
        Some(carried) => on_their_way(scene, mesh, carried)?,
        None => Vec::new(),
    };
    let start = carried.map_or(0.0, |carried| carried.at);
    for ((list, index), terms, moved) in all(scene) {
        if moved.is_some() && !scene.load[index].span().holds_from(start) {
            continue;
        }
        let entry = SceneEntry::of_list(scene, list, index);
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
                let moved = moved.map(|value| {
                    let before = carried.map_or(0.0, |carried| {
                        let of = terms.iter().map(|&(node, v)| dot(v, carried.of_node(node)));
                        carried.of_node(node)[direction] - of.sum::<f64>()
                    });
                    let taken = carried.and_then(|c| c.taken_over(scene, index, [value, before]));
                    taken.unwrap_or_else(|| vec![(index, value)])
                });
                out.push(Following {
                    node,
                    direction,
                    terms,
                    moved: moved.unwrap_or_default(),
                    of: (list, index),
                });
            }
        }
    }
    Ok(out)
}

/// Equations for prescribed displacements of nodes that start from where an earlier leg of the
/// program left them: a share of that displacement plus a share of the prescribed one.
fn on_their_way(scene: &Scene, mesh: &Mesh, carried: &Carried) -> Result<Vec<Following>> {
    let mut out = Vec::new();
    for (index, load) in scene.load.iter().enumerate() {
        let Some(given) = &load.displacement else {
            continue;
        };
        let entry = SceneEntry::of_list(scene, "load", index);
        let within = |error: Error| entry.refused(error.within(entry.on(&load.on)));
        for (direction, field) in given.components().into_iter().enumerate() {
            let Some(field) = field else { continue };
            let field = OnMesh::new(field, "displacement", scene, mesh).map_err(within)?;
            for node in entry.nodes(mesh, &load.on)? {
                let value = field.at_node(node).map_err(within)?;
                let before = carried.of_node(node)[direction];
                if let Some(moved) = carried.taken_over(scene, index, [value, before]) {
                    out.push(Following {
                        node,
                        direction,
                        terms: Vec::new(),
                        moved,
                        of: ("load", index),
                    });
                }
            }
        }
    }
    Ok(out)
}

/// Name of a list of the scene, and the index of an entry in this list.
type EntryNumber = (&'static str, usize);

/// All equations of the scene, each with its entry, its terms and the value of a prescribed
/// difference. The first term is the displacement that follows the others.
fn all(scene: &Scene) -> impl Iterator<Item = (EntryNumber, Vec<EquationTerm>, Option<f64>)> {
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
    entry: &SceneEntry,
    mesh: &Mesh,
    (list, index): EntryNumber,
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
