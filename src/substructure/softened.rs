//! The structure with less stiffness in the zone, eliminated and recovered as the structure itself.

use super::groups::Groups;
use super::{Substructure, Trailing, tie};
use crate::contact::PairMatrix;
use crate::linalg::{ChangedFactor, ZonePart};
use crate::model::Model;

/// The condensed structure whose stiffness on zone and contact freedoms is `S - K`, `K` a sum over
/// elements, as that of a plastic tangent. Elements have no stiffness against rigid motions to
/// lose: floating bodies float as before.
pub(crate) struct Softened {
    factor: Box<dyn ChangedFactor>,
    n_pairs: usize,
    tied: Option<Groups>,
}

impl Softened {
    pub(super) fn new(factor: Box<dyn ChangedFactor>, n_pairs: usize) -> Self {
        Softened {
            factor,
            n_pairs,
            tied: None,
        }
    }

    /// Floating point operations of a factorisation, and of a solve.
    pub(crate) fn flops(&self) -> [f64; 2] {
        self.factor.flops()
    }

    /// Begins another stiffness: that of the structure.
    pub(crate) fn begin(&mut self) {
        self.factor.begin();
    }

    /// Takes a symmetric matrix off the stiffness, whose rows are these zone freedoms and, numbered
    /// on, contact freedoms.
    pub(crate) fn take_off(&mut self, places: &[u32], matrix: &[f64]) {
        self.factor.take_off(places, matrix);
    }

    /// Factors the stiffness: the contact matrix. `None` where the stiffness is not positive
    /// definite, also with all pairs closed.
    pub(crate) fn factor(&mut self, model: &Model, of: &Substructure) -> Option<PairMatrix> {
        if !self.factor.factor() {
            return None;
        }
        if self.n_pairs == 0 {
            return Some(PairMatrix::new(Vec::new()));
        }
        let stiffness = self.factor.contact_stiffness();
        let (tied, matrix) = tie(model, &of.partition, stiffness).ok()?;
        self.tied = Some(tied);
        Some(matrix)
    }

    /// As [`Substructure::eliminate`].
    pub(crate) fn eliminate(&self, load: &mut Trailing, forces: &mut [f64]) {
        self.factor
            .eliminate_zone(&mut load.zone, &mut load.contact);
        if let Some(tied) = &self.tied {
            tied.eliminate(&mut load.contact, forces);
        }
    }

    /// As [`Substructure::recover_part`].
    pub(crate) fn recover_part(&self, part: &ZonePart, load: &mut Trailing, slip: &[f64]) {
        if let Some(tied) = &self.tied {
            tied.recover(&mut load.contact, slip);
        }
        self.factor
            .recover_part(part, &mut load.zone, &load.contact);
    }
}
