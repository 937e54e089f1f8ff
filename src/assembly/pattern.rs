//! Incidence of elements and freedoms, and the sparsity pattern that follows from it.

use super::elements::Elements;
use rayon::prelude::*;

/// Number of columns of the pattern that a thread takes at a time.
const BLOCK: usize = 4096;
/// Number of rows for which each column gets room at first: that of bilinear elements.
const ROWS_EXPECTED: usize = 10;

/// For each freedom, the elements that act on it.
#[derive(Debug, Clone)]
pub(super) struct Incidence {
    starts: Vec<usize>,
    entries: Vec<(u32, u16)>,
}

impl Incidence {
    pub(super) fn new(elements: &Elements) -> Self {
        let n = elements.n_freedoms();
        let mut starts = vec![0usize; n + 1];
        let of = |e: usize| elements.freedoms(e).iter().enumerate();
        for e in 0..elements.len() {
            for (_, &f) in of(e).filter(|(_, f)| **f >= 0) {
                starts[f as usize + 1] += 1;
            }
        }
        for i in 0..n {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut entries = vec![(0u32, 0u16); starts[n]];
        for e in 0..elements.len() {
            for (local, &f) in of(e).filter(|(_, f)| **f >= 0) {
                entries[next[f as usize]] = (e as u32, local as u16);
                next[f as usize] += 1;
            }
        }
        Incidence { starts, entries }
    }

    /// Elements that act on a freedom, ascending, each with the local number of the freedom.
    pub(super) fn elements(&self, freedom: usize) -> &[(u32, u16)] {
        &self.entries[self.starts[freedom]..self.starts[freedom + 1]]
    }

    /// Returns column pointers and sorted rows of the upper triangle; columns that are not `wanted`
    /// are empty.
    pub(super) fn pattern(
        &self,
        elements: &Elements,
        wanted: impl Fn(usize) -> bool + Sync,
    ) -> (Vec<i64>, Vec<i64>) {
        let n = self.starts.len() - 1;
        // The columns are split into blocks of fixed size, so that the number of threads does not
        // decide what is computed together.
        let blocks: Vec<(Vec<u32>, Vec<i64>)> = (0..n.div_ceil(BLOCK))
            .into_par_iter()
            .map(|block| {
                let columns = block * BLOCK..((block + 1) * BLOCK).min(n);
                let mut lengths = Vec::with_capacity(columns.len());
                let mut rows = Vec::with_capacity(ROWS_EXPECTED * columns.len());
                let mut column = Vec::new();
                for j in columns {
                    column.clear();
                    let own = self.elements(j).iter().filter(|_| wanted(j));
                    for &(e, _) in own {
                        let freedoms = elements.freedoms(e as usize).iter().copied();
                        column.extend(freedoms.filter(|f| (0..=j as i64).contains(f)));
                    }
                    column.sort_unstable();
                    column.dedup();
                    lengths.push(column.len() as u32);
                    rows.extend_from_slice(&column);
                }
                (lengths, rows)
            })
            .collect();
        let mut pointers = Vec::with_capacity(n + 1);
        pointers.push(0);
        let mut total = 0;
        for length in blocks.iter().flat_map(|(lengths, _)| lengths) {
            total += i64::from(*length);
            pointers.push(total);
        }
        let mut rows = Vec::with_capacity(total as usize);
        for (_, block) in blocks {
            rows.extend_from_slice(&block);
        }
        (pointers, rows)
    }
}
