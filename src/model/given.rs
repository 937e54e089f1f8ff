//! Data of a model from arrays that are stated node by node, where a scene relies on geometry.

use super::carried::Carried;
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::space::{Vector, direction, dot, in_words, length};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Two nodes that may touch, given by their indices. Normal and gap may be stated if they are known
/// more accurately than from the mesh.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct NodePair {
    /// Node of the first surface.
    pub first: usize,
    /// Node of the second surface.
    pub second: usize,
    /// Direction from the second body to the first (the paper's i_1), of any length; `None` for the
    /// outward normal of the second surface.
    pub normal: Option<Vector>,
    /// Initial gap, >= 0; `None` for the distance of the nodes along the normal.
    pub gap: Option<f64>,
}

/// Data given in addition to a scene: pairs of a contact and nodal forces of a load, by the index
/// of the contact or load.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct Given {
    pub(super) pairs: BTreeMap<usize, Vec<NodePair>>,
    /// Forces on the model itself (not on the whole of a symmetric one) at factor 1.
    pub(super) forces: BTreeMap<usize, Vec<(usize, Vector)>>,
    /// State that an earlier leg of the program has left.
    pub(super) carried: Option<Carried>,
}

impl Given {
    /// Checks that forces act on existing nodes; nodes of pairs are checked when they are looked up
    /// on their surfaces.
    ///
    /// # Errors
    /// A force on a node that does not exist; displacements of another mesh.
    pub(super) fn check(&self, n_nodes: usize) -> Result<()> {
        if (self.carried.as_ref()).is_some_and(|carried| !carried.is_of(n_nodes)) {
            return Err(Error::input(
                "the displacements carried over are of a mesh with other nodes",
            ));
        }
        let nodes = self.forces.values().flatten().map(|(node, _)| *node);
        match nodes.into_iter().find(|node| *node >= n_nodes) {
            Some(node) => Err(Error::input(format!(
                "a force acts on node {node}, but there are {n_nodes} nodes"
            ))),
            None => Ok(()),
        }
    }
}

/// The node of the first surface that faces a node of the second.
#[derive(Debug, Clone, Copy)]
pub(super) struct Partner {
    /// Place among the nodes of the first surface.
    pub(super) first: usize,
    pub(super) normal: Vector,
    /// Gap of the pair; `None` if the contact's own gap, or else the geometric one, applies.
    pub(super) gap: Option<f64>,
}

/// Deviation from 1 up to which a vector's length counts as 1: normalising it again would only
/// change its last digit.
const UNIT: f64 = 4.0 * f64::EPSILON;

/// Finds the partner of each node of the second surface. `normals` are the outward normals of the
/// second surface.
///
/// # Errors
/// A pair whose nodes are not on the two surfaces, or whose normal points into the second body.
pub(super) fn partners(
    given: &[NodePair],
    mesh: &Mesh,
    names: [&str; 2],
    [first_nodes, second_nodes]: [&[usize]; 2],
    normals: &[Vector],
) -> Result<Vec<Option<Partner>>> {
    let places = |nodes: &[usize]| -> BTreeMap<usize, usize> {
        nodes.iter().enumerate().map(|(i, &n)| (n, i)).collect()
    };
    let (first_places, second_places) = (places(first_nodes), places(second_nodes));
    let mut out = vec![None; second_nodes.len()];
    for (k, pair) in given.iter().enumerate() {
        let place = |node: usize, places: &BTreeMap<usize, usize>, name: &str| {
            places.get(&node).copied().ok_or_else(|| {
                Error::input(format!(
                    "pair {k}: node {} is not on surface `{name}`",
                    mesh.node_label(node)
                ))
            })
        };
        let first = place(pair.first, &first_places, names[0])?;
        let second = place(pair.second, &second_places, names[1])?;
        let outward = normals[second];
        let normal = match pair.normal {
            None => outward,
            Some(n) => {
                if dot(n, outward) <= 0.0 {
                    return Err(Error::input(format!(
                        "pair {k} (nodes {} and {}): the normal {} points into the second body, \
                         whose outward normal there is {}; give the direction from the second body \
                         to the first",
                        mesh.node_label(pair.first),
                        mesh.node_label(pair.second),
                        in_words(n, mesh.dimension),
                        in_words(outward, mesh.dimension)
                    )));
                }
                if (length(n) - 1.0).abs() <= UNIT {
                    n
                } else {
                    direction(n)
                }
            }
        };
        out[second] = Some(Partner {
            first,
            normal,
            gap: pair.gap,
        });
    }
    Ok(out)
}
