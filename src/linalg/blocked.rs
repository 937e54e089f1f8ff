//! Dense kernels by blocks, on all threads, for models with thousands of contact pairs.
//!
//! The sizes of the blocks and the order of summation do not depend on the number of threads, so
//! results are the same bit for bit.
//!
//! # Source
//! G. H. Golub, C. F. Van Loan, *Matrix Computations*, 4th ed., 2013, sections 3.1.7 and 4.2.9.

use nalgebra::{DMatrix, DMatrixViewMut};
use rayon::prelude::*;

/// Number of columns of a block.
const BLOCK: usize = 96;
/// Number of entries that a thread takes at a time.
const ENTRIES: usize = 1 << 14;
/// Fraction of nonzero entries above which a block is multiplied faster as a full matrix than as a
/// sparse one. With 300, 1000 and 2000 rows, both ways take the same time at fractions of 0.25, 0.2
/// and 0.1, respectively.
const FULL: f64 = 0.2;

/// Number of columns of the given length that a thread takes at a time: for fewer columns, waking
/// the thread would cost more than the work.
pub(crate) fn at_once(length: usize) -> usize {
    ENTRIES / length.max(1) + 1
}

/// Returns the product `a b` and the number of multiplications. The matrix `b` is given by its
/// columns, each as the rows and values of its entries.
pub(crate) fn times(a: &DMatrix<f64>, b: &[Vec<(usize, f64)>]) -> (DMatrix<f64>, usize) {
    let (m, n) = a.shape();
    let mut product = DMatrix::zeros(m, b.len());
    let strips = product.as_mut_slice().par_chunks_mut((BLOCK * m).max(1));
    let multiplications = strips
        .zip(b.par_chunks(BLOCK))
        .map(|(product, b)| {
            let mut product = DMatrixViewMut::from_slice(product, m, b.len());
            let entries: usize = b.iter().map(Vec::len).sum();
            if (entries as f64) < FULL * (n * b.len()) as f64 {
                for (mut column, b) in product.column_iter_mut().zip(b) {
                    b.iter()
                        .for_each(|&(k, value)| column.axpy(value, &a.column(k), 1.0));
                }
                return m * entries;
            }
            let mut full = DMatrix::zeros(n, b.len());
            for (j, b) in b.iter().enumerate() {
                b.iter().for_each(|&(k, value)| full[(k, j)] += value);
            }
            product.gemm(1.0, a, &full, 0.0);
            m * n * b.len()
        })
        .sum();
    (product, multiplications)
}

/// Replaces the lower triangle of `a` by that of `a + a'`.
pub(crate) fn add_transpose(a: &mut DMatrix<f64>) {
    for j in 0..a.ncols() {
        for i in j..a.nrows() {
            a[(i, j)] += a[(j, i)];
        }
    }
}

/// Returns the lower Cholesky factor of `a`, of which only the lower triangle is read; `None` if a
/// pivot is not positive.
pub(crate) fn cholesky(mut a: DMatrix<f64>) -> Option<DMatrix<f64>> {
    let n = a.nrows();
    for start in (0..n).step_by(BLOCK) {
        let end = (start + BLOCK).min(n);
        let width = end - start;
        let block = a.view((start, start), (width, width)).into_owned();
        let own = block.cholesky()?.unpack();
        a.view_mut((start, start), (width, width)).copy_from(&own);
        a.view_mut((0, start), (start, width)).fill(0.0);
        // L_21 = A_21 L_11^-T, computed by its transpose.
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

/// Solves `L x = b` in place for a lower triangle `L` without zeros on its diagonal.
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

/// Returns the lower triangle of `a a'`, computed by strips of columns; only entries within a strip
/// are valid above the diagonal. In the rows before `i`, only the first `depth(i)` columns of `a`
/// may have nonzero entries.
pub(crate) fn outer(a: &DMatrix<f64>, depth: impl Fn(usize) -> usize + Sync) -> DMatrix<f64> {
    let n = a.nrows();
    let mut product = DMatrix::zeros(n, n);
    if n == 0 {
        return product;
    }
    // The strips are wide, because for each strip the kernel copies the left factor of the product
    // into its own order.
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
            // The matrix is diagonally dominant with a condition number below 4; round-off is n eps
            // times the size of the entries.
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

    /// Columns with few and with many entries, in one block and in several blocks.
    #[test]
    fn sparse_columns_are_multiplied_as_full_ones() {
        let mut numbers = Numbers::new(7);
        for (m, n, columns) in [(0, 3, 2), (3, 0, 2), (40, 30, 1), (25, 60, 300)] {
            let a = DMatrix::from_vec(m, n, numbers.vector(m * n));
            let mut entries = |j: usize| {
                let count = if j < 96 { n.min(2) } else { n };
                let rows = (0..count).map(|k| (k * 29 + j) % n);
                rows.map(|k| (k, numbers.next())).collect()
            };
            let b: Vec<Vec<(usize, f64)>> = (0..columns).map(&mut entries).collect();
            let mut full = DMatrix::zeros(n, columns);
            for (j, b) in b.iter().enumerate() {
                b.iter().for_each(|&(k, value)| full[(k, j)] += value);
            }
            let (product, multiplications) = times(&a, &b);
            assert!((product - &a * full).amax() <= 2.0 * n as f64 * f64::EPSILON);
            let [few, rest] = [columns.min(96), columns.saturating_sub(96)];
            assert_eq!(multiplications, m * (few * n.min(2) + rest * n));
        }
        let mut a = DMatrix::from_vec(5, 5, numbers.vector(25));
        let expected = &a + a.transpose();
        add_transpose(&mut a);
        assert_eq!(a.lower_triangle(), expected.lower_triangle());
    }
}
