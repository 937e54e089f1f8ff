//! A symmetric matrix, whether stored in one place or shared among ranks.

#[cfg(feature = "mumps")]
use super::mumps;
use super::row_sums::{RowSums, largest, norm};
use super::{Backend, Condensed, Partition, Prediction, SymmetricCsc, condense, predict};
#[cfg(feature = "mumps")]
use crate::error::Error;
use crate::error::Result;
use crate::results::Ranks;
use std::sync::Arc;

/// A symmetric matrix, stored as a whole in this process or as parts on several ranks.
#[derive(Debug, Clone)]
pub enum Symmetric {
    /// The whole matrix in this process, as its upper triangle.
    Whole(Arc<SymmetricCsc>),
    /// Parts of the matrix, distributed over the ranks of MUMPS.
    #[cfg(feature = "mumps")]
    Shared(mumps::Shared),
}

impl From<SymmetricCsc> for Symmetric {
    fn from(matrix: SymmetricCsc) -> Self {
        Symmetric::Whole(Arc::new(matrix))
    }
}

impl Symmetric {
    /// Upper triangle of a matrix stored as a whole; `None` if it is distributed.
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

    /// Diagonal entry of a freedom.
    pub fn diagonal(&self, freedom: usize) -> f64 {
        match self {
            Symmetric::Whole(matrix) => matrix.get(freedom, freedom).copied().unwrap_or(0.0),
            #[cfg(feature = "mumps")]
            Symmetric::Shared(shared) => shared.diagonal()[freedom],
        }
    }

    /// Infinity norm: the largest sum of absolute values of a row.
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

    /// Row sums from one pass over the matrix, for a solution `u` with the load `f`.
    pub(super) fn rows(&self, f: &[f64], u: &[f64]) -> Result<RowSums> {
        match self {
            Symmetric::Whole(matrix) => Ok(RowSums::new(matrix, f, u)),
            #[cfg(feature = "mumps")]
            Symmetric::Shared(shared) => shared.rows(f, u),
        }
    }

    /// Largest `|K| |u|` of a row.
    ///
    /// # Errors
    /// Errors of the ranks.
    pub(crate) fn largest_terms(&self, u: &[f64]) -> Result<f64> {
        Ok(largest(&self.rows(&vec![0.0; u.len()], u)?.terms))
    }

    /// Work of the ranks that share the matrix; `None` if it is stored as a whole.
    pub(crate) fn ranks(&self) -> Option<Ranks> {
        match self {
            Symmetric::Whole(_) => None,
            #[cfg(feature = "mumps")]
            Symmetric::Shared(shared) => shared.ranks(),
        }
    }

    /// Number of ranks that share the matrix; 1 if it is stored as a whole.
    pub(crate) fn n_ranks(&self) -> usize {
        match self {
            Symmetric::Whole(_) => 1,
            #[cfg(feature = "mumps")]
            Symmetric::Shared(shared) => shared.n_ranks(),
        }
    }

    /// Runs `evaluate` on each rank that shares the matrix, with a message for that rank, and
    /// returns the answers: work on the mesh is done where the matrix is stored.
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

    /// Factors and condenses this matrix ([`super::condense`]).
    ///
    /// # Errors
    /// Errors of [`super::condense`]; `Internal` for a distributed matrix if the backend needs a
    /// whole one.
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

    /// Predicts the cost of condensing this matrix ([`super::predict`]).
    ///
    /// # Errors
    /// Errors of [`Symmetric::condense`].
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
