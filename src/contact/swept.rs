//! A symmetric matrix under principal pivots, of which the latest wait until they are applied
//! together.
//!
//! A pivot changes every entry of the matrix: with thousands of pairs its cost is that of reading
//! and writing the whole matrix. Here the latest pivots are kept as columns. An entry or a column
//! is computed from them when it is asked for (O(number of waiting pivots) for each entry), and
//! [`WAITING`] pivots are applied in one pass. Each entry undergoes the same operations in the same
//! order, whenever the pivots are applied, so the result is the same bit for bit.
//!
//! # Source
//! Pivots: Cottle, Pang, Stone (1992), section 2.3. Waiting: like the delayed rank-one updates of
//! P. K. V. V. Nukala et al. (2009), doi:10.1103/PhysRevB.80.195111.

use nalgebra::DMatrix;
use rayon::prelude::*;

/// Largest number of waiting pivots: [`ROWS`] rows of their columns fit into the first-level cache
/// of the processor.
const WAITING: usize = 16;
/// Number of rows that are taken at a time.
const ROWS: usize = 256;
/// Order of the matrix from which the work is shared among threads.
const SHARED: usize = 512;

/// A matrix with the pivots that are not applied to it yet.
#[derive(Debug, Clone)]
pub(super) struct Swept {
    /// Matrix before the waiting pivots.
    matrix: DMatrix<f64>,
    waiting: Vec<SweptPivot>,
    /// Columns of applied pivots, whose memory the next pivots reuse.
    spare: Vec<Vec<f64>>,
}

/// A principal pivot on the diagonal entry (k, k).
#[derive(Debug, Clone)]
struct SweptPivot {
    k: usize,
    /// Column `k` before the pivot.
    column: Vec<f64>,
    /// The pivot itself, `column[k]`.
    value: f64,
    /// Sign of the pivot: 1 if the pair opens, -1 if it closes.
    sign: f64,
}

impl SweptPivot {
    /// Entry (i, j) after this pivot, from its value `before` the pivot.
    fn entry(&self, before: f64, i: usize, j: usize) -> f64 {
        match (i == self.k, j == self.k) {
            (true, true) => -1.0 / self.value,
            (true, false) => self.sign * (self.column[j] / self.value),
            (false, true) => self.sign * (self.column[i] / self.value),
            (false, false) => before - self.column[j] / self.value * self.column[i],
        }
    }
}

impl Swept {
    pub(super) fn new(matrix: DMatrix<f64>) -> Self {
        Swept {
            matrix,
            waiting: Vec::with_capacity(WAITING),
            spare: Vec::new(),
        }
    }

    /// Replaces the matrix by `matrix` and drops all waiting pivots.
    pub(super) fn copy_from(&mut self, matrix: &DMatrix<f64>) {
        self.matrix.copy_from(matrix);
        self.spare
            .extend(self.waiting.drain(..).map(|pivot| pivot.column));
    }

    /// Entry (i, j) with all pivots applied.
    pub(super) fn get(&self, i: usize, j: usize) -> f64 {
        self.waiting
            .iter()
            .fold(self.matrix[(i, j)], |entry, pivot| pivot.entry(entry, i, j))
    }

    /// Writes column `j` with all pivots applied.
    pub(super) fn column(&self, j: usize, out: &mut [f64]) {
        out.copy_from_slice(self.matrix.column(j).as_slice());
        bring_forward(&self.waiting, j, out, |i| self.get(i, j));
    }

    /// The whole matrix, after applying all waiting pivots.
    pub(super) fn matrix(&mut self) -> &DMatrix<f64> {
        self.apply();
        &self.matrix
    }

    /// Pivots on entry (k, k): `sign` 1 opens the pair, -1 closes it.
    pub(super) fn pivot(&mut self, k: usize, sign: f64) {
        let mut column = self.spare.pop().unwrap_or_default();
        column.resize(self.matrix.nrows(), 0.0);
        self.column(k, &mut column);
        self.waiting.push(SweptPivot {
            k,
            value: column[k],
            column,
            sign,
        });
        if self.waiting.len() == WAITING {
            self.apply();
        }
    }

    /// Applies the waiting pivots to the matrix.
    fn apply(&mut self) {
        let n = self.matrix.nrows();
        if self.waiting.is_empty() {
            return;
        }
        let waiting = &self.waiting;
        let column = |(j, column): (usize, &mut [f64])| {
            let mut rows = [0.0; WAITING];
            for (row, pivot) in rows.iter_mut().zip(waiting) {
                let before = column[pivot.k];
                *row = waiting
                    .iter()
                    .fold(before, |entry, p| p.entry(entry, pivot.k, j));
            }
            let mut rows = rows.into_iter();
            bring_forward(waiting, j, column, |_| rows.next().unwrap_or(f64::NAN));
        };
        let columns = self.matrix.as_mut_slice();
        if n < SHARED {
            columns.chunks_exact_mut(n).enumerate().for_each(column);
        } else {
            let columns = columns.par_chunks_exact_mut(n).enumerate();
            columns.with_min_len(16).for_each(column);
        }
        self.spare
            .extend(self.waiting.drain(..).map(|pivot| pivot.column));
    }
}

/// Applies the pivots to column `j`; `row(k)` gives the new entries in the rows of the pivots, in
/// their order.
fn bring_forward(
    pivots: &[SweptPivot],
    j: usize,
    column: &mut [f64],
    mut row: impl FnMut(usize) -> f64,
) {
    let rows: [f64; WAITING] =
        std::array::from_fn(|m| pivots.get(m).map_or(0.0, |pivot| row(pivot.k)));
    // Pivots before the last one on column j itself no longer matter.
    let own = pivots.iter().rposition(|pivot| pivot.k == j);
    let rest = match own {
        Some(own) => {
            let SweptPivot {
                column: u,
                value,
                sign,
                ..
            } = &pivots[own];
            for (entry, u) in column.iter_mut().zip(u) {
                *entry = sign * (u / value);
            }
            &pivots[own + 1..]
        }
        None => pivots,
    };
    for (block, entries) in column.chunks_mut(ROWS).enumerate() {
        let at = block * ROWS;
        let part = |pivot: &'_ SweptPivot| pivot.column[j] / pivot.value;
        let mut four = rest.chunks_exact(4);
        for pivots in &mut four {
            let [f0, f1, f2, f3] = std::array::from_fn(|m| part(&pivots[m]));
            let [u0, u1, u2, u3] =
                std::array::from_fn(|m| &pivots[m].column[at..at + entries.len()]);
            for (i, entry) in entries.iter_mut().enumerate() {
                *entry = (((*entry - f0 * u0[i]) - f1 * u1[i]) - f2 * u2[i]) - f3 * u3[i];
            }
        }
        for pivot in four.remainder() {
            let (f, u) = (part(pivot), &pivot.column[at..at + entries.len()]);
            for (entry, u) in entries.iter_mut().zip(u) {
                *entry -= f * u;
            }
        }
    }
    for (pivot, row) in pivots.iter().zip(rows) {
        column[pivot.k] = row;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Applies one pivot directly to the whole matrix.
    fn plainly(s: &mut DMatrix<f64>, k: usize, sign: f64) {
        let (before, value) = (s.clone(), s[(k, k)]);
        for j in 0..s.ncols() {
            for i in 0..s.nrows() {
                s[(i, j)] = match (i == k, j == k) {
                    (true, true) => -1.0 / value,
                    (true, false) => sign * (before[(j, k)] / value),
                    (false, true) => sign * (before[(i, k)] / value),
                    (false, false) => before[(i, j)] - before[(j, k)] / value * before[(i, k)],
                };
            }
        }
    }

    #[test]
    fn waiting_changes_no_bit() {
        // Orders below and above the one from which threads share the work, with rows left over in
        // the last block.
        for n in [7, SHARED + 13] {
            let a = DMatrix::from_fn(n, n, |i, j| {
                let bump = 1.0 / (1.0 + (i as f64 - j as f64).abs());
                if i == j { 3.0 } else { bump / 8.0 }
            });
            let mut expected = a.clone();
            let mut swept = Swept::new(a);
            let mut open = vec![false; n];
            // Repeats within one batch, full batches, and a batch that is read half full.
            let order = (0..45).map(|m| (m * m + m / 3) % 7 + if m % 4 == 0 { n - 7 } else { 0 });
            for (m, k) in order.enumerate() {
                let sign = if open[k] { -1.0 } else { 1.0 };
                open[k] = !open[k];
                plainly(&mut expected, k, sign);
                swept.pivot(k, sign);
                let mut column = vec![0.0; n];
                for j in [k, 0, (3 * m) % n, n - 1] {
                    swept.column(j, &mut column);
                    assert_eq!(column, expected.column(j).as_slice(), "{n}: pivot {m}");
                    assert_eq!(swept.get(k, j), expected[(k, j)]);
                }
            }
            assert!(!swept.waiting.is_empty());
            assert_eq!(swept.matrix(), &expected);
        }
    }
}
