//! A factor of the condensed matrix with other values, kept alongside the factor of the matrix
//! itself.

use super::{ContactStiffness, ZonePart};

/// A factor of `M = S + diag(shift) - sum_e P_e' A_e P_e`, with small matrices `A_e` that couple
/// what the condensed matrix `S` couples. Vectors are those of [`super::Condensed`] for the zone
/// that was chosen when it was made.
pub trait ChangedFactor: Send {
    /// Floating point operations of a factorisation, and of a solve.
    fn flops(&self) -> [f64; 2];

    /// Begins a matrix: `M = S + diag(shift)`.
    fn begin(&mut self);

    /// Takes a symmetric matrix off `M` (column by column), whose rows are these freedoms: places
    /// in the zone, and after those of the zone places among the contact freedoms.
    fn take_off(&mut self, places: &[u32], matrix: &[f64]);

    /// Factors `M`; false where it is not positive definite: the factor is of no use then.
    fn factor(&mut self) -> bool;

    /// What is left of `M - diag(shift)` on the contact freedoms after the zone is eliminated.
    fn contact_stiffness(&self) -> ContactStiffness;

    /// As [`super::Condensed::eliminate_zone`].
    fn eliminate_zone(&self, zone: &mut [f64], contact: &mut [f64]);

    /// As [`super::Condensed::recover_part`].
    fn recover_part(&self, part: &ZonePart, zone: &mut [f64], u_contact: &[f64]);
}
