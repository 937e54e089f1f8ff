//! Displacement of a node as a sum over freedoms, in global axes:
//!
//! ```text
//!     u_node = sum_k v_k d_k      d_k a free freedom or a prescribed displacement
//! ```
//!
//! Rotated axes, control points of quadratic faces, surfaces held plane, ties and equations differ
//! only in the vectors `v`: assembly and analysis know this one form. For an element's
//! displacements the form is `u = C d`; its stiffness on `d` is `C' K C`, the forces on `d` are
//! `C' f`.

use super::Model;
use super::freedoms::{Freedoms, Slot};
use crate::element::packed;
use crate::space::{Vector, along};
use serde::{Deserialize, Serialize};

impl Freedoms {
    /// Calls `of` with the terms of a node's displacement: free freedoms and prescribed
    /// displacements with their vectors.
    #[inline]
    pub fn each_term(&self, node: usize, mut of: impl FnMut(Slot, Vector)) {
        self.basis.each_control(node, |control, weight| {
            for (slot, axis) in self.of_node(control).iter().zip(self.local(control)) {
                self.each(*slot, |slot, c| of(slot, axis.map(|a| weight * c * a)));
            }
        });
    }

    /// Whether the displacements of a node along the global axes are directly its own slots.
    #[inline]
    pub fn is_plain(&self, node: usize) -> bool {
        let follows = |slot: &Slot| matches!(slot, Slot::Sum(_));
        !self.is_turned(node)
            && self.basis.ends(node).is_none()
            && !self.of_node(node).iter().any(follows)
    }

    /// Displacement of a node in global axes, from free freedoms and load factors.
    pub fn displacement(&self, node: usize, u: &[f64], factors: &[f64]) -> Vector {
        let mut sum = [0.0; 3];
        self.each_term(node, |slot, v| {
            sum = along(sum, self.value(slot, u, factors), v);
        });
        sum
    }

    fn value(&self, slot: Slot, u: &[f64], factors: &[f64]) -> f64 {
        match slot {
            Slot::Free(f) => u[f as usize],
            Slot::Prescribed(p) => {
                let p = self.prescribed[p as usize];
                factors[p.load] * p.value
            }
            Slot::Fixed | Slot::Sum(_) => 0.0,
        }
    }
}

/// Displacements of an element's nodes as sums: `u_i = sum_k c_ik d_k`.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Sums {
    /// Slots `d` of the sums: free freedoms and prescribed displacements.
    pub slots: Vec<Slot>,
    /// Number `i` of a nodal displacement, node by node, number `k` of a slot, and `c_ik`.
    parts: Vec<(usize, usize, f64)>,
}

impl Sums {
    fn add(&mut self, own: usize, slot: Slot, coefficient: f64) {
        let known = self.slots.iter().position(|other| *other == slot);
        let k = known.unwrap_or_else(|| {
            self.slots.push(slot);
            self.slots.len() - 1
        });
        self.parts.push((own, k, coefficient));
    }

    /// Computes `C' K C` from a stiffness of `n` displacements; both are packed lower triangles.
    pub fn stiffness(&self, n: usize, stiffness: &[f64], out: &mut [f64]) {
        // First `C' K`, slot by slot.
        let mut shared = vec![0.0; self.slots.len() * n];
        for &(i, k, c) in &self.parts {
            for (j, shared) in shared[k * n..(k + 1) * n].iter_mut().enumerate() {
                *shared += c * stiffness[packed(i, j)];
            }
        }
        out.fill(0.0);
        for &(i, l, c) in &self.parts {
            for k in l..self.slots.len() {
                out[packed(k, l)] += c * shared[k * n + i];
            }
        }
    }
}

impl Model {
    /// Displacements of an element's nodes as sums; `None` if they are directly the slots of its
    /// nodes.
    pub fn sums_of(&self, element: usize) -> Option<Sums> {
        let (nodes, freedoms) = (self.mesh.nodes(element), &self.freedoms);
        if nodes.iter().all(|&node| freedoms.is_plain(node as usize)) {
            return None;
        }
        let mut sums = Sums::default();
        for (i, &node) in nodes.iter().enumerate() {
            freedoms.each_term(node as usize, |slot, v| {
                for (d, c) in v.into_iter().take(freedoms.per_node).enumerate() {
                    if c != 0.0 {
                        sums.add(freedoms.per_node * i + d, slot, c);
                    }
                }
            });
        }
        Some(sums)
    }

    /// Slots on which an element's stiffness acts: free, held and prescribed ones.
    pub fn slots_of(&self, element: usize) -> Vec<Slot> {
        match self.sums_of(element) {
            Some(sums) => sums.slots,
            None => {
                let nodes = self.mesh.nodes(element).iter();
                let of_node = |&node: &u32| self.freedoms.of_node(node as usize);
                nodes.flat_map(of_node).copied().collect()
            }
        }
    }
}
