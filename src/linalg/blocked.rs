//! Dense kernels by blocks, on all threads: what thousands of contact pairs spend their time in.
//!
//! Blocks have the same sizes and sums the same order whatever the number of threads: so have the
//! bits.
//!
//! # Source
//! G. H. Golub, C. F. Van Loan, *Matrix Computations*, 4th ed., 2013, sections 3.1.7 and 4.2.9.

use nalgebra::{DMatrix, DMatrixViewMut};
use rayon::prelude::*;

/// Columns of a block.
const BLOCK: usize = 96;

/// The lower Cholesky factor of `a`, whose lower triangle is read; `None` where a pivot is not
/// positive.
pub(crate) fn cholesky(mut a: DMatrix<f64>) -> Option<DMatrix<f64>> {
    let n = a.nrows();
    for start in (0..n).step_by(BLOCK) {
        let end = (start + BLOCK).min(n);
        let width = end - start;
        let block = a.view((start, start), (width, width)).into_owned();
        let own = block.cholesky()?.unpack();
        a.view_mut((start, start), (width, width)).copy_from(&own);
        a.view_mut((0, start), (start, width)).fill(0.0);
        // L_21 = A_21 L_11^-T, by its transpose.
        let mut right = a.view((end, start), (n - end, width)).transpose();
        own.solve_lower_triangular_mut(&mut right);
        let below = right.transpose();
        a.view_mut((end, start), (n - end, width)).copy_from(&below);
        a.as_mut_slice()[end * n..]
            .par_chunks_mut(BLOCK * n)
            .enumerate()
            .for_each(|(k, columns)| {
                let (first, width) = (k * BLOCK, columns.len() / n);
                let mut columns = DMatrixViewMut::from_slice(columns, n, width);
                columns.rows_mut(end + first, n - end - first).gemm(
                    -1.0,
                    &below.rows(first, n - end - first),
                    &right.columns(first, width),
                    1.0,
                );
            });
    }
    Some(a)
}

/// `b = L^-1 b` for a lower triangle `L` without zeros on its diagonal.
pub(crate) fn solve_lower(l: &DMatrix<f64>, b: &mut DMatrix<f64>) {
    let n = l.nrows();
    if n == 0 {
        return;
    }
    b.as_mut_slice()
        .par_chunks_mut(BLOCK * n)
        .for_each(|columns| {
            let width = columns.len() / n;
            let mut b = DMatrixViewMut::from_slice(columns, n, width);
            for start in (0..n).step_by(BLOCK) {
                let rows = BLOCK.min(n - start);
                let (above, mut own) = b.rows_range_pair_mut(..start, start..start + rows);
                own.gemm(-1.0, &l.view((start, 0), (rows, start)), &above, 1.0);
                l.view((start, start), (rows, rows))
                    .solve_lower_triangular_unchecked_mut(&mut own);
            }
        });
}

/// The lower triangle of `a a'`, by strips of columns: above the diagonal only within them.
/// `depth(i)` says how many columns of the rows before `i` count, all where it is not less.
pub(crate) fn outer(a: &DMatrix<f64>, depth: impl Fn(usize) -> usize + Sync) -> DMatrix<f64> {
    let n = a.nrows();
    let mut product = DMatrix::zeros(n, n);
    if n == 0 {
        return product;
    }
    // Wide strips: the kernel copies what stands left of a product into its own order once for
    // each.
    let strip = (n / 8).clamp(BLOCK, 4 * BLOCK);
    product
        .as_mut_slice()
        .par_chunks_mut(strip * n)
        .enumerate()
        .for_each(|(k, columns)| {
            let (first, width) = (k * strip, columns.len() / n);
            let m = depth(first + width).min(a.ncols());
            let right = a.view((first, 0), (width, m)).transpose();
            DMatrixViewMut::from_slice(columns, n, width)
                .rows_mut(first, n - first)
                .gemm(1.0, &a.view((first, 0), (n - first, m)), &right, 0.0);
        });
    product
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::tests::Numbers;

    #[test]
    fn blocks_do_what_the_whole_does() {
        for n in [0, 1, 95, 96, 97, 250] {
            let mut numbers = Numbers::new(5);
            let random = DMatrix::from_vec(n, n, numbers.vector(n * n));
            // Diagonally dominant: condition below 4, round-off n eps times the size of the
            // entries.
            let a = &random * random.transpose() + DMatrix::identity(n, n) * (n * n) as f64;
            let tolerance = n as f64 * f64::EPSILON * 2.0 * (n * n + 1) as f64;
            let l = cholesky(a.clone()).unwrap();
            assert!((&l * l.transpose() - &a).amax() <= tolerance);
            let b = DMatrix::from_vec(n, 130, numbers.vector(n * 130));
            let mut x = b.clone();
            solve_lower(&l, &mut x);
            assert!((&l * x - &b).amax() <= 4.0 * n as f64 * f64::EPSILON + 0.0);
            let c = outer(&b.transpose(), |_| n);
            let expected = b.tr_mul(&b);
            for j in 0..130 {
                for i in j..130 {
                    assert!((c[(i, j)] - expected[(i, j)]).abs() <= tolerance.max(1e-15));
                }
            }
        }
        assert!(cholesky(DMatrix::from_element(200, 200, 1.0)).is_none());
    }
}
