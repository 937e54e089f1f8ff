//! MUMPS backend: what lies outside the zone is factored on many machines, all else stays as it is.
//!
//! With the freedoms in the order `[ interior | trailing ]`, trailing being zone and contact, and
//! `G` the trailing freedoms that the interior touches,
//!
//! ```text
//!     S_G = - K_GI K_II^-1 K_IG      by MUMPS on all ranks, dense
//!     S   = K_tt + S_G               condensed by another backend on the first rank
//! ```
//!
//! The interior is touched once for each load vector and once for each state that is written; zone,
//! contact and events need the first rank alone.
//!
//! The first rank is the program; the others do what MUMPS needs of them ([`World::serve`]).
//! Results agree with those of the other backends to round-off, not to the bit, and so do those of
//! different numbers of ranks.
//!
//! # Source
//! P. R. Amestoy, I. S. Duff, J. Koster, J.-Y. L'Excellent, *A fully asynchronous multifrontal
//! solver using distributed dynamic scheduling*, SIAM J. Matrix Anal. Appl. 23 (2001) 15,
//! doi:10.1137/S0895479899358194; the users' guide of MUMPS 5.5, sections 3.18 (Schur complement).

mod meaning;
#[cfg(test)]
pub(in crate::linalg) mod tests;
mod world;

pub use world::World;

use super::{
    Backend, Condensed, ContactStiffness, NotDefinite, Partition, Pivot, Prediction, SymmetricCsc,
    ZonePart, check, cholmod, condense as condense_by, smallest_pivot_ratio,
};
use crate::error::{Error, Result};
use std::ffi::c_int;
use world::{Factor, Triplets};

/// Who condenses the trailing freedoms on the first rank.
const INNER: Backend = Backend::Cholmod;

/// How far a solution of size 1 may be off. Its error is about the condition times the unit
/// round-off: a matrix of which no digit comes back is singular.
const LOST: f64 = 0.1;

/// Row, column and value.
type Entry = (usize, usize, f64);

/// A matrix whose interior MUMPS has factored.
struct MumpsCondensed {
    n: usize,
    /// Zone and contact freedoms, ascending: the numbers of `inner`.
    trailing: Vec<usize>,
    exterior: Option<Exterior>,
    inner: Box<dyn Condensed>,
    cost: Prediction,
    weakest: Pivot,
}

/// The interior and what it touches.
struct Exterior {
    factor: Factor,
    /// Interior freedoms, with their numbers among the variables of the factor.
    interior: Vec<(usize, usize)>,
    n_variables: usize,
    /// Entries between interior and trailing freedoms: variable, trailing freedom, value.
    coupling: Vec<Entry>,
}

/// Factors and condenses `matrix + diag(shift)`.
///
/// # Errors
/// As [`super::condense`].
pub fn condense(
    matrix: &SymmetricCsc,
    partition: &Partition,
    shift: &[f64],
) -> Result<Box<dyn Condensed>> {
    check::arguments(matrix, partition, shift)?;
    let cost = predict(matrix, partition)?;
    let n = partition.n;
    let mut trailing: Vec<usize> = (partition.zone.iter())
        .chain(&partition.contact)
        .copied()
        .collect();
    trailing.sort_unstable();
    let mut place = vec![None; n];
    for (t, &freedom) in trailing.iter().enumerate() {
        place[freedom] = Some(t);
    }
    let mut of_trailing: Vec<Entry> = Vec::new();
    for (column, entries) in matrix.outer_iterator().enumerate() {
        for (row, &value) in entries.iter() {
            if let (Some(i), Some(j)) = (place[row], place[column]) {
                of_trailing.push((i, j, value));
            }
        }
    }
    if trailing.is_empty() {
        // Nothing to condense onto.
        return condense_by(INNER, matrix, partition, shift);
    }
    let exterior = match trailing.len() == n {
        true => None,
        false => {
            let (exterior, schur) = Exterior::new(matrix, &place)?;
            of_trailing.extend(schur);
            Some(exterior)
        }
    };
    let local = |freedoms: &[usize]| -> Vec<usize> {
        freedoms
            .iter()
            .filter_map(|&freedom| place[freedom])
            .collect()
    };
    let inner_partition = Partition {
        n: trailing.len(),
        zone: local(&partition.zone),
        contact: local(&partition.contact),
    };
    let condensed = upper_triangle(trailing.len(), of_trailing);
    let inner = condense_by(INNER, &condensed, &inner_partition, shift);
    let inner = inner.map_err(|error| of_freedom(error, &trailing))?;
    // What was lost on the way from K to S counts too.
    let pivot = inner.weakest_pivot();
    let freedom = trailing[pivot.freedom];
    let contacts = partition.contact.iter().zip(shift);
    let shifted = contacts.filter(|(contact, _)| **contact == freedom);
    let shift: f64 = shifted.map(|(_, shift)| shift).sum();
    let at = |matrix: &SymmetricCsc, j: usize| matrix.get(j, j).copied().unwrap_or(0.0) + shift;
    let left = at(&condensed, pivot.freedom) / at(matrix, freedom);
    let weakest = Pivot {
        freedom,
        ratio: pivot.ratio * left.min(1.0),
    };
    if weakest.ratio <= smallest_pivot_ratio(n) || weakest.ratio.is_nan() {
        return Err(NotDefinite { freedom }.into());
    }
    Ok(Box::new(MumpsCondensed {
        n,
        trailing,
        exterior,
        inner,
        cost,
        weakest,
    }))
}

/// Predicts the cost of [`condense`], which is that of one factor of all on one rank.
///
/// # Errors
/// As [`super::predict`].
pub fn predict(matrix: &SymmetricCsc, partition: &Partition) -> Result<Prediction> {
    cholmod::predict(matrix, partition)
}

/// The freedom that is not held, as the whole matrix numbers it.
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

/// A matrix from entries of its upper triangle, those at the same place added up.
fn upper_triangle(n: usize, mut entries: Vec<Entry>) -> SymmetricCsc {
    entries.sort_unstable_by_key(|&(row, column, _)| (column, row));
    let mut starts = vec![0i64; n + 1];
    let mut rows: Vec<i64> = Vec::with_capacity(entries.len());
    let mut values: Vec<f64> = Vec::with_capacity(entries.len());
    let mut last = None;
    for (row, column, value) in entries {
        if last == Some((row, column)) {
            if let Some(sum) = values.last_mut() {
                *sum += value;
            }
            continue;
        }
        last = Some((row, column));
        rows.push(row as i64);
        values.push(value);
        starts[column + 1] = rows.len() as i64;
    }
    for j in 0..n {
        starts[j + 1] = starts[j + 1].max(starts[j]);
    }
    SymmetricCsc::new_csc((n, n), starts, rows, values)
}

impl Exterior {
    /// Factors the interior: freedoms without a place among the trailing ones. With it the entries
    /// of `S_G` in the upper triangle of the trailing freedoms.
    fn new(matrix: &SymmetricCsc, place: &[Option<usize>]) -> Result<(Self, Vec<Entry>)> {
        let n = place.len();
        let touches = |row: usize, column: usize| place[row].is_none() || place[column].is_none();
        let mut is_variable: Vec<bool> = place.iter().map(Option::is_none).collect();
        let mut n_entries = 0;
        for (column, entries) in matrix.outer_iterator().enumerate() {
            for (row, _) in entries.iter().filter(|(row, _)| touches(*row, column)) {
                is_variable[row] = true;
                is_variable[column] = true;
                n_entries += 1;
            }
        }
        let freedoms: Vec<usize> = (0..n).filter(|&freedom| is_variable[freedom]).collect();
        let n_variables = freedoms.len();
        if n_variables > c_int::MAX as usize {
            return Err(Error::input("more freedoms than MUMPS can number"));
        }
        let mut variable = vec![usize::MAX; n];
        for (k, &freedom) in freedoms.iter().enumerate() {
            variable[freedom] = k;
        }
        let mut coupling = Vec::new();
        let mut triplets = Triplets {
            n: n_variables,
            rows: Vec::with_capacity(n_entries),
            columns: Vec::with_capacity(n_entries),
            values: Vec::with_capacity(n_entries),
            place: Vec::new(),
        };
        let mut pattern = Vec::with_capacity(n_entries);
        for (column, entries) in matrix.outer_iterator().enumerate() {
            for (row, &value) in entries.iter().filter(|(row, _)| touches(*row, column)) {
                let (i, j) = (variable[row], variable[column]);
                // The lower triangle.
                triplets.rows.push(j as c_int + 1);
                triplets.columns.push(i as c_int + 1);
                triplets.values.push(value);
                pattern.push((i, j, value));
                match (place[row], place[column]) {
                    (None, Some(t)) => coupling.push((i, t, value)),
                    (Some(t), None) => coupling.push((j, t, value)),
                    _ => {}
                }
            }
        }
        let mut kept: Vec<usize> = (0..n_variables)
            .filter(|&k| place[freedoms[k]].is_some())
            .collect();
        triplets.place = order(n_variables, pattern, &kept)?;
        // MUMPS wants them listed as they come in the order.
        kept.sort_by_key(|&k| triplets.place[k]);
        let mut numbers: Vec<c_int> = kept.iter().map(|&k| k as c_int + 1).collect();
        let (factor, schur) = Factor::new(&mut triplets, &mut numbers)?;
        let m = kept.len();
        let mut of_trailing = Vec::with_capacity(m * (m + 1) / 2);
        for a in 0..m {
            for b in 0..=a {
                let ends = [a, b].map(|k| place[freedoms[kept[k]]].unwrap_or(0));
                let (row, column) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
                // Bodies that have nothing to do with each other stay apart.
                let value = schur[a * m + b];
                if value != 0.0 {
                    of_trailing.push((row, column, value));
                }
            }
        }
        let interior = freedoms.iter().enumerate();
        let interior = interior
            .filter(|(_, freedom)| place[**freedom].is_none())
            .map(|(k, &freedom)| (freedom, k));
        let exterior = Exterior {
            factor,
            interior: interior.collect(),
            n_variables,
            coupling,
        };
        exterior.require_held(matrix, place)?;
        Ok((exterior, of_trailing))
    }

    /// MUMPS says nothing of a matrix that is singular to round-off: a known solution is asked for.
    ///
    /// # Errors
    /// [`NotDefinite`] where it does not come back, by the freedom that is farthest off.
    fn require_held(&self, matrix: &SymmetricCsc, place: &[Option<usize>]) -> Result<()> {
        let known = |freedom: usize| 1.0 + (freedom % 7) as f64 / 8.0;
        let mut load = vec![0.0; place.len()];
        for (column, entries) in matrix.outer_iterator().enumerate() {
            let inside = entries.iter().filter(|(row, _)| place[*row].is_none());
            for (row, &value) in inside.filter(|_| place[column].is_none()) {
                load[row] += value * known(column);
                if row != column {
                    load[column] += value * known(row);
                }
            }
        }
        let found = self.solve(&load, None)?;
        let off = |&(freedom, k): &(usize, usize)| (found[k] - known(freedom)).abs();
        let worst = (self.interior.iter()).max_by(|a, b| off(a).total_cmp(&off(b)));
        match worst {
            Some(worst) if off(worst).is_nan() || off(worst) > LOST => {
                Err(NotDefinite { freedom: worst.0 }.into())
            }
            _ => Ok(()),
        }
    }

    /// `K_II^-1` times what stands at the interior freedoms of `load`, less coupled displacements
    /// where there are some; by variable.
    fn solve(&self, load: &[f64], u_trailing: Option<&[f64]>) -> Result<Vec<f64>> {
        let mut out = vec![0.0; self.n_variables];
        for &(freedom, k) in &self.interior {
            out[k] = load[freedom];
        }
        if let Some(u) = u_trailing {
            for &(k, t, value) in &self.coupling {
                out[k] -= value * u[t];
            }
        }
        self.factor.solve(&mut out)?;
        Ok(out)
    }
}

/// The place of each variable, from 1, in an order that ends with those that are kept.
fn order(n: usize, entries: Vec<Entry>, kept: &[usize]) -> Result<Vec<c_int>> {
    // A diagonal entry for each: an order needs no values.
    let diagonal = (0..n).map(|k| (k, k, 0.0));
    let matrix = upper_triangle(n, entries.into_iter().chain(diagonal).collect());
    let partition = Partition {
        n,
        zone: Vec::new(),
        contact: kept.to_vec(),
    };
    let mut place = vec![0; n];
    for (k, &variable) in cholmod::order(&matrix, &partition)?.iter().enumerate() {
        place[variable as usize] = k as c_int + 1;
    }
    Ok(place)
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

    /// The loads of the interior as they are, those of the trailing freedoms reduced.
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

    /// Of the trailing freedoms: MUMPS does not tell its pivots.
    fn weakest_pivot(&self) -> Pivot {
        self.weakest
    }
}
