//! CHOLMOD backend: the sparse Cholesky factor of SuiteSparse, computed by a BLAS on supernodes.
//!
//! The code that uses the factor is in `linalg::sparse`. Only `common`, `ordering`, `factor`,
//! `blas` and `openmp` call C.
//!
//! The same BLAS with the same number of threads gives the same bits in every run. With another
//! number of threads the order of sums may differ, and results differ by round-off
//! ([`set_blas_threads`]).
//!
//! # Source
//! T. A. Davis, *Direct Methods for Sparse Linear Systems*, SIAM 2006, chapter 4,
//! doi:10.1137/1.9780898718881; Y. Chen, T. A. Davis, W. W. Hager, S. Rajamanickam, *Algorithm 887:
//! CHOLMOD*, ACM TOMS 35 (3), 2008, doi:10.1145/1391989.1391995.

mod blas;
mod common;
mod factor;
mod kernels;
mod matrix;
mod openmp;
mod ordering;
#[cfg(test)]
pub(in crate::linalg) mod tests;

pub use blas::{blas_name, blas_threads, blas_threads_are_too_many, kernels, set_blas_threads};
pub use common::cholmod_version;
pub use kernels::{KERNEL_SETTING, better_kernels, slow_kernels};
pub use ordering::Method;

#[cfg(feature = "mumps")]
use super::sparse::Supervariables;
use super::sparse::{self, Groups, LowerFactor, Pattern, SparseCondensed};
use super::{Condensed, Partition, Prediction, SymmetricCsc, check};
use crate::error::Result;
use common::Common;
use factor::{CholmodFactor, FactorSystem};
use matrix::SymmetricView;
use openmp::Serial;
use ordering::CholmodOrdering;

/// A matrix factored by CHOLMOD and condensed.
type CholmodCondensed = SparseCondensed<CholmodFactor>;

/// Orders, factors and condenses `matrix + diag(shift)`.
///
/// # Errors
/// Errors of [`super::condense`].
pub fn condense(
    matrix: &SymmetricCsc,
    partition: &Partition,
    shift: &[f64],
) -> Result<Box<dyn Condensed>> {
    condense_with_method(matrix, partition, shift, Method::Automatic)
}

/// Condenses as [`condense`] does, in an ordering found by `method`.
///
/// # Errors
/// Errors of [`super::condense`].
pub fn condense_with_method(
    matrix: &SymmetricCsc,
    partition: &Partition,
    shift: &[f64],
    method: Method,
) -> Result<Box<dyn Condensed>> {
    let common = Common::start()?;
    let condensed = with_common(common, matrix, partition, shift, method)?;
    Ok(Box::new(condensed))
}

fn with_common(
    common: Common,
    matrix: &SymmetricCsc,
    partition: &Partition,
    shift: &[f64],
    method: Method,
) -> Result<CholmodCondensed> {
    check::arguments(matrix, partition, shift)?;
    let pattern = Pattern::new(matrix);
    let groups = Groups::new(partition);
    let (mut factor, name) = analyze(common, &pattern, &groups, method)?;
    let cost = sparse::prediction(&factor, name, matrix, &groups);
    sparse::require_memory(&cost, matrix)?;

    // A copy of the values, shifted for the factorisation.
    let mut values = matrix.data().to_vec();
    let diagonal = sparse::shifted_diagonal(matrix, partition, shift);
    for (&end, &value) in matrix.proper_indptr()[1..].iter().zip(&diagonal) {
        values[end as usize - 1] = value;
    }
    {
        let _serial = Serial::new();
        let _entered = blas::enter()?;
        factor.allocate()?;
        factor.factorize(&SymmetricView::with_values(&pattern, &values))?;
    }
    drop(values);
    SparseCondensed::new(factor, &diagonal, partition, shift, cost)
}

/// Predicts the cost of [`condense`] by its ordering and symbolic analysis.
///
/// # Errors
/// Errors of [`super::predict`].
pub fn predict(matrix: &SymmetricCsc, partition: &Partition) -> Result<Prediction> {
    predict_with_method(matrix, partition, Method::Automatic)
}

/// Predicts the cost as [`predict`] does, for an ordering found by `method`.
///
/// # Errors
/// Errors of [`super::predict`].
pub fn predict_with_method(
    matrix: &SymmetricCsc,
    partition: &Partition,
    method: Method,
) -> Result<Prediction> {
    check::arguments(matrix, partition, &[])?;
    let groups = Groups::new(partition);
    let (factor, name) = analyze(Common::start()?, &Pattern::new(matrix), &groups, method)?;
    Ok(sparse::prediction(&factor, name, matrix, &groups))
}

/// Enters the BLAS on behalf of another library, so that the BLAS has its work buffer.
///
/// # Errors
/// `Analysis` if the limits of the process leave no room for the work buffer.
#[cfg(feature = "mumps")]
pub(super) fn enter_blas() -> Result<impl Sized> {
    blas::enter()
}

/// Finds an elimination ordering that ends with the supervariables that stay; returns its name and
/// its permutation. `first` holds the first freedom of each supervariable, followed by the number
/// of freedoms; `stays` marks the supervariables that are not eliminated; `coupled` holds the pairs
/// of coupled supervariables.
///
/// # Errors
/// Errors of [`super::predict`].
#[cfg(feature = "mumps")]
pub(super) fn order(
    first: Vec<usize>,
    stays: &[bool],
    coupled: &[[i32; 2]],
) -> Result<(&'static str, Vec<i64>)> {
    let member = stays.iter().map(|stays| if *stays { 2 } else { 0 });
    let compressed = Supervariables::known(first, member.collect(), coupled);
    let entries = compressed.pattern().rows().len() as f64 * compressed.size().powi(2);
    let mut common = Common::start()?;
    let order = ordering::choose_for(&mut common, &compressed, entries, Method::Automatic)?;
    Ok((order.name, order.permutation))
}

/// Cost of CHOLMOD's own factorisation of a matrix, without groups.
#[derive(Debug, Clone, PartialEq)]
pub struct Unconstrained {
    /// Predicted figures of the symbolic analysis.
    pub prediction: Prediction,
    /// Seconds that ordering and symbolic analysis took.
    pub analyse_seconds: f64,
    /// Seconds that the numerical factorisation took.
    pub factor_seconds: f64,
    /// Seconds that a solve with one right-hand side took.
    pub solve_seconds: f64,
}

/// Analyses and factors `matrix` as CHOLMOD does by default, without groups, and drops the factor.
/// The condensation is measured against this factorisation.
///
/// # Errors
/// Errors of [`super::condense`].
pub fn factor_unconstrained(matrix: &SymmetricCsc) -> Result<Prediction> {
    Ok(unconstrained(matrix, None)?.prediction)
}

/// Factors as [`factor_unconstrained`] does, solves once, and measures the times.
///
/// # Errors
/// Errors of [`super::condense`]; `Internal` if the load has the wrong length.
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
    let pattern = Pattern::new(matrix);
    let mut factor = CholmodFactor::analyze(common, &SymmetricView::new(&pattern), None)?;
    let analyse_seconds = lap();
    {
        let _entered = blas::enter()?;
        factor.factorize(&SymmetricView::with_values(&pattern, matrix.data()))?;
    }
    let factor_seconds = lap();
    if let Some(load) = load {
        factor.solve(FactorSystem::Whole, load)?;
    }
    let solve_seconds = lap();
    Ok(Unconstrained {
        prediction: sparse::prediction(&factor, "CHOLMOD's own", matrix, &Groups::new(&partition)),
        analyse_seconds,
        factor_seconds,
        solve_seconds,
    })
}

/// Orders and analyses symbolically; each group occupies contiguous columns of the factor.
fn analyze(
    mut common: Common,
    pattern: &Pattern,
    groups: &Groups,
    method: Method,
) -> Result<(CholmodFactor, &'static str)> {
    let CholmodOrdering {
        name,
        mut permutation,
        ..
    } = ordering::choose(&mut common, pattern, groups, method)?;
    let matrix = SymmetricView::new(pattern);
    let factor = CholmodFactor::analyze(common, &matrix, Some(&mut permutation))?;
    sparse::require_groups(groups, factor.permutation(), name)?;
    Ok((factor, name))
}
