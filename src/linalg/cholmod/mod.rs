//! CHOLMOD backend: one sparse factor `P (K + D) P' = L L'` in the order
//! `[ interior | zone | contact ]`.
//!
//! ```text
//!     L = [ L_ii           ]      L_tt = [ L_zz      ]    is the factor of the condensed matrix:
//!         [ L_zi L_zz      ]             [ L_cz L_cc ]    L_tt L_tt' = K_tt + D - K_ti K_ii^-1 K_it = S + D
//!         [ L_ci L_cz L_cc ]
//! ```
//!
//! `D = diag(shift)` acts on contact freedoms only, so it enters `L_cc` alone:
//! `L_cc L_cc' = C + D`. Of the whole module only `common`, `sparse`, `ordering`, `factor`, `blas`
//! and `openmp` call C, and `pages` the system.
//!
//! The same BLAS with the same number of threads gives the same bits in every run; another number
//! of threads may add in another order and differ by round-off ([`set_blas_threads`]).
//!
//! # Source
//! T. A. Davis, *Direct Methods for Sparse Linear Systems*, SIAM 2006, chapter 4,
//! doi:10.1137/1.9780898718881; Y. Chen, T. A. Davis, W. W. Hager, S. Rajamanickam, *Algorithm 887:
//! CHOLMOD*, ACM TOMS 35 (3), 2008, doi:10.1145/1391989.1391995.

mod backward;
mod blas;
mod common;
mod factor;
mod openmp;
mod ordering;
mod pages;
mod panel;
mod sparse;
mod supervariables;
#[cfg(test)]
mod tests;
mod trailing;
mod tree;

pub use blas::{blas_name, blas_threads, blas_threads_are_too_many, set_blas_threads};
pub use common::cholmod_version;
pub use ordering::Method;

use super::{
    Condensed, ContactStiffness, NotDefinite, Partition, Pivot, Prediction, SymmetricCsc, ZonePart,
    check, smallest_pivot_ratio,
};
use crate::error::{Error, Result};
use crate::memory;
use backward::Backward;
use common::Common;
use factor::{Factor, System};
use openmp::Serial;
use ordering::{Groups, Ordering};
use sparse::SymmetricView;
use std::sync::{Mutex, MutexGuard, PoisonError};
use trailing::Trailing;

/// A matrix factored by CHOLMOD and condensed.
pub struct CholmodCondensed {
    /// What was factored.
    partition: Partition,
    /// The zone freedoms in use.
    zone: Vec<usize>,
    shift: Vec<f64>,
    trailing: Trailing,
    solver: Mutex<Solver>,
    cost: Prediction,
    weakest: Pivot,
}

/// The factor and the vectors of its solves.
struct Solver {
    factor: Factor,
    backward: Backward,
    /// In the order of the factor.
    load: Vec<f64>,
    solution: Vec<f64>,
    known: Vec<bool>,
}

impl CholmodCondensed {
    /// Orders, factors and condenses `matrix + diag(shift)`.
    ///
    /// # Errors
    /// As [`super::condense`].
    pub fn new(matrix: &SymmetricCsc, partition: &Partition, shift: &[f64]) -> Result<Self> {
        Self::with_method(matrix, partition, shift, Method::Automatic)
    }

    /// As [`CholmodCondensed::new`], in an order found by `method`.
    ///
    /// # Errors
    /// As [`super::condense`].
    pub fn with_method(
        matrix: &SymmetricCsc,
        partition: &Partition,
        shift: &[f64],
        method: Method,
    ) -> Result<Self> {
        Self::with_common(Common::start()?, matrix, partition, shift, method)
    }

    fn with_common(
        common: Common,
        matrix: &SymmetricCsc,
        partition: &Partition,
        shift: &[f64],
        method: Method,
    ) -> Result<Self> {
        check::arguments(matrix, partition, shift)?;
        let groups = Groups::new(partition);
        let (mut factor, name) = analyze(common, matrix, &groups, method)?;
        let cost = prediction(&factor, name, matrix, &groups);
        // The matrix itself is there already.
        let needed = cost.memory_bytes - 16.0 * matrix.nnz() as f64;
        memory::require(
            &format!("factorisation of {} freedoms", partition.n),
            needed,
        )?;

        // A copy of the values, shifted for the factorisation.
        let mut values = matrix.data().to_vec();
        let columns = matrix.proper_indptr();
        let diagonal = |freedom: usize| columns[freedom + 1] as usize - 1;
        for (&freedom, &d) in partition.contact.iter().zip(shift) {
            values[diagonal(freedom)] += d;
        }
        {
            let _serial = Serial::new();
            let _entered = blas::enter()?;
            factor.allocate()?;
            factor.factorize(&SymmetricView::with_values(matrix, &values))?;
        }
        let weakest = weakest_pivot(&factor, |freedom| values[diagonal(freedom)]);
        if weakest.ratio <= smallest_pivot_ratio(partition.n) {
            return Err(NotDefinite {
                freedom: weakest.freedom,
            }
            .into());
        }
        drop(values);

        let (trailing, zone) = Trailing::extract(&factor, &groups, partition, &partition.zone)?;
        Ok(CholmodCondensed {
            trailing,
            zone,
            partition: partition.clone(),
            shift: shift.to_vec(),
            solver: Mutex::new(Solver {
                backward: Backward::new(&factor),
                factor,
                load: vec![0.0; partition.n],
                solution: vec![0.0; partition.n],
                known: vec![false; partition.n],
            }),
            cost,
            weakest,
        })
    }

    /// Number of interior freedoms as factored.
    fn interior(&self) -> usize {
        self.partition.n - self.partition.zone.len() - self.partition.contact.len()
    }

    fn solver(&self) -> MutexGuard<'_, Solver> {
        self.solver.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Condensed for CholmodCondensed {
    fn contact_stiffness(&self) -> ContactStiffness {
        self.trailing.contact_stiffness(&self.shift)
    }

    fn choose_zone(&mut self, wanted: &[usize]) -> Result<Option<Vec<usize>>> {
        if !check::contains(&self.partition.zone, wanted) {
            return Ok(None);
        }
        let solver = self.solver();
        let groups = Groups::new(&self.partition);
        let chosen = Trailing::extract(&solver.factor, &groups, &self.partition, wanted)?;
        drop(solver);
        (self.trailing, self.zone) = chosen;
        Ok(Some(self.zone.clone()))
    }

    // y = L^-1 P load has y_i = L_ii^-1 load_i and y_t = L_tt^-1 (load_t - L_ti y_i). Since L_ti
    // L_ii' = K_ti and L_ii L_ii' = K_ii,
    //     L_tt y_t = load_t - L_ti L_ii^-1 load_i = load_t - K_ti K_ii^-1 load_i = f_t:
    // the shift is in L_tt alone, which is divided by and multiplied back.
    fn reduce_load(&self, load: &[f64]) -> Result<Vec<f64>> {
        check::length("load", load.len(), self.partition.n)?;
        let mut solver = self.solver();
        let solver = &mut *solver;
        for (value, &freedom) in solver.load.iter_mut().zip(solver.factor.permutation()) {
            *value = load[freedom as usize];
        }
        Ok(solver.factor.solve(System::Lower, &solver.load)?.to_vec())
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

    // L_ii^T u_i = y_i - L_ti^T u_t, since y_i = L_ii^-1 load_i and L_ii L_ti^T = K_it.
    fn recover_all(&self, reduced: &[f64], zone: &[f64], contact: &[f64]) -> Result<Vec<f64>> {
        check::length("reduced load", reduced.len(), self.partition.n)?;
        check::length("zone displacement", zone.len(), self.zone.len())?;
        let n_contact = self.partition.contact.len();
        check::length("contact displacement", contact.len(), n_contact)?;
        let mut solver = self.solver();
        let Solver {
            factor,
            backward,
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
        backward.solve(factor, known, solution, load);
        let mut u = vec![0.0; self.partition.n];
        for (&freedom, value) in factor.permutation().iter().zip(&*solution) {
            u[freedom as usize] = *value;
        }
        Ok(u)
    }

    fn cost(&self) -> Prediction {
        self.cost
    }

    fn weakest_pivot(&self) -> Pivot {
        self.weakest
    }
}

/// Predicts the cost of [`CholmodCondensed::new`] by its ordering and symbolic analysis.
///
/// # Errors
/// As [`super::predict`].
pub fn predict(matrix: &SymmetricCsc, partition: &Partition) -> Result<Prediction> {
    predict_with_method(matrix, partition, Method::Automatic)
}

/// As [`predict`], for an order found by `method`.
///
/// # Errors
/// As [`super::predict`].
pub fn predict_with_method(
    matrix: &SymmetricCsc,
    partition: &Partition,
    method: Method,
) -> Result<Prediction> {
    check::arguments(matrix, partition, &[])?;
    let groups = Groups::new(partition);
    let (factor, name) = analyze(Common::start()?, matrix, &groups, method)?;
    Ok(prediction(&factor, name, matrix, &groups))
}

/// What CHOLMOD alone needs for a matrix.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unconstrained {
    /// Figures of the analysis.
    pub prediction: Prediction,
    /// Seconds for ordering and symbolic analysis.
    pub analyse_seconds: f64,
    /// Seconds for the numerical factorisation.
    pub factor_seconds: f64,
    /// Seconds for a solve with one right-hand side.
    pub solve_seconds: f64,
}

/// Analyses and factors `matrix` as CHOLMOD does by itself, without groups, and drops the factor:
/// what the condensation is measured against.
///
/// # Errors
/// As [`super::condense`].
pub fn factor_unconstrained(matrix: &SymmetricCsc) -> Result<Prediction> {
    Ok(unconstrained(matrix, None)?.prediction)
}

/// As [`factor_unconstrained`], with one solve, timed.
///
/// # Errors
/// As [`super::condense`]; `Internal` where the load has the wrong length.
pub fn solve_unconstrained(matrix: &SymmetricCsc, load: &[f64]) -> Result<Unconstrained> {
    check::length("load", load.len(), matrix.rows())?;
    unconstrained(matrix, Some(load))
}

fn unconstrained(matrix: &SymmetricCsc, load: Option<&[f64]>) -> Result<Unconstrained> {
    let partition = Partition {
        n: matrix.rows(),
        ..Partition::default()
    };
    check::arguments(matrix, &partition, &[])?;
    let mut start = std::time::Instant::now();
    let mut lap = || {
        std::mem::replace(&mut start, std::time::Instant::now())
            .elapsed()
            .as_secs_f64()
    };
    let mut common = Common::start()?;
    common.choose_ordering();
    let mut factor = Factor::analyze(common, &SymmetricView::pattern(matrix), None)?;
    let analyse_seconds = lap();
    {
        let _entered = blas::enter()?;
        factor.factorize(&SymmetricView::with_values(matrix, matrix.data()))?;
    }
    let factor_seconds = lap();
    if let Some(load) = load {
        factor.solve(System::Whole, load)?;
    }
    let solve_seconds = lap();
    Ok(Unconstrained {
        prediction: prediction(&factor, "CHOLMOD's own", matrix, &Groups::new(&partition)),
        analyse_seconds,
        factor_seconds,
        solve_seconds,
    })
}

/// Ordering and symbolic analysis; the groups of the factor's columns are contiguous.
fn analyze(
    mut common: Common,
    matrix: &SymmetricCsc,
    groups: &Groups,
    method: Method,
) -> Result<(Factor, &'static str)> {
    let pattern = SymmetricView::pattern(matrix);
    let Ordering {
        name,
        mut permutation,
        ..
    } = ordering::choose(&mut common, &pattern, groups, method)?;
    let factor = Factor::analyze(common, &pattern, Some(&mut permutation))?;
    if !groups.are_contiguous(factor.permutation()) {
        return Err(Error::internal(format!(
            "the order found by {name} mixes interior, zone and contact freedoms"
        )));
    }
    Ok((factor, name))
}

fn prediction(
    factor: &Factor,
    name: &'static str,
    matrix: &SymmetricCsc,
    groups: &Groups,
) -> Prediction {
    let [_, first_trailing, first_contact, n] = groups.starts();
    let trailing: i64 = factor.column_counts()[first_trailing..].iter().sum();
    let entries = matrix.nnz();
    // Contact columns of a body are coupled with one another, all of them, and with no others: half
    // of each block.
    let of_contact: i64 = factor.column_counts()[first_contact..].iter().sum();
    let blocks = 2.0 * of_contact as f64 - (n - first_contact) as f64;
    Prediction {
        ordering: name,
        factor_nonzeros: factor.nonzeros(),
        flops: factor.flops(),
        trailing_nonzeros: trailing as f64,
        // The matrix as given (16 bytes an entry), the copy of its values, the factor with its own
        // needs; after it the trailing copy, condensed stiffness and vectors, smaller than what is
        // gone by then or added here.
        memory_bytes: 24.0 * entries as f64
            + factor.bytes(entries)
            + 8.0 * trailing as f64
            + 8.0 * 3.0 * blocks
            + 8.0 * 8.0 * n as f64,
    }
}

/// The smallest `l_jj^2 / a_jj`, the first of equals in the order of elimination.
fn weakest_pivot(factor: &Factor, diagonal: impl Fn(usize) -> f64) -> Pivot {
    let mut weakest = Pivot {
        freedom: 0,
        ratio: f64::INFINITY,
    };
    for (&freedom, pivot) in factor.permutation().iter().zip(factor.columns().pivots()) {
        let freedom = freedom as usize;
        let ratio = pivot * pivot / diagonal(freedom);
        if ratio < weakest.ratio || ratio.is_nan() {
            weakest = Pivot { freedom, ratio };
        }
    }
    weakest
}
