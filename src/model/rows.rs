//! Contact rows: the constraint of each pair, expressed by free freedoms.
//!
//! ```text
//!     u_slave . n - sum_k w_k u_k . n = sum_i b_i u_i <= delta
//! ```
//!
//! Nodes that face each other give the two coefficients -1 and 1; surfaces that do not match give
//! the coefficient 1 of the slave and several of the masters.

use super::freedoms::{Freedoms, Slot};
use super::pairs::Pair;
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::space::dot;
use std::collections::BTreeMap;

/// Cosine up to which a master's direction counts as orthogonal to the normal.
const ROUND_OFF: f64 = 16.0 * f64::EPSILON;

/// Contact rows of all pairs.
#[derive(Debug, Clone, Default)]
pub struct ContactRows {
    /// Free freedoms on which rows act: freedoms of masters in the order of the pairs, then
    /// overlaps of soft contact, then the normal freedoms of the slaves.
    pub freedoms: Vec<usize>,
    /// Places in `freedoms` and coefficients `b` of each pair; the last is the slave's, 1.
    pub entries: Vec<Vec<(usize, f64)>>,
    /// Number of rows that act on each contact freedom.
    rows_at: Vec<u32>,
    /// Range of the overlaps within `freedoms`.
    overlaps: std::ops::Range<usize>,
    /// Whether no two rows share a freedom and all coefficients are -1 and 1.
    are_apart: bool,
}

impl ContactRows {
    /// Builds the rows of the pairs.
    ///
    /// # Errors
    /// A slave whose normal displacement is held or prescribed.
    pub(super) fn of(mesh: &Mesh, freedoms: &Freedoms, pairs: &[Pair]) -> Result<Self> {
        let held = |node: usize| {
            Error::input(format!(
                "node {} belongs to a contact pair but its normal displacement is held by a \
                 support or load",
                mesh.node_label(node)
            ))
        };
        let normal = |node: usize| freedoms.normal_freedom(node).ok_or_else(|| held(node));
        let slaves: Vec<usize> =
            (pairs.iter().map(|pair| normal(pair.slave))).collect::<Result<_>>()?;
        let is_slave: BTreeMap<usize, usize> = slaves
            .iter()
            .enumerate()
            .map(|(k, &freedom)| (freedom, k))
            .collect();
        let mut of_masters: Vec<Vec<(usize, f64)>> = Vec::with_capacity(pairs.len());
        let mut place: BTreeMap<usize, usize> = BTreeMap::new();
        let mut masters = Vec::new();
        for pair in pairs {
            let row = on_masters(freedoms, pair);
            for &(freedom, _) in &row {
                if !is_slave.contains_key(&freedom) {
                    place.entry(freedom).or_insert_with(|| {
                        masters.push(freedom);
                        masters.len() - 1
                    });
                }
            }
            of_masters.push(row);
        }
        let first = masters.len();
        for spring in &freedoms.springs {
            let Some(pair) = spring.pair else { continue };
            place.insert(spring.freedom, masters.len());
            masters.push(spring.freedom);
            of_masters[pair].push((spring.freedom, -1.0));
        }
        let overlaps = first..masters.len();
        let n_masters = masters.len();
        let place_of = |freedom: usize| match is_slave.get(&freedom) {
            Some(k) => n_masters + k,
            None => place[&freedom],
        };
        let entries: Vec<Vec<(usize, f64)>> = (of_masters.into_iter().enumerate())
            .map(|(k, row)| {
                let of_masters = row.into_iter().map(|(freedom, b)| (place_of(freedom), b));
                of_masters.chain([(n_masters + k, 1.0)]).collect()
            })
            .collect();
        let are_apart = n_masters == pairs.len()
            && overlaps.is_empty()
            && entries
                .iter()
                .all(|row| row.len() == 2 && row[0].0 < n_masters && row[0].1 == -1.0);
        masters.extend(slaves);
        let mut rows_at = vec![0; masters.len()];
        entries.iter().flatten().for_each(|&(i, _)| rows_at[i] += 1);
        Ok(ContactRows {
            freedoms: masters,
            entries,
            rows_at,
            overlaps,
            are_apart,
        })
    }

    /// Number of contact freedoms.
    pub fn n_contact(&self) -> usize {
        self.freedoms.len()
    }

    /// Displacement of a row, `sum b_i u_i`, for displacements of the contact freedoms.
    pub fn slip(&self, row: usize, contact: impl Fn(usize) -> f64) -> f64 {
        self.entries[row].iter().map(|&(i, b)| b * contact(i)).sum()
    }

    /// Adds the forces `-B' r` on the contact freedoms for row forces `r`, compressive positive.
    pub(crate) fn add_forces(&self, forces: &[f64], mut add: impl FnMut(usize, f64)) {
        for (row, force) in self.entries.iter().zip(forces) {
            for &(i, b) in row {
                add(i, -b * force);
            }
        }
    }

    /// Displacements along the normal of the masters' side and of the slave.
    pub(crate) fn both_sides(&self, row: usize, contact: &[f64]) -> [f64; 2] {
        let [masters @ .., slave] = self.entries[row].as_slice() else {
            return [0.0; 2];
        };
        let masters = masters.iter().filter(|(i, _)| !self.overlaps.contains(i));
        let faced: f64 = masters.map(|&(i, b)| -b * contact[i]).sum();
        [faced, contact[slave.0]]
    }

    /// Freedoms on which no other row acts and on which this row acts with its whole force, each
    /// with its coefficient, 1 or -1.
    pub fn own(&self, row: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let entries = self.entries[row].iter().copied();
        entries.filter(|&(i, b)| b.abs() == 1.0 && self.rows_at[i] == 1)
    }

    /// Moves the part of a load that closed rows can carry from the contact freedoms to `carried`,
    /// as compressive forces of the rows. If no two rows share a freedom, the loads that remain on
    /// both nodes of a pair are equal; otherwise no load remains on the slaves.
    pub(crate) fn take_carried(&self, contact: &mut [f64], carried: &mut [f64], open: &[bool]) {
        if self.are_apart {
            let (first, second) = contact.split_at_mut(carried.len());
            let pairs = first.iter_mut().zip(second).zip(carried);
            for (((first, second), carried), open) in pairs.zip(open) {
                if !open {
                    let half = 0.5 * (*first + *second);
                    *carried += 0.5 * (*first - *second);
                    (*first, *second) = (half, half);
                }
            }
            return;
        }
        // A slave may be the master of another row; such a chain of bodies has at most as many
        // links as there are rows.
        for _ in 0..self.entries.len() {
            let mut changed = false;
            let closed = self
                .entries
                .iter()
                .zip(&mut *carried)
                .zip(open)
                .filter(|(_, open)| !**open);
            for ((row, carried), _) in closed {
                let Some(&(slave, _)) = row.last() else {
                    continue;
                };
                let force = contact[slave];
                if force == 0.0 {
                    continue;
                }
                changed = true;
                *carried -= force;
                for &(i, b) in row {
                    contact[i] -= b * force;
                }
                contact[slave] = 0.0;
            }
            if !changed {
                break;
            }
        }
    }
}

/// Coefficients of a pair's row on the freedoms of its masters.
fn on_masters(freedoms: &Freedoms, pair: &Pair) -> Vec<(usize, f64)> {
    let mut row: Vec<(usize, f64)> = Vec::new();
    for &(node, weight) in &pair.masters {
        let axes = freedoms.local(node);
        let along_normal = axes[0] == pair.normal;
        for (local, slot) in freedoms.of_node(node).iter().enumerate() {
            // An axis that equals the normal has exactly the coefficient 1.
            let share = match (along_normal, local) {
                (true, 0) => 1.0,
                (true, _) => continue,
                (false, _) => dot(pair.normal, axes[local]),
            };
            if share.abs() <= ROUND_OFF {
                continue;
            }
            freedoms.each(*slot, |slot, c| match slot {
                Slot::Free(freedom) => {
                    let (freedom, b) = (freedom as usize, -c * weight * share);
                    match row.iter_mut().find(|entry| entry.0 == freedom) {
                        Some(entry) => entry.1 += b,
                        None => row.push((freedom, b)),
                    }
                }
                // A prescribed motion of a master changes the gap instead
                // (`loads::open_by_moved_masters`).
                Slot::Prescribed(_) | Slot::Fixed | Slot::Sum(_) => {}
            });
        }
    }
    row
}
