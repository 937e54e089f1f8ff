//! Numbers of the freedoms of a scene, from its supports, loads, contact normals, ties and
//! equations.

use super::carried::Carried;
use super::contact_basis::ContactBasis;
use super::followers::{Followers, Others};
use super::following::Following;
use super::frame::{ALIGNED, frame};
use super::freedoms::{Freedoms, Planes, Slot};
use super::pairs::Pair;
use super::pairs::resolved_tie::ResolvedTie;
use super::prescribed::{apply_loads, give_to_control_points};
use super::rigid::RigidBodies;
use super::supports::{HeldDirection, Supports, turn_normals_into_supports};
use crate::error::Result;
use crate::mesh::Mesh;
use crate::scene::Scene;
use crate::space::{Vector, dot, in_words};
use std::collections::BTreeMap;

impl Freedoms {
    /// Numbers the freedoms of a scene. Contact normals on symmetry planes are rotated into the
    /// plane (`pairs` is updated). `master_normals` are the normals of masters that face no single
    /// node.
    ///
    /// # Errors
    /// Input errors: a support in the direction of a contact normal, rotated supports that
    /// disagree, a prescribed displacement on a held freedom, a plane surface that is not free to
    /// move.
    pub(super) fn new(
        scene: &Scene,
        mesh: &Mesh,
        basis: ContactBasis,
        pairs: &mut [Pair],
        master_normals: &[(usize, Vector)],
        (ties, equations, rigid): (&[ResolvedTie], &[Following], &RigidBodies),
        carried: Option<&Carried>,
    ) -> Result<(Self, Followers)> {
        let supports = Supports::resolve(scene, mesh)?;
        // All legs of the program have the same normals.
        turn_normals_into_supports(pairs, &supports);
        let supports = supports.in_leg(scene, carried.map_or(0.0, |carried| carried.at));
        let ContactNormals {
            of_node: normal_of,
            touches,
        } = ContactNormals::new(scene, pairs, master_normals, &supports, mesh.n_nodes());
        let mut freedoms = Freedoms::unnumbered(mesh, basis, rigid.first_node());
        for (node, normal) in normal_of.iter().enumerate() {
            if normal.is_some() && !supports.of_node.contains_key(&node) {
                let frame = frame(mesh.dimension, *normal, &[]).unwrap_or_default();
                freedoms.set_frame(node, frame);
            }
        }
        for (&node, of_node) in &supports.of_node {
            freedoms.hold(scene, mesh, node, normal_of[node], of_node)?;
            if let Some(carried) = carried {
                freedoms.hold_where_it_is(scene, node, of_node, carried);
            }
        }
        let shared = rigid.hold(&mut freedoms);
        let mut planes = apply_loads(&mut freedoms, scene, mesh, &touches, carried)?;
        planes.extend(
            shared
                .into_iter()
                .map(|(axis, k)| (axis, scene.load.len() + k)),
        );
        let middles = give_to_control_points(&mut freedoms, scene.load.len());
        let others = Others {
            plane: &|axis| planes.contains_key(&axis),
            pairs: &*pairs,
        };
        let mut followers = Followers::of_ties(&mut freedoms, mesh, ties, &others)?;
        followers.add_middles(&mut freedoms, &middles);
        followers.add_equations(&mut freedoms, scene, mesh, equations, &others)?;
        freedoms.number(&planes);
        Ok((freedoms, followers))
    }

    /// Holds a node along the directions of its supports. If the node has a contact normal, the
    /// normal is the first of its axes.
    fn hold(
        &mut self,
        scene: &Scene,
        mesh: &Mesh,
        node: usize,
        normal: Option<Vector>,
        of_node: &[HeldDirection],
    ) -> Result<()> {
        let directions: Vec<Vector> = of_node.iter().map(|held| held.direction).collect();
        for (held, direction) in of_node.iter().zip(&directions) {
            let Some(normal) = normal.filter(|n| dot(*n, *direction).abs() > ALIGNED) else {
                continue;
            };
            return Err(held.refused(
                scene,
                format!(
                    "node {} belongs to a contact surface and {} acts along its contact normal {}: \
                     contact and support cannot hold the same freedom; {}",
                    mesh.node_label(node),
                    held.by(scene),
                    in_words(normal, mesh.dimension),
                    match held.support {
                        Some(_) => "take the node out of one of the two sets",
                        None => "give the contact a `normal` along the axis",
                    }
                ),
            ));
        }
        let frame = frame(mesh.dimension, normal, &directions).map_err(|k| {
            of_node[k].refused(
                scene,
                format!(
                    "node {} is held in directions that are not at right angles; the last is {}",
                    mesh.node_label(node),
                    of_node[k].by(scene)
                ),
            )
        })?;
        self.set_frame(node, frame);
        for direction in directions {
            for (slot, axis) in self.slots[node].iter_mut().zip(frame) {
                if dot(axis, direction).abs() > ALIGNED {
                    *slot = Slot::Fixed;
                }
            }
        }
        Ok(())
    }

    /// Holds a node at its carried displacement along supports that began within the program.
    fn hold_where_it_is(
        &mut self,
        scene: &Scene,
        node: usize,
        of_node: &[HeldDirection],
        carried: &Carried,
    ) {
        let began = |held: &&HeldDirection| {
            let support = held.support.map(|index| &scene.support[index]);
            support.is_some_and(|support| support.since.is_some())
        };
        let axes = self.local(node);
        for HeldDirection { direction, .. } in of_node.iter().filter(began) {
            for (i, axis) in axes.into_iter().enumerate() {
                if self.slots[node][i] == Slot::Fixed && dot(axis, *direction).abs() > ALIGNED {
                    let value = dot(carried.of_node(node), axis);
                    let number = self.add_prescribed(Carried::held_case(scene), value);
                    self.slots[node][i] = Slot::Prescribed(number);
                }
            }
        }
    }

    fn number(&mut self, planes: &Planes) {
        let mut group_freedom = BTreeMap::new();
        for node in 0..self.slots.len() {
            for local in 0..self.per_node {
                if !matches!(self.slots[node][local], Slot::Free(_)) {
                    continue;
                }
                let next = self.n as u32;
                let freedom = match planes.get(&(node, local)) {
                    Some(&group) => *group_freedom.entry(group).or_insert(next),
                    None => next,
                };
                if freedom == next {
                    self.owners.push((node as u32, local as u8));
                    self.n += 1;
                }
                self.slots[node][local] = Slot::Free(freedom);
            }
        }
    }
}

/// Contact normals that become the first axes of nodes.
struct ContactNormals {
    /// Normal at each node; `None` if its axes are the global ones or those of its supports.
    of_node: Vec<Option<Vector>>,
    /// Whether each node touches another body.
    touches: Vec<bool>,
}

impl ContactNormals {
    /// Finds the normals from the pairs, from the normals of masters that face no single node, and
    /// from the supports of the leg.
    fn new(
        scene: &Scene,
        pairs: &[Pair],
        master_normals: &[(usize, Vector)],
        supports: &Supports,
        n_nodes: usize,
    ) -> Self {
        let mut of_node = vec![None; n_nodes];
        for pair in pairs {
            // A master that a support holds is an obstacle: it does not move.
            let faced = pair.faced();
            let may_hold = scene
                .contact
                .get(pair.contact)
                .is_some_and(|contact| contact.held);
            let faced = faced.filter(|n| !may_hold || !supports.hold_along(*n, pair.normal));
            if let Some(node) = faced {
                of_node[node] = Some(pair.normal);
            }
        }
        // A node may be the slave of one contact and the master of another with the opposite
        // normal: its first axis is its normal as a slave, on which contact rows rely.
        for pair in pairs {
            of_node[pair.slave] = Some(pair.normal);
        }
        // Masters that face no single node do not need the normal as an axis, but on a master
        // without supports such an axis keeps contact rows short.
        let mut touches: Vec<bool> = of_node.iter().map(Option::is_some).collect();
        for &(node, normal) in master_normals {
            touches[node] = true;
            if !supports.of_node.contains_key(&node) {
                of_node[node].get_or_insert(normal);
            }
        }
        ContactNormals { of_node, touches }
    }
}
