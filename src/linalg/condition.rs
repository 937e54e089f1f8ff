//! Condition number of a factored matrix, estimated with a few solves.
//!
//! For `A = K + diag(shift)` and `S = diag(a_ii^-1/2)` the estimate is `|B|_1 |B^-1|_1` with
//! `B = S A S`. This is about the smallest condition that any scaling of rows and columns gives
//! (van der Sluis), so that units and graded meshes have no influence. `|B^-1|_1`, the maximum of a
//! convex function over a polytope, is found by climbing from vertex to vertex; each step takes two
//! solves, and two or three steps are usual. The estimate is a lower bound, rarely off by more than
//! a factor of three.
//!
//! # Source
//! W. W. Hager (1984), doi:10.1137/0905023; N. J. Higham (1988), algorithm 674,
//! doi:10.1145/50063.214386, as in LAPACK's `dlacn2`; A. van der Sluis (1969),
//! doi:10.1007/BF02165096.

use super::{Condensed, Partition, Symmetric, solve_whole};
use crate::error::Result;
use nalgebra::Cholesky;

/// Largest number of steps from vertex to vertex.
const MOST: usize = 5;

/// Estimates the condition of a factored `matrix` with its `shift` (empty for none), scaled to a
/// unit diagonal; infinite if round-off has left no definite matrix on the contact freedoms.
/// `partition` holds the zone that is chosen at present.
///
/// # Errors
/// Errors of [`Condensed::recover_all`].
pub fn condition(
    condensed: &dyn Condensed,
    matrix: &Symmetric,
    partition: &Partition,
    shift: &[f64],
) -> Result<f64> {
    let n = matrix.n();
    let of_matrix: Vec<f64> = (0..n).map(|freedom| matrix.diagonal(freedom)).collect();
    let mut root = of_matrix.clone();
    for (&freedom, d) in partition.contact.iter().zip(shift) {
        root[freedom] += d;
    }
    if root.iter().any(|a| *a <= 0.0) {
        return Ok(f64::INFINITY);
    }
    root.iter_mut().for_each(|a| *a = a.sqrt());
    // Row sums of |S K S|, with the diagonal entries replaced by those of S A S, which are one.
    let inverse: Vec<f64> = root.iter().map(|root| 1.0 / root).collect();
    let terms = matrix.rows(&vec![0.0; n], &inverse)?.terms;
    let beside = |i: usize| (terms[i] - of_matrix[i].abs() * inverse[i]) * inverse[i];
    let norm = (0..n).fold(0.0f64, |largest, i| largest.max(1.0 + beside(i)));
    let mut stiffness = condensed.contact_stiffness().dense();
    for (k, d) in shift.iter().enumerate() {
        stiffness[(k, k)] += d;
    }
    let held = if partition.contact.is_empty() {
        None
    } else {
        let Some(held) = Cholesky::new(stiffness) else {
            return Ok(f64::INFINITY);
        };
        Some(held)
    };
    let solve = |x: &mut [f64]| -> Result<()> {
        let scale = |x: &mut [f64]| x.iter_mut().zip(&root).for_each(|(x, r)| *x *= r);
        scale(x);
        solve_whole(condensed, partition, held.as_ref(), x)?;
        scale(x);
        Ok(())
    };
    Ok(norm * inverse_norm(n, solve)?)
}

/// Estimates `|B^-1|_1` for a symmetric `B` of order `n`, given a function that solves with `B`.
fn inverse_norm(n: usize, solve: impl Fn(&mut [f64]) -> Result<()>) -> Result<f64> {
    let size = |x: &[f64]| x.iter().map(|v| v.abs()).sum::<f64>();
    let signs = |x: &[f64]| -> Vec<f64> { x.iter().map(|v| 1f64.copysign(*v)).collect() };
    let mut x = vec![1.0 / n as f64; n];
    solve(&mut x)?;
    let mut estimate = size(&x);
    let mut vertex = signs(&x);
    let mut last = usize::MAX;
    for _ in 0..MOST {
        let mut slope = vertex.clone();
        solve(&mut slope)?;
        // Of equal slopes the first one is taken.
        let steepest = (0..n).fold(0, |best, i| {
            if slope[i].abs() > slope[best].abs() {
                i
            } else {
                best
            }
        });
        if steepest == last {
            break;
        }
        last = steepest;
        x.fill(0.0);
        x[steepest] = 1.0;
        solve(&mut x)?;
        let found = size(&x);
        if found <= estimate {
            break;
        }
        estimate = found;
        let next = signs(&x);
        if next == vertex {
            break;
        }
        vertex = next;
    }
    // For some matrices the climb is known to stop at once: a vector with all frequencies detects
    // most of them.
    for (i, v) in x.iter_mut().enumerate() {
        let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
        *v = sign * (1.0 + i as f64 / (n.max(2) - 1) as f64);
    }
    solve(&mut x)?;
    Ok(estimate.max(2.0 * size(&x) / (3.0 * n as f64)))
}
