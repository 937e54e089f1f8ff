//! Assembly of the stiffness of elements, column by column.

use super::elements::{Elements, Matrices};
use super::pattern::Incidence;
use crate::element::packed;
use crate::linalg::SymmetricCsc;
use rayon::prelude::*;

impl Elements<'_> {
    /// Assembles the upper triangle of the stiffness; columns of freedoms not `wanted` stay empty.
    ///
    /// Every column is owned by one thread and gathers its elements' contributions in ascending
    /// element order, so the result has the same bits for any number of threads.
    pub(super) fn stiffness(&self, wanted: impl Fn(usize) -> bool + Sync) -> SymmetricCsc {
        let n = self.n_freedoms();
        let incidence = Incidence::new(self);
        let matrices = Matrices::new(self);
        let (pointers, rows) = incidence.pattern(self, wanted);
        let mut values = vec![0.0; rows.len()];
        let mut columns: Vec<&mut [f64]> = Vec::with_capacity(n);
        let mut rest = values.as_mut_slice();
        for j in 0..n {
            let (column, tail) = rest.split_at_mut((pointers[j + 1] - pointers[j]) as usize);
            columns.push(column);
            rest = tail;
        }
        let columns = columns.into_par_iter().enumerate().with_min_len(1024);
        columns.for_each(|(j, column)| {
            if column.is_empty() {
                return;
            }
            let rows = &rows[pointers[j] as usize..pointers[j + 1] as usize];
            for &(element, local) in incidence.elements(j) {
                let matrix = matrices.of(element as usize);
                for (i, &freedom) in self.freedoms(element as usize).iter().enumerate() {
                    if (0..=j as i64).contains(&freedom)
                        && let Ok(at) = rows.binary_search(&freedom)
                    {
                        column[at] += matrix[packed(i, local as usize)];
                    }
                }
            }
        });
        SymmetricCsc::new_csc((n, n), pointers, rows, values)
    }

    /// For each freedom, whether the same elements act on it as on the freedom before.
    #[cfg(feature = "mumps")]
    pub(super) fn continued(&self) -> Vec<bool> {
        let incidence = Incidence::new(self);
        let of = |j: usize| incidence.elements(j).iter().map(|(element, _)| element);
        let same = |j: usize| j > 0 && of(j).eq(of(j - 1));
        (0..self.n_freedoms()).map(same).collect()
    }
}
