//! The structure with less stiffness in the zone, with the elimination and recovery of the
//! structure itself.

use super::groups::{TiedGroups, tie};
use super::trailing::Trailing;
use crate::contact::PairMatrix;
use crate::linalg::{ChangedFactor, Partition, ZonePart};
use crate::model::Model;

/// Condensed structure whose stiffness on zone and contact freedoms is `S - K`, where `K` is a sum
/// over elements, such as the stiffness lost to plastic flow. `K` takes nothing from rigid motions,
/// so floating bodies keep their rigid motions.
pub(crate) struct Softened {
    factor: Box<dyn ChangedFactor>,
    n_pairs: usize,
    tied: Option<TiedGroups>,
}

impl Softened {
    pub(super) fn new(factor: Box<dyn ChangedFactor>, n_pairs: usize) -> Self {
        Softened {
            factor,
            n_pairs,
            tied: None,
        }
    }

    /// Floating point operations of one factorisation, and of one solve.
    pub(crate) fn flops(&self) -> [f64; 2] {
        self.factor.flops()
    }

    /// Begins a new stiffness, at first that of the unchanged structure.
    pub(crate) fn begin(&mut self) {
        self.factor.begin();
    }

    /// Subtracts a symmetric matrix from the stiffness. Its rows are zone freedoms, followed in the
    /// numbering by contact freedoms.
    pub(crate) fn take_off(&mut self, places: &[u32], matrix: &[f64]) {
        self.factor.take_off(places, matrix);
    }

    /// Factors the stiffness of a structure with the given partition and returns the contact
    /// matrix. `None` if the stiffness is not positive definite even with all pairs closed.
    pub(crate) fn factor(&mut self, model: &Model, of: &Partition) -> Option<PairMatrix> {
        if !self.factor.factor() {
            return None;
        }
        if self.n_pairs == 0 {
            return Some(PairMatrix::new(Vec::new()));
        }
        let stiffness = self.factor.contact_stiffness();
        let (tied, matrix) = tie(model, of, stiffness).ok()?;
        self.tied = Some(tied);
        Some(matrix)
    }

    /// Eliminates zone and tied contact freedoms as [`super::Substructure::eliminate`] does.
    pub(crate) fn eliminate(&self, load: &mut Trailing, forces: &mut [f64]) {
        self.factor
            .eliminate_zone(&mut load.zone, &mut load.contact);
        if let Some(tied) = &self.tied {
            tied.eliminate(&mut load.contact, forces);
        }
    }

    /// Recovers displacements in a part of the zone as [`super::Substructure::recover_part`] does.
    pub(crate) fn recover_part(&self, part: &ZonePart, load: &mut Trailing, slip: &[f64]) {
        if let Some(tied) = &self.tied {
            tied.recover(&mut load.contact, slip);
        }
        self.factor
            .recover_part(part, &mut load.zone, &load.contact);
    }
}
