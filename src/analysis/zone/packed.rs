//! Compact forms of data that fill much of a checkpoint: sets of numbers as runs, vectors that are
//! mostly zero, histories of points most of which have none. Unpacking restores every bit.

use serde::{Deserialize, Serialize};

/// Ascending numbers as runs. A run is the count of numbers left out, and the count of numbers that
/// follow.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(in crate::analysis) struct Ascending(Vec<(u32, u32)>);

impl Ascending {
    pub(in crate::analysis) fn new(numbers: impl IntoIterator<Item = usize>) -> Self {
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

    pub(in crate::analysis) fn iter(&self) -> impl Iterator<Item = usize> + '_ {
        let mut end = 0usize;
        self.0.iter().flat_map(move |&(gap, length)| {
            let begin = end + gap as usize;
            end = begin + length as usize;
            begin..end
        })
    }

    pub(in crate::analysis) fn to_vec(&self) -> Vec<usize> {
        self.iter().collect()
    }

    pub(in crate::analysis) fn len(&self) -> usize {
        self.0.iter().map(|&(_, length)| length as usize).sum()
    }

    /// Whether all numbers are less than `end`.
    pub(in crate::analysis) fn within(&self, end: usize) -> bool {
        let last: usize = self.0.iter().map(|&(a, b)| a as usize + b as usize).sum();
        last <= end
    }
}

/// Items at some places of a list. At all other places, the list has a default value, which is not
/// stored.
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

    /// Writes the items to their places in `out`; false if they do not fit the length of `out`.
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

/// Ascending numbers in compact form, for `#[serde(with)]`.
pub(in crate::analysis) mod ascending {
    use super::Ascending;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};
    use std::sync::Arc;

    pub(in crate::analysis) fn serialize<S: Serializer>(
        numbers: &Arc<[usize]>,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        Ascending::new(numbers.iter().copied()).serialize(serializer)
    }

    pub(in crate::analysis) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Arc<[usize]>, D::Error> {
        Ok(Ascending::deserialize(deserializer)?.iter().collect())
    }
}

/// A vector on zone and contact freedoms that is zero where nothing has yielded, for
/// `#[serde(with)]`.
pub(in crate::analysis) mod trailing {
    use super::Sparse;
    use crate::substructure::Trailing;
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

    pub(in crate::analysis) fn serialize<S: Serializer>(
        vector: &Trailing,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        // Minus zero is stored: its bits differ from zero's.
        let not_zero = |value: &f64| value.to_bits() != 0;
        let values = Sparse::new(vector.zone.iter().chain(&vector.contact), not_zero);
        (vector.zone.len(), vector.contact.len(), values).serialize(serializer)
    }

    pub(in crate::analysis) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Trailing, D::Error> {
        let (n_zone, n_contact, values) = <(usize, usize, Sparse<f64>)>::deserialize(deserializer)?;
        let mut zone = vec![0.0; n_zone + n_contact];
        if !values.unpack(&mut zone) {
            return Err(D::Error::custom("a vector of another size"));
        }
        let contact = zone.split_off(n_zone);
        Ok(Trailing { zone, contact })
    }
}

/// The history of points, most of which have none, for `#[serde(with)]`.
pub(in crate::analysis) mod history {
    use super::Sparse;
    use crate::material::PlasticState;
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

    pub(in crate::analysis) fn serialize<S: Serializer>(
        history: &[PlasticState<6>],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        let has_one = |state: &PlasticState<6>| *state != PlasticState::default();
        (history.len(), Sparse::new(history.iter(), has_one)).serialize(serializer)
    }

    pub(in crate::analysis) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vec<PlasticState<6>>, D::Error> {
        let (n, states) = <(usize, Sparse<PlasticState<6>>)>::deserialize(deserializer)?;
        let mut history = vec![PlasticState::default(); n];
        if !states.unpack(&mut history) {
            return Err(D::Error::custom("a history of another number of points"));
        }
        Ok(history)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::PlasticState;
    use crate::substructure::Trailing;
    use proptest::prelude::*;

    #[derive(Serialize, Deserialize)]
    struct Held {
        #[serde(with = "trailing")]
        vector: Trailing,
        #[serde(with = "history")]
        history: Vec<PlasticState<6>>,
    }

    proptest! {
        #[test]
        fn sets_and_vectors_come_back_as_they_were(
            marks in prop::collection::vec(any::<bool>(), 0..200),
        ) {
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
            let mut history = vec![PlasticState::default(); marks.len()];
            for &i in &numbers {
                history[i].equivalent = 1.0 + i as f64;
            }
            let held = Held { vector, history };
            let bytes = postcard::to_stdvec(&held).unwrap();
            let back: Held = postcard::from_bytes(&bytes).unwrap();
            let bits = |v: &Trailing| v.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            prop_assert_eq!(bits(&back.vector), bits(&held.vector));
            prop_assert_eq!(back.vector.zone.len(), half);
            prop_assert_eq!(back.history, held.history);
            // A vector that holds more places than its length allows is refused.
            if end > 0 {
                let packed = Sparse::new(marks.iter(), |mark| *mark);
                let short = postcard::to_stdvec(&(end - 1, 0usize, packed.places)).unwrap();
                let mut short = short;
                short.extend(postcard::to_stdvec(&vec![1.0; numbers.len()]).unwrap());
                let mut reader = postcard::Deserializer::from_bytes(&short);
                prop_assert!(trailing::deserialize(&mut reader).is_err());
            }
        }
    }
}
