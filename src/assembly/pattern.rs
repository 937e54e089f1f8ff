//! Which elements touch which freedom, and the sparsity pattern that follows.

use crate::model::{Model, Slot};
use rayon::prelude::*;

/// Element freedoms and, for each freedom, the elements that hold it.
#[derive(Debug, Clone)]
pub struct Incidence {
    offsets: Vec<usize>,
    freedoms: Vec<i64>,
    starts: Vec<usize>,
    entries: Vec<(u32, u8)>,
}

impl Incidence {
    /// Incidence of a model.
    pub fn new(model: &Model) -> Self {
        let mut offsets = Vec::with_capacity(model.mesh.n_elements() + 1);
        offsets.push(0);
        let mut freedoms = Vec::with_capacity(2 * model.mesh.connectivity.len());
        for e in 0..model.mesh.n_elements() {
            for &node in model.mesh.nodes(e) {
                for slot in model.freedoms.slots[node as usize] {
                    freedoms.push(if let Slot::Free(f) = slot {
                        i64::from(f)
                    } else {
                        -1
                    });
                }
            }
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
        let mut entries = vec![(0u32, 0u8); starts[model.freedoms.n]];
        for e in 0..model.mesh.n_elements() {
            for (local, &f) in freedoms[offsets[e]..offsets[e + 1]].iter().enumerate() {
                if f >= 0 {
                    entries[next[f as usize]] = (e as u32, local as u8);
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
    pub fn elements(&self, freedom: usize) -> &[(u32, u8)] {
        &self.entries[self.starts[freedom]..self.starts[freedom + 1]]
    }

    /// Column pointers and sorted rows of the upper triangle.
    pub fn pattern(&self) -> (Vec<i64>, Vec<i64>) {
        let n = self.starts.len() - 1;
        let columns: Vec<Vec<i64>> = (0..n)
            .into_par_iter()
            .with_min_len(1024)
            .map(|j| {
                let mut rows: Vec<i64> = self
                    .elements(j)
                    .iter()
                    .flat_map(|&(e, _)| self.freedoms(e as usize))
                    .copied()
                    .filter(|&f| f >= 0 && f <= j as i64)
                    .collect();
                rows.sort_unstable();
                rows.dedup();
                rows
            })
            .collect();
        let mut pointers = Vec::with_capacity(n + 1);
        pointers.push(0);
        let mut total = 0;
        for column in &columns {
            total += column.len() as i64;
            pointers.push(total);
        }
        let mut rows = Vec::with_capacity(total as usize);
        for column in columns {
            rows.extend_from_slice(&column);
        }
        (pointers, rows)
    }
}
