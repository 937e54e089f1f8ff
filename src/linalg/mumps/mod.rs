//! MUMPS backend: freedoms outside the zone are factored on several machines.
//!
//! With the freedoms in the order `[ interior | trailing ]`, where trailing means zone and contact,
//! and `G` the trailing freedoms that the interior touches,
//!
//! ```text
//!     S_G = - K_GI K_II^-1 K_IG      by MUMPS on all ranks, dense
//!     S   = K_tt + S_G               condensed by CHOLMOD on the first rank
//! ```
//!
//! The interior is needed once for each load vector and once for each state that is written. The
//! ranks also evaluate the stresses of that state ([`World::serve`]). Zone, contact and events need
//! the first rank alone.
//!
//! The first rank runs the program; each rank holds some columns of the matrix ([`Shared`]) and
//! carries out requests ([`World::serve`]). No rank holds the whole matrix; MUMPS gathers its
//! pattern on the first rank for the symbolic analysis. Results agree with those of the other
//! backends to round-off, not to the bit; the same holds between different numbers of ranks, and
//! between runs.
//!
//! | file | what |
//! |---|---|
//! | `world` | the ranks, and requests of the first rank to all |
//! | `task`, `rank` | requests and answers; data and work of a rank |
//! | `shared` | the matrix as the first rank sees it |
//! | `exterior` | ordering, analysis and factor of the interior |
//! | `meaning` | error numbers of MUMPS in words |
//! | `shim.c` | MPI and MUMPS themselves |
//!
//! # Source
//! P. R. Amestoy, I. S. Duff, J. Koster, J.-Y. L'Excellent, *A fully asynchronous multifrontal
//! solver using distributed dynamic scheduling*, SIAM J. Matrix Anal. Appl. 23 (2001) 15,
//! doi:10.1137/S0895479899358194; the users' guide of MUMPS 5.5, section 3.18 (Schur complement).

mod exterior;
mod meaning;
mod rank;
mod shared;
mod task;
#[cfg(test)]
pub(in crate::linalg) mod tests;
mod world;

pub use rank::{Assemble, Columns, Evaluate};
pub use shared::{Part, Shared};
pub use world::{Traffic, World};

use super::{
    ChangedFactor, Condensed, ContactStiffness, NotDefinite, Partition, Pivot, Prediction,
    SymmetricCsc, ZonePart, check, cholmod, smallest_pivot_ratio,
};
use crate::error::{Error, Result};
use crate::memory;
use exterior::{Exterior, Schur, SymbolicFactor};
use shared::Entry;

/// A condensed matrix whose interior MUMPS has factored.
struct MumpsCondensed {
    n: usize,
    /// Zone and contact freedoms, ascending; their places are the freedom numbers of `inner`.
    trailing: Vec<usize>,
    exterior: Option<Exterior>,
    inner: Box<dyn Condensed>,
    cost: Prediction,
    weakest: Pivot,
}

/// Factors and condenses `matrix + diag(shift)`, given as a whole on the first rank.
///
/// # Errors
/// Errors of [`super::condense`].
pub fn condense(
    matrix: &SymmetricCsc,
    partition: &Partition,
    shift: &[f64],
) -> Result<Box<dyn Condensed>> {
    check::arguments(matrix, partition, shift)?;
    condense_shared(&Shared::here(matrix)?, partition, shift)
}

/// Factors and condenses `matrix + diag(shift)` for a matrix shared among ranks.
///
/// # Errors
/// Errors of [`super::condense`].
pub fn condense_shared(
    matrix: &Shared,
    partition: &Partition,
    shift: &[f64],
) -> Result<Box<dyn Condensed>> {
    check::partition(partition, shift)?;
    let mut trailing = RemainingMatrix::new(matrix, partition)?;
    let cost = trailing.cost()?;
    if let Some(analysis) = &trailing.analysis {
        // The columns are in memory already.
        let ranks = cost.memory_by_rank.iter().zip(&trailing.columns);
        let more: Vec<f64> = ranks.map(|(all, columns)| all - columns).collect();
        analysis.require_memory(&more)?;
    }
    let n = partition.n;
    let (exterior, schur) = match trailing.analysis.take() {
        Some(analysis) => {
            let (exterior, schur) = Exterior::new(matrix, analysis)?;
            (Some(exterior), Some(schur))
        }
        None => (None, None),
    };
    let condensed = trailing.matrix(schur);
    trailing.own = Vec::new();
    let inner = cholmod::condense(&condensed, &trailing.partition, shift);
    let inner = inner.map_err(|error| of_freedom(error, &trailing.freedoms))?;
    let mut shifts = vec![0.0; n];
    for (&contact, shift) in partition.contact.iter().zip(shift) {
        shifts[contact] += shift;
    }
    let weakest = trailing.weakest(inner.weakest_pivot(), &condensed, matrix, &shifts);
    let freedom = weakest.freedom;
    if weakest.ratio <= smallest_pivot_ratio(n) || weakest.ratio.is_nan() {
        return Err(NotDefinite { freedom }.into());
    }
    Ok(Box::new(MumpsCondensed {
        n,
        trailing: trailing.freedoms,
        exterior,
        inner,
        cost,
        weakest,
    }))
}

/// Predicts the cost of [`condense`].
///
/// # Errors
/// Errors of [`super::predict`].
pub fn predict(matrix: &SymmetricCsc, partition: &Partition) -> Result<Prediction> {
    predict_shared(&Shared::here(matrix)?, partition)
}

/// Predicts the cost of [`condense_shared`].
///
/// # Errors
/// Errors of [`super::predict`].
pub fn predict_shared(matrix: &Shared, partition: &Partition) -> Result<Prediction> {
    check::partition(partition, &[])?;
    RemainingMatrix::new(matrix, partition)?.cost()
}

/// Matrix that remains when the interior is eliminated.
struct RemainingMatrix {
    /// Zone and contact freedoms, ascending; the last freedom if there are none.
    freedoms: Vec<usize>,
    /// Partition of the remaining freedoms, in their own numbering.
    partition: Partition,
    /// Entries between the remaining freedoms.
    own: Vec<Entry>,
    /// Analysis of the interior; `None` without an interior.
    analysis: Option<SymbolicFactor>,
    /// Bytes of the columns that each rank holds.
    columns: Vec<f64>,
}

impl RemainingMatrix {
    fn new(matrix: &Shared, partition: &Partition) -> Result<Self> {
        let n = partition.n;
        let mut freedoms: Vec<usize> = (partition.zone.iter())
            .chain(&partition.contact)
            .copied()
            .collect();
        freedoms.sort_unstable();
        if freedoms.is_empty() {
            // At least one freedom is needed to condense onto.
            freedoms.push(n - 1);
        }
        let mut place = vec![None; n];
        for (t, &freedom) in freedoms.iter().enumerate() {
            place[freedom] = Some(t);
        }
        let local = |of: &[usize]| of.iter().filter_map(|&freedom| place[freedom]).collect();
        let inner = Partition {
            n: freedoms.len(),
            zone: local(&partition.zone),
            contact: local(&partition.contact),
        };
        let (near, touched) =
            matrix.near(&place.iter().map(Option::is_some).collect::<Vec<_>>())?;
        let mut own = Vec::new();
        let mut coupling = Vec::new();
        for (row, column, value) in near {
            match (place[row], place[column]) {
                (Some(i), Some(j)) => own.push((i, j, value)),
                (None, Some(t)) => coupling.push((row, t, value)),
                (Some(t), None) => coupling.push((column, t, value)),
                (None, None) => {}
            }
        }
        let analysis = match freedoms.len() == n {
            true => None,
            false => Some(SymbolicFactor::new(matrix, &place, &touched, coupling)?),
        };
        Ok(RemainingMatrix {
            freedoms,
            partition: inner,
            own,
            analysis,
            columns: matrix.bytes(),
        })
    }

    /// Matrix of the trailing freedoms with the Schur complement of the interior, in which ones
    /// stand for values that are not computed yet.
    fn matrix(&self, schur: Option<Schur>) -> SymmetricCsc {
        upper_triangle(self.freedoms.len(), |add| {
            self.own.iter().copied().for_each(&mut *add);
            if let Some(schur) = &schur {
                schur.each(add);
            }
        })
    }

    /// Pivot that lost the most digits to cancellation. The loss counts from `K` to `S`
    /// (`condensed`); for the freedom of the `inner` pivot, the loss in the factorisation of `S` is
    /// included.
    fn weakest(
        &self,
        inner: Pivot,
        condensed: &SymmetricCsc,
        matrix: &Shared,
        shifts: &[f64],
    ) -> Pivot {
        let left = |t: usize| {
            let freedom = self.freedoms[t];
            let of_schur = condensed.get(t, t).copied().unwrap_or(0.0) + shifts[freedom];
            let ratio = of_schur / (matrix.diagonal()[freedom] + shifts[freedom]);
            Pivot {
                freedom,
                ratio: ratio.min(1.0),
            }
        };
        let last = left(inner.freedom);
        let start = Pivot {
            ratio: inner.ratio * last.ratio,
            ..last
        };
        let all = (0..self.freedoms.len()).map(left);
        all.fold(start, |least, pivot| match pivot.ratio < least.ratio {
            true => pivot,
            false => least,
        })
    }

    /// Predicts the cost. The memory of each rank is the largest of three stages: while the
    /// ordering is found, while the interior is factored, and, on the first rank, while the
    /// remaining matrix is factored.
    fn cost(&self) -> Result<Prediction> {
        let schur = self.analysis.as_ref().map(SymbolicFactor::unknown);
        let m = schur.as_ref().map_or(0, |schur| schur.freedoms.len()) as f64;
        // The pattern, and its copies in the analysis.
        memory::require("matrix that remains on the first rank", 24.0 * m * m)?;
        let mut cost = cholmod::predict(&self.matrix(schur), &self.partition)?;
        let mut by_rank = self.columns.clone();
        by_rank[0] += cost.memory_bytes;
        if let Some(analysis) = &self.analysis {
            cost.ordering = analysis.order_name.into();
            cost.flops += analysis.flops();
            cost.factor_nonzeros += analysis.nonzeros();
            by_rank[0] += analysis.bytes_later();
            let own = (size_of::<Entry>() * self.own.len()) as f64;
            let needed = self.columns.iter().zip(analysis.bytes(own));
            for (bytes, (columns, more)) in by_rank.iter_mut().zip(needed) {
                *bytes = bytes.max(columns + more);
            }
        }
        cost.memory_bytes = by_rank.iter().copied().fold(0.0, f64::max);
        cost.memory_by_rank = by_rank;
        Ok(cost)
    }
}

/// Converts the freedom in an error to the numbering of the whole matrix.
fn of_freedom(error: Error, trailing: &[usize]) -> Error {
    let cause = error
        .causes()
        .find_map(|cause| cause.downcast_ref::<NotDefinite>());
    let local = cause.map(|cause| cause.freedom);
    match local.and_then(|local| trailing.get(local)) {
        Some(&freedom) => NotDefinite { freedom }.into(),
        None => error,
    }
}

/// Builds a matrix from entries of its upper triangle; entries at the same place are added. `each`
/// is called twice, so that the entries need no storage of their own.
fn upper_triangle(n: usize, each: impl Fn(&mut dyn FnMut(Entry))) -> SymmetricCsc {
    let mut starts = vec![0usize; n + 1];
    each(&mut |(_, column, _)| starts[column + 1] += 1);
    for j in 0..n {
        starts[j + 1] += starts[j];
    }
    let mut next = starts.clone();
    let (mut rows, mut values) = (vec![0i64; starts[n]], vec![0.0; starts[n]]);
    each(&mut |(row, column, value)| {
        rows[next[column]] = row as i64;
        values[next[column]] = value;
        next[column] += 1;
    });
    let mut pointers = vec![0i64];
    let mut n_kept = 0;
    let mut sorted: Vec<(i64, f64)> = Vec::new();
    for j in 0..n {
        let column = starts[j]..starts[j + 1];
        sorted.clear();
        sorted.extend(
            rows[column.clone()]
                .iter()
                .copied()
                .zip(values[column].iter().copied()),
        );
        sorted.sort_by_key(|&(row, _)| row);
        let first = n_kept;
        for &(row, value) in &sorted {
            if n_kept > first && rows[n_kept - 1] == row {
                values[n_kept - 1] += value;
            } else {
                (rows[n_kept], values[n_kept]) = (row, value);
                n_kept += 1;
            }
        }
        pointers.push(n_kept as i64);
    }
    rows.truncate(n_kept);
    values.truncate(n_kept);
    SymmetricCsc::new_csc((n, n), pointers, rows, values)
}

impl MumpsCondensed {
    fn of_trailing(&self, all: &[f64]) -> Vec<f64> {
        self.trailing.iter().map(|&freedom| all[freedom]).collect()
    }
}

impl Condensed for MumpsCondensed {
    fn contact_stiffness(&self) -> ContactStiffness {
        self.inner.contact_stiffness()
    }

    fn choose_zone(&mut self, wanted: &[usize]) -> Result<Option<Vec<usize>>> {
        let place = |freedom: &usize| self.trailing.binary_search(freedom).ok();
        let local: Option<Vec<usize>> = wanted.iter().map(place).collect();
        let Some(local) = local else { return Ok(None) };
        let chosen = self.inner.choose_zone(&local)?;
        Ok(chosen.map(|zone| zone.into_iter().map(|t| self.trailing[t]).collect()))
    }

    /// Keeps the loads of the interior and reduces those of the trailing freedoms.
    fn reduce_load(&self, load: &[f64]) -> Result<Vec<f64>> {
        check::length("load", load.len(), self.n)?;
        let mut trailing = self.of_trailing(load);
        let mut out = load.to_vec();
        if let Some(exterior) = &self.exterior {
            let acts = exterior
                .interior
                .iter()
                .any(|&(freedom, _)| load[freedom] != 0.0);
            if acts {
                let y = exterior.solve(load, None)?;
                for &(k, t, value) in &exterior.coupling {
                    trailing[t] -= value * y[k];
                }
            }
        }
        let reduced = self.inner.reduce_load(&trailing)?;
        for (&freedom, value) in self.trailing.iter().zip(reduced) {
            out[freedom] = value;
        }
        Ok(out)
    }

    fn condense_load(&self, reduced: &[f64], zone: &mut [f64], contact: &mut [f64]) -> Result<()> {
        check::length("reduced load", reduced.len(), self.n)?;
        let trailing = self.of_trailing(reduced);
        self.inner.condense_load(&trailing, zone, contact)
    }

    fn eliminate_zone(&self, zone: &mut [f64], contact: &mut [f64]) {
        self.inner.eliminate_zone(zone, contact);
    }

    fn recover_zone(&self, zone: &mut [f64], u_contact: &[f64]) {
        self.inner.recover_zone(zone, u_contact);
    }

    fn part_of_zone(&self, marked: &[bool]) -> ZonePart {
        self.inner.part_of_zone(marked)
    }

    fn recover_part(&self, part: &ZonePart, zone: &mut [f64], u_contact: &[f64]) {
        self.inner.recover_part(part, zone, u_contact);
    }

    fn changed(&self) -> Option<Box<dyn ChangedFactor>> {
        self.inner.changed()
    }

    fn recover_all(&self, reduced: &[f64], zone: &[f64], contact: &[f64]) -> Result<Vec<f64>> {
        check::length("reduced load", reduced.len(), self.n)?;
        let trailing = self.of_trailing(reduced);
        let u = self.inner.recover_all(&trailing, zone, contact)?;
        let mut out = vec![0.0; self.n];
        if let Some(exterior) = &self.exterior {
            let interior = exterior.solve(reduced, Some(&u))?;
            for &(freedom, k) in &exterior.interior {
                out[freedom] = interior[k];
            }
        }
        for (&freedom, value) in self.trailing.iter().zip(u) {
            out[freedom] = value;
        }
        Ok(out)
    }

    fn cost(&self) -> Prediction {
        self.cost.clone()
    }

    /// Weakest pivot of the trailing freedoms, since MUMPS does not report its pivots.
    fn weakest_pivot(&self) -> Pivot {
        self.weakest
    }
}
