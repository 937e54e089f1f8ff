//! Which elements touch which freedom, and the sparsity pattern that follows.

use crate::model::{Model, Slot};
use rayon::prelude::*;

/// Columns of the pattern that a thread takes at a time.
const BLOCK: usize = 4096;
/// Rows of a column that room is made for: those of bilinear elements.
const ROWS_EXPECTED: usize = 10;

/// Element freedoms, those of springs after them as elements of one freedom, and, for each freedom,
/// the elements that hold it.
#[derive(Debug, Clone)]
pub struct Incidence {
    offsets: Vec<usize>,
    freedoms: Vec<i64>,
    starts: Vec<usize>,
    entries: Vec<(u32, u16)>,
}

impl Incidence {
    /// Incidence of a model.
    pub fn new(model: &Model) -> Self {
        let mut offsets = Vec::with_capacity(model.mesh.n_elements() + 1);
        offsets.push(0);
        let n = model.freedoms.per_node * model.mesh.connectivity.len();
        let mut freedoms = Vec::with_capacity(n);
        let number = |slot: &Slot| match *slot {
            Slot::Free(f) => i64::from(f),
            _ => -1,
        };
        for e in 0..model.mesh.n_elements() {
            freedoms.extend(model.slots_of(e).iter().map(number));
            offsets.push(freedoms.len());
        }
        for spring in &model.freedoms.springs {
            freedoms.push(spring.freedom as i64);
            offsets.push(freedoms.len());
        }
        let mut starts = vec![0usize; model.freedoms.n + 1];
        for &f in freedoms.iter().filter(|f| **f >= 0) {
            starts[f as usize + 1] += 1;
        }
        for i in 0..model.freedoms.n {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut entries = vec![(0u32, 0u16); starts[model.freedoms.n]];
        for e in 0..offsets.len() - 1 {
            for (local, &f) in freedoms[offsets[e]..offsets[e + 1]].iter().enumerate() {
                if f >= 0 {
                    entries[next[f as usize]] = (e as u32, local as u16);
                    next[f as usize] += 1;
                }
            }
        }
        Incidence {
            offsets,
            freedoms,
            starts,
            entries,
        }
    }

    /// Freedoms of an element, -1 where held.
    pub fn freedoms(&self, element: usize) -> &[i64] {
        &self.freedoms[self.offsets[element]..self.offsets[element + 1]]
    }

    /// Elements (with the local number) that hold a freedom, ascending.
    pub fn elements(&self, freedom: usize) -> &[(u32, u16)] {
        &self.entries[self.starts[freedom]..self.starts[freedom + 1]]
    }

    /// Column pointers and sorted rows of the upper triangle.
    pub fn pattern(&self) -> (Vec<i64>, Vec<i64>) {
        let n = self.starts.len() - 1;
        // Blocks of columns: their number, not the number of threads, decides what is computed
        // together.
        let blocks: Vec<(Vec<u32>, Vec<i64>)> = (0..n.div_ceil(BLOCK))
            .into_par_iter()
            .map(|block| {
                let columns = block * BLOCK..((block + 1) * BLOCK).min(n);
                let mut lengths = Vec::with_capacity(columns.len());
                let mut rows = Vec::with_capacity(ROWS_EXPECTED * columns.len());
                let mut column = Vec::new();
                for j in columns {
                    column.clear();
                    for &(e, _) in self.elements(j) {
                        let freedoms = self.freedoms(e as usize).iter().copied();
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
