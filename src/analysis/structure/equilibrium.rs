//! Displacements, gaps and contact forces in equilibrium, and the loads they answer to.
//!
//! All of it is linear for given contact statuses: states and changes of states are added up part
//! by part.

use crate::analysis::zone::packed;
use crate::substructure::Trailing;
use serde::{Deserialize, Serialize};

/// A load on zone and contact freedoms, and what its elimination leaves: the first half of its
/// solve, the same for all contact statuses.
///
/// Eliminated piece by piece it is not what eliminating it at once gives, to the last bit:
/// checkpoints hold both.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EliminatedLoad {
    /// The load on zone and contact freedoms.
    #[serde(with = "packed::trailing")]
    pub load: Trailing,
    /// What [`crate::substructure::Substructure::recover`] needs of it.
    #[serde(with = "packed::trailing")]
    pub eliminated: Trailing,
    /// Force of each pair if all were tied without gap.
    pub forces: Vec<f64>,
}

impl EliminatedLoad {
    /// No load; `like` has the sizes.
    pub fn none(like: &Trailing, n_pairs: usize) -> Self {
        let zeros = Trailing::zeros(like.zone.len(), like.contact.len());
        EliminatedLoad {
            load: zeros.clone(),
            eliminated: zeros,
            forces: vec![0.0; n_pairs],
        }
    }

    /// Whether both loads are of structures with the same freedoms and pairs.
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

    /// `self += factor * other`.
    pub fn add(&mut self, factor: f64, other: &EliminatedLoad) {
        for (own, other) in self.parts_mut().into_iter().zip(other.parts()) {
            combine(own, other, |a, b| a + factor * b);
        }
    }

    /// `self *= factor`.
    pub fn scale(&mut self, factor: f64) {
        for values in self.parts_mut() {
            values.iter_mut().for_each(|value| *value *= factor);
        }
    }
}

/// Displacements, gaps and contact forces in equilibrium with a load point and initial loads, for
/// the contact statuses in the tableau; or a change of such.
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
    /// Nothing moves and nothing acts; `like` has the sizes.
    pub fn none(like: &Trailing, n_pairs: usize) -> Self {
        Equilibrium {
            initial: EliminatedLoad::none(like, n_pairs),
            u: Trailing::zeros(like.zone.len(), like.contact.len()),
            gap: vec![0.0; n_pairs],
            force: vec![0.0; n_pairs],
        }
    }

    /// Takes over the values of another one of the same sizes.
    pub fn copy_from(&mut self, other: &Equilibrium) {
        self.combine_with(other, |_, b| b);
    }

    /// `self += factor * other`.
    pub fn add(&mut self, factor: f64, other: &Equilibrium) {
        self.combine_with(other, |a, b| a + factor * b);
    }

    /// `self = other + factor * self`.
    pub fn scale_and_add(&mut self, factor: f64, other: &Equilibrium) {
        self.combine_with(other, |a, b| b + factor * a);
    }

    /// `self = from + share * (self - from)`.
    pub fn rescale(&mut self, from: &Equilibrium, share: f64) {
        self.combine_with(from, |a, b| b + share * (a - b));
    }

    /// Every value becomes what `of` makes of it and of the other's.
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
