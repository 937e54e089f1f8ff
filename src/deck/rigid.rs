//! Nodes that move like a rigid body (`*RIGID BODY`, `*COUPLING` with `*KINEMATIC`).
//!
//! With the displacement `u_r` of the reference node, the rotation `w` and the position `x` of a
//! node,
//!
//! ```text
//! u = u_r + w x (x - x_r)
//! ```
//!
//! along the axes along which the nodes follow the body. The rotation is either the displacement of
//! a rotation node (`ROT NODE`), or given by the degrees of freedom 4 to 6 of the reference node.
//!
//! # Source
//! G. Dhondt, *CalculiX CrunchiX User's Manual* 2.20, `*RIGID BODY`, `*KINEMATIC`.

use super::constraints::{GLOBAL, LocalAxes};
use super::data::{EntitySelection, Rigid, RigidNodes};
use super::facets::Key;
use super::linear::{FreedomCoefficients, LinearRow};
use super::mesh::DeckMesh;
use super::sets::{At, Lookup, What};
use super::source::LinePlace;
use crate::error::Result;
use crate::space::{Vector, cross, difference, dot, length, unit};

/// Largest cosine between two directions that counts as round-off: they are perpendicular.
const ROUND_OFF: f64 = 1e-14;

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

impl DeckRigidBody {
    /// All rigid bodies of a deck.
    ///
    /// # Errors
    /// `Input` for undefined names and numbers, and for a reference that is not a single node.
    pub(super) fn all(bodies: &[Rigid], lookup: Lookup) -> Result<Vec<DeckRigidBody>> {
        let mesh = lookup.mesh;
        let all = bodies.iter().enumerate();
        all.map(|(number, rigid)| {
            let at = (rigid.place, rigid.keyword);
            let reference = one_node(&rigid.reference, lookup, at)?;
            let rotation = match &rigid.rotation {
                Some(node) => one_node(node, lookup, at)?,
                None => (mesh.n_nodes() + number) as u32,
            };
            let set = |name: &String| EntitySelection::Set(name.clone());
            let mut nodes = match &rigid.nodes {
                RigidNodes::Set(name) => lookup.indices(What::Nodes, &set(name), at)?,
                RigidNodes::Elements(name) => {
                    let elements = lookup.indices(What::Elements, &set(name), at)?;
                    let nodes = elements.iter().map(|e| mesh.element_nodes(*e as usize));
                    nodes.flatten().copied().collect()
                }
                RigidNodes::Surface(name) => mesh.nodes_of(&lookup.surface(name, at)?),
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

    /// Nodes of the body in ascending order, without the reference node and the rotation node.
    pub(super) fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    /// The equations of the body's nodes, each along its own axes: those of a `*TRANSFORM`, if the
    /// node has any and follows the body in every direction, otherwise x, y and z. With a direction
    /// `v` and the position `r` relative to the reference node,
    ///
    /// ```text
    /// v . u - v . u_r - (r x v) . w = 0
    /// ```
    pub(super) fn rows(&self, mesh: &DeckMesh, axes: &LocalAxes) -> Vec<LinearRow> {
        let dimension = mesh.dimension();
        let follows_wholly = self.follows[..dimension].iter().all(|follows| *follows);
        let origin = mesh.point(self.reference as usize);
        let mut out = Vec::new();
        for &node in &self.nodes {
            let r = difference(mesh.point(node as usize), origin);
            let own = axes.get(&node).filter(|_| follows_wholly);
            for axis in (0..dimension).filter(|axis| self.follows[*axis]) {
                let v = own.map_or(unit(axis), |own| own[axis]);
                let mut terms = FreedomCoefficients::new();
                match own {
                    Some(_) => _ = terms.insert((node, axis as u8), 1.0),
                    None => add(&mut terms, node, v, axes),
                }
                let largest = terms.iter().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
                let first = largest.map(|(key, _)| *key);
                add(&mut terms, self.reference, v.map(|x| -x), axes);
                let mut arm = cross(r, v).map(|x| -x);
                if dimension == 2 {
                    // In the plane only the rotation about the normal exists.
                    arm = [0.0, 0.0, arm[2]];
                }
                add(&mut terms, self.rotation, arm, axes);
                out.push(LinearRow {
                    terms,
                    first,
                    place: self.place,
                    keyword: self.keyword,
                });
            }
        }
        out
    }
}

/// Adds the term `v . u` of a node's displacement `u`, which is given along the node's own axes.
fn add(terms: &mut FreedomCoefficients, node: u32, v: Vector, axes: &LocalAxes) {
    for (of, axis) in axes.get(&node).unwrap_or(&GLOBAL).iter().enumerate() {
        let c = dot(*axis, v);
        if c.abs() > ROUND_OFF * length(v) {
            *terms.entry((node, of as u8)).or_insert(0.0) += c;
        }
    }
}

fn one_node(target: &EntitySelection, lookup: Lookup, at: At) -> Result<u32> {
    match lookup.indices(What::Nodes, target, at)?[..] {
        [node] => Ok(node),
        ref nodes => {
            let message = format!(
                "the reference is {} nodes; name one node, or a set of one",
                nodes.len()
            );
            Err(lookup.error(at, message))
        }
    }
}

/// The rotations of rigid bodies among a range of degrees of freedom of some nodes: 4 to 6 of a
/// reference node, or 3 of a rotation node in the plane.
pub(super) fn rotations_among(
    bodies: &[Rigid],
    lookup: Lookup,
    nodes: &[u32],
    [first, last]: [usize; 2],
) -> Result<Vec<Key>> {
    let mut out = Vec::new();
    let is_plane = lookup.mesh.dimension() == 2;
    for body in DeckRigidBody::all(bodies, lookup)? {
        if nodes.contains(&body.reference) {
            let freedoms = first.max(4)..=last.min(6);
            out.extend(freedoms.map(|freedom| (body.rotation, freedom as u8 - 4)));
        }
        if is_plane && nodes.contains(&body.rotation) && first <= 3 && last >= 3 {
            out.push((body.rotation, 2));
        }
    }
    out.sort_unstable();
    out.dedup();
    Ok(out)
}
