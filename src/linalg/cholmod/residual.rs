//! A compact copy of `K` for residuals: row numbers of 32 bits.

use crate::linalg::{SymmetricCsc, backward_error};

/// Upper triangle of `K`.
pub(super) struct Matrix {
    columns: Vec<usize>,
    rows: Vec<u32>,
    values: Vec<f64>,
    norm: f64,
}

impl Matrix {
    /// The pattern of `matrix` with `values`, which are taken over.
    pub(super) fn new(matrix: &SymmetricCsc, values: Vec<f64>) -> Self {
        let columns: Vec<usize> = matrix.proper_indptr().iter().map(|&p| p as usize).collect();
        let rows: Vec<u32> = matrix.indices().iter().map(|&row| row as u32).collect();
        let mut sums = vec![0.0f64; columns.len().saturating_sub(1)];
        for j in 0..sums.len() {
            for k in columns[j]..columns[j + 1] {
                let (i, size) = (rows[k] as usize, values[k].abs());
                sums[j] += size;
                if i != j {
                    sums[i] += size;
                }
            }
        }
        let norm = sums.into_iter().fold(0.0, f64::max);
        Matrix {
            columns,
            rows,
            values,
            norm,
        }
    }

    /// `r = f - K u`. Each column ends with its diagonal, as [`crate::linalg::check`] has made sure.
    pub(super) fn residual(&self, f: &[f64], u: &[f64], r: &mut [f64]) {
        r.copy_from_slice(f);
        for (j, bounds) in self.columns.windows(2).enumerate() {
            let range = bounds[0]..bounds[1].saturating_sub(1);
            let diagonal = &self.values[range.end..bounds[1]];
            let u_j = u[j];
            let mut sum: f64 = diagonal.iter().map(|a| a * u_j).sum();
            for (&i, &a) in self.rows[range.clone()].iter().zip(&self.values[range]) {
                let i = i as usize;
                sum += a * u[i];
                r[i] -= a * u_j;
            }
            r[j] -= sum;
        }
    }

    /// `|r| / (|K| |u| + |f|)` in infinity norms; zero where all are zero, NaN where one is.
    pub(super) fn backward_error(&self, f: &[f64], u: &[f64], r: &[f64]) -> f64 {
        backward_error(self.norm, f, u, r)
    }
}
