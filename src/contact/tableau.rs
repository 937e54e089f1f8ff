//! The contact matrix with a set of pairs opened: a principal pivotal transform.

use super::matrix::{self, PairMatrix};
use super::swept::Swept;
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

/// Share of the original diagonal below which a pivot counts as zero: opening the pair would free a
/// rigid motion.
const SINGULAR: f64 = 1e-11;
/// Share beyond which it certainly does not.
const NOT_SINGULAR: f64 = 1e-4;
/// Multiple of the round-off to be expected beyond which a solution has lost its digits.
const LOST: f64 = 1e3;
/// Rounds of a solution: two, and more where the matrix is so near to a singular one that they do
/// not settle it.
const MOST_ROUNDS: usize = 4;
/// Pivots after which the transform is rebuilt from the original matrix.
const REBUILD: usize = 2000;

/// `T` swept on the open pairs: blocks `-T_oo^-1`, `T_oo^-1 T_oc`, `T_cc - T_co T_oo^-1 T_oc`.
///
/// # Source
/// R. W. Cottle, J.-S. Pang, R. E. Stone, *The Linear Complementarity Problem* (1992), section 2.3.
#[derive(Debug, Clone)]
pub struct Tableau {
    matrix: PairMatrix,
    /// Swept form of each block of the matrix.
    swept: Vec<Swept>,
    open: Vec<bool>,
    way: TableauRecord,
    column: Vec<f64>,
}

/// How the swept matrix came about: the same pivots in the same order give it again, bit for bit.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct TableauRecord {
    /// Statuses when it was last built from the original matrix.
    base: Vec<bool>,
    /// Pairs whose status was changed since, in order.
    flips: Vec<u32>,
}

impl Tableau {
    /// The symmetric positive semidefinite matrix `T` with every pair closed.
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

    /// True where there is no pair.
    pub fn is_empty(&self) -> bool {
        self.open.is_empty()
    }

    /// Which pairs are open.
    pub fn open(&self) -> &[bool] {
        &self.open
    }

    /// The original matrix T.
    pub fn matrix(&self) -> &PairMatrix {
        &self.matrix
    }

    /// An entry of the swept matrix.
    pub(super) fn swept(&self, i: usize, j: usize) -> f64 {
        let ((block, i), (other, j)) = (self.matrix.place(i), self.matrix.place(j));
        if block == other {
            self.swept[block].get(i, j)
        } else {
            0.0
        }
    }

    /// A column of the swept matrix: the pairs of its group, ascending, and the entries.
    pub(super) fn swept_column(&mut self, j: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.bring_column(j);
        let pairs = &self.matrix.blocks()[self.matrix.place(j).0].pairs;
        pairs.iter().copied().zip(self.column.iter().copied())
    }

    /// Puts a column of the swept matrix into `column`, for the pairs of its group.
    fn bring_column(&mut self, j: usize) {
        let (block, j) = self.matrix.place(j);
        let n = self.matrix.blocks()[block].pairs.len();
        self.swept[block].column(j, &mut self.column[..n]);
    }

    /// Whether opening pair `k` now would free a rigid motion.
    ///
    /// What is left of `T_kk` is `T_kk - T_ko w` with `w = T_oo^-1 T_ok`: the round-off of that is
    /// a share of `|T_kk| + 2 |T_ko| |w| + |w|' |T_oo| |w| <= (sqrt T_kk + sum |w_o| sqrt T_oo)^2`,
    /// since `|T_ij| <= sqrt(T_ii T_jj)`.
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

    /// Opens or closes pair `k`; false (and nothing changed) if opening it would free a rigid
    /// motion.
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

    /// As [`Tableau::flip`]; keeps `gap` and `force` what [`Tableau::solve`] gives for their
    /// right-hand side, for the new statuses: one column instead of the whole matrix.
    pub(crate) fn flip_with(&mut self, k: usize, gap: &mut [f64], force: &mut [f64]) -> bool {
        if self.would_free(k) {
            return false;
        }
        // Of y = b + S z with y = (r_closed, -g_open) and z = (g_closed, r_open) only b stands
        // where z is zero.
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

    /// Sets all statuses, starting from the original matrix; pairs whose opening would free a rigid
    /// motion stay closed.
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

    /// How this tableau came about.
    pub fn record(&self) -> &TableauRecord {
        &self.way
    }

    /// Repeats what a tableau of the same matrix went through; false (and the tableau of no use)
    /// where the record is of another one.
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

    /// Gaps of the open pairs and forces of the closed ones for the given statuses: `r_o = 0`,
    /// `g_c = 0`, `r = q + T g`. The gaps are refined against `T`, so that errors of many pivots do
    /// not stay.
    pub fn solve(&mut self, q: &[f64], gap: &mut [f64], force: &mut [f64]) {
        self.solve_with_residual(q, gap, force);
    }

    /// As [`Tableau::solve`], starting again from the original matrix where pivots have lost the
    /// digits (a pivot that was hardly more than round-off): pairs that then turn out to hold a
    /// rigid motion are closed.
    pub(crate) fn solve_safely(&mut self, q: &[f64], gap: &mut [f64], force: &mut [f64]) {
        let residual = self.solve_with_residual(q, gap, force);
        if residual > LOST * self.force_tolerance(q, gap) {
            let open = self.open.clone();
            self.reset(&open);
            self.solve_with_residual(q, gap, force);
        }
    }

    /// [`Tableau::solve`]; the largest force that is left on an open pair.
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

    /// `g_o -= T_oo^-1 residual_o`.
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

    /// Round-off to be expected in the forces of a solution with these right-hand side and gaps.
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
