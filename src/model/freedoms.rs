//! Freedoms: one per node and axis, in local axes if a contact normal or a rotated support requires
//! them.

use super::contact_basis::ContactBasis;
use super::frame::{ALIGNED, Frame, frame};
use crate::mesh::Mesh;
use crate::space::{Vector, dot, unit};
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

/// Overlap of a pair, as a freedom with a stiffness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spring {
    /// Number of the pair; `None` for the dummy freedom of a model without any other.
    pub pair: Option<usize>,
    /// Free freedom of the overlap.
    pub freedom: usize,
    /// Stiffness `k A`, as force over overlap.
    pub stiffness: f64,
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
    /// Control points of quadratic faces in contact, whose displacements are the freedoms there.
    pub basis: ContactBasis,
    /// Springs of soft contact, whose freedoms are the last of the free freedoms.
    pub springs: Vec<Spring>,
    /// First node of rigid surfaces; all nodes from it on belong to rigid surfaces.
    first_rigid: Option<usize>,
    /// Nodes, axes and coefficients of each sum.
    pub(super) followers: Vec<Vec<(u32, u8, f64)>>,
    /// Numbers of prescribed values that are added to the sum of each follower, and coefficients.
    pub(super) follower_values: Vec<Vec<(u32, f64)>>,
    /// Number of followers by ties; the followers by equations come after them.
    pub(super) n_followers_of_ties: usize,
}

impl Freedoms {
    /// Freedoms that are all free, in global axes and without numbers. Nodes from
    /// `first_rigid` on belong to rigid surfaces.
    pub(super) fn unnumbered(mesh: &Mesh, basis: ContactBasis, first_rigid: Option<usize>) -> Self {
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
            first_rigid,
            followers: Vec::new(),
            follower_values: Vec::new(),
            n_followers_of_ties: 0,
        }
    }

    /// Gives a node local axes.
    pub(super) fn set_frame(&mut self, node: usize, frame: Frame) {
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

    /// Adds a displacement that a load prescribes. Returns its number.
    pub(super) fn add_prescribed(&mut self, load: usize, value: f64) -> u32 {
        self.prescribed.push(Prescribed { load, value });
        self.prescribed.len() as u32 - 1
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

    /// Calls `of` with the free freedoms and prescribed displacements of a slot, and their
    /// coefficients.
    #[inline]
    pub(super) fn each(&self, slot: Slot, mut of: impl FnMut(Slot, f64)) {
        match slot {
            Slot::Sum(k) => {
                for &(node, i, c) in self.followed_axes(k) {
                    match self.slots[node as usize][usize::from(i)] {
                        Slot::Fixed => {}
                        slot => of(slot, c),
                    }
                }
                for &(p, c) in &self.follower_values[k as usize] {
                    of(Slot::Prescribed(p), c);
                }
            }
            Slot::Fixed => {}
            slot => of(slot, 1.0),
        }
    }

    /// Number of displacements that follow others, in ties and equations.
    pub(crate) fn n_tied(&self) -> usize {
        self.followers.len()
    }

    /// Whether a follower, given by its number, follows by a tie rather than by an equation.
    pub(crate) fn is_of_tie(&self, tied: u32) -> bool {
        (tied as usize) < self.n_followers_of_ties
    }

    /// Nodes, axes and coefficients of the sum that a tied slot equals.
    pub fn followed_axes(&self, tied: u32) -> &[(u32, u8, f64)] {
        &self.followers[tied as usize]
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

/// Group of each node and local direction on a surface held plane (numbered by its load) or on a
/// rigid surface (numbered after all loads).
pub(super) type Planes = BTreeMap<(usize, usize), usize>;
