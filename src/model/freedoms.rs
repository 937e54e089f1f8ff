//! Freedoms: one per node and axis, in local axes if a contact normal or a rotated support requires
//! them.

use super::carried::Carried;
use super::contact_basis::ContactBasis;
use super::equations::Following;
use super::followers::{Followers, Others};
use super::frame::{ALIGNED, Frame, frame};
use super::pairs::Pair;
use super::pairs::ties::ResolvedTie;
use super::rigid::RigidBodies;
use super::springs::Spring;
use super::supports::{HeldDirection, Supports, turn_normals_into_supports};
use crate::error::Result;
use crate::mesh::Mesh;
use crate::scene::Scene;
use crate::space::{Vector, dot, in_words, unit};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// State of a node's displacement along one of its axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Slot {
    /// A free freedom with its number. Nodes of a surface held plane share one.
    Free(u32),
    /// A displacement held at zero.
    Fixed,
    /// A displacement held at a prescribed value, see [`Freedoms::prescribed`].
    Prescribed(u32),
    /// A weighted sum of other displacements, which this one follows in a tie or an equation.
    Sum(u32),
}

/// Displacement prescribed by a load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prescribed {
    /// Index of the load whose factor scales the displacement.
    pub load: usize,
    /// Displacement at factor 1.
    pub value: f64,
}

/// Numbering of the freedoms, and the local axes to which they belong: `u = sum u_i a_i`.
#[derive(Debug, Clone, Default)]
pub struct Freedoms {
    /// Number of free freedoms.
    pub n: usize,
    /// Number of freedoms of a node, which is the dimension of the mesh.
    pub per_node: usize,
    /// Slots of each node, one per local axis; in the plane the third is held.
    pub slots: Vec<[Slot; 3]>,
    /// Number of each node's local axes in `frames`.
    frame_of: Vec<u32>,
    /// All different local axes, the global ones first.
    frames: Vec<Frame>,
    /// Displacements that loads prescribe.
    pub prescribed: Vec<Prescribed>,
    /// Node and local direction of each free freedom, for messages.
    pub owners: Vec<(u32, u8)>,
    /// Control points to whose displacements freedoms belong on quadratic faces in contact.
    pub basis: ContactBasis,
    /// Springs of soft contact, whose freedoms are the last of the free freedoms.
    pub springs: Vec<Spring>,
    /// First node of rigid surfaces; all nodes from it on belong to rigid surfaces.
    first_rigid: Option<usize>,
    /// Nodes, axes and coefficients of each sum.
    pub(super) followers: Vec<Vec<(u32, u8, f64)>>,
    /// Numbers of prescribed values that are added to the sum of each follower, and coefficients.
    pub(super) follower_values: Vec<Vec<(u32, f64)>>,
    /// How many of the followers belong to ties; those of equations come after them.
    pub(super) n_followers_of_ties: usize,
}

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
        let mut freedoms = Freedoms::unnumbered(mesh, basis, rigid);
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
        let mut planes = freedoms.apply_loads(scene, mesh, &touches, carried)?;
        planes.extend(
            shared
                .into_iter()
                .map(|(axis, k)| (axis, scene.load.len() + k)),
        );
        let middles = freedoms.give_to_control_points(scene.load.len());
        let others = Others {
            plane: &|axis| planes.contains_key(&axis),
            pairs: &*pairs,
        };
        let mut followers = freedoms.follow(mesh, ties, &others)?;
        freedoms.follow_ends(&middles, &mut followers);
        freedoms.follow_equations(scene, mesh, equations, &others, &mut followers)?;
        freedoms.number(&planes);
        Ok((freedoms, followers))
    }

    /// Freedoms that are all free, in global axes and without numbers.
    fn unnumbered(mesh: &Mesh, basis: ContactBasis, rigid: &RigidBodies) -> Self {
        let n_nodes = mesh.n_nodes();
        let free = match mesh.dimension {
            2 => [Slot::Free(0), Slot::Free(0), Slot::Fixed],
            _ => [Slot::Free(0); 3],
        };
        Freedoms {
            n: 0,
            per_node: mesh.dimension,
            slots: vec![free; n_nodes],
            frame_of: vec![0; n_nodes],
            frames: vec![frame(mesh.dimension, None, &[]).unwrap_or_default()],
            prescribed: Vec::new(),
            owners: Vec::new(),
            basis,
            springs: Vec::new(),
            first_rigid: rigid.first_node(),
            followers: Vec::new(),
            follower_values: Vec::new(),
            n_followers_of_ties: 0,
        }
    }

    fn set_frame(&mut self, node: usize, frame: Frame) {
        if frame != self.frames[0] {
            self.frame_of[node] = self.frames.len() as u32;
            self.frames.push(frame);
        }
    }

    /// Rotates the axes of a node so that the first lies along a direction.
    pub(super) fn turn(&mut self, node: usize, first: Vector) {
        let frame = frame(self.per_node, Some(first), &[]).unwrap_or_default();
        self.set_frame(node, frame);
    }

    /// Whether a node belongs to a rigid surface.
    pub fn is_rigid(&self, node: usize) -> bool {
        self.first_rigid.is_some_and(|first| node >= first)
    }

    /// Free freedoms of rigid surfaces.
    pub(crate) fn of_rigid(&self) -> impl Iterator<Item = usize> + '_ {
        let owners = self.owners.iter().enumerate();
        owners
            .filter(|(_, owner)| self.is_rigid(owner.0 as usize))
            .map(|(freedom, _)| freedom)
    }

    /// Holds a node along the directions of its supports, in axes of which the first is the contact
    /// normal if there is one.
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

    fn number(&mut self, planes: &Planes) {
        let mut group_freedom = std::collections::BTreeMap::new();
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

    /// Holds a freedom at zero and renumbers the freedoms after it.
    pub(super) fn pin(&mut self, freedom: usize) {
        for slot in self.slots.iter_mut().flatten() {
            if let Slot::Free(f) = *slot {
                *slot = match (f as usize).cmp(&freedom) {
                    std::cmp::Ordering::Less => continue,
                    std::cmp::Ordering::Equal => Slot::Fixed,
                    std::cmp::Ordering::Greater => Slot::Free(f - 1),
                };
            }
        }
        self.owners.remove(freedom);
        self.n -= 1;
    }

    /// Slots of a node, one for each axis of the model.
    #[inline]
    pub fn of_node(&self, node: usize) -> &[Slot] {
        &self.slots[node][..self.per_node]
    }

    /// Local axes of a node; a contact normal is the first.
    #[inline]
    pub fn local(&self, node: usize) -> Frame {
        self.frames[self.frame_of[node] as usize]
    }

    /// Whether the axes of a node differ from the global ones.
    #[inline]
    pub fn is_turned(&self, node: usize) -> bool {
        self.frame_of[node] != 0
    }

    /// Number of the local axis along a global direction (in either sense); `None` if there is
    /// none.
    pub(crate) fn local_axis(&self, node: usize, direction: usize) -> Option<usize> {
        let axes = self.local(node);
        (0..self.per_node).find(|&i| dot(axes[i], unit(direction)).abs() > 1.0 - ALIGNED)
    }

    /// Free freedom of a node along its contact normal (its first local axis).
    pub fn normal_freedom(&self, node: usize) -> Option<usize> {
        match self.slots[node][0] {
            Slot::Free(f) => Some(f as usize),
            _ => None,
        }
    }

    /// Names a freedom for messages: body, node and direction.
    pub(crate) fn describe(&self, mesh: &Mesh, freedom: usize) -> String {
        let Some(&(node, local)) = self.owners.get(freedom) else {
            return format!("freedom {freedom}");
        };
        let Some(axis) = self.local(node as usize).get(local as usize).copied() else {
            let node = mesh.node_label(node as usize);
            return format!("the overlap of soft contact at node {node}");
        };
        let body = (0..mesh.n_elements())
            .find(|&e| mesh.nodes(e).contains(&node))
            .map_or("?", |e| mesh.bodies[mesh.element_body[e] as usize].as_str());
        let axis: Vec<String> = (axis[..self.per_node].iter())
            .map(|a| format!("{a:.3}"))
            .collect();
        format!(
            "body `{body}`, node {}, direction ({})",
            mesh.node_label(node as usize),
            axis.join(", ")
        )
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
        // normal: contact rows count on the slave's.
        for pair in pairs {
            of_node[pair.slave] = Some(pair.normal);
        }
        // Other masters do not need the normal as an axis. Where nothing holds them, such an axis
        // keeps contact rows short.
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

/// Group of each node and local direction that belong to a surface held plane (load index) or to a
/// rigid one (numbers beyond those of the loads).
pub(super) type Planes = BTreeMap<(usize, usize), usize>;
