//! Conditions on sums of displacements that hold only in one leg of the program, each solved for
//! one displacement.
//!
//! ```text
//!     sum_k c_k d_k = sum_l h_l v_l      d_k a displacement along an axis, h_l a factor of a load
//! ```
//!
//! The set of conditions that hold changes from leg to leg, and so does the choice of the
//! displacements that follow others.

use super::following::Following;
use crate::error::{Error, Result};
use crate::space::unit;
use std::collections::{BTreeMap, BTreeSet};

/// Largest coefficient that counts as zero after an elimination, relative to coefficients of 1.
const ROUND_OFF: f64 = 1e-12;

/// A node and an axis.
type NodeAxis = (usize, usize);

/// A sum of displacements that equals a sum of values of loads.
#[derive(Clone)]
struct SumRow {
    terms: BTreeMap<NodeAxis, f64>,
    moved: BTreeMap<usize, f64>,
    /// Entry of the scene that states the condition.
    of: (&'static str, usize),
}

impl SumRow {
    fn of(following: Following) -> SumRow {
        let mut terms = BTreeMap::from([((following.node, following.direction), 1.0)]);
        for (node, v) in following.terms {
            for (axis, c) in v.into_iter().enumerate().filter(|(_, c)| *c != 0.0) {
                *terms.entry((node, axis)).or_insert(0.0) -= c;
            }
        }
        let mut moved = BTreeMap::new();
        for (load, value) in following.moved {
            *moved.entry(load).or_insert(0.0) += value;
        }
        SumRow {
            terms,
            moved,
            of: following.of,
        }
    }

    fn scale(&mut self, factor: f64) {
        let all = self.terms.values_mut().chain(self.moved.values_mut());
        all.for_each(|value| *value *= factor);
    }

    /// Eliminates a displacement from the sum by a row in which its coefficient is 1.
    fn eliminate(&mut self, pivot: NodeAxis, by: &SumRow) {
        let Some(&factor) = self.terms.get(&pivot) else {
            return;
        };
        for (key, own) in &by.terms {
            *self.terms.entry(*key).or_insert(0.0) -= factor * own;
        }
        self.terms
            .retain(|key, c| *key != pivot && c.abs() > ROUND_OFF);
        for (load, own) in &by.moved {
            *self.moved.entry(*load).or_insert(0.0) -= factor * own;
        }
    }

    fn following(self, (node, direction): NodeAxis) -> Following {
        let others = self
            .terms
            .into_iter()
            .filter(|(key, _)| *key != (node, direction));
        Following {
            node,
            direction,
            terms: others
                .map(|((node, axis), c)| (node, unit(axis).map(|e| -c * e)))
                .collect(),
            moved: self.moved.into_iter().collect(),
            of: self.of,
        }
    }
}

/// Solves conditions for one displacement each, which occurs in no other of them (Gauss-Jordan
/// elimination with the largest coefficient as the pivot). Displacements in `taken` follow nothing.
///
/// # Errors
/// `Input` for a condition that has no displacement of its own.
pub(super) fn solved(
    conditions: Vec<Following>,
    taken: &BTreeSet<NodeAxis>,
    refused: impl Fn((&'static str, usize), &str) -> Error,
) -> Result<Vec<Following>> {
    let mut rows: Vec<SumRow> = conditions.into_iter().map(SumRow::of).collect();
    // Conditions with few displacements come first: a single displacement leaves no choice.
    rows.sort_by_key(|row| row.terms.len());
    let mut pivots: Vec<NodeAxis> = Vec::new();
    for k in 0..rows.len() {
        let is_free = |key: &NodeAxis| !taken.contains(key) && !pivots.contains(key);
        let free = rows[k].terms.iter().filter(|(key, _)| is_free(key));
        let largest = free.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        // If no displacement of the condition is free, any of them is taken: the condition is
        // refused later, when the axis that would follow turns out to be held or in use.
        let any = rows[k].terms.iter().next();
        let Some((&pivot, &c)) = largest.or(any) else {
            let why =
                "is implied by others that hold at the same load factor: take one of them out";
            return Err(refused(rows[k].of, why));
        };
        rows[k].scale(1.0 / c);
        let own = rows[k].clone();
        let others = rows.iter_mut().enumerate().filter(|(other, _)| *other != k);
        others.for_each(|(_, row)| row.eliminate(pivot, &own));
        pivots.push(pivot);
    }
    let solved = rows.into_iter().zip(pivots);
    Ok(solved.map(|(row, pivot)| row.following(pivot)).collect())
}
