//! A factor of the condensed matrix with changed values, kept alongside the factor of the matrix
//! itself.

use super::{ContactStiffness, ZonePart};

/// A factor of `M = S + diag(shift) - sum_e P_e' A_e P_e`, with small symmetric matrices `A_e` on
/// the freedoms that `P_e` selects. Each `A_e` couples only freedoms that the condensed matrix `S`
/// couples. Vectors are those of [`super::Condensed`] for the zone that was chosen when this factor
/// was made.
pub trait ChangedFactor: Send {
    /// Floating point operations of one factorisation, and of one solve.
    fn flops(&self) -> [f64; 2];

    /// Begins a new matrix, at first `M = S + diag(shift)`.
    fn begin(&mut self);

    /// Subtracts a symmetric matrix (column by column) from `M`. Its rows are numbered in `places`:
    /// zone freedoms first, then contact freedoms.
    fn take_off(&mut self, places: &[u32], matrix: &[f64]);

    /// Factors `M`. Returns false if `M` is not positive definite; the factor is then unusable.
    fn factor(&mut self) -> bool;

    /// Schur complement of `M - diag(shift)` on the contact freedoms, with the zone eliminated.
    fn contact_stiffness(&self) -> ContactStiffness;

    /// Eliminates the zone as [`super::Condensed::eliminate_zone`] does.
    fn eliminate_zone(&self, zone: &mut [f64], contact: &mut [f64]);

    /// Recovers a part of the zone as [`super::Condensed::recover_part`] does.
    fn recover_part(&self, part: &ZonePart, zone: &mut [f64], u_contact: &[f64]);
}
