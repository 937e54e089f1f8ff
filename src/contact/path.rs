//! Contact along a load path: from one change of status to the next.
//!
//! For `q(t) = q_0 + t q_1` and fixed statuses, gaps and forces are linear in `t`, so the next
//! change is computed, not searched for. Pairs at the border of both conditions (gap and force
//! zero) are settled together by the complementarity problem of their rates: pairs that reach the
//! border at once open or close together, and no status flips back and forth.
//!
//! # Source
//! Paper, section 4.1, with (4.17) read as `Delta alpha / psi`; parametric principal pivoting:
//! Cottle, Pang, Stone (1992), section 4.5.

use super::complementarity::{Unbounded, solve};
use super::{PairBlock, PairMatrix, Tableau};
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A change of the contact status of one pair.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Change {
    /// The pair with this number closes.
    Closes(usize),
    /// The pair with this number opens.
    Opens(usize),
}

/// Why [`Path::advance`] stopped.
#[derive(Debug, Clone, PartialEq)]
pub enum PathEnd {
    /// The end of the piece was reached without a change.
    Target,
    /// These pairs have reached the border of their condition; their new statuses are found when
    /// the path goes on.
    Event(Vec<Change>),
}

/// Fraction of the largest force below which a force counts as zero when pairs that change status
/// at once are collected. For gaps the fraction is a hundredth of this.
const TIE: f64 = 1e-10;
/// Fraction of the terms of a force's rate that is round-off: eps times the number of pairs and the
/// condition of the tied structure from which the terms come.
const ROUND_OFF: f64 = 1e-11;
/// Least number of events after which gaps, forces and their rates are solved for anew, so that
/// round-off does not add up. Until then they are updated, which takes one column of the matrix for
/// each event.
const CARRIED: usize = 16;
/// With `n` pairs, at least `n/PAIRS_PER_CARRIED` events pass before a new solution: the round-off
/// of a solution, a sum of as many terms as there are pairs, also grows with `n`.
const PAIRS_PER_CARRIED: usize = 32;
/// Fraction of the largest force (or of the largest rate of a force) up to which a pair may be
/// pulled and stay closed, if a body would be free without the pair. The line of action of the load
/// then passes so near to the other pairs that round-off decides on which side.
const PULLED: f64 = 1e-9;
/// Value of [`Path`]'s event counter before any rates are known.
const NEVER: usize = usize::MAX;
/// Fraction of the tolerance of a tie by which a pair may violate its condition at the end of a
/// piece: the round-off of an event that is due there.
const AT_END: f64 = 1e-2;
/// Fraction of its force at the start by which a pair may be in tension at the end of a piece if it
/// is among the last pairs that hold a body.
const LAST: f64 = 1e-7;

/// Gaps and forces along one piece of the load path.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Path {
    start: Vec<f64>,
    rate: Vec<f64>,
    /// Position on the piece, 0 at its start.
    pub t: f64,
    /// Gap of each pair.
    pub gap: Vec<f64>,
    /// Force of each pair.
    pub force: Vec<f64>,
    gap_rate: Vec<f64>,
    force_rate: Vec<f64>,
    gap_scale: f64,
    terms: f64,
    force_scale: f64,
    /// Number of events since gaps, forces and rates were last solved for; [`NEVER`] before the
    /// first solution.
    carried: usize,
    /// Number of pairs that changed status when the rates were last settled.
    pub changes: usize,
}

impl Path {
    /// Starts at `t = 0` with `q(t) = start + t rate` and the gaps and forces there, for the
    /// statuses in the tableau. `gap_scale` is the size of gaps that matter (such as the largest
    /// initial gap). `terms` is the size of the terms of which `start` is a sum: the terms may
    /// cancel, their round-off does not.
    ///
    /// # Errors
    /// [`Unbounded`] if the load pushes pairs apart for ever.
    pub fn new(
        tableau: &mut Tableau,
        start: Vec<f64>,
        rate: Vec<f64>,
        gap: Vec<f64>,
        force: Vec<f64>,
        gap_scale: f64,
        terms: f64,
    ) -> Result<Self, Unbounded> {
        let n = tableau.len();
        let mut path = Path {
            start,
            rate,
            t: 0.0,
            gap,
            force,
            gap_rate: vec![0.0; n],
            force_rate: vec![0.0; n],
            gap_scale,
            terms,
            force_scale: 0.0,
            carried: NEVER,
            changes: 0,
        };
        path.settle(tableau)?;
        Ok(path)
    }

    /// Returns the gap and the force that count as zero: `share` of the tolerances for ties, but at
    /// least the round-off. The round-off follows from the terms of the sums, since all forces may
    /// have been zero so far.
    fn zero(&self, tableau: &Tableau, share: f64) -> (f64, f64) {
        let q: Vec<f64> = self
            .start
            .iter()
            .zip(&self.rate)
            .map(|(a, b)| a.abs() + self.t * b.abs())
            .collect();
        let round_off = tableau
            .force_tolerance(&q, &self.gap)
            .max(tableau.force_tolerance(&[self.terms], &[]));
        let gap = TIE * self.gap.iter().fold(self.gap_scale, |m, g| m.max(*g)) * 1e-2;
        let force = TIE * self.force.iter().fold(self.force_scale, |m, r| m.max(*r));
        (
            (share * gap).max(tableau.gap_tolerance(round_off)),
            (share * force).max(round_off),
        )
    }

    /// Whether gaps, forces and rates have been updated over so many events that they are to be
    /// solved for anew.
    fn is_old(&self) -> bool {
        self.carried >= CARRIED.max(self.gap.len() / PAIRS_PER_CARRIED)
    }

    /// Finds the statuses of the pairs at the border from the complementarity problem of the rates,
    /// then computes all rates.
    fn settle(&mut self, tableau: &mut Tableau) -> Result<(), Unbounded> {
        let n = tableau.len();
        let (zero_gap, zero_force) = self.zero(tableau, 1.0);
        self.force_scale = self.force.iter().fold(self.force_scale, |m, r| m.max(*r));
        let border: Vec<usize> = (0..n)
            .filter(|&k| self.gap[k] <= zero_gap && self.force[k] <= zero_force)
            .collect();
        let before = tableau.open().to_vec();
        let anew = self.is_old();
        if self.carried == NEVER {
            tableau.solve(&self.rate, &mut self.gap_rate, &mut self.force_rate);
        }
        self.carried = if anew { 0 } else { self.carried + 1 };
        if !border.is_empty() {
            for &k in &border {
                if tableau.open()[k] {
                    tableau.flip_with(k, &mut self.gap_rate, &mut self.force_rate);
                }
                self.gap[k] = 0.0;
                self.force[k] = 0.0;
            }
            let m = border.len();
            // A rate that is only the round-off of the terms of its sum has no meaningful sign. If
            // the sign were followed, a body on which nothing acts would drift away.
            let terms = |k: usize| {
                let column = tableau.matrix().column(k);
                let of_gaps = column.map(|(j, t)| (t * self.gap_rate[j]).abs());
                self.rate[k].abs() + of_gaps.sum::<f64>()
            };
            let largest = self.force_rate.iter().fold(0.0, |m: f64, r| m.max(r.abs()));
            let rates: Vec<f64> = border
                .iter()
                .map(|&k| match self.force_rate[k] {
                    rate if rate.abs() <= ROUND_OFF * terms(k) => 0.0,
                    rate if rate < 0.0 && -rate <= PULLED * largest && tableau.would_free(k) => 0.0,
                    rate => rate,
                })
                .collect();
            let mut small = Tableau::new(among(tableau, &border));
            let (mut dg, mut dr) = (vec![0.0; m], vec![0.0; m]);
            solve(&mut small, &rates, &mut dg, &mut dr).map_err(|u| Unbounded {
                pair: border[u.pair],
            })?;
            for (i, &k) in border.iter().enumerate() {
                if small.open()[i]
                    && !tableau.flip_with(k, &mut self.gap_rate, &mut self.force_rate)
                {
                    return Err(Unbounded { pair: k });
                }
            }
        }
        if anew {
            tableau.solve(&self.rate, &mut self.gap_rate, &mut self.force_rate);
        }
        // A negative rate at the border is round-off, since the complementarity problem excludes
        // it. If it were followed, the path would stand still for ever.
        for &k in &border {
            self.gap_rate[k] = self.gap_rate[k].max(0.0);
            self.force_rate[k] = self.force_rate[k].max(0.0);
        }
        self.changes = before
            .iter()
            .zip(tableau.open())
            .filter(|(a, b)| a != b)
            .count();
        Ok(())
    }

    /// Goes on to `end` or to the next change of contact, whichever comes first. A change at the
    /// end, within round-off, counts as the end.
    pub fn advance(&mut self, tableau: &mut Tableau, end: f64) -> PathEnd {
        let room = end - self.t;
        let mut step = room;
        let mut first = None;
        let (end_gap, end_force) = self.zero(tableau, AT_END);
        let largest = self.force.iter().fold(0.0, |m: f64, r| m.max(*r));
        // Whether the group of a pair carries no contact force any more at the end of the piece.
        let comes_loose = |path: &Path, k: usize| {
            let (block, _) = tableau.matrix().place(k);
            let pairs = &tableau.matrix().blocks()[block].pairs;
            let sum = |of: &[f64]| pairs.iter().map(|&k| of[k]).sum::<f64>();
            let now = sum(&path.force);
            now + room * sum(&path.force_rate) <= LAST * now
        };
        for k in 0..tableau.len() {
            let (value, rate) = self.value_and_rate(tableau, k);
            if rate < 0.0 && value + step * rate < 0.0 {
                let at_end = if tableau.open()[k] {
                    end_gap
                } else if tableau.would_free(k) {
                    // A body would be free without this pair: the pair may be pulled a little.
                    (LAST * value).max(PULLED * largest)
                } else if comes_loose(self, k) {
                    // The last pairs that hold a body cannot open: when the body is unloaded
                    // completely, their forces vanish near the end.
                    LAST * value
                } else {
                    end_force
                };
                if value + room * rate < -at_end {
                    step = value / -rate;
                    first = Some(k);
                }
            }
        }
        if first.is_none() {
            self.state_at(tableau, end);
            return PathEnd::Target;
        }
        if self.is_old() {
            self.state_at(tableau, self.t + step);
        } else {
            self.t += step;
            let rates = self.gap_rate.iter().chain(&self.force_rate);
            for (value, rate) in self.gap.iter_mut().chain(&mut self.force).zip(rates) {
                *value = (*value + step * rate).max(0.0);
            }
        }
        if let Some(k) = first {
            // This pair is at its border by construction. Round-off in its value would otherwise
            // make the path stand still.
            let value = if tableau.open()[k] {
                &mut self.gap[k]
            } else {
                &mut self.force[k]
            };
            *value = 0.0;
        }
        let (zero_gap, zero_force) = self.zero(tableau, 1.0);
        let changes = (0..tableau.len())
            .filter_map(|k| {
                let (_, rate) = self.value_and_rate(tableau, k);
                if rate >= 0.0 {
                    None
                } else if tableau.open()[k] {
                    (self.gap[k] <= zero_gap).then_some(Change::Closes(k))
                } else {
                    (self.force[k] <= zero_force).then_some(Change::Opens(k))
                }
            })
            .collect();
        PathEnd::Event(changes)
    }

    /// Goes on after an event with the statuses that hold after it.
    ///
    /// # Errors
    /// [`Unbounded`] if the load pushes pairs apart for ever.
    pub fn turn(&mut self, tableau: &mut Tableau) -> Result<(), Unbounded> {
        self.settle(tableau)
    }

    fn value_and_rate(&self, tableau: &Tableau, k: usize) -> (f64, f64) {
        if tableau.open()[k] {
            (self.gap[k], self.gap_rate[k])
        } else {
            (self.force[k], self.force_rate[k])
        }
    }

    /// Computes gaps and forces at `t` for the current statuses, which must hold there.
    pub(crate) fn state_at(&mut self, tableau: &mut Tableau, t: f64) {
        self.t = t;
        let q: Vec<f64> = self
            .start
            .iter()
            .zip(&self.rate)
            .map(|(a, b)| a + t * b)
            .collect();
        tableau.solve(&q, &mut self.gap, &mut self.force);
        for v in self.gap.iter_mut().chain(&mut self.force) {
            *v = v.max(0.0);
        }
    }
}

/// Returns the entries of the swept matrix that couple the given pairs.
fn among(tableau: &Tableau, pairs: &[usize]) -> PairMatrix {
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (i, &k) in pairs.iter().enumerate() {
        let (block, _) = tableau.matrix().place(k);
        groups.entry(block).or_default().push(i);
    }
    let blocks = groups.into_values().map(|own| {
        let entry = |i: usize, j: usize| tableau.swept(pairs[own[i]], pairs[own[j]]);
        let matrix = DMatrix::from_fn(own.len(), own.len(), entry);
        PairBlock {
            pairs: own,
            matrix: Arc::new(matrix),
        }
    });
    PairMatrix::new(blocks.collect())
}
