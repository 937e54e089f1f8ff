//! Rigid motion of a floating body, measured on the boundary far from contact.
//!
//! The dent of a body is measured from the position that its undeformed surface would have.
//! Supports define this position. A body that only contact holds has no supports; the surface
//! through which it is loaded takes their place. The rigid motion `sum a_j R_j` that best fits the
//! displacement `u` of the nodes of this surface,
//!
//! ```text
//!     a = G^-1 b,    G_ij = sum_f w_f R_if R_jf,    b_i = sum_f w_f R_if u_f
//! ```
//!
//! is linear in `u`: each `a_j` is a row of weights on the freedoms `f` of these nodes. `w_f` is
//! the node's share in a loaded surface times the work of that load on the motions: a load that
//! presses elsewhere, or hardly at all, does not move the reference. A body on which no load does
//! work is measured from its mean: `w_f` is the node's share in the volume, so that half of a body
//! is measured in the same way as the whole.

use super::{Freedoms, LoadCase, RigidMotion, Slot};
use crate::element::volume_points;
use crate::mesh::Mesh;
use crate::space::{Space, Vector};
use nalgebra::{DMatrix, SymmetricEigen};
use std::collections::BTreeMap;

/// Smallest eigenvalue of `G`, scaled to a unit diagonal, at which the nodes distinguish the
/// motions: half of the digits are left.
const TOLD_APART: f64 = 1e-8;

/// A rigid motion that a pin stops at one freedom. The deformation of the body can still contain a
/// share of this motion, so it is fitted together with the motions that remain free.
pub(super) struct StoppedMotion {
    pub part: usize,
    /// Displacement of the freedoms that move. The number of a pinned freedom is the number of its
    /// pin plus the number of free freedoms.
    pub values: Vec<(u32, f64)>,
}

/// Data on which the rigid motions of bodies are measured.
pub(super) struct FarBoundary<'a> {
    pub part_of_node: &'a [usize],
    /// Share of each node in the volume.
    pub volumes: Vec<f64>,
    pub freedoms: &'a Freedoms,
    pub stopped: Vec<StoppedMotion>,
    /// Node and local direction of each pin.
    pub pins: &'a [(usize, usize)],
}

impl FarBoundary<'_> {
    /// Finds the weights of each motion ([`RigidMotion::in_far_boundary`]). `work(motion)` gives,
    /// by load number, the work that each load does on the motion; it lists the loads with forces
    /// on the bodies of the motion.
    pub(super) fn measure(
        &self,
        motions: &mut [RigidMotion],
        loads: &[LoadCase],
        work: impl Fn(usize) -> BTreeMap<usize, f64>,
    ) {
        let mut parts: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (j, motion) in motions.iter().enumerate() {
            parts.entry(motion.part).or_default().push(j);
        }
        let mut nodes_of_part: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (node, part) in self.part_of_node.iter().enumerate() {
            if parts.contains_key(part) {
                nodes_of_part.entry(*part).or_default().push(node);
            }
        }
        for (part, of_part) in parts {
            let mut works: BTreeMap<usize, f64> = BTreeMap::new();
            for (load, work) in of_part.iter().flat_map(|&j| work(j)) {
                *works.entry(load).or_default() += work.powi(2);
            }
            let loaded = works.into_iter().flat_map(|(load, squares)| {
                let works = squares.sqrt();
                let nodes = loads[load].nodes.iter().copied().zip(&loads[load].shares);
                nodes.map(move |(node, share)| (node, works * share))
            });
            let loaded =
                loaded.filter(|(node, weight)| self.part_of_node[*node] == part && *weight > 0.0);
            let all = nodes_of_part.get(&part).into_iter().flatten();
            let all = all.map(|&node| (node, self.volumes[node]));
            let moving = of_part.iter().map(|&j| &*motions[j].values);
            let stopped = self.stopped.iter().filter(|motion| motion.part == part);
            let values: Vec<&[(u32, f64)]> = moving
                .chain(stopped.map(|motion| &*motion.values))
                .collect();
            let weights = [self.on_freedoms(loaded), self.on_freedoms(all)];
            // All rigid motions are fitted, or only the free ones if the nodes do not distinguish
            // all motions.
            let fitted = weights.iter().find_map(|weights| {
                fit(&values, weights).or_else(|| fit(&values[..of_part.len()], weights))
            });
            for (&j, weights) in of_part.iter().zip(fitted.unwrap_or_default()) {
                // Pinned freedoms do not move.
                let free = weights
                    .into_iter()
                    .filter(|(f, _)| (*f as usize) < self.freedoms.n);
                motions[j].in_far_boundary = free.collect();
            }
        }
    }

    /// Weight of each free and pinned freedom of these nodes. A freedom that several nodes share is
    /// counted for each of them.
    fn on_freedoms(&self, nodes: impl Iterator<Item = (usize, f64)>) -> BTreeMap<u32, f64> {
        let pins = self.pins.iter().enumerate();
        let mut pins_of: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        pins.for_each(|(k, pin)| pins_of.entry(pin.0).or_default().push(k));
        let mut out = BTreeMap::new();
        for (node, weight) in nodes {
            for slot in self.freedoms.slots[node] {
                if let Slot::Free(freedom) = slot {
                    *out.entry(freedom).or_insert(0.0) += weight;
                }
            }
            for k in pins_of.get(&node).into_iter().flatten() {
                *out.entry((self.freedoms.n + k) as u32).or_insert(0.0) += weight;
            }
        }
        out
    }
}

/// Share of each node in the volume of its elements. The nodes of an element have equal shares, so
/// that none is negative.
pub(crate) fn volumes_of_nodes(space: Space, mesh: &Mesh) -> Vec<f64> {
    let mut out = vec![0.0; mesh.n_nodes()];
    for (element, &shape) in mesh.shapes.iter().enumerate() {
        let nodes = mesh.nodes(element);
        let points: Vec<Vector> = nodes.iter().map(|&n| mesh.point(n as usize)).collect();
        let kind = (shape, mesh.integration_of(element));
        let weights = volume_points(space, kind, &points).map(|point| point.weight);
        let share = weights.sum::<f64>() / nodes.len() as f64;
        nodes.iter().for_each(|&node| out[node as usize] += share);
    }
    out
}

/// Returns the rows of `G^-1 R' W`; `None` if these freedoms do not distinguish the motions.
fn fit(motions: &[&[(u32, f64)]], weights: &BTreeMap<u32, f64>) -> Option<Vec<Vec<(u32, f64)>>> {
    let m = motions.len();
    let freedoms: Vec<(u32, f64)> = weights.iter().map(|(&f, &w)| (f, w)).collect();
    let value = |j: usize, freedom: u32| {
        let place = motions[j].binary_search_by_key(&freedom, |&(f, _)| f);
        place.map_or(0.0, |at| motions[j][at].1)
    };
    let moved = DMatrix::from_fn(freedoms.len(), m, |i, j| value(j, freedoms[i].0));
    let weighted = DMatrix::from_fn(freedoms.len(), m, |i, j| freedoms[i].1 * moved[(i, j)]);
    let gram = moved.tr_mul(&weighted);
    let scale: Vec<f64> = (0..m).map(|j| gram[(j, j)].sqrt()).collect();
    if m == 0 || scale.iter().any(|s| *s <= 0.0) {
        return None;
    }
    let scaled = DMatrix::from_fn(m, m, |i, j| gram[(i, j)] / (scale[i] * scale[j]));
    let smallest = SymmetricEigen::new(scaled.clone()).eigenvalues.min();
    let inverse = scaled
        .cholesky()
        .filter(|_| smallest > TOLD_APART)?
        .inverse();
    let row = |j: usize| {
        let weight = |k: usize| -> f64 {
            let sum: f64 = (0..m)
                .map(|i| inverse[(j, i)] * weighted[(k, i)] / scale[i])
                .sum();
            sum / scale[j]
        };
        let entries = freedoms
            .iter()
            .enumerate()
            .map(|(k, &(f, _))| (f, weight(k)));
        entries.filter(|(_, w)| *w != 0.0).collect()
    };
    Some((0..m).map(row).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_weights_give_back_the_amplitudes_of_rigid_motions() {
        // Two freedoms at each of three nodes: translations along x and y, and a rotation.
        let place = [[0.0, 0.0], [2.0, 0.0], [1.0, 3.0f64]];
        let motion = |of: &dyn Fn([f64; 2]) -> [f64; 2]| -> Vec<(u32, f64)> {
            let values = place.iter().flat_map(|&x| of(x)).enumerate();
            values.map(|(f, v)| (f as u32, v)).collect()
        };
        let motions = [
            motion(&|_| [1.0, 0.0]),
            motion(&|_| [0.0, 1.0]),
            motion(&|x| [-x[1], x[0]]),
        ];
        let motions: Vec<&[(u32, f64)]> = motions.iter().map(Vec::as_slice).collect();
        let weights = (0..6)
            .map(|f| (f, [0.2, 0.5, 0.3][f as usize / 2]))
            .collect();
        let rows = fit(&motions, &weights).unwrap();
        let amplitudes = [0.7, -1.3, 0.01];
        for (row, amplitude) in rows.iter().zip(amplitudes) {
            let displacement = |f: u32| -> f64 {
                let moved = motions.iter().zip(amplitudes);
                moved.map(|(m, a)| a * m[f as usize].1).sum()
            };
            let found: f64 = row.iter().map(|&(f, w)| w * displacement(f)).sum();
            assert!((found - amplitude).abs() < 1e-14, "{found} {amplitude}");
        }
        // A single node shows no rotation about itself.
        assert!(fit(&motions, &[(0, 1.0), (1, 1.0)].into()).is_none());
    }
}
