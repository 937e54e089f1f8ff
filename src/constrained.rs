//! A stiffness matrix with contact rows, for programs that have their own elements: condense it,
//! solve contact, follow the load from event to event.
//!
//! Given the symmetric positive (semi)definite stiffness `K`, rows `B` and gaps `delta`,
//!
//! ```text
//!     K u = f - B' r,     g = delta - B u >= 0,     r >= 0,     g . r = 0
//! ```
//!
//! A row is any linear combination of freedoms: the relative normal displacement of two nodes, or
//! of a node and a point between others. The freedoms that occur in rows are the contact freedoms
//! `c`; `K` is condensed on them to `C`. The row displacements `s = B u_c` replace one freedom of
//! each row, its follower; the other contact freedoms are the leaders `v`. Eliminating `v`, as is
//! done for scenes, gives
//!
//! ```text
//!     r = t - T s = q + T g,    q = t - T delta
//! ```
//!
//! which is the problem of [`crate::contact`]. Plastic strains are loads like any others:
//! `f + sum of B_e' D eps_p` over the elements, with the strain-displacement matrix `B_e` of each
//! element.

mod arrays;
mod displacements;
mod held;
mod loaded_state;
mod path;

pub use arrays::{Triangle, rows_from_csr, stiffness_from_csc};
pub use path::Event;

use crate::contact::{self, Tableau};
use crate::error::{Error, Result};
use crate::linalg::{self, Backend, Condensed, Partition, SymmetricCsc};
use crate::substructure::{RowEntries, Rows, Tied};
use held::{condense, pushed_away};
use loaded_state::{LoadedState, Way};
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Fraction of the stiffness of a row's own freedoms below which a diagonal entry of `T` counts as
/// round-off.
const CANCELLED: f64 = 1e-12;

/// A sparse stiffness with contact rows, factored and condensed once.
///
/// Three springs of stiffness 1 in a row, the first to ground; the last node meets a wall at
/// distance 1:
///
/// ```
/// use brinell::constrained::ConstrainedStructure;
/// use brinell::contact::Change;
/// use brinell::linalg::{Backend, SymmetricCsc};
///
/// # fn main() -> brinell::Result<()> {
/// // Upper triangle by columns: column pointers, rows, values.
/// let stiffness = SymmetricCsc::new_csc(
///     (3, 3),
///     vec![0, 1, 3, 5],
///     vec![0, 0, 1, 1, 2],
///     vec![2.0, -1.0, 2.0, -1.0, 1.0],
/// );
/// let rows = [vec![(2, 1.0)]];
/// let mut structure = ConstrainedStructure::new(Backend::default(), &stiffness, &rows, &[1.0])?;
///
/// // A force that grows to 2 pulls the last node. The node meets the wall at a force of 1/3; the
/// // wall carries the rest.
/// structure.start(&[0.0, 0.0, 1.0])?;
/// let event = structure.step(2.0)?;
/// assert_eq!(event.changes, [Change::Closes(0)]);
/// assert!((event.t - 1.0 / 3.0).abs() < 1e-12);
/// structure.step(2.0)?;
/// assert!((structure.forces()[0] - 5.0 / 3.0).abs() < 1e-12);
///
/// // Contact can also be solved at once, under any load, such as the initial loads of plastic
/// // strains.
/// structure.solve(&[0.0, 3.0, 0.0])?;
/// let mut u = [0.0; 3];
/// structure.displacements(&mut u)?;
/// assert!((u[2] - 1.0).abs() < 1e-12 && structure.gaps()[0] == 0.0);
/// # Ok(())
/// # }
/// ```
pub struct ConstrainedStructure {
    condensed: Box<dyn Condensed>,
    /// Stiffness condensed on the contact freedoms, `C`.
    condensed_stiffness: Arc<DMatrix<f64>>,
    stiffness: Arc<SymmetricCsc>,
    /// Infinity norm of the stiffness.
    norm: f64,
    /// Partition without a zone; contact freedoms ascending.
    partition: Partition,
    /// Contact rows `B` on the contact freedoms, `n_rows x n_contact`.
    rows: DMatrix<f64>,
    gaps: DVector<f64>,
    /// The structure with all rows closed.
    tied: Tied,
    /// The matrix `T` of the contact problem.
    contact_matrix: Arc<DMatrix<f64>>,
    tableau: Tableau,
    state: LoadedState,
    way: Option<Way>,
}

impl ConstrainedStructure {
    /// Factors `stiffness` (upper triangle) and condenses it on the freedoms of `rows`. Each row
    /// lists (freedom, coefficient) of `B`; `gaps` holds `delta`, one value for each row. The
    /// initial state is the one without load.
    ///
    /// # Errors
    /// [`crate::ErrorKind::Input`] if sizes, freedoms or values do not fit, or if the rows are
    /// linearly dependent; [`crate::ErrorKind::Unheld`], naming the freedom, if the structure is
    /// not held even with all rows closed; an error of the backend if the structure exceeds one of
    /// its limits.
    pub fn new(
        backend: Backend,
        stiffness: &SymmetricCsc,
        rows: &[Vec<(usize, f64)>],
        gaps: &[f64],
    ) -> Result<Self> {
        Self::with_owned(backend, stiffness.clone(), rows, gaps)
    }

    /// Factors and condenses like [`ConstrainedStructure::new`], but takes ownership of the
    /// stiffness instead of copying it (the structure keeps it to refine displacements).
    ///
    /// # Errors
    /// Errors of [`ConstrainedStructure::new`].
    pub fn with_owned(
        backend: Backend,
        stiffness: SymmetricCsc,
        rows: &[Vec<(usize, f64)>],
        gaps: &[f64],
    ) -> Result<Self> {
        let n = stiffness.cols();
        arrays::check(n, rows, gaps)?;
        let mut place: BTreeMap<usize, usize> =
            rows.iter().flatten().map(|&(f, _)| (f, 0)).collect();
        for (i, at) in place.values_mut().enumerate() {
            *at = i;
        }
        let partition = Partition {
            n,
            zone: Vec::new(),
            contact: place.keys().copied().collect(),
        };
        let condensed = condense(backend, &stiffness, &partition)?;
        let mut b = DMatrix::zeros(rows.len(), partition.contact.len());
        for (i, row) in rows.iter().enumerate() {
            for (freedom, coefficient) in row {
                b[(i, place[freedom])] += coefficient;
            }
        }
        let stiffness_of_contact = condensed.contact_stiffness();
        let c = stiffness_of_contact.dense();
        let entries = |row: &Vec<(usize, f64)>| -> RowEntries {
            row.iter()
                .map(|&(freedom, b)| (place[&freedom], b))
                .collect()
        };
        let coordinates = Rows::any(
            rows.iter().map(entries).collect(),
            partition.contact.len(),
            |i| c[(i, i)],
        )?;
        let (tied, mut matrix) = Tied::new(&stiffness_of_contact, coordinates, &[], &[])?;
        drop_round_off(&mut matrix, &sizes(&c, &b));
        let contact_matrix = Arc::new(matrix);
        let mut structure = ConstrainedStructure {
            norm: linalg::norm(&stiffness),
            stiffness: Arc::new(stiffness),
            state: LoadedState {
                load: vec![0.0; n],
                condensed: DVector::zeros(partition.contact.len()),
                gap: Arc::new(gaps.to_vec()),
                force: Arc::new(vec![0.0; rows.len()]),
            },
            partition,
            condensed,
            condensed_stiffness: Arc::new(c),
            rows: b,
            gaps: DVector::from_column_slice(gaps),
            tableau: Tableau::new(contact_matrix.clone()),
            contact_matrix,
            tied,
            way: None,
        };
        structure.solve(&vec![0.0; n])?;
        Ok(structure)
    }

    /// Number of freedoms.
    pub fn n_freedoms(&self) -> usize {
        self.partition.n
    }

    /// Number of contact rows.
    pub fn n_rows(&self) -> usize {
        self.gaps.len()
    }

    /// Contact freedoms, in ascending order. The rows and columns of
    /// [`ConstrainedStructure::condensed_stiffness`] belong to them in this order.
    pub fn contact_freedoms(&self) -> &[usize] {
        &self.partition.contact
    }

    /// Condensed stiffness `C = K_cc - K_ci K_ii^-1 K_ic`, `n_contact x n_contact`, symmetric,
    /// column-major.
    pub fn condensed_stiffness(&self) -> &DMatrix<f64> {
        &self.condensed_stiffness
    }

    /// Solves contact under the load `f` (all freedoms), starting from the current statuses.
    ///
    /// # Errors
    /// [`crate::ErrorKind::Input`] if the load has the wrong length or holds a number that is not
    /// finite; [`crate::ErrorKind::Unheld`], naming the row, if the load pushes a body away from
    /// every contact.
    pub fn solve(&mut self, load: &[f64]) -> Result<()> {
        self.check_load(load)?;
        let condensed = self.condense(load)?;
        let q = self.forces_if_tied(&condensed, 1.0);
        let (mut gap, mut force) = (vec![0.0; q.len()], vec![0.0; q.len()]);
        contact::solve(&mut self.tableau, q.as_slice(), &mut gap, &mut force)
            .map_err(pushed_away)?;
        self.state = LoadedState {
            load: load.to_vec(),
            condensed,
            gap: Arc::new(gap),
            force: Arc::new(force),
        };
        self.way = None;
        Ok(())
    }

    /// Gaps of the rows in the current state, >= 0.
    pub fn gaps(&self) -> &[f64] {
        &self.state.gap
    }

    /// Forces of the rows in the current state, >= 0, compressive.
    pub fn forces(&self) -> &[f64] {
        &self.state.force
    }

    /// Shares [`ConstrainedStructure::gaps`] without a copy. The shared values do not change when
    /// the structure moves on to another state.
    pub fn shared_gaps(&self) -> Arc<Vec<f64>> {
        Arc::clone(&self.state.gap)
    }

    /// Shares [`ConstrainedStructure::forces`] without a copy. The shared values do not change when
    /// the structure moves on to another state.
    pub fn shared_forces(&self) -> Arc<Vec<f64>> {
        Arc::clone(&self.state.force)
    }

    /// Shares [`ConstrainedStructure::condensed_stiffness`] without a copy.
    pub fn shared_condensed_stiffness(&self) -> Arc<DMatrix<f64>> {
        Arc::clone(&self.condensed_stiffness)
    }

    /// For each row, whether it is open.
    pub fn open(&self) -> &[bool] {
        self.tableau.open()
    }

    fn condense(&self, load: &[f64]) -> Result<DVector<f64>> {
        let mut out = DVector::zeros(self.partition.contact.len());
        let reduced = self.condensed.reduce_load(load)?;
        self.condensed
            .condense_load(&reduced, &mut [], out.as_mut_slice())?;
        Ok(out)
    }

    /// Forces `q` of the tied rows for a condensed load and `share` of the gaps.
    fn forces_if_tied(&self, condensed: &DVector<f64>, share: f64) -> DVector<f64> {
        let mut load = condensed.clone_owned();
        let mut forces = DVector::zeros(self.n_rows());
        self.tied
            .eliminate(load.as_mut_slice(), forces.as_mut_slice());
        forces - &*self.contact_matrix * &self.gaps * share
    }

    fn check_load(&self, load: &[f64]) -> Result<()> {
        if load.len() != self.partition.n {
            return Err(Error::input(format!(
                "a load of {} values was given for {} freedoms",
                load.len(),
                self.partition.n
            )));
        }
        match load.iter().position(|v| !v.is_finite()) {
            Some(at) => Err(Error::input(format!(
                "the load on freedom {at} is {}",
                load[at]
            ))),
            None => Ok(()),
        }
    }
}

/// Stiffness of each row's own freedoms in the condensed stiffness `c`, per displacement of the
/// row; the stiffness of the stiffest freedom if the row's own have none.
fn sizes(c: &DMatrix<f64>, rows: &DMatrix<f64>) -> DVector<f64> {
    let size = c.diagonal().amax();
    DVector::from_fn(rows.nrows(), |i, _| {
        let b = rows.row(i);
        let own: f64 = b.iter().enumerate().map(|(k, v)| v * v * c[(k, k)]).sum();
        let norm = b.norm_squared();
        if own > 1e-9 * size * norm {
            own / (norm * norm)
        } else {
            size / norm
        }
    })
}

/// Sets round-off in `T` to zero. If nothing but a row holds a body, the row's part of `T` is zero
/// in theory, but the difference of equal numbers leaves round-off.
fn drop_round_off(matrix: &mut DMatrix<f64>, sizes: &DVector<f64>) {
    for i in 0..sizes.len() {
        if matrix[(i, i)] <= CANCELLED * sizes[i] {
            matrix.row_mut(i).fill(0.0);
            matrix.column_mut(i).fill(0.0);
        }
    }
}

#[cfg(test)]
mod tests;
