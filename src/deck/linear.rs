//! Reduction of linear equations between displacements: which displacements follow which.
//!
//! In the rows `sum_k c_k u_k = 0`, displacements of nodes without elements are eliminated first:
//! each is expressed by one row. The remaining rows are brought into the form
//! `u_i = sum_k a_k u_k`, in which no `u_i` occurs on the right of any row (Gauss-Jordan
//! elimination, with the largest coefficient of a column or row as the pivot).

use super::constraints::LocalAxes;
use super::facets::Key;
use super::source::LinePlace;
use std::collections::{BTreeMap, BTreeSet};

/// Fraction of the largest coefficient of a column below which a coefficient counts as round-off.
const ROUND_OFF: f64 = 1e-11;
/// Fraction of the largest coefficient of a row. The first term of the row, in the order of the
/// deck, follows the others if its coefficient is at least this large.
const LARGE_ENOUGH: f64 = 0.1;

/// Coefficients of displacements, by node and axis.
pub(super) type FreedomCoefficients = BTreeMap<Key, f64>;

/// An equation from a line of the deck.
#[derive(Debug, Clone)]
pub(super) struct LinearRow {
    pub(super) terms: FreedomCoefficients,
    /// The term that follows the others if its coefficient is large enough.
    pub(super) first: Option<Key>,
    pub(super) place: LinePlace,
    pub(super) keyword: &'static str,
}

impl LinearRow {
    /// Replaces displacements along local axes of some nodes by those along x, y and z.
    pub(super) fn resolve(&mut self, axes: &LocalAxes) {
        for (key, c) in std::mem::take(&mut self.terms) {
            let Some(own) = axes.get(&key.0) else {
                *self.terms.entry(key).or_insert(0.0) += c;
                continue;
            };
            for (k, share) in (0..3u8).zip(own[key.1 as usize]) {
                *self.terms.entry((key.0, k)).or_insert(0.0) += c * share;
            }
        }
        if let Some((node, _)) = self.first.filter(|first| axes.contains_key(&first.0)) {
            let of_node = self.terms.range((node, 0)..=(node, 2));
            let largest = of_node.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
            self.first = largest.map(|(key, _)| *key);
        }
    }
}

/// A displacement that is expressed by others.
#[derive(Debug, Clone)]
pub(super) struct Follows {
    pub(super) key: Key,
    /// Coefficients `a_k` of `u_key = sum_k a_k u_k`.
    pub(super) of: FreedomCoefficients,
    pub(super) place: LinePlace,
}

/// The result of the reduction of all equations.
#[derive(Debug, Clone, Default)]
pub(super) struct Reduced {
    /// Displacements of nodes without elements, expressed by others.
    pub(super) loose: Vec<Follows>,
    /// Displacements of other nodes, expressed by others.
    pub(super) others: Vec<Follows>,
    /// Equations in which all displacements are known.
    pub(super) known: Vec<LinearRow>,
}

/// Equations, with an index of the rows in which each key occurs.
struct Matrix {
    rows: Vec<LinearRow>,
    of_key: BTreeMap<Key, BTreeSet<usize>>,
    /// The largest absolute coefficient of each key.
    scale: BTreeMap<Key, f64>,
}

/// Reduces the equations. `is_loose` tells whether a displacement belongs to a node without
/// elements, `is_known` whether it is prescribed. A prescribed displacement is a number and never
/// follows others.
pub(super) fn reduce(
    rows: Vec<LinearRow>,
    is_loose: impl Fn(&Key) -> bool,
    is_known: impl Fn(&Key) -> bool,
) -> Reduced {
    let mut matrix = Matrix::new(rows);
    let mut out = Reduced::default();
    let keys: Vec<Key> = matrix.of_key.keys().copied().collect();
    let (mut done, mut loose) = (BTreeSet::new(), Vec::new());
    for key in keys.iter().filter(|key| is_loose(key) && !is_known(key)) {
        let Some(row) = matrix.largest_of(key, &done) else {
            continue;
        };
        matrix.eliminate(row, key);
        done.insert(row);
        loose.push((row, *key));
    }
    let follows = loose.into_iter().map(|(row, key)| matrix.follows(row, key));
    out.loose.extend(follows);
    // The remaining rows contain no loose displacement that is not known, because it would have
    // been eliminated.
    let rows: Vec<usize> = (0..matrix.rows.len())
        .filter(|r| !done.contains(r))
        .collect();
    let mut pivots = Vec::new();
    for row in rows {
        match matrix.follower(row, &is_known) {
            Some(key) => {
                matrix.eliminate(row, &key);
                pivots.push((row, key));
            }
            None if matrix.rows[row].terms.is_empty() => {}
            None => out.known.push(matrix.rows[row].clone()),
        }
    }
    let follows = pivots
        .into_iter()
        .map(|(row, key)| matrix.follows(row, key));
    out.others.extend(follows);
    out
}

impl Matrix {
    fn new(rows: Vec<LinearRow>) -> Self {
        let mut out = Matrix {
            rows,
            of_key: BTreeMap::new(),
            scale: BTreeMap::new(),
        };
        for (number, row) in out.rows.iter_mut().enumerate() {
            row.terms.retain(|_, c| *c != 0.0);
            for (key, c) in &row.terms {
                out.of_key.entry(*key).or_default().insert(number);
                let largest = out.scale.entry(*key).or_insert(0.0);
                *largest = largest.max(c.abs());
            }
        }
        out
    }

    /// The row in which a key has its largest coefficient, apart from the rows in `but`.
    fn largest_of(&self, key: &Key, but: &BTreeSet<usize>) -> Option<usize> {
        let rows = self
            .of_key
            .get(key)?
            .iter()
            .filter(|row| !but.contains(row));
        let size = |row: &&usize| self.rows[**row].terms[key].abs();
        rows.max_by(|a, b| size(a).total_cmp(&size(b)).then(b.cmp(a)))
            .copied()
    }

    /// The displacement that is to follow the others of a row: the row's first term, or the one
    /// with the largest coefficient.
    fn follower(&self, row: usize, is_known: impl Fn(&Key) -> bool) -> Option<Key> {
        let row = &self.rows[row];
        let free = || row.terms.iter().filter(|(key, _)| !is_known(key));
        let largest = free().fold(None, |most: Option<(&Key, f64)>, (key, c)| match most {
            Some((_, size)) if c.abs() <= size => most,
            _ => Some((key, c.abs())),
        });
        let (key, size) = largest?;
        let first = row.first.filter(|first| {
            let c = row.terms.get(first).filter(|_| !is_known(first));
            c.is_some_and(|c| c.abs() >= LARGE_ENOUGH * size)
        });
        Some(first.unwrap_or(*key))
    }

    /// Eliminates a key from all rows except its own.
    fn eliminate(&mut self, own: usize, key: &Key) {
        let terms = self.rows[own].terms.clone();
        let Some(pivot) = terms.get(key) else { return };
        let others: Vec<usize> = self.of_key[key].iter().copied().collect();
        for row in others.into_iter().filter(|row| *row != own) {
            let Some(c) = self.rows[row].terms.get(key) else {
                continue;
            };
            let factor = c / pivot;
            for (of, c) in &terms {
                let sum = self.rows[row].terms.entry(*of).or_insert(0.0);
                *sum -= factor * c;
                let least = ROUND_OFF * self.scale[of].max((factor * c).abs());
                let is_left = of != key && sum.abs() > least;
                let rows = self.of_key.entry(*of).or_default();
                if is_left {
                    rows.insert(row);
                } else {
                    self.rows[row].terms.remove(of);
                    rows.remove(&row);
                }
            }
        }
    }

    fn follows(&self, row: usize, key: Key) -> Follows {
        let row = &self.rows[row];
        let pivot = row.terms.get(&key).copied().unwrap_or(1.0);
        let others = row.terms.iter().filter(|(other, _)| **other != key);
        Follows {
            key,
            of: others.map(|(other, c)| (*other, -c / pivot)).collect(),
            place: row.place,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(terms: &[(u32, f64)]) -> LinearRow {
        LinearRow {
            terms: terms.iter().map(|&(node, c)| ((node, 0), c)).collect(),
            first: terms.first().map(|term| (term.0, 0)),
            place: LinePlace::default(),
            keyword: "EQUATION",
        }
    }

    fn of(follows: &Follows) -> Vec<(u32, f64)> {
        follows.of.iter().map(|(key, c)| (key.0, *c)).collect()
    }

    #[test]
    fn chains_end_at_what_follows_nothing() {
        let rows = vec![row(&[(1, 1.0), (2, -1.0)]), row(&[(2, 2.0), (3, -1.0)])];
        let reduced = reduce(rows, |_| false, |_| false);
        let all: Vec<_> = reduced.others.iter().map(|f| (f.key.0, of(f))).collect();
        assert_eq!(all, [(1, vec![(3, 0.5)]), (2, vec![(3, 0.5)])]);
    }

    #[test]
    fn what_is_loose_is_taken_out_and_what_is_known_follows_nothing() {
        // Two nodes follow a loose node, which a third, known node follows too.
        let rows = vec![
            row(&[(1, 1.0), (100, -1.0)]),
            row(&[(2, 1.0), (100, -2.0)]),
            row(&[(3, 1.0), (100, -1.0)]),
        ];
        let reduced = reduce(rows, |key| key.0 == 100, |key| key.0 == 3);
        assert_eq!(of(&reduced.loose[0]), [(2, 0.5)]);
        let all: Vec<_> = reduced.others.iter().map(|f| (f.key.0, of(f))).collect();
        assert_eq!(all, [(1, vec![(3, 1.0)]), (2, vec![(3, 2.0)])]);
        assert!(reduced.known.is_empty());
    }

    #[test]
    fn what_is_said_twice_is_said_once_and_known_rows_are_left() {
        let rows = vec![
            row(&[(1, 1.0), (2, -1.0)]),
            row(&[(1, 3.0), (2, -3.0)]),
            row(&[(8, 1.0), (9, -1.0)]),
        ];
        let reduced = reduce(rows, |_| false, |key| key.0 > 7);
        assert_eq!(reduced.others.len(), 1);
        assert_eq!(reduced.known.len(), 1);
    }
}
