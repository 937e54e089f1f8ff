//! `L^T x = y` for the columns whose `x` is not known yet, subtree by subtree.
//!
//! The memory delivers `L` once: that is the time it takes.

use super::factor::{Columns, Factor};
use super::tree::Forest;
use rayon::prelude::*;
use std::ops::Range;

/// Partial sums of one dot product.
const LANES: usize = 8;

/// What of the factor's supernodes may be solved at the same time.
pub(super) struct Backward {
    /// Ranges of supernodes, ascending.
    subtrees: Vec<Range<usize>>,
    /// The columns of each subtree.
    columns: Vec<Range<usize>>,
    /// Rows of the tallest supernode.
    tallest: usize,
}

impl Backward {
    /// The subtrees of a numerical factor.
    pub(super) fn new(factor: &Factor) -> Self {
        let Columns::Supernodal(supernodes) = factor.columns() else {
            return Backward {
                subtrees: Vec::new(),
                columns: Vec::new(),
                tallest: 0,
            };
        };
        let n = supernodes.len();
        let mut of_column = vec![0u32; factor.n()];
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
        Backward {
            subtrees,
            columns,
            tallest: (0..n).map(|s| supernodes.rows(s).len()).max().unwrap_or(0),
        }
    }

    /// Number of subtrees.
    #[cfg(test)]
    pub(super) fn n_subtrees(&self) -> usize {
        self.subtrees.len()
    }

    /// Solves in place: on entry `x` holds `y`, but the solution where `known`; a known column's
    /// rows are all known. `above` is workspace of the same length.
    pub(super) fn solve(&self, factor: &Factor, known: &[bool], x: &mut [f64], above: &mut [f64]) {
        let supernodes = match factor.columns() {
            Columns::Supernodal(supernodes) => supernodes,
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
        let mut pieces = Vec::with_capacity(self.subtrees.len());
        let (mut rest, mut taken) = (x, 0);
        for columns in &self.columns {
            let (_, tail) = rest.split_at_mut(columns.start - taken);
            let (piece, tail) = tail.split_at_mut(columns.len());
            pieces.push(piece);
            (rest, taken) = (tail, columns.end);
        }
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

/// Read from the end, as the columns are taken: the memory delivers one stream.
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
