//! What a backend's factor offers to the condensation.

use super::{FactorColumns, Triangular};
use crate::error::Result;

/// Factor `L` of a backend after the analysis; it has values once it is computed.
pub(crate) trait LowerFactor: Send {
    /// Freedom of each column of `L`.
    fn permutation(&self) -> &[i64];

    /// Number of nonzeros of each column, from the analysis.
    fn column_counts(&self) -> &[i64];

    /// Number of nonzeros of `L`, from the analysis.
    fn nonzeros(&self) -> f64;

    /// Floating point operations of the factorisation, from the analysis.
    fn flops(&self) -> f64;

    /// Bytes of the numerical factor and of its computation, including copies of a matrix with
    /// `entries` stored entries.
    fn bytes(&self, entries: usize) -> f64;

    /// Columns of the numerical factor, to be read one by one.
    fn columns(&self) -> FactorColumns<'_>;

    /// Computes `L^-1 load` in the order of the factor; `load` serves as workspace.
    ///
    /// # Errors
    /// `Analysis` if the memory does not suffice.
    fn solve_lower<'a>(
        &'a mut self,
        triangular: &Triangular,
        load: &'a mut [f64],
    ) -> Result<&'a [f64]>;
}
