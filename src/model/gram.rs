//! Gram matrix of the rows that hold rigid motions, and the motions that these rows leave free.

use crate::classes::Classes;
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use std::collections::BTreeMap;

/// A sparse symmetric matrix, stored by rows: each body is coupled to few others.
pub(super) struct Gram {
    rows: Vec<BTreeMap<usize, f64>>,
}

impl Gram {
    pub(super) fn new(n: usize) -> Self {
        Gram {
            rows: vec![BTreeMap::new(); n],
        }
    }

    /// Adds the product `row row'`. Entries of `row` with the same index are summed first, which
    /// reduces a contact row with many masters to the motions of two bodies.
    pub(super) fn add(&mut self, row: &[(usize, f64)]) {
        let mut summed: BTreeMap<usize, f64> = BTreeMap::new();
        for &(i, a) in row {
            *summed.entry(i).or_insert(0.0) += a;
        }
        for (&i, a) in &summed {
            for (&j, b) in &summed {
                *self.rows[i].entry(j).or_insert(0.0) += a * b;
            }
        }
    }

    pub(super) fn get(&self, i: usize, j: usize) -> f64 {
        self.rows[i].get(&j).copied().unwrap_or(0.0)
    }

    pub(super) fn largest_diagonal(&self) -> f64 {
        (0..self.rows.len()).fold(0.0, |m, i| m.max(self.get(i, i)))
    }

    /// Blocks of rows that nothing couples with other blocks, ascending; rows come in groups of
    /// `per`. Within a block groups with few neighbours come first, which keeps the envelope of its
    /// factor small.
    pub(super) fn uncoupled(&self, per: usize) -> Vec<Vec<usize>> {
        let n = self.rows.len() / per;
        let mut classes = Classes::new(n);
        let mut neighbours = vec![0; n];
        for (i, row) in self.rows.iter().enumerate() {
            for &j in row.keys() {
                classes.join(i / per, j / per);
            }
            neighbours[i / per] += row.len();
        }
        let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (group, first) in classes.firsts().into_iter().enumerate() {
            groups.entry(first).or_default().push(group);
        }
        let blocks = groups.into_values().map(|mut block| {
            block.sort_by_key(|&group| neighbours[group]);
            let rows = |group: usize| (0..per).map(move |m| per * group + m);
            block.into_iter().flat_map(rows).collect()
        });
        blocks.collect()
    }

    /// Whether a block minus `shift` times the identity is positive definite, that is, has a
    /// Cholesky factor. The factor is temporary; each of its rows is stored from the first nonzero
    /// to the diagonal.
    pub(super) fn is_definite(&self, block: &[usize], shift: f64) -> bool {
        let mut place = BTreeMap::new();
        place.extend(block.iter().enumerate().map(|(k, &row)| (row, k)));
        let mut factor: Vec<(usize, Vec<f64>)> = Vec::with_capacity(block.len());
        for (k, &row) in block.iter().enumerate() {
            let mut entries: Vec<(usize, f64)> = self.rows[row]
                .iter()
                .map(|(j, &value)| (place[j], value))
                .filter(|&(j, _)| j <= k)
                .collect();
            entries.push((k, -shift));
            let first = entries.iter().map(|e| e.0).min().unwrap_or(k);
            let mut values = vec![0.0; k - first + 1];
            for (j, value) in entries {
                values[j - first] += value;
            }
            for j in first..k {
                let (start, left) = &factor[j];
                let from = first.max(*start);
                let dot: f64 = (values[from - first..j - first].iter())
                    .zip(&left[from - start..j - start])
                    .map(|(a, b)| a * b)
                    .sum();
                values[j - first] = (values[j - first] - dot) / left[j - start];
            }
            let pivot =
                values[k - first] - (values[..k - first].iter()).map(|v| v * v).sum::<f64>();
            if pivot.is_nan() || pivot <= 0.0 {
                return false;
            }
            values[k - first] = pivot.sqrt();
            factor.push((first, values));
        }
        true
    }

    /// Rows of a block, ascending, and its eigenvectors on them with eigenvalues below `limit`.
    pub(super) fn null_vectors(
        &self,
        block: &[usize],
        limit: f64,
    ) -> (Vec<usize>, Vec<DVector<f64>>) {
        let n = block.len();
        let mut place = BTreeMap::new();
        place.extend(block.iter().enumerate().map(|(k, &row)| (row, k)));
        let mut matrix = DMatrix::zeros(n, n);
        for (k, &row) in block.iter().enumerate() {
            for (j, &value) in &self.rows[row] {
                matrix[(k, place[j])] = value;
            }
        }
        let eigen = SymmetricEigen::new(matrix);
        let found = (0..n).filter(|&k| eigen.eigenvalues[k] < limit);
        let vectors = found.map(|k| {
            let entries = place.values().map(|&at| eigen.eigenvectors[(at, k)]);
            DVector::from_iterator(n, entries)
        });
        (place.keys().copied().collect(), vectors.collect())
    }
}
