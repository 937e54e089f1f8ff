//! Displacements, gaps and contact forces in equilibrium, and the loads that they balance.
//!
//! For given contact statuses these quantities are linear in the loads: states and changes of
//! states are added part by part.

use crate::analysis::zone::packed;
use crate::substructure::Trailing;
use serde::{Deserialize, Serialize};

/// A load on zone and contact freedoms, with the result of its elimination: the first half of a
/// trailing solve, which does not depend on contact statuses.
///
/// Loads eliminated one by one and then added differ in the last bits from their sum eliminated at
/// once. Checkpoints therefore hold both the load and the result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EliminatedLoad {
    /// The load on zone and contact freedoms.
    #[serde(with = "packed::trailing")]
    pub load: Trailing,
    /// The eliminated load, from which [`crate::substructure::Substructure::recover`] finds
    /// displacements.
    #[serde(with = "packed::trailing")]
    pub eliminated: Trailing,
    /// Force of each pair if all pairs were tied without gap.
    pub forces: Vec<f64>,
}

impl EliminatedLoad {
    /// No load, with the sizes of `like`.
    pub fn none(like: &Trailing, n_pairs: usize) -> Self {
        let zeros = Trailing::zeros(like.zone.len(), like.contact.len());
        EliminatedLoad {
            load: zeros.clone(),
            eliminated: zeros,
            forces: vec![0.0; n_pairs],
        }
    }

    /// Whether both loads have equal numbers of freedoms and pairs.
    pub fn is_like(&self, other: &EliminatedLoad) -> bool {
        let mut parts = self.parts().into_iter().zip(other.parts());
        parts.all(|(own, other)| own.len() == other.len())
    }

    fn parts(&self) -> [&[f64]; 5] {
        let (load, rest) = (&self.load, &self.eliminated);
        [
            &load.zone,
            &load.contact,
            &rest.zone,
            &rest.contact,
            &self.forces,
        ]
    }

    fn parts_mut(&mut self) -> [&mut [f64]; 5] {
        let (load, rest) = (&mut self.load, &mut self.eliminated);
        [
            &mut load.zone,
            &mut load.contact,
            &mut rest.zone,
            &mut rest.contact,
            &mut self.forces,
        ]
    }

    /// Computes `self += factor * other`.
    pub fn add(&mut self, factor: f64, other: &EliminatedLoad) {
        for (own, other) in self.parts_mut().into_iter().zip(other.parts()) {
            combine(own, other, |a, b| a + factor * b);
        }
    }

    /// Computes `self *= factor`.
    pub fn scale(&mut self, factor: f64) {
        for values in self.parts_mut() {
            values.iter_mut().for_each(|value| *value *= factor);
        }
    }
}

/// Displacements, gaps and contact forces in equilibrium with a load point and initial loads, for
/// the contact statuses in the tableau; or a change of these.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Equilibrium {
    /// Initial loads J of the plastic strains.
    pub initial: EliminatedLoad,
    /// Displacements of zone and contact freedoms.
    pub u: Trailing,
    /// Gap of each pair.
    pub gap: Vec<f64>,
    /// Contact force of each pair, compressive positive.
    pub force: Vec<f64>,
}

impl Equilibrium {
    /// No displacements, gaps or forces, with the sizes of `like`.
    pub fn none(like: &Trailing, n_pairs: usize) -> Self {
        Equilibrium {
            initial: EliminatedLoad::none(like, n_pairs),
            u: Trailing::zeros(like.zone.len(), like.contact.len()),
            gap: vec![0.0; n_pairs],
            force: vec![0.0; n_pairs],
        }
    }

    /// Takes over the values of another equilibrium of the same sizes.
    pub fn copy_from(&mut self, other: &Equilibrium) {
        self.combine_with(other, |_, b| b);
    }

    /// Computes `self += factor * other`.
    pub fn add(&mut self, factor: f64, other: &Equilibrium) {
        self.combine_with(other, |a, b| a + factor * b);
    }

    /// Computes `self = other + factor * self`.
    pub fn scale_and_add(&mut self, factor: f64, other: &Equilibrium) {
        self.combine_with(other, |a, b| b + factor * a);
    }

    /// Computes `self = from + share * (self - from)`.
    pub fn rescale(&mut self, from: &Equilibrium, share: f64) {
        self.combine_with(from, |a, b| b + share * (a - b));
    }

    /// Replaces each value by `of` of this value and the corresponding value of `other`.
    fn combine_with(&mut self, other: &Equilibrium, of: impl Fn(f64, f64) -> f64 + Copy) {
        let loads = self.initial.parts_mut().into_iter();
        for (own, other) in loads.zip(other.initial.parts()) {
            combine(own, other, of);
        }
        combine(&mut self.u.zone, &other.u.zone, of);
        combine(&mut self.u.contact, &other.u.contact, of);
        combine(&mut self.gap, &other.gap, of);
        combine(&mut self.force, &other.force, of);
    }
}

fn combine(own: &mut [f64], other: &[f64], of: impl Fn(f64, f64) -> f64) {
    for (a, b) in own.iter_mut().zip(other) {
        *a = of(*a, *b);
    }
}
