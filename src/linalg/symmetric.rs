//! A symmetric matrix wherever its entries are.

#[cfg(feature = "mumps")]
use super::mumps;
use super::residual::{Rows, largest, norm};
use super::{Backend, Condensed, Partition, Prediction, SymmetricCsc, condense, predict};
#[cfg(feature = "mumps")]
use crate::error::Error;
use crate::error::Result;
use crate::results::Ranks;
use std::sync::Arc;

/// A symmetric matrix: all of it here, or a part on each of several ranks.
#[derive(Debug, Clone)]
pub enum Symmetric {
    /// The whole matrix here, as its upper triangle.
    Whole(Arc<SymmetricCsc>),
    /// Parts of the matrix on the ranks of MUMPS.
    #[cfg(feature = "mumps")]
    Shared(mumps::Shared),
}

impl From<SymmetricCsc> for Symmetric {
    fn from(matrix: SymmetricCsc) -> Self {
        Symmetric::Whole(Arc::new(matrix))
    }
}

impl Symmetric {
    /// The upper triangle, where all of it is here.
    pub fn whole(&self) -> Option<&SymmetricCsc> {
        match self {
            Symmetric::Whole(matrix) => Some(matrix),
            #[cfg(feature = "mumps")]
            Symmetric::Shared(_) => None,
        }
    }

    /// Number of rows.
    pub fn n(&self) -> usize {
        match self {
            Symmetric::Whole(matrix) => matrix.rows(),
            #[cfg(feature = "mumps")]
            Symmetric::Shared(shared) => shared.n(),
        }
    }

    /// Number of entries of the upper triangle.
    pub fn n_entries(&self) -> usize {
        match self {
            Symmetric::Whole(matrix) => matrix.nnz(),
            #[cfg(feature = "mumps")]
            Symmetric::Shared(shared) => shared.n_entries(),
        }
    }

    /// An entry of the diagonal.
    pub fn diagonal(&self, freedom: usize) -> f64 {
        match self {
            Symmetric::Whole(matrix) => matrix.get(freedom, freedom).copied().unwrap_or(0.0),
            #[cfg(feature = "mumps")]
            Symmetric::Shared(shared) => shared.diagonal()[freedom],
        }
    }

    /// The infinity norm: the largest sum of absolute values of a row.
    ///
    /// # Errors
    /// Errors of the ranks.
    pub fn norm(&self) -> Result<f64> {
        match self {
            Symmetric::Whole(matrix) => Ok(norm(matrix)),
            #[cfg(feature = "mumps")]
            Symmetric::Shared(shared) => {
                let nothing = vec![0.0; shared.n()];
                Ok(largest(&shared.rows(&nothing, &nothing)?.stiffness))
            }
        }
    }

    /// What one pass over the matrix states about a solution `u` for the load `f`.
    pub(super) fn rows(&self, f: &[f64], u: &[f64]) -> Result<Rows> {
        match self {
            Symmetric::Whole(matrix) => Ok(Rows::new(matrix, f, u)),
            #[cfg(feature = "mumps")]
            Symmetric::Shared(shared) => shared.rows(f, u),
        }
    }

    /// The largest `|K| |u|` of a row.
    ///
    /// # Errors
    /// Errors of the ranks.
    pub(crate) fn largest_terms(&self, u: &[f64]) -> Result<f64> {
        Ok(largest(&self.rows(&vec![0.0; u.len()], u)?.terms))
    }

    /// What ranks that share it did so far; `None` where all of it is here.
    pub(crate) fn ranks(&self) -> Option<Ranks> {
        match self {
            Symmetric::Whole(_) => None,
            #[cfg(feature = "mumps")]
            Symmetric::Shared(shared) => shared.ranks(),
        }
    }

    /// Number of ranks that share it, 1 where all of it is here.
    pub(crate) fn n_ranks(&self) -> usize {
        match self {
            Symmetric::Whole(_) => 1,
            #[cfg(feature = "mumps")]
            Symmetric::Shared(shared) => shared.n_ranks(),
        }
    }

    /// What each rank that shares it answers to its message by `evaluate`: work on the mesh goes
    /// where the matrix is.
    ///
    /// # Errors
    /// Errors of the ranks.
    pub(crate) fn evaluate(
        &self,
        mut message: impl FnMut(usize) -> Vec<u8>,
        evaluate: fn(&[u8]) -> Result<Vec<u8>>,
    ) -> Result<Vec<Vec<u8>>> {
        match self {
            Symmetric::Whole(_) => Ok(vec![evaluate(&message(0))?]),
            #[cfg(feature = "mumps")]
            Symmetric::Shared(shared) => shared.evaluate(message, evaluate),
        }
    }

    /// [`super::condense`] of this matrix.
    ///
    /// # Errors
    /// As there; `Internal` for a matrix on ranks and a backend that wants it here.
    pub fn condense(
        &self,
        backend: Backend,
        partition: &Partition,
        shift: &[f64],
    ) -> Result<Box<dyn Condensed>> {
        match (self, backend) {
            (Symmetric::Whole(matrix), _) => condense(backend, matrix, partition, shift),
            #[cfg(feature = "mumps")]
            (Symmetric::Shared(shared), Backend::Mumps) => {
                mumps::condense_shared(shared, partition, shift)
            }
            #[cfg(feature = "mumps")]
            _ => Err(elsewhere(backend)),
        }
    }

    /// [`super::predict`] of this matrix.
    ///
    /// # Errors
    /// As [`Symmetric::condense`].
    pub fn predict(&self, backend: Backend, partition: &Partition) -> Result<Prediction> {
        match (self, backend) {
            (Symmetric::Whole(matrix), _) => predict(backend, matrix, partition),
            #[cfg(feature = "mumps")]
            (Symmetric::Shared(shared), Backend::Mumps) => mumps::predict_shared(shared, partition),
            #[cfg(feature = "mumps")]
            _ => Err(elsewhere(backend)),
        }
    }
}

#[cfg(feature = "mumps")]
fn elsewhere(backend: Backend) -> Error {
    Error::internal(format!(
        "the matrix lies on several ranks: the solver `{}` cannot take it",
        backend.name()
    ))
}
