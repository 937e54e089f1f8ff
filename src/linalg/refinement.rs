//! Iterative refinement with a residual in twice the working precision.
//!
//! Refinement with a residual in working precision makes the backward error small and stops there:
//! the residual's own round-off, `eps |K| |u|`, hides the remaining error, and the solution keeps
//! an error of `eps` times the condition. With the residual in twice the precision every step gains
//! as many digits as the factor has, until the solution is right to the last bit but one, as long
//! as the condition is below about `1 / (n eps)`.
//!
//! The result is the solution for the matrix as it is stored. If the matrix is exact (a caller's
//! own), this is the true solution. If its entries are rounded sums of element stiffnesses, their
//! round-off costs as much accuracy as the solve's, and refinement gains nothing: the analysis of
//! scenes does not use it (checked in `tests/stability/refinement.rs`; only for extremely thin
//! elements factored by faer would refinement gain a digit).
//!
//! # Source
//! N. J. Higham, *Accuracy and Stability of Numerical Algorithms*, 2nd ed., theorem 12.1; T. Ogita,
//! S. M. Rump, S. Oishi (2005), algorithm 5.3 (`Dot2`), doi:10.1137/030601818; M. Arioli, J. W.
//! Demmel, I. S. Duff (1989), doi:10.1137/0610013 (rows without load).

use super::SymmetricCsc;
use super::row_sums::RowSums;
use crate::error::Result;

/// Largest number of steps, for a condition at which each step gains only one digit.
const MOST: usize = 20;
/// Fraction of the previous correction below which the next one must be for the refinement to go
/// on; otherwise the factor gains nothing more.
const PROGRESS: f64 = 0.5;

/// Record of a refinement.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Refinement {
    /// Number of corrections that were added.
    pub steps: usize,
    /// Largest value of the first correction, relative to the largest value of the solution: the
    /// error of the solution before the refinement.
    pub first: f64,
    /// Size of the last correction that was added, relative to the solution in the same way.
    pub last: f64,
}

/// Improves a solution `u` until it is right to round-off or no longer improves. `residual` gives
/// `f - A u` in twice the precision ([`twofold_residual`]); `solve` solves with a factor of `A`.
///
/// # Errors
/// Errors of `solve`.
pub fn refine(
    u: &mut [f64],
    residual: impl Fn(&[f64]) -> Vec<f64>,
    solve: impl Fn(&mut [f64]) -> Result<()>,
) -> Result<Refinement> {
    let largest = |v: &[f64]| v.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let mut out = Refinement::default();
    let mut before = f64::INFINITY;
    for _ in 0..MOST {
        let mut step = residual(u);
        solve(&mut step)?;
        let size = largest(&step) / largest(u).max(f64::MIN_POSITIVE);
        if before.is_infinite() {
            out.first = size;
        }
        if size.is_nan() || size > PROGRESS * before {
            break;
        }
        out.last = size;
        out.steps += 1;
        for (u, du) in u.iter_mut().zip(&step) {
            *u += du;
        }
        if size <= f64::EPSILON {
            break;
        }
        before = size;
    }
    Ok(out)
}

/// Residual `load - K u`, summed in twice the working precision and rounded once.
pub fn twofold_residual(matrix: &SymmetricCsc, load: &[f64], u: &[f64]) -> Vec<f64> {
    let mut high = load.to_vec();
    let mut low = vec![0.0; load.len()];
    for (j, column) in matrix.outer_iterator().enumerate() {
        for (i, &a) in column.iter() {
            subtract_product(&mut high[i], &mut low[i], a, u[j]);
            if i != j {
                subtract_product(&mut high[j], &mut low[j], a, u[i]);
            }
        }
    }
    high.iter().zip(&low).map(|(h, l)| h + l).collect()
}

/// Subtracts `a b` from `high + low`, and keeps the round-off of product and sum in `low`.
fn subtract_product(high: &mut f64, low: &mut f64, a: f64, b: f64) {
    let product = -a * b;
    let product_error = (-a).mul_add(b, -product);
    let sum = *high + product;
    let part = sum - *high;
    let sum_error = (*high - (sum - part)) + (product - part);
    *high = sum;
    *low += sum_error + product_error;
}

/// Componentwise backward error of `u` as a solution of `K u = load`: the smallest `omega` for
/// which `u` is the exact solution of a system whose entries of matrix and load differ from the
/// given ones by at most the fraction `omega`. Rows without load and almost without displacement
/// are measured against their own stiffness times the largest displacement.
pub fn componentwise_backward_error(matrix: &SymmetricCsc, load: &[f64], u: &[f64]) -> f64 {
    let mut rows = RowSums::new(matrix, load, u);
    rows.residual = twofold_residual(matrix, load, u);
    rows.componentwise_error(load, u)
}
