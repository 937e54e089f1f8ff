//! faer backend: the sparse factor in pure Rust, without system libraries and under permissive
//! licences.
//!
//! The code that uses the factor is in `linalg::sparse`. The factor is computed on one thread, so
//! all results have the same bits for any number of threads; the solves are shared among threads as
//! with CHOLMOD.
//!
//! # Source
//! S. El Kazdadi, *faer: linear algebra for Rust*, <https://docs.rs/faer>; T. A. Davis, *Direct
//! Methods for Sparse Linear Systems*, SIAM 2006, chapter 4, doi:10.1137/1.9780898718881.

mod elimination;
mod factor;
mod ordering;
#[cfg(test)]
pub(in crate::linalg) mod tests;

use super::sparse::{self, Groups, Pattern, SparseCondensed};
use super::{Condensed, Partition, Prediction, SymmetricCsc, check};
use crate::error::Result;
use factor::{FaerFactor, Symbolic};
use ordering::FillReduction;

/// Orders, factors and condenses `matrix + diag(shift)`.
///
/// # Errors
/// Errors of [`super::condense`].
pub fn condense(
    matrix: &SymmetricCsc,
    partition: &Partition,
    shift: &[f64],
) -> Result<Box<dyn Condensed>> {
    let condensed = with_method(matrix, partition, shift, FillReduction::Automatic)?;
    Ok(Box::new(condensed))
}

fn with_method(
    matrix: &SymmetricCsc,
    partition: &Partition,
    shift: &[f64],
    method: FillReduction,
) -> Result<SparseCondensed<FaerFactor>> {
    check::arguments(matrix, partition, shift)?;
    let groups = Groups::new(partition);
    let (mut factor, symbolic, name) = analyze(&Pattern::new(matrix), &groups, method)?;
    let cost = sparse::prediction(&factor, name, matrix, &groups);
    sparse::require_memory(&cost, matrix)?;
    let diagonal = sparse::shifted_diagonal(matrix, partition, shift);
    factor.factorize(symbolic, matrix, &diagonal)?;
    SparseCondensed::new(factor, &diagonal, partition, shift, cost)
}

/// Predicts the cost of [`condense`] by its ordering and symbolic analysis.
///
/// # Errors
/// Errors of [`super::predict`].
pub fn predict(matrix: &SymmetricCsc, partition: &Partition) -> Result<Prediction> {
    predict_with_method(matrix, partition, FillReduction::Automatic)
}

fn predict_with_method(
    matrix: &SymmetricCsc,
    partition: &Partition,
    method: FillReduction,
) -> Result<Prediction> {
    check::arguments(matrix, partition, &[])?;
    let groups = Groups::new(partition);
    let (factor, _, name) = analyze(&Pattern::new(matrix), &groups, method)?;
    Ok(sparse::prediction(&factor, name, matrix, &groups))
}

/// Orders and analyses symbolically; each group occupies contiguous columns of the factor.
fn analyze(
    pattern: &Pattern,
    groups: &Groups,
    method: FillReduction,
) -> Result<(FaerFactor, Symbolic, &'static str)> {
    let order = ordering::choose(pattern, groups, method)?;
    let name = order.name;
    sparse::require_groups(groups, &order.permutation, name)?;
    let (factor, symbolic) = FaerFactor::analyze(pattern, order)?;
    Ok((factor, symbolic, name))
}
