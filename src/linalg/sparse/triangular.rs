//! Solves with the whole of `L`, subtree by subtree: `L y = f`, and `L^T x = y` for the columns
//! whose `x` is not known yet.
//!
//! The time of a solve is the time in which memory delivers `L` once.

use super::FactorColumns;
#[cfg(feature = "faer")]
use super::columns::Supernodes;
use super::tree::Forest;
use rayon::prelude::*;
use std::ops::Range;

/// Number of partial sums of one dot product.
const LANES: usize = 8;

/// Subtrees of the factor's supernodes that may be solved at the same time.
pub(crate) struct Triangular {
    /// Ranges of supernodes, one for each subtree, ascending.
    subtrees: Vec<Range<usize>>,
    /// Range of the columns of each subtree.
    columns: Vec<Range<usize>>,
    /// Number of rows of the tallest supernode.
    tallest: usize,
}

impl Triangular {
    /// Finds the subtrees of a numerical factor.
    pub(crate) fn new(columns: &FactorColumns) -> Self {
        let FactorColumns::Supernodal(supernodes) = columns else {
            return Triangular {
                subtrees: Vec::new(),
                columns: Vec::new(),
                tallest: 0,
            };
        };
        let n = supernodes.len();
        let mut of_column = vec![0u32; supernodes.n_columns()];
        for s in 0..n {
            of_column[supernodes.columns(s)].fill(s as u32);
        }
        let width = |s: usize| supernodes.columns(s).len();
        let parent: Vec<usize> = (0..n)
            .map(|s| {
                let next = supernodes.rows(s).get(width(s));
                next.map_or(usize::MAX, |&row| of_column[row as usize] as usize)
            })
            .collect();
        let work: Vec<u64> = (0..n)
            .map(|s| (supernodes.rows(s).len() * width(s)) as u64)
            .collect();
        let forest = Forest {
            parent: &parent,
            work: &work,
        };
        let subtrees = forest.subtrees();
        let columns = subtrees
            .iter()
            .map(|range| {
                supernodes.columns(range.start).start..supernodes.columns(range.end - 1).end
            })
            .collect();
        Triangular {
            subtrees,
            columns,
            tallest: (0..n).map(|s| supernodes.rows(s).len()).max().unwrap_or(0),
        }
    }

    /// Number of subtrees.
    #[cfg(test)]
    pub(crate) fn n_subtrees(&self) -> usize {
        self.subtrees.len()
    }

    /// Splits a vector into the parts that belong to the columns of the subtrees.
    fn pieces<'a>(&self, x: &'a mut [f64]) -> Vec<&'a mut [f64]> {
        let mut pieces = Vec::with_capacity(self.subtrees.len());
        let (mut rest, mut taken) = (x, 0);
        for columns in &self.columns {
            let (_, tail) = rest.split_at_mut(columns.start - taken);
            let (piece, tail) = tail.split_at_mut(columns.len());
            pieces.push(piece);
            (rest, taken) = (tail, columns.end);
        }
        pieces
    }

    /// Solves `y = L^-1 f` in place. Contributions of subtrees to the rows above them are added in
    /// the sequence of the subtrees, so the bits are the same for any number of threads.
    #[cfg(feature = "faer")]
    pub(crate) fn forward(&self, supernodes: &Supernodes, x: &mut [f64]) {
        let n = x.len();
        let pieces = self.pieces(x);
        let outer: Vec<Vec<f64>> = self
            .subtrees
            .par_iter()
            .zip(&self.columns)
            .zip(pieces)
            .map_init(
                || vec![0.0; self.tallest],
                |sums, ((range, columns), piece)| {
                    // Only the rows of the subtree's root are touched.
                    let mut outer = vec![0.0; n - columns.end];
                    for s in range.clone() {
                        eliminate(supernodes, s, columns.start, piece, &mut outer, sums);
                    }
                    let root = range.end - 1;
                    let rows = &supernodes.rows(root)[supernodes.columns(root).len()..];
                    let outer = rows.iter().map(|&row| outer[row as usize - columns.end]);
                    outer.collect()
                },
            )
            .collect();
        for (range, outer) in self.subtrees.iter().zip(outer) {
            let root = range.end - 1;
            let rows = &supernodes.rows(root)[supernodes.columns(root).len()..];
            for (&row, value) in rows.iter().zip(outer) {
                x[row as usize] += value;
            }
        }
        let mut sums = vec![0.0; self.tallest];
        let mut next = 0;
        let ends = self.subtrees.iter().map(|range| (range.start, range.end));
        for (start, end) in ends.chain([(supernodes.len(), 0)]) {
            for s in next..start {
                eliminate(supernodes, s, 0, x, &mut [], &mut sums);
            }
            next = end;
        }
    }

    /// Solves `L^T x = y` in place: on entry `x` holds the solution in `known` columns, and `y` in
    /// all others. All rows of a known column are known. `above` is workspace of the length of `x`.
    pub(crate) fn backward(
        &self,
        columns: &FactorColumns,
        known: &[bool],
        x: &mut [f64],
        above: &mut [f64],
    ) {
        let supernodes = match columns {
            FactorColumns::Supernodal(supernodes) => supernodes,
            simplicial => {
                for j in (0..x.len()).rev().filter(|&j| !known[j]) {
                    let column = simplicial.get(j);
                    let below = column.rows[1..].iter().zip(&column.values[1..]);
                    let sum: f64 = below.map(|(&i, l)| l * x[i as usize]).sum();
                    x[j] = (x[j] - sum) / column.values[0];
                }
                return;
            }
        };
        let solve = |s: usize, first: usize, x: &mut [f64], above: &[f64], v: &mut [f64]| {
            let own = supernodes.columns(s);
            if known[own.start] {
                return;
            }
            let end = first + x.len();
            let rows = supernodes.rows(s);
            let v = &mut v[..rows.len()];
            for (v, &row) in v.iter_mut().zip(rows) {
                let row = row as usize;
                *v = if row < end {
                    x[row - first]
                } else {
                    above[row]
                };
            }
            let values = supernodes.values(s);
            for k in (0..own.len()).rev().filter(|k| !known[own.start + k]) {
                let column = &values[k * rows.len()..(k + 1) * rows.len()];
                v[k] = (v[k] - dot(&column[k + 1..], &v[k + 1..])) / column[k];
            }
            x[own.start - first..own.end - first].copy_from_slice(&v[..own.len()]);
        };
        let mut v = vec![0.0; self.tallest];
        let mut left = supernodes.len();
        for range in self.subtrees.iter().rev() {
            for s in (range.end..left).rev() {
                solve(s, 0, x, &[], &mut v);
            }
            left = range.start;
        }
        for s in (0..left).rev() {
            solve(s, 0, x, &[], &mut v);
        }
        above.copy_from_slice(x);
        let pieces = self.pieces(x);
        let above = &*above;
        self.subtrees
            .par_iter()
            .zip(&self.columns)
            .zip(pieces)
            .for_each_init(
                || vec![0.0; self.tallest],
                |v, ((range, columns), piece)| {
                    for s in range.clone().rev() {
                        solve(s, columns.start, piece, above, v);
                    }
                },
            );
    }
}

/// Performs the forward substitution with the columns of a supernode. `x` holds the columns from
/// `first` on, and `outer` those that follow.
#[cfg(feature = "faer")]
fn eliminate(
    supernodes: &Supernodes,
    s: usize,
    first: usize,
    x: &mut [f64],
    outer: &mut [f64],
    sums: &mut [f64],
) {
    let (columns, rows) = (supernodes.columns(s), supernodes.rows(s));
    let own = &mut x[columns.start - first..columns.end - first];
    // A load on few freedoms reaches only their ancestors in the tree.
    if own.iter().all(|value| *value == 0.0) {
        return;
    }
    let (width, height) = (columns.len(), rows.len());
    let sums = &mut sums[..height - width];
    sums.fill(0.0);
    for (k, column) in supernodes.values(s).chunks_exact(height).enumerate() {
        let (done, rest) = own.split_at_mut(k + 1);
        let value = done[k] / column[k];
        done[k] = value;
        let (within, below) = column[k + 1..].split_at(width - k - 1);
        for (x, l) in rest.iter_mut().zip(within) {
            *x -= l * value;
        }
        for (sum, l) in sums.iter_mut().zip(below) {
            *sum -= l * value;
        }
    }
    let end = first + x.len();
    for (&row, &sum) in rows[width..].iter().zip(&*sums) {
        let row = row as usize;
        if row < end {
            x[row - first] += sum;
        } else {
            outer[row - end] += sum;
        }
    }
}

/// Dot product that reads from the end. The columns are also taken from the last to the first, so
/// the memory is read in one stream.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    let (a_lanes, b_lanes) = (a.rchunks_exact(LANES), b.rchunks_exact(LANES));
    let head: f64 = a_lanes
        .remainder()
        .iter()
        .zip(b_lanes.remainder())
        .map(|(a, b)| a * b)
        .sum();
    for (a, b) in a_lanes.zip(b_lanes) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    sums.iter().sum::<f64>() + head
}
