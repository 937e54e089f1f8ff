//! Common part of the sparse backends: the use of a factor `P (K + D) P' = L L'` in the ordering
//! `[ interior | zone | contact ]`, whichever library computed it.
//!
//! ```text
//!     L = [ L_ii           ]      L_tt = [ L_zz      ]    is the factor of the condensed matrix:
//!         [ L_zi L_zz      ]             [ L_cz L_cc ]
//!         [ L_ci L_cz L_cc ]    L_tt L_tt' = K_tt + D - K_ti K_ii^-1 K_it = S + D
//! ```
//!
//! `D = diag(shift)` acts on contact freedoms only, so it enters `L_cc` alone:
//! `L_cc L_cc' = C + D`.
//!
//! # Source
//! T. A. Davis, *Direct Methods for Sparse Linear Systems*, SIAM 2006, chapter 4,
//! doi:10.1137/1.9780898718881.

mod columns;
mod groups;
mod lower_factor;
mod pages;
mod panel;
mod pattern;
mod supervariables;
#[cfg(test)]
pub(crate) mod tests;
mod trailing;
mod tree;
mod triangular;

pub(crate) use columns::{FactorColumns, Supernodes};
pub(crate) use groups::Groups;
pub(crate) use lower_factor::LowerFactor;
pub(crate) use pages::prefer_large;
pub(crate) use pattern::Pattern;
pub(crate) use supervariables::Supervariables;
pub(crate) use triangular::Triangular;

use super::{
    ChangedFactor, Condensed, ContactStiffness, NotDefinite, Partition, Pivot, Prediction,
    SymmetricCsc, ZonePart, check, smallest_pivot_ratio,
};
use crate::error::{Error, Result};
use crate::memory;
use std::sync::{Mutex, MutexGuard, PoisonError};
use trailing::{Changed, TrailingFactor};

/// A matrix factored by a sparse backend and condensed.
pub(crate) struct SparseCondensed<F> {
    /// Partition with which the matrix was factored.
    partition: Partition,
    /// Zone freedoms that are chosen at present.
    zone: Vec<usize>,
    shift: Vec<f64>,
    pub(crate) trailing: TrailingFactor,
    solver: Mutex<FactorSolver<F>>,
    cost: Prediction,
    weakest: Pivot,
}

/// Factor with the vectors of its solves.
pub(crate) struct FactorSolver<F> {
    pub(crate) factor: F,
    pub(crate) triangular: Triangular,
    /// Load in the order of the factor.
    load: Vec<f64>,
    solution: Vec<f64>,
    known: Vec<bool>,
}

impl<F: LowerFactor> SparseCondensed<F> {
    /// Condenses by the numerical factor of a matrix with this `diagonal`, including the shift.
    ///
    /// # Errors
    /// [`NotDefinite`] if a pivot is no larger than round-off; `Analysis` if the memory does not
    /// suffice.
    pub(crate) fn new(
        factor: F,
        diagonal: &[f64],
        partition: &Partition,
        shift: &[f64],
        cost: Prediction,
    ) -> Result<Self> {
        let weakest = weakest_pivot(&factor, diagonal);
        if weakest.ratio <= smallest_pivot_ratio(partition.n) || weakest.ratio.is_nan() {
            let freedom = weakest.freedom;
            return Err(NotDefinite { freedom }.into());
        }
        let groups = Groups::new(partition);
        let (trailing, zone) =
            TrailingFactor::extract(&factor, &groups, partition, &partition.zone)?;
        Ok(SparseCondensed {
            trailing,
            zone,
            partition: partition.clone(),
            shift: shift.to_vec(),
            solver: Mutex::new(FactorSolver {
                triangular: Triangular::new(&factor.columns()),
                factor,
                load: vec![0.0; partition.n],
                solution: vec![0.0; partition.n],
                known: vec![false; partition.n],
            }),
            cost,
            weakest,
        })
    }

    /// Number of interior freedoms at the factorisation.
    fn interior(&self) -> usize {
        self.partition.n - self.partition.zone.len() - self.partition.contact.len()
    }

    pub(crate) fn solver(&self) -> MutexGuard<'_, FactorSolver<F>> {
        self.solver.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<F: LowerFactor> Condensed for SparseCondensed<F> {
    fn contact_stiffness(&self) -> ContactStiffness {
        self.trailing.contact_stiffness(&self.shift)
    }

    fn choose_zone(&mut self, wanted: &[usize]) -> Result<Option<Vec<usize>>> {
        if !check::contains(&self.partition.zone, wanted) {
            return Ok(None);
        }
        let solver = self.solver();
        let groups = Groups::new(&self.partition);
        let chosen = TrailingFactor::extract(&solver.factor, &groups, &self.partition, wanted)?;
        drop(solver);
        (self.trailing, self.zone) = chosen;
        Ok(Some(self.zone.clone()))
    }

    // y = L^-1 P load has y_i = L_ii^-1 load_i and y_t = L_tt^-1 (load_t - L_ti y_i). Since L_ti
    // L_ii' = K_ti and L_ii L_ii' = K_ii,
    //     L_tt y_t = load_t - L_ti L_ii^-1 load_i = load_t - K_ti K_ii^-1 load_i = f_t:
    // the shift enters L_tt alone. This method divides by L_tt; `condense_load` multiplies by L_tt
    // again.
    fn reduce_load(&self, load: &[f64]) -> Result<Vec<f64>> {
        check::length("load", load.len(), self.partition.n)?;
        let mut solver = self.solver();
        let solver = &mut *solver;
        for (value, &freedom) in solver.load.iter_mut().zip(solver.factor.permutation()) {
            *value = load[freedom as usize];
        }
        let reduced = solver
            .factor
            .solve_lower(&solver.triangular, &mut solver.load)?;
        Ok(reduced.to_vec())
    }

    fn condense_load(&self, reduced: &[f64], zone: &mut [f64], contact: &mut [f64]) -> Result<()> {
        check::length("reduced load", reduced.len(), self.partition.n)?;
        check::length("zone load", zone.len(), self.zone.len())?;
        check::length("contact load", contact.len(), self.partition.contact.len())?;
        let trailing = &reduced[self.interior()..];
        self.trailing.condensed_load(trailing, zone, contact);
        Ok(())
    }

    fn eliminate_zone(&self, zone: &mut [f64], contact: &mut [f64]) {
        self.trailing.eliminate_zone(zone, contact);
    }

    fn recover_zone(&self, zone: &mut [f64], u_contact: &[f64]) {
        self.recover_part(&ZonePart::default(), zone, u_contact);
    }

    fn part_of_zone(&self, marked: &[bool]) -> ZonePart {
        self.trailing.part_of_zone(marked)
    }

    fn recover_part(&self, part: &ZonePart, zone: &mut [f64], u_contact: &[f64]) {
        self.trailing.recover_zone(part, zone, u_contact);
    }

    fn changed(&self) -> Option<Box<dyn ChangedFactor>> {
        let needed = 8.0 * 3.0 * self.trailing.n_values() as f64;
        memory::require("factor of the tangent", needed).ok()?;
        Some(Box::new(Changed::new(&self.trailing, &self.shift)))
    }

    // L_ii^T u_i = y_i - L_ti^T u_t, since y_i = L_ii^-1 load_i and L_ii L_ti^T = K_it.
    fn recover_all(&self, reduced: &[f64], zone: &[f64], contact: &[f64]) -> Result<Vec<f64>> {
        check::length("reduced load", reduced.len(), self.partition.n)?;
        check::length("zone displacement", zone.len(), self.zone.len())?;
        let n_contact = self.partition.contact.len();
        check::length("contact displacement", contact.len(), n_contact)?;
        let mut solver = self.solver();
        let FactorSolver {
            factor,
            triangular,
            load,
            solution,
            known,
        } = &mut *solver;
        solution.copy_from_slice(reduced);
        known.fill(false);
        let interior = self.interior();
        self.trailing.place(
            zone,
            contact,
            &mut known[interior..],
            &mut solution[interior..],
        );
        triangular.backward(&factor.columns(), known, solution, load);
        let mut u = vec![0.0; self.partition.n];
        for (&freedom, value) in factor.permutation().iter().zip(&*solution) {
            u[freedom as usize] = *value;
        }
        Ok(u)
    }

    fn cost(&self) -> Prediction {
        self.cost.clone()
    }

    fn weakest_pivot(&self) -> Pivot {
        self.weakest
    }
}

/// Diagonal of `matrix + diag(shift)`.
pub(crate) fn shifted_diagonal(
    matrix: &SymmetricCsc,
    partition: &Partition,
    shift: &[f64],
) -> Vec<f64> {
    let ends = &matrix.proper_indptr()[1..];
    let values = ends.iter().map(|&end| matrix.data()[end as usize - 1]);
    let mut diagonal: Vec<f64> = values.collect();
    for (&freedom, d) in partition.contact.iter().zip(shift) {
        diagonal[freedom] += d;
    }
    diagonal
}

/// Refuses a factorisation that does not fit into memory before it starts.
///
/// # Errors
/// `Analysis` with the memory needed and the memory left.
pub(crate) fn require_memory(cost: &Prediction, matrix: &SymmetricCsc) -> Result<()> {
    // The matrix itself is in memory already.
    let needed = cost.memory_bytes - 16.0 * matrix.nnz() as f64;
    let what = format!("factorisation of {} freedoms", matrix.rows());
    memory::require(&what, needed)
}

/// Checks that an ordering keeps the groups apart, on which all sparse backends rely.
///
/// # Errors
/// `Internal` if the groups are mixed.
pub(crate) fn require_groups(groups: &Groups, permutation: &[i64], name: &str) -> Result<()> {
    if groups.are_contiguous(permutation) {
        return Ok(());
    }
    Err(Error::internal(format!(
        "the order found by {name} mixes interior, zone and contact freedoms"
    )))
}

/// Predicted cost of an analysed factor.
pub(crate) fn prediction(
    factor: &dyn LowerFactor,
    name: &'static str,
    matrix: &SymmetricCsc,
    groups: &Groups,
) -> Prediction {
    let [_, first_trailing, first_contact, n] = groups.starts();
    let trailing: i64 = factor.column_counts()[first_trailing..].iter().sum();
    let entries = matrix.nnz();
    // Contact columns of a body are all coupled with one another, and with no others: their counts
    // cover half of each block.
    let of_contact: i64 = factor.column_counts()[first_contact..].iter().sum();
    let blocks = 2.0 * of_contact as f64 - (n - first_contact) as f64;
    Prediction {
        ordering: name.into(),
        factor_nonzeros: factor.nonzeros(),
        flops: factor.flops(),
        trailing_nonzeros: trailing as f64,
        // The matrix as given (16 bytes an entry) and the factor with its workspace. Trailing copy,
        // condensed stiffness and vectors come later and are either smaller than what is freed by
        // then or added here.
        memory_bytes: 16.0 * entries as f64
            + factor.bytes(entries)
            + 8.0 * trailing as f64
            + 8.0 * 3.0 * blocks
            + 8.0 * 8.0 * n as f64,
        memory_by_rank: Vec::new(),
    }
}

/// Pivot with the smallest `l_jj^2 / a_jj`; of equal ones the first in the elimination.
fn weakest_pivot(factor: &dyn LowerFactor, diagonal: &[f64]) -> Pivot {
    let mut weakest = Pivot {
        freedom: 0,
        ratio: f64::INFINITY,
    };
    for (&freedom, pivot) in factor.permutation().iter().zip(factor.columns().pivots()) {
        let freedom = freedom as usize;
        let ratio = pivot * pivot / diagonal[freedom];
        if ratio < weakest.ratio || ratio.is_nan() {
            weakest = Pivot { freedom, ratio };
        }
    }
    weakest
}
