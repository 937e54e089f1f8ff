//! Elimination tree and column counts of a factor, from the pattern and an ordering.
//!
//! # Source
//! T. A. Davis, *Direct Methods for Sparse Linear Systems*, SIAM 2006, sections 4.1 and 4.5:
//! the nonzeros of row `j` of `L` lie on the paths up the tree from the entries of row `j` of the
//! matrix.

use crate::linalg::sparse::Pattern;

/// Symbolic elimination of a pattern in a given ordering. A column of the pattern may stand for
/// several freedoms.
pub(super) struct Elimination {
    /// Parent of each column in the ordering, -1 for a root.
    pub(super) parent: Vec<i64>,
    /// For each column of the pattern, the number of nonzeros in the column of `L` that belongs to
    /// its first freedom.
    pub(super) counts: Vec<i64>,
}

impl Elimination {
    /// Computes the elimination of `pattern` in the ordering `permutation`; column `j` of the
    /// pattern stands for `sizes[j]` freedoms.
    pub(super) fn new(pattern: &Pattern, sizes: &[i64], permutation: &[i64]) -> Self {
        let n = pattern.n();
        let (starts, rows) = permuted(pattern, permutation);
        let mut parent = vec![-1i64; n];
        let mut counts: Vec<i64> = permutation.iter().map(|&v| sizes[v as usize]).collect();
        let mut reached = vec![u32::MAX; n];
        for j in 0..n {
            let size = sizes[permutation[j] as usize];
            reached[j] = j as u32;
            for &row in &rows[starts[j]..starts[j + 1]] {
                let mut i = row as usize;
                while reached[i] != j as u32 {
                    reached[i] = j as u32;
                    counts[i] += size;
                    if parent[i] < 0 {
                        parent[i] = j as i64;
                    }
                    i = parent[i] as usize;
                }
            }
        }
        Elimination { parent, counts }
    }

    /// Floating point operations of the factorisation: the sum of the squares of all column counts.
    pub(super) fn flops(&self, sizes: &[i64], permutation: &[i64]) -> f64 {
        let columns = self.counts.iter().zip(permutation);
        let flops = columns.map(|(&count, &vertex)| {
            let own = 0..sizes[vertex as usize];
            own.map(|k| ((count - k) as f64).powi(2)).sum::<f64>()
        });
        flops.sum()
    }
}

/// Strict upper triangle in another ordering, compressed by column, with unsorted rows.
fn permuted(pattern: &Pattern, permutation: &[i64]) -> (Vec<usize>, Vec<u32>) {
    let n = pattern.n();
    let mut place = vec![0u32; n];
    for (k, &vertex) in permutation.iter().enumerate() {
        place[vertex as usize] = k as u32;
    }
    let edges = || {
        (0..n).flat_map(|j| {
            let above = pattern.column(j).iter().filter(move |&&i| i as usize != j);
            above.map(move |&i| (i as usize, j))
        })
    };
    let mut starts = vec![0usize; n + 1];
    for (i, j) in edges() {
        starts[place[i].max(place[j]) as usize + 1] += 1;
    }
    for k in 0..n {
        starts[k + 1] += starts[k];
    }
    let mut next = starts.clone();
    let mut rows = vec![0u32; starts[n]];
    for (i, j) in edges() {
        let (a, b) = (place[i].min(place[j]), place[i].max(place[j]));
        rows[next[b as usize]] = a;
        next[b as usize] += 1;
    }
    (starts, rows)
}
