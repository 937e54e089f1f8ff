//! Sparse Cholesky factor by faer: analyse, factorise, read columns.

use super::ordering::FaerOrdering;
use crate::error::{Error, Result};
use crate::linalg::NotDefinite;
use crate::linalg::SymmetricCsc;
use crate::linalg::sparse::{
    FactorColumns, LowerFactor, Pattern, Supernodes, Triangular, prefer_large,
};
use ::faer::Par;
use ::faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use ::faer::linalg::cholesky::llt::factor::{LltError, LltParams};
use ::faer::prelude::default;
use ::faer::sparse::linalg::cholesky::{simplicial, supernodal};
use ::faer::sparse::{FaerError, SparseColMatRef, SymbolicSparseColMatRef};

/// A single thread: the supernodes of a plane model are too small to share, and the result has the
/// same bits for any number of threads.
const PARALLELISM: Par = Par::Seq;

/// Factor `P K P' = L L'` with supernodal storage.
pub(super) struct FaerFactor {
    permutation: Vec<i64>,
    counts: Vec<i64>,
    nonzeros: f64,
    flops: f64,
    /// Bytes that the factorisation needs in addition to factor and matrix.
    workspace: f64,
    starts: Vec<i64>,
    row_starts: Vec<i64>,
    value_starts: Vec<i64>,
    rows: Vec<i64>,
    values: Vec<f64>,
}

/// Symbolic factor of faer, needed until the values are computed.
pub(super) struct Symbolic(supernodal::SymbolicSupernodalCholesky<usize>);

impl FaerFactor {
    /// Analyses a matrix symbolically, with exactly the given ordering.
    pub(super) fn analyze(pattern: &Pattern, order: FaerOrdering) -> Result<(Self, Symbolic)> {
        let n = pattern.n();
        let no_memory = || out_of_memory("symbolic analysis", n);
        let place = places(&order.permutation);
        let (columns, rows, _) = permuted(pattern, &place, StoredTriangle::Upper, None);
        let upper = SymbolicSparseColMatRef::new_unsorted_checked(n, n, &columns, None, &rows);
        let mut tree = vec![0isize; n];
        let mut counts = vec![0usize; n];
        let needed = StackReq::any_of(&[
            simplicial::prefactorize_symbolic_cholesky_scratch::<usize>(n, rows.len()),
            supernodal::factorize_supernodal_symbolic_cholesky_scratch::<usize>(n),
        ]);
        let mut memory = MemBuffer::try_new(needed).map_err(|_| no_memory())?;
        let stack = MemStack::new(&mut memory);
        let tree = simplicial::prefactorize_symbolic_cholesky(&mut tree, &mut counts, upper, stack);
        let symbolic = supernodal::factorize_supernodal_symbolic_cholesky(
            upper,
            tree,
            &counts,
            stack,
            default(),
        );
        let symbolic = symbolic.map_err(|cause| match cause {
            FaerError::OutOfMemory => no_memory(),
            cause => Error::internal(format!("faer failed to analyse {n} freedoms: {cause}")),
        })?;
        let scratch = supernodal::factorize_supernodal_numeric_llt_scratch::<usize, f64>(
            &symbolic,
            PARALLELISM,
            default(),
        );
        let below = symbolic.row_idx().len();
        let factor = FaerFactor {
            nonzeros: order.counts.iter().sum::<i64>() as f64,
            flops: order.flops,
            // faer's own row lists of the supernodes, stored once by columns and once by rows.
            workspace: scratch.size_bytes() as f64 + 16.0 * below as f64,
            starts: numbers(symbolic.supernode_begin().iter().chain([&n])),
            row_starts: Vec::new(),
            value_starts: numbers(symbolic.col_ptr_for_val()),
            rows: Vec::new(),
            values: Vec::new(),
            permutation: order.permutation,
            counts: order.counts,
        };
        Ok((factor.with_rows(&symbolic), Symbolic(symbolic)))
    }

    /// Lists the rows of each supernode, beginning with its own columns.
    fn with_rows(mut self, symbolic: &supernodal::SymbolicSupernodalCholesky<usize>) -> Self {
        let n = self.permutation.len();
        self.rows.reserve_exact(n + symbolic.row_idx().len());
        self.row_starts.reserve_exact(self.starts.len());
        for (s, own) in self.starts.windows(2).enumerate() {
            self.row_starts.push(self.rows.len() as i64);
            self.rows.extend(own[0]..own[1]);
            let below = symbolic.supernode(s).pattern();
            self.rows.extend(below.iter().map(|&row| row as i64));
        }
        self.row_starts.push(self.rows.len() as i64);
        self
    }

    /// Factors `matrix`, which has the analysed pattern, numerically with the given diagonal.
    pub(super) fn factorize(
        &mut self,
        Symbolic(symbolic): Symbolic,
        matrix: &SymmetricCsc,
        diagonal: &[f64],
    ) -> Result<()> {
        let n = matrix.rows();
        let no_memory = || out_of_memory("factorisation", n);
        let length = symbolic.len_val();
        self.values
            .try_reserve_exact(length)
            .map_err(|cause| no_memory().because(cause))?;
        prefer_large(self.values.as_mut_ptr().cast(), length * size_of::<f64>());
        self.values.resize(length, 0.0);
        let scratch = supernodal::factorize_supernodal_numeric_llt_scratch::<usize, f64>(
            &symbolic,
            PARALLELISM,
            default(),
        );
        let mut memory = MemBuffer::try_new(scratch).map_err(|_| no_memory())?;
        let place = places(&self.permutation);
        let values = Some((matrix.data(), diagonal));
        let (columns, rows, values) =
            permuted(&Pattern::new(matrix), &place, StoredTriangle::Lower, values);
        let pattern = SymbolicSparseColMatRef::new_unsorted_checked(n, n, &columns, None, &rows);
        supernodal::factorize_supernodal_numeric_llt(
            &mut self.values,
            SparseColMatRef::new(pattern, &values),
            default(),
            &symbolic,
            PARALLELISM,
            MemStack::new(&mut memory),
            ::faer::Spec::<LltParams, f64>::default(),
        )
        .map_err(|LltError::NonPositivePivot { index }| {
            let freedom = self.permutation.get(index).copied().unwrap_or(0) as usize;
            NotDefinite { freedom }
        })?;
        Ok(())
    }

    fn supernodes(&self) -> Supernodes<'_> {
        Supernodes {
            starts: &self.starts,
            row_starts: &self.row_starts,
            value_starts: &self.value_starts,
            rows: &self.rows,
            values: &self.values,
        }
    }
}

impl LowerFactor for FaerFactor {
    fn permutation(&self) -> &[i64] {
        &self.permutation
    }

    fn column_counts(&self) -> &[i64] {
        &self.counts
    }

    fn nonzeros(&self) -> f64 {
        self.nonzeros
    }

    fn flops(&self) -> f64 {
        self.flops
    }

    fn bytes(&self, entries: usize) -> f64 {
        let values = self.value_starts.last().map_or(0, |&length| length);
        let lists = self.rows.len() + 3 * self.starts.len();
        // The permuted copy of the matrix; ordering, inverse ordering, counts, diagonal, pointers.
        8.0 * (values as f64 + lists as f64)
            + self.workspace
            + 16.0 * entries as f64
            + 64.0 * self.permutation.len() as f64
    }

    fn columns(&self) -> FactorColumns<'_> {
        FactorColumns::Supernodal(self.supernodes())
    }

    fn solve_lower<'a>(
        &'a mut self,
        triangular: &Triangular,
        load: &'a mut [f64],
    ) -> Result<&'a [f64]> {
        triangular.forward(&self.supernodes(), load);
        Ok(load)
    }
}

fn out_of_memory(what: &str, n: usize) -> Error {
    Error::analysis(format!(
        "out of memory in the {what} of {n} freedoms: use a coarser mesh, a smaller zone or a \
         machine with more memory"
    ))
}

fn numbers<'a>(values: impl IntoIterator<Item = &'a usize>) -> Vec<i64> {
    values.into_iter().map(|&value| value as i64).collect()
}

/// Column of each freedom in the factor.
fn places(permutation: &[i64]) -> Vec<u32> {
    let mut place = vec![0; permutation.len()];
    for (column, &freedom) in permutation.iter().enumerate() {
        place[freedom as usize] = column as u32;
    }
    place
}

/// Triangle in which a symmetric matrix is stored.
#[derive(Clone, Copy, PartialEq)]
enum StoredTriangle {
    Upper,
    Lower,
}

/// Returns a triangle of the permuted matrix, compressed by column with unsorted rows: column
/// pointers, rows, and values. `values` gives the value of each entry and a diagonal that replaces
/// the diagonal entries. Without `values`, the returned values are empty.
fn permuted(
    pattern: &Pattern,
    place: &[u32],
    triangle: StoredTriangle,
    values: Option<(&[f64], &[f64])>,
) -> (Vec<usize>, Vec<usize>, Vec<f64>) {
    let n = pattern.n();
    // Row and column within the triangle.
    let target = |i: usize, j: usize| {
        let (a, b) = (place[i] as usize, place[j] as usize);
        match triangle {
            StoredTriangle::Upper => (a.min(b), a.max(b)),
            StoredTriangle::Lower => (a.max(b), a.min(b)),
        }
    };
    let mut starts = vec![0usize; n + 1];
    for j in 0..n {
        for &i in pattern.column(j) {
            starts[target(i as usize, j).1 + 1] += 1;
        }
    }
    for k in 0..n {
        starts[k + 1] += starts[k];
    }
    let entries = pattern.rows().len();
    let mut next = starts.clone();
    let mut rows = vec![0usize; entries];
    let mut entry_values = vec![0.0; if values.is_some() { entries } else { 0 }];
    let mut entry = 0;
    for j in 0..n {
        for &i in pattern.column(j) {
            let i = i as usize;
            let (row, column) = target(i, j);
            rows[next[column]] = row;
            if let Some((values, diagonal)) = values {
                entry_values[next[column]] = if i == j { diagonal[j] } else { values[entry] };
            }
            next[column] += 1;
            entry += 1;
        }
    }
    (starts, rows, entry_values)
}
