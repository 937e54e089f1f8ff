//! The structure with all contact rows closed, and the contact matrix without cancellation.
//!
//! The stiffer freedoms of a row lead and the softest follows ([`Rows`]): `v` are the displacements
//! of the leaders, `s` those of the rows, and the leaders are eliminated. If the softest freedom
//! led instead, the contact matrix, which is no stiffer than the softer body, would be the
//! difference of two matrices as large as the stiffer body's. With `P = [1; G]` (leaders,
//! followers)
//!
//! ```text
//!     [ P'S P   P'S H  ] [ v ]   [ P' f         ]
//!     [ H'S P   H'S H  ] [ s ] = [ H' f - r     ]       r = t - T s
//! ```
//!
//! A floating body that is stiff compared with its supports hardly deforms. Only the soft stiffness
//! of the supports resists its rigid motions, and this is lost in the round-off of the body's own
//! stiffness. The rigid motions are known exactly (`R`, from the geometry), so they are unknowns in
//! their own right:
//!
//! ```text
//!     v = R a + Z w      Z: unit vectors of all leaders but as many as there are motions
//!
//!     [ Z'S Z  Z'S R ] [ w ]   [ Z' f ]
//!     [ R'S Z  R'S R ] [ a ] = [ R' f ]      S_body r = 0 is put in
//!                                             exactly where r is a rigid motion of that body
//! ```
//!
//! Cholesky's method is insensitive to the scaling of rows: its error in each entry is a fraction
//! of the geometric mean of the two diagonal entries.
//!
//! # Source
//! C. Farhat, F.-X. Roux (1991), doi:10.1002/nme.1620320604 (floating subdomains and their rigid
//! motions); A. van der Sluis (1969), doi:10.1007/BF02165096, and N. J. Higham, *Accuracy and
//! Stability of Numerical Algorithms*, 2nd ed., theorem 10.5 (scaling).

use super::rigid_slips::{RigidSlip, rigid_slips, take_rigid_slips};
use super::rows::Rows;
use super::tied_stiffness::TiedStiffness;
use super::trace::Trace;
use crate::error::{Error, ErrorKind, Result};
use crate::linalg::{ContactStiffness, blocked};
use crate::model::Work;
use nalgebra::{Cholesky, DMatrix, DVector, DVectorView, Dyn};
use rayon::prelude::*;

/// Displacements of the contact freedoms with the rigid motions of floating bodies split off.
pub(super) struct Split {
    /// Displacements of the contact freedoms without the rigid motions.
    pub contact: Vec<f64>,
    /// Amplitude of each rigid motion of the model.
    pub motions: DVector<f64>,
}

/// A displacement of the rows with the rigid motions of floating bodies split off, as these take no
/// force.
pub(super) struct SplitSlip {
    /// Part of the displacement that deforms the bodies.
    pub rest: DVector<f64>,
    /// Amplitude of each rigid motion of the model, which together give the part split off.
    pub motions: DVector<f64>,
}

/// Fraction of a motion below which the remainder after orthogonalisation counts as round-off.
const ROUND_OFF: f64 = 1e-11;

/// The tied structure, factored: all contact rows closed.
pub(crate) struct Tied {
    rows: Rows,
    /// Leaders that have an entry in `w`: all but as many as there are rigid motions.
    kept: Vec<usize>,
    /// Rigid motions of the leaders, `leaders x motions`.
    motions: DMatrix<f64>,
    /// Rigid motions of the leaders spread to all contact freedoms, without the rigid motion of
    /// each part (`n_contact x motions`).
    lifted: DMatrix<f64>,
    /// Rigid motion of each part that `lifted` leaves out: amplitudes, `traces x motions`.
    rigid_share: DMatrix<f64>,
    /// Traces of the rigid motions, orthonormal within each part.
    rigid: Vec<Trace>,
    /// Orthonormal displacements of the rows in rigid motions.
    rigid_slips: Vec<RigidSlip>,
    /// Number of the part to which each contact freedom belongs.
    part: Vec<usize>,
    /// Cholesky factor `L` of the tied stiffness, `L L' = [Z R]' P'S P [Z R]`.
    factor: Cholesky<f64, Dyn>,
    /// Coupling `L^-1 [Z R]' P'S` of unknowns (rows) with followers (columns).
    coupling: DMatrix<f64>,
    /// Number of multiplications that combining leaders and followers took.
    pub(super) multiplications: usize,
}

impl Tied {
    /// Builds the tied structure and the contact matrix `T` (force of each row over displacement of
    /// each row, as in `r = t - T s`) from the condensed stiffness, the rigid motions of floating
    /// parts and the part of each contact freedom.
    ///
    /// # Errors
    /// `Unheld`, if the tied structure is not held.
    pub(crate) fn new(
        stiffness: &ContactStiffness,
        rows: Rows,
        traces: &[Trace],
        part: &[usize],
    ) -> Result<(Self, DMatrix<f64>)> {
        let rigid = orthonormal(traces);
        let (motions, kept) = basis(&rigid, &rows, part);
        // Rigid motions on all contact freedoms, and the forces that they take.
        let (lifted, rigid_share) = lift(&motions, &rows, &rigid, (part, stiffness.n_contact()));
        let forces = stiffness.times(&lifted);

        let (n_w, n_a) = (kept.len(), motions.ncols());
        let leaders = TiedStiffness::new(stiffness, &rows, &kept);
        let mut tied = leaders.matrix.resize(n_w + n_a, n_w + n_a, 0.0);
        for (k, &leader) in kept.iter().enumerate() {
            for &(freedom, weight) in &rows.moved[leader] {
                for a in 0..n_a {
                    tied[(n_w + a, k)] += weight * forces[(freedom, a)];
                }
            }
        }
        let mut coupling = leaders.coupling.resize_vertically(n_w + n_a, 0.0);
        let of_motions = forces.select_rows(&rows.follow).transpose();
        coupling.rows_mut(n_w, n_a).copy_from(&of_motions);
        // All products at once are one matrix product, which has a fast kernel.
        let energy = lifted.transpose() * &forces;
        tied.view_mut((n_w, n_w), (n_a, n_a)).copy_from(&energy);
        let factor = blocked::cholesky(tied).ok_or_else(|| {
            Error::new(
                ErrorKind::Unheld,
                "the structure is not held even with all contact rows closed: its condensed \
                 stiffness is not positive definite",
            )
        })?;
        blocked::solve_lower(&factor, &mut coupling);
        let factor = Cholesky::pack_dirty(factor);
        let mut matrix = contact_matrix(stiffness, &rows, &coupling);
        let rigid_slips = rigid_slips(&rigid, &rows);
        take_rigid_slips(&mut matrix, &rigid_slips);
        let tied = Tied {
            kept,
            motions,
            lifted,
            rigid_share,
            rigid_slips,
            rigid,
            part: part.to_vec(),
            factor,
            coupling,
            multiplications: leaders.multiplications,
            rows,
        };
        Ok((tied, matrix))
    }

    /// Displacements of the rows in rigid motions (`rows x motions`, orthonormal); `None` without
    /// any.
    pub(super) fn rigid_slips(&self) -> Option<DMatrix<f64>> {
        let columns: Vec<_> = self.rigid_slips.iter().map(|s| s.values.clone()).collect();
        (!columns.is_empty()).then(|| DMatrix::from_columns(&columns))
    }

    /// Corrects the forces on the rows, numbered by `pairs`, so that their work on each rigid
    /// motion of the group is the known `work`. Elimination leaves an error of the order of its
    /// round-off times the condition, which would set a body in motion.
    pub(super) fn balance(
        &self,
        pairs: &[usize],
        forces: &mut [f64],
        work: impl Fn(usize) -> Work,
    ) {
        for rigid in &self.rigid_slips {
            let shares = rigid.of_motion.iter().enumerate();
            let known = Work::combined(shares.map(|(motion, share)| (*share, work(motion)))).done();
            let slips = || pairs.iter().zip(rigid.values.iter());
            let left = known - slips().map(|(&k, slip)| slip * forces[k]).sum::<f64>();
            for (&k, slip) in slips() {
                forces[k] += left * slip;
            }
        }
    }

    /// Number of values that the dense matrices hold.
    pub(crate) fn n_entries(&self) -> usize {
        self.factor.l_dirty().len()
            + self.coupling.len()
            + self.motions.len()
            + self.lifted.len()
            + self.rigid_share.len()
    }

    /// Eliminates the tied structure. On entry `contact` holds forces on the contact freedoms. On
    /// return its first places hold the unknowns of the tied structure under these forces, and
    /// `forces` holds the force that each row then carries.
    pub(crate) fn eliminate(&self, contact: &mut [f64], forces: &mut [f64]) {
        let total = self.rows.on_leaders(contact);
        let n_w = self.kept.len();
        let mut unknowns = DVector::zeros(n_w + self.motions.ncols());
        for (y, &leader) in unknowns.iter_mut().zip(&self.kept) {
            *y = total[leader];
        }
        for (a, motion) in self.motions.column_iter().enumerate() {
            unknowns[n_w + a] = motion.dot(&total);
        }
        let factor = self.factor.l_dirty();
        factor.solve_lower_triangular_unchecked_mut(&mut unknowns);
        let follow = &self.rows.follow;
        let carried = |j: usize| contact[follow[j]] - self.coupling.column(j).dot(&unknowns);
        self.rows.forces(carried, forces);
        factor.tr_solve_lower_triangular_unchecked_mut(&mut unknowns);
        contact.fill(0.0);
        contact[..unknowns.len()].copy_from_slice(unknowns.as_slice());
    }

    /// Recovers displacements from displacements of the rows and from what [`Tied::eliminate`] left
    /// in `contact`.
    pub(crate) fn recover(&self, contact: &mut [f64], slip: &[f64]) {
        let apart = self.rows.apart(slip);
        let v = self.spread(&self.unknowns(contact, &apart));
        self.rows.spread(&v, &apart, contact);
    }

    /// Splits the rigid motions of floating bodies off a displacement of the rows. Rigid motions
    /// take no force: forces and strains follow from the rest alone, and so do not drown in the
    /// round-off of a gap that is large compared with the deformation. A rest that is only
    /// round-off is set to zero, so that a body which an interference lifts off another feels no
    /// force, rather than a force of random sign.
    pub(super) fn split_slip(&self, slip: &[f64]) -> SplitSlip {
        let mut rest = DVector::from_column_slice(slip);
        let n_motions = self.rigid.first().map_or(0, |t| t.of_motion.len());
        let mut motions = DVector::zeros(n_motions);
        let whole = rest.norm();
        for _ in 0..2 {
            for rigid in &self.rigid_slips {
                let along = rigid.values.dot(&rest);
                rest.axpy(-along, &rigid.values, 1.0);
                motions.axpy(along, &rigid.of_motion, 1.0);
            }
        }
        // Each subtraction leaves a rounding error of its operands.
        let round_off = 4.0 * (self.rigid_slips.len() + 1) as f64 * f64::EPSILON * whole;
        if rest.norm() <= round_off {
            rest.fill(0.0);
        }
        SplitSlip { rest, motions }
    }

    /// Recovers displacements as [`Tied::recover`] does, with rigid motions split off: the
    /// deformation of a stiff body keeps its digits even if the motion is larger by orders of
    /// magnitude.
    pub(super) fn split(&self, contact: &[f64], slip: &[f64]) -> Split {
        let apart = self.rows.apart(slip);
        let unknowns = self.unknowns(contact, &apart);
        let amplitudes = unknowns.rows(self.kept.len(), self.motions.ncols());
        let mut out = &self.lifted * amplitudes;
        let mut share = &self.rigid_share * amplitudes;
        for (&leader, w) in self.kept.iter().zip(unknowns.iter()) {
            for &(freedom, weight) in &self.rows.moved[leader] {
                out[freedom] += weight * w;
            }
        }
        for (&freedom, apart) in self.rows.follow.iter().zip(apart.iter()) {
            out[freedom] += apart;
        }
        take_rigid(
            out.as_mut_slice(),
            share.as_mut_slice(),
            &self.rigid,
            &self.part,
        );
        let n_motions = self.rigid.first().map_or(0, |t| t.of_motion.len());
        let mut motions = DVector::zeros(n_motions);
        for (trace, amplitude) in self.rigid.iter().zip(share.iter()) {
            motions.axpy(*amplitude, &trace.of_motion, 1.0);
        }
        Split {
            contact: out.as_slice().to_vec(),
            motions,
        }
    }

    /// Unknowns `[w a]` for what [`Tied::eliminate`] left and the followers' relative
    /// displacements.
    fn unknowns(&self, contact: &[f64], apart: &DVector<f64>) -> DVector<f64> {
        let mut change = DVector::zeros(self.coupling.nrows());
        for (j, &way) in apart.iter().enumerate().filter(|(_, way)| **way != 0.0) {
            change.axpy(way, &self.coupling.column(j), 1.0);
        }
        let factor = self.factor.l_dirty();
        factor.tr_solve_lower_triangular_unchecked_mut(&mut change);
        DVector::from_column_slice(&contact[..change.len()]) - change
    }

    /// Displacements of the leaders, `v = R a + Z w`.
    fn spread(&self, unknowns: &DVector<f64>) -> DVector<f64> {
        let n_w = self.kept.len();
        let mut v = &self.motions * unknowns.rows(n_w, self.motions.ncols());
        for (&k, w) in self.kept.iter().zip(unknowns.iter()) {
            v[k] += w;
        }
        v
    }
}

/// Spreads rigid motions of the leaders to all contact freedoms (`n_contact x motions`), and splits
/// the rigid motion of each part off (amplitudes, `traces x motions`).
fn lift(
    motions: &DMatrix<f64>,
    rows: &Rows,
    rigid: &[Trace],
    (part, n_contact): (&[usize], usize),
) -> (DMatrix<f64>, DMatrix<f64>) {
    let mut lifted = DMatrix::zeros(n_contact, motions.ncols());
    let mut rigid_share = DMatrix::zeros(rigid.len(), motions.ncols());
    let apart = DVector::zeros(rows.len());
    for (j, mut column) in lifted.column_iter_mut().enumerate() {
        let column = column.as_mut_slice();
        rows.spread(&motions.column(j).into_owned(), &apart, column);
        let mut share = rigid_share.column_mut(j);
        take_rigid(column, share.as_mut_slice(), rigid, part);
    }
    (lifted, rigid_share)
}

/// The contact matrix, from the lower triangle of `S_ff - C' C` with `C` the coupling of unknowns
/// and followers. It is symmetric to the last bit.
fn contact_matrix(
    stiffness: &ContactStiffness,
    rows: &Rows,
    coupling: &DMatrix<f64>,
) -> DMatrix<f64> {
    let n = rows.len();
    let mut row_of = vec![None; stiffness.n_contact()];
    for (j, &freedom) in rows.follow.iter().enumerate() {
        row_of[freedom] = Some(j);
    }
    let mut matrix = blocked::outer(&coupling.transpose(), |_| coupling.nrows());
    let columns = matrix.as_mut_slice().par_chunks_mut(n.max(1)).enumerate();
    let columns = columns.with_min_len(blocked::at_once(n));
    columns.for_each(|(j, column)| {
        column.iter_mut().for_each(|entry| *entry = -*entry);
        for (freedom, entry) in stiffness.column(rows.follow[j]) {
            if let Some(i) = row_of[freedom] {
                column[i] += entry;
            }
        }
    });
    matrix.fill_upper_triangle_with_lower_triangle();
    let mut matrix = rows.congruence(matrix);
    matrix.fill_upper_triangle_with_lower_triangle();
    matrix
}

/// Makes the traces of each part orthonormal; motions that leave no trace on the contact freedoms
/// are left out.
fn orthonormal(traces: &[Trace]) -> Vec<Trace> {
    let mut out: Vec<Trace> = Vec::new();
    for trace in traces {
        let size = trace.values.norm();
        let mut next = trace.clone();
        // Twice is enough: B. N. Parlett, The Symmetric Eigenvalue Problem (1980), section 6.9.
        for _ in 0..2 {
            for other in out.iter().filter(|o| o.part == trace.part) {
                let along = other.values.dot(&next.values);
                next.values.axpy(-along, &other.values, 1.0);
                next.of_motion.axpy(-along, &other.of_motion, 1.0);
            }
        }
        let left = next.values.norm();
        if left > ROUND_OFF * size {
            next.values /= left;
            next.of_motion /= left;
            out.push(next);
        }
    }
    out
}

/// Returns independent motions of the leaders (`leaders x motions`) and the leaders that remain
/// unknowns. Gaussian elimination with complete pivoting picks for each motion the leader that
/// distinguishes it best from the others.
fn basis(rigid: &[Trace], rows: &Rows, part: &[usize]) -> (DMatrix<f64>, Vec<usize>) {
    let n = rows.lead.len();
    let mut all = DMatrix::zeros(n, rigid.len());
    for (mut column, trace) in all.column_iter_mut().zip(rigid) {
        column.copy_from(&rows.motion_of_leaders(trace, part));
    }
    let mut rest = all.clone();
    let scale = all.amax();
    // Row and size of the largest entry of each column. They are kept, since a pivot changes only
    // the columns of motions of the same pairs.
    let largest = |column: DVectorView<f64>| {
        let row = if column.is_empty() { 0 } else { column.iamax() };
        (row, column.get(row).map_or(0.0, |entry| entry.abs()))
    };
    let mut tops: Vec<(usize, f64)> = rest.column_iter().map(largest).collect();
    let mut pivots: Vec<(usize, usize)> = Vec::new();
    while pivots.len() < rigid.len().min(n) {
        let mut column = 0;
        for (j, top) in tops.iter().enumerate() {
            if top.1 > tops[column].1 {
                column = j;
            }
        }
        let (row, size) = tops[column];
        if size <= 1e-9 * scale {
            break;
        }
        pivots.push((row, column));
        let pivot = rest.column(column) / rest[(row, column)];
        for j in 0..rest.ncols() {
            let share = rest[(row, j)];
            if share != 0.0 {
                rest.column_mut(j).axpy(-share, &pivot, 1.0);
                tops[j] = largest(rest.column(j));
            }
        }
    }
    let mut columns: Vec<usize> = pivots.iter().map(|p| p.1).collect();
    columns.sort_unstable();
    let kept = (0..n)
        .filter(|k| pivots.iter().all(|(row, _)| row != k))
        .collect();
    (all.select_columns(&columns), kept)
}

/// Splits the rigid motions of each part off a displacement of all contact freedoms and adds their
/// amplitudes to `share`. A remainder that is only round-off is set to zero, so that a rigid motion
/// takes exactly no force.
fn take_rigid(column: &mut [f64], share: &mut [f64], rigid: &[Trace], part: &[usize]) {
    let mut parts: Vec<usize> = rigid.iter().map(|t| t.part).collect();
    parts.dedup();
    let mut is_moved = vec![false; part.iter().max().map_or(0, |last| last + 1)];
    for (value, &part) in column.iter().zip(part) {
        is_moved[part] |= *value != 0.0;
    }
    // A displacement moves few of many parts.
    let is_moved = |part: &usize| is_moved.get(*part).copied().unwrap_or(false);
    for own in parts.into_iter().filter(is_moved) {
        let size = |column: &[f64]| {
            let values = column.iter().zip(part).filter(|(_, p)| **p == own);
            values.map(|(v, _)| v * v).sum::<f64>().sqrt()
        };
        let before = size(column);
        for _ in 0..2 {
            for (trace, amplitude) in rigid.iter().zip(share.iter_mut()) {
                if trace.part != own {
                    continue;
                }
                // A trace is zero on the freedoms of other parts.
                let values = trace.values.as_slice();
                let along: f64 = values.iter().zip(&*column).map(|(a, b)| a * b).sum();
                for (c, v) in column.iter_mut().zip(values) {
                    *c -= along * v;
                }
                *amplitude += along;
            }
        }
        if size(column) <= ROUND_OFF * before {
            for (c, p) in column.iter_mut().zip(part) {
                if *p == own {
                    *c = 0.0;
                }
            }
        }
    }
}
