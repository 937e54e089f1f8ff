//! Compact forms of what checkpoints hold much of: sets of numbers as runs, vectors that are mostly
//! zero, histories of points most of which have none. Unpacked they are the same bits.

use crate::material::PlasticState;
use crate::substructure::Trailing;
use serde::{Deserialize, Serialize};

/// Ascending numbers as runs: how many are left out, how many follow.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(super) struct Ascending(Vec<(u32, u32)>);

impl Ascending {
    pub(super) fn new(numbers: impl IntoIterator<Item = usize>) -> Self {
        let mut runs: Vec<(u32, u32)> = Vec::new();
        let mut end = 0;
        for number in numbers {
            match runs.last_mut() {
                Some((_, length)) if number == end => *length += 1,
                _ => runs.push(((number - end) as u32, 1)),
            }
            end = number + 1;
        }
        Ascending(runs)
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = usize> + '_ {
        let mut end = 0usize;
        self.0.iter().flat_map(move |&(gap, length)| {
            let begin = end + gap as usize;
            end = begin + length as usize;
            begin..end
        })
    }

    pub(super) fn to_vec(&self) -> Vec<usize> {
        self.iter().collect()
    }

    pub(super) fn len(&self) -> usize {
        self.0.iter().map(|&(_, length)| length as usize).sum()
    }

    /// Whether all numbers are below `end`.
    pub(super) fn within(&self, end: usize) -> bool {
        let last: usize = self.0.iter().map(|&(a, b)| a as usize + b as usize).sum();
        last <= end
    }
}

/// Items at some of the places of a list; the others are as the list's owner knows.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
struct Sparse<T> {
    places: Ascending,
    values: Vec<T>,
}

impl<T: Copy> Sparse<T> {
    fn new<'a>(items: impl Iterator<Item = &'a T> + Clone, kept: impl Fn(&T) -> bool) -> Self
    where
        T: 'a,
    {
        let numbered = items.clone().enumerate();
        Sparse {
            places: Ascending::new(numbered.filter(|(_, item)| kept(item)).map(|(i, _)| i)),
            values: items.filter(|item| kept(item)).copied().collect(),
        }
    }

    /// False where it is of a list of another length.
    fn unpack(&self, out: &mut [T]) -> bool {
        if self.places.len() != self.values.len() || !self.places.within(out.len()) {
            return false;
        }
        for (place, value) in self.places.iter().zip(&self.values) {
            out[place] = *value;
        }
        true
    }
}

/// A vector on zone and contact freedoms that is zero where nothing has flowed.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct SparseTrailing(Sparse<f64>);

impl SparseTrailing {
    pub(super) fn new(vector: &Trailing) -> Self {
        // Minus zero is kept: its bits are not those of zero.
        SparseTrailing(Sparse::new(
            vector.zone.iter().chain(&vector.contact),
            |v| v.to_bits() != 0,
        ))
    }

    /// On return `out`, all zeros before, holds the vector; false where it is of another size.
    pub(super) fn unpack(&self, out: &mut Trailing) -> bool {
        let n_zone = out.zone.len();
        let mut all: Vec<f64> = out.iter().copied().collect();
        let fits = self.0.unpack(&mut all);
        out.zone.copy_from_slice(&all[..n_zone]);
        out.contact.copy_from_slice(&all[n_zone..]);
        fits
    }
}

/// The history of the points that have one.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct SparseHistory(Sparse<PlasticState>);

impl SparseHistory {
    pub(super) fn new(history: &[PlasticState]) -> Self {
        SparseHistory(Sparse::new(history.iter(), |state| {
            *state != PlasticState::default()
        }))
    }

    /// On return `out` holds the history of all points; false where it is of another number of
    /// points.
    pub(super) fn unpack(&self, out: &mut [PlasticState]) -> bool {
        out.fill(PlasticState::default());
        self.0.unpack(out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn sets_and_vectors_come_back_as_they_were(marks in prop::collection::vec(any::<bool>(), 0..200)) {
            let numbers: Vec<usize> = (0..marks.len()).filter(|&i| marks[i]).collect();
            let packed = Ascending::new(numbers.iter().copied());
            prop_assert_eq!(packed.to_vec(), numbers.clone());
            prop_assert_eq!(packed.len(), numbers.len());
            let end = numbers.last().map_or(0, |last| last + 1);
            prop_assert!(packed.within(end));
            prop_assert!(end == 0 || !packed.within(end - 1));

            let value = |i: usize| if marks[i] { -1.5 * i as f64 } else { 0.0 };
            let half = marks.len() / 2;
            let vector = Trailing {
                zone: (0..half).map(value).collect(),
                contact: (half..marks.len()).map(value).collect(),
            };
            let mut back = Trailing::zeros(half, marks.len() - half);
            prop_assert!(SparseTrailing::new(&vector).unpack(&mut back));
            let bits = |v: &Trailing| v.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            prop_assert_eq!(bits(&back), bits(&vector));
            if end > 0 {
                let mut short = vec![PlasticState::default(); end - 1];
                let mut history = vec![PlasticState::default(); marks.len()];
                for &i in &numbers {
                    history[i].equivalent = 1.0 + i as f64;
                }
                let packed = SparseHistory::new(&history);
                prop_assert!(!packed.unpack(&mut short));
                let mut whole = vec![PlasticState { equivalent: 9.0, ..PlasticState::default() }; marks.len()];
                prop_assert!(packed.unpack(&mut whole));
                prop_assert_eq!(whole, history);
            }
        }
    }
}
