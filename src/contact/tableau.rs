//! The contact matrix after a set of pairs has been opened: a principal pivotal transform.

use super::matrix::{self, PairMatrix};
use super::swept::Swept;
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

/// Fraction of the original diagonal entry below which a pivot counts as zero: opening the pair
/// would free a rigid motion.
const SINGULAR: f64 = 1e-11;
/// Fraction of the original diagonal entry above which a pivot certainly frees no rigid motion.
const NOT_SINGULAR: f64 = 1e-4;
/// Multiple of the expected round-off beyond which a solution has lost its digits.
const LOST: f64 = 1e3;
/// Largest number of refinement rounds of a solution: two suffice unless the matrix is nearly
/// singular.
const MOST_ROUNDS: usize = 4;
/// Number of pivots after which the transform is rebuilt from the original matrix.
const REBUILD: usize = 2000;

/// Matrix `T` swept on the open pairs: blocks `-T_oo^-1`, `T_oo^-1 T_oc`,
/// `T_cc - T_co T_oo^-1 T_oc`.
///
/// # Source
/// R. W. Cottle, J.-S. Pang, R. E. Stone, *The Linear Complementarity Problem* (1992), section 2.3.
#[derive(Debug, Clone)]
pub struct Tableau {
    matrix: PairMatrix,
    /// Swept form of each block of `matrix`.
    swept: Vec<Swept>,
    open: Vec<bool>,
    way: TableauRecord,
    column: Vec<f64>,
}

/// History of a swept matrix: the same pivots in the same order reproduce the matrix bit for bit.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct TableauRecord {
    /// Statuses when the swept matrix was last built from the original matrix.
    base: Vec<bool>,
    /// Pairs whose status has changed since the matrix was last built, in order.
    flips: Vec<u32>,
}

impl Tableau {
    /// Starts from the symmetric positive semidefinite matrix `T` with every pair closed.
    pub fn new(matrix: impl Into<PairMatrix>) -> Self {
        let matrix = matrix.into();
        let n = matrix.len();
        let blocks = matrix.blocks().iter();
        Tableau {
            swept: blocks
                .map(|block| Swept::new(DMatrix::clone(&block.matrix)))
                .collect(),
            matrix,
            open: vec![false; n],
            way: TableauRecord {
                base: vec![false; n],
                flips: Vec::new(),
            },
            column: vec![0.0; n],
        }
    }

    /// Number of pairs.
    pub fn len(&self) -> usize {
        self.open.len()
    }

    /// True if there is no pair.
    pub fn is_empty(&self) -> bool {
        self.open.is_empty()
    }

    /// For each pair, whether it is open.
    pub fn open(&self) -> &[bool] {
        &self.open
    }

    /// The original matrix `T`, with all pairs closed.
    pub fn matrix(&self) -> &PairMatrix {
        &self.matrix
    }

    /// Entry (i, j) of the swept matrix; zero between pairs of different groups.
    pub(super) fn swept(&self, i: usize, j: usize) -> f64 {
        let ((block, i), (other, j)) = (self.matrix.place(i), self.matrix.place(j));
        if block == other {
            self.swept[block].get(i, j)
        } else {
            0.0
        }
    }

    /// Column of a pair in the swept matrix: the pairs of its group, ascending, each with its
    /// entry.
    pub(super) fn swept_column(&mut self, j: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.bring_column(j);
        let pairs = &self.matrix.blocks()[self.matrix.place(j).0].pairs;
        pairs.iter().copied().zip(self.column.iter().copied())
    }

    /// Copies a column of the swept matrix into `self.column`, for the pairs of its group.
    fn bring_column(&mut self, j: usize) {
        let (block, j) = self.matrix.place(j);
        let n = self.matrix.blocks()[block].pairs.len();
        self.swept[block].column(j, &mut self.column[..n]);
    }

    /// Whether opening pair `k` now would free a rigid motion.
    ///
    /// The pivot is `T_kk - T_ko w` with `w = T_oo^-1 T_ok`. Its round-off is a share of `|T_kk| +
    /// 2 |T_ko| |w| + |w|' |T_oo| |w| <= (sqrt T_kk + sum |w_o| sqrt T_oo)^2`, since `|T_ij| <=
    /// sqrt(T_ii T_jj)`.
    pub(crate) fn would_free(&self, k: usize) -> bool {
        let (block, own) = self.matrix.place(k);
        let (left, whole) = (self.swept[block].get(own, own), self.matrix.diagonal(k));
        if self.open[k] || left > NOT_SINGULAR * whole {
            return false;
        }
        let pairs = &self.matrix.blocks()[block].pairs;
        let open = pairs.iter().enumerate().filter(|(_, k)| self.open[**k]);
        let moved: f64 = open
            .map(|(j, &k)| self.swept[block].get(j, own).abs() * self.matrix.diagonal(k).sqrt())
            .sum();
        let n = (pairs.len() as f64).sqrt();
        let round_off = 8.0 * f64::EPSILON * n * (whole.sqrt() + moved).powi(2);
        left <= round_off.max(SINGULAR * whole)
    }

    /// Opens or closes pair `k`. Returns false, and changes nothing, if opening the pair would free
    /// a rigid motion.
    pub fn flip(&mut self, k: usize) -> bool {
        if self.would_free(k) {
            return false;
        }
        self.sweep(k);
        self.open[k] = !self.open[k];
        self.way.flips.push(k as u32);
        if self.way.flips.len() >= REBUILD {
            let open = self.open.clone();
            self.reset(&open);
        }
        true
    }

    /// Flips a pair like [`Tableau::flip`] and updates `gap` and `force` from the solution
    /// ([`Tableau::solve`]) for the old statuses to that for the new ones. The right-hand side
    /// stays the same, so this takes one column of the matrix instead of the whole matrix.
    pub(crate) fn flip_with(&mut self, k: usize, gap: &mut [f64], force: &mut [f64]) -> bool {
        if self.would_free(k) {
            return false;
        }
        // In y = b + S z with y = (r_closed, -g_open) and z = (g_closed, r_open), z is zero except
        // for pair k, so b is known from y.
        let b = if self.open[k] { -gap[k] } else { force[k] };
        let own = self.matrix.place(k).1;
        self.bring_column(k);
        let pairs = &self.matrix.blocks()[self.matrix.place(k).0].pairs;
        let z = -b / self.column[own];
        for (&i, s) in pairs.iter().zip(&self.column) {
            if self.open[i] {
                gap[i] -= s * z;
            } else {
                force[i] += s * z;
            }
        }
        (gap[k], force[k]) = if self.open[k] { (0.0, z) } else { (z, 0.0) };
        self.flip(k)
    }

    /// Sets all statuses, starting from the original matrix. A pair whose opening would free a
    /// rigid motion stays closed.
    pub fn reset(&mut self, open: &[bool]) {
        for (swept, block) in self.swept.iter_mut().zip(self.matrix.blocks()) {
            swept.copy_from(&block.matrix);
        }
        self.open.fill(false);
        self.way.flips.clear();
        for k in 0..self.len() {
            if open[k] && !self.would_free(k) {
                self.sweep(k);
                self.open[k] = true;
            }
        }
        self.way.base.copy_from_slice(&self.open);
    }

    /// History of this tableau, from which an equal tableau can be made.
    pub fn record(&self) -> &TableauRecord {
        &self.way
    }

    /// Repeats the history of another tableau of the same matrix. Returns false, and leaves the
    /// tableau unusable, if the record belongs to a different matrix.
    pub(crate) fn replay(&mut self, record: &TableauRecord) -> bool {
        if record.base.len() != self.len() || record.flips.len() >= REBUILD {
            return false;
        }
        self.reset(&record.base);
        self.open == record.base
            && record
                .flips
                .iter()
                .all(|&k| (k as usize) < self.open.len() && self.flip(k as usize))
    }

    fn sweep(&mut self, k: usize) {
        let sign = if self.open[k] { -1.0 } else { 1.0 };
        let (block, own) = self.matrix.place(k);
        self.swept[block].pivot(own, sign);
    }

    /// Computes the gaps of the open pairs and the forces of the closed pairs for the current
    /// statuses: `r_o = 0`, `g_c = 0`, `r = q + T g`. The gaps are refined against `T`, so that the
    /// errors of many pivots do not accumulate.
    pub fn solve(&mut self, q: &[f64], gap: &mut [f64], force: &mut [f64]) {
        self.solve_with_residual(q, gap, force);
    }

    /// Solves like [`Tableau::solve`], but rebuilds the tableau from the original matrix if pivots
    /// have lost the digits (a pivot was hardly more than round-off). Pairs that then turn out to
    /// hold a rigid motion are closed.
    pub(crate) fn solve_safely(&mut self, q: &[f64], gap: &mut [f64], force: &mut [f64]) {
        let residual = self.solve_with_residual(q, gap, force);
        if residual > LOST * self.force_tolerance(q, gap) {
            let open = self.open.clone();
            self.reset(&open);
            self.solve_with_residual(q, gap, force);
        }
    }

    /// Solves like [`Tableau::solve`] and returns the largest force that remains on an open pair.
    fn solve_with_residual(&mut self, q: &[f64], gap: &mut [f64], force: &mut [f64]) -> f64 {
        gap.fill(0.0);
        force.copy_from_slice(q);
        let mut residual = f64::INFINITY;
        for round in 0..MOST_ROUNDS {
            self.correct(force, gap);
            force.copy_from_slice(q);
            self.matrix.add_product(gap, force);
            let left = force.iter().zip(&self.open).filter(|(_, open)| **open);
            residual = left.fold(0.0f64, |m, (f, _)| m.max(f.abs()));
            if round > 0 && residual <= self.force_tolerance(q, gap) {
                break;
            }
        }
        for (f, _) in force.iter_mut().zip(&self.open).filter(|(_, open)| **open) {
            *f = 0.0;
        }
        residual
    }

    /// Corrects the gaps of the open pairs: `g_o -= T_oo^-1 residual_o`.
    fn correct(&mut self, residual: &mut [f64], gap: &mut [f64]) {
        for (r, _) in residual
            .iter_mut()
            .zip(&self.open)
            .filter(|(_, open)| !**open)
        {
            *r = 0.0;
        }
        self.column.fill(0.0);
        let blocks = self.matrix.blocks().iter().zip(&mut self.swept);
        let blocks = blocks.map(|(block, swept)| (block.pairs.as_slice(), swept.matrix()));
        matrix::add_products(blocks, residual, &mut self.column);
        let correction = gap.iter_mut().zip(&self.column).zip(&self.open);
        for ((g, c), _) in correction.filter(|(_, open)| **open) {
            *g += c;
        }
    }

    /// Round-off to be expected in the forces of a solution with this right-hand side and these
    /// gaps.
    pub(crate) fn force_tolerance(&self, q: &[f64], gap: &[f64]) -> f64 {
        let largest_q = q.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        let largest_t = (0..self.len()).fold(0.0f64, |m, k| m.max(self.matrix.diagonal(k)));
        let largest_g = gap.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        8.0 * f64::EPSILON
            * (self.len() as f64).sqrt().max(1.0)
            * (largest_q + largest_t * largest_g)
    }

    /// The gap that a force tolerance corresponds to.
    pub(crate) fn gap_tolerance(&self, force_tolerance: f64) -> f64 {
        let largest_t = (0..self.len()).fold(0.0f64, |m, k| m.max(self.matrix.diagonal(k)));
        if largest_t > 0.0 {
            force_tolerance / largest_t
        } else {
            0.0
        }
    }
}
