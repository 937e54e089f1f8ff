//! Checks of the arguments on which the backends rely.

use super::{Partition, SymmetricCsc};
use crate::error::{Error, Result};

/// Checks that the three arguments are well formed and fit together: `matrix` is `n x n`,
/// compressed by column, upper triangle, finite, its diagonal stored; the freedoms of the partition
/// are distinct and below `n`; `shift` is empty or has a finite value for each contact freedom.
pub(super) fn arguments(matrix: &SymmetricCsc, partition: &Partition, shift: &[f64]) -> Result<()> {
    let n = partition.n;
    any_freedoms(n)?;
    if matrix.rows() != n || matrix.cols() != n || !matrix.is_csc() {
        return Err(Error::internal(format!(
            "the matrix is {} x {}{}, the partition has {n} freedoms: hand over the upper triangle \
             by columns",
            matrix.rows(),
            matrix.cols(),
            if matrix.is_csc() { "" } else { " by rows" },
        )));
    }
    if u32::try_from(n).is_err() {
        return Err(Error::input(format!(
            "{n} freedoms are more than the {} that can be numbered: use a coarser mesh",
            u32::MAX
        )));
    }
    for (j, column) in matrix.outer_iterator().enumerate() {
        if column.indices().last() != Some(&(j as i64)) {
            return Err(Error::internal(format!(
                "column {j} of the matrix must end with its diagonal entry (upper triangle, rows \
                 ascending)"
            )));
        }
        if let Some((i, value)) = column.iter().find(|(_, value)| !value.is_finite()) {
            return Err(Error::internal(format!(
                "entry ({i}, {j}) of the matrix is {value}: check material and mesh"
            )));
        }
    }
    self::partition(partition, shift)
}

fn any_freedoms(n: usize) -> Result<()> {
    if n > 0 {
        return Ok(());
    }
    Err(Error::internal(
        "a matrix without freedoms cannot be factored: the model has nothing to solve for",
    ))
}

/// Checks that the freedoms of a partition are distinct and below `n`; `shift` is empty or has a
/// finite value for each contact freedom.
pub(super) fn partition(partition: &Partition, shift: &[f64]) -> Result<()> {
    let n = partition.n;
    any_freedoms(n)?;
    let mut seen = vec![false; n];
    for (group, list) in [("zone", &partition.zone), ("contact", &partition.contact)] {
        for &freedom in list {
            match seen.get_mut(freedom) {
                None => {
                    return Err(Error::internal(format!(
                        "{group} freedom {freedom} does not exist: the matrix has {n}"
                    )));
                }
                Some(true) => {
                    return Err(Error::internal(format!(
                        "freedom {freedom} is listed twice in zone and contact"
                    )));
                }
                Some(new) => *new = true,
            }
        }
    }
    if !shift.is_empty() && shift.len() != partition.contact.len() {
        return Err(Error::internal(format!(
            "{} values of shift for {} contact freedoms",
            shift.len(),
            partition.contact.len()
        )));
    }
    if let Some((k, value)) = shift.iter().enumerate().find(|(_, d)| !d.is_finite()) {
        return Err(Error::internal(format!(
            "the shift of contact freedom {} is {value}",
            partition.contact[k]
        )));
    }
    Ok(())
}

/// Checks that a vector of `what` has the `expected` length.
pub(super) fn length(what: &str, found: usize, expected: usize) -> Result<()> {
    if found == expected {
        return Ok(());
    }
    Err(Error::internal(format!(
        "{found} values of {what} where {expected} are needed"
    )))
}

/// Whether each of `some` (ascending) occurs in `all` (ascending).
pub(super) fn contains(all: &[usize], some: &[usize]) -> bool {
    some.iter().all(|one| all.binary_search(one).is_ok())
}
