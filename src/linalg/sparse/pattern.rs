//! Pattern of a symmetric matrix, borrowed from the matrix.

use crate::linalg::SymmetricCsc;
use std::borrow::Cow;

/// Pattern of the upper triangle of a symmetric matrix, compressed by column, rows ascending.
pub(crate) struct Pattern<'a> {
    columns: Cow<'a, [i64]>,
    rows: &'a [i64],
}

impl<'a> Pattern<'a> {
    /// Borrows the pattern of `matrix`.
    pub(crate) fn new(matrix: &'a SymmetricCsc) -> Self {
        Pattern {
            columns: matrix.proper_indptr(),
            rows: matrix.indices(),
        }
    }

    /// Makes a pattern from column pointers (`n + 1`) and row indices, ascending in each column.
    pub(crate) fn from_parts(columns: &'a [i64], rows: &'a [i64]) -> Self {
        Pattern {
            columns: Cow::Borrowed(columns),
            rows,
        }
    }

    /// Number of columns.
    pub(crate) fn n(&self) -> usize {
        self.columns.len().saturating_sub(1)
    }

    /// Column pointers, `n + 1`.
    #[cfg(feature = "cholmod")]
    pub(crate) fn columns(&self) -> &[i64] {
        &self.columns
    }

    /// Row indices, column after column.
    pub(crate) fn rows(&self) -> &'a [i64] {
        self.rows
    }

    /// Stored rows of a column, ascending to the diagonal.
    pub(crate) fn column(&self, j: usize) -> &'a [i64] {
        &self.rows[self.columns[j] as usize..self.columns[j + 1] as usize]
    }

    /// Extracts the block of the rows and columns for which `is_in` is true. Returns the number
    /// that each column has in the block (-1 if it is not in the block), the column pointers and
    /// the rows of the block.
    pub(crate) fn block(&self, is_in: impl Fn(usize) -> bool) -> (Vec<i64>, Vec<i64>, Vec<i64>) {
        let mut local = vec![-1i64; self.n()];
        let mut next = 0;
        for (j, number) in local.iter_mut().enumerate() {
            if is_in(j) {
                *number = next;
                next += 1;
            }
        }
        let mut columns = Vec::with_capacity(next as usize + 1);
        let mut rows = Vec::new();
        columns.push(0);
        for j in (0..self.n()).filter(|&j| local[j] >= 0) {
            let numbers = self.column(j).iter().map(|&row| local[row as usize]);
            rows.extend(numbers.filter(|&row| row >= 0));
            columns.push(rows.len() as i64);
        }
        (local, columns, rows)
    }
}
