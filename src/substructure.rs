//! The condensed structure for contact and plasticity: the only step from sparse to dense matrices.
//!
//! The stiffness is factored in the order `[ interior | zone | contact ]` and condensed. Contact
//! rows `s = B u_c <= delta` act on the contact freedoms. For the normal displacements `(u^1, u^2)`
//! of nodes that face each other the unknowns are `v = u^1` and the relative displacement
//! `s = u^2 - u^1 <= delta`, the paper's u_c^1 and (2.4). In these unknowns
//!
//! ```text
//!     [ S_vv  S_vs ] [ v ]   [ f_1 + f_2 ]       S_vv = sum of the bodies'
//!     [ S_sv  S_ss ] [ s ] = [ f_2 - r   ]       condensed stiffness (paper, eq. 3.8)
//! ```
//!
//! Eliminating `v` leaves `r = t - T s = q + T g` with the gap `g = delta - s` and `q = t - T
//! delta`. General rows, and bodies of which one is much stiffer, are handled in `rows`; rigid
//! motions of floating bodies are handled in `tied`.

mod groups;
mod rigid_slips;
mod rows;
mod sharing;
mod singular;
mod softened;
mod tied;
mod tied_stiffness;
mod trace;
mod trailing;

pub(crate) use rows::{RowEntries, Rows};
pub use sharing::sharing_factors;
pub(crate) use softened::Softened;
pub(crate) use tied::Tied;
pub use trailing::Trailing;

use crate::assembly::System;
use crate::contact::{PairBlock, PairMatrix, Tableau};
use crate::error::Result;
use crate::linalg::{self, Backend, Partition, Recovered, ZonePart};
use crate::memory;
use crate::model::{Model, Work};
use groups::{TiedGroups, tie};
use nalgebra::DMatrix;
use sharing::{Condensation, HeldFactor};
use singular::name_freedom;

/// The condensed structure, with the contact matrix of its pairs.
pub struct Substructure {
    /// Zone and contact freedoms of the model.
    pub partition: Partition,
    condensed: HeldFactor,
    /// Whether the factor was made for this structure, rather than taken over from an earlier run.
    is_new: bool,
    n_pairs: usize,
    tied: Option<TiedGroups>,
    contact_matrix: PairMatrix,
}

impl Substructure {
    /// Factors and condenses the stiffness with the given zone freedoms (ascending, none of them a
    /// contact freedom).
    ///
    /// # Errors
    /// A matrix that is not positive definite, with body, node and direction; backend limits.
    pub fn new(model: &Model, system: &System, zone: Vec<usize>, backend: Backend) -> Result<Self> {
        let mut partition = Partition {
            n: model.freedoms.n,
            zone,
            contact: model.rows.freedoms.clone(),
        };
        let shift = shift(model, system, &partition);
        let cost = ContactCost::of(model);
        cost.require()?;
        let Condensation {
            condensed,
            zone,
            is_new,
        } = sharing::condense(&system.stiffness, backend, &partition, &shift)
            .map_err(|e| name_freedom(e, model))?;
        partition.zone = zone;
        let n = model.pairs.len();
        let (tied, contact_matrix) = if n > 0 {
            // The check is repeated with the memory that the factor left.
            cost.require()?;
            let (tied, matrix) = tie(model, &partition, condensed.contact_stiffness())?;
            (Some(tied), matrix)
        } else {
            (None, PairMatrix::new(Vec::new()))
        };
        Ok(Substructure {
            partition,
            condensed,
            is_new,
            n_pairs: n,
            tied,
            contact_matrix,
        })
    }

    /// Changes the zone. Within the factored zone, freedoms are only selected (the backend may keep
    /// more of them than are given); for other freedoms the structure is condensed anew. Returns
    /// whether the structure was condensed anew.
    ///
    /// # Errors
    /// Errors of [`Substructure::new`].
    pub(crate) fn set_zone(
        &mut self,
        model: &Model,
        system: &System,
        zone: Vec<usize>,
        backend: Backend,
    ) -> Result<bool> {
        if let Some(kept) = self.condensed.choose_zone(&zone)? {
            self.partition.zone = kept;
            return Ok(false);
        }
        self.release()?;
        *self = Substructure::new(model, system, zone, backend)?;
        Ok(true)
    }

    /// Frees the memory of the factor before another one is made: two at once would double the peak
    /// of memory. A factor of one freedom of stiffness 1 takes its place.
    fn release(&mut self) -> Result<()> {
        let one = linalg::SymmetricCsc::new_csc((1, 1), vec![0, 1], vec![0], vec![1.0]);
        let partition = Partition {
            n: 1,
            ..Partition::default()
        };
        self.condensed =
            HeldFactor::alone(linalg::condense(Backend::Dense, &one, &partition, &[])?);
        Ok(())
    }

    /// Number of factorisations that this substructure took: zero if it took over the factor of an
    /// earlier run.
    pub fn factorizations(&self) -> usize {
        usize::from(self.is_new)
    }

    /// Returns a tableau of the contact matrix `T` with all pairs closed.
    pub fn tableau(&self) -> Tableau {
        Tableau::new(self.contact_matrix.clone())
    }

    /// The contact matrix `T` of the pairs, all pairs closed.
    pub(crate) fn pair_matrix(&self) -> &PairMatrix {
        &self.contact_matrix
    }

    /// Corrects forces on the pairs so that their work on each rigid motion of floating bodies is
    /// the known `work`.
    pub(crate) fn balance(&self, forces: &mut [f64], work: &[Work]) {
        if let Some(groups) = &self.tied {
            groups.balance(forces, |motion| work[motion]);
        }
    }

    /// Corrects forces so that they are in equilibrium on each floating body, as the forces of
    /// plastic strains are: they do no work on a rigid body mode.
    pub(crate) fn balance_in_bodies(&self, forces: &mut [f64]) {
        if let Some(groups) = &self.tied {
            groups.balance(forces, |_| Work::default());
        }
    }

    /// For each group that `asked_for` selects and that rigid motions of floating bodies move: the
    /// pairs of the group, and their displacements in the rigid motions (`pairs x motions`,
    /// orthonormal).
    pub(crate) fn rigid_slips(
        &self,
        asked_for: impl Fn(&[usize]) -> bool,
    ) -> Vec<(&[usize], DMatrix<f64>)> {
        let groups = self.tied.as_ref();
        groups.map_or(Vec::new(), |groups| groups.rigid_slips(asked_for))
    }

    /// Forces `T s` of relative displacements `s` of the pairs.
    pub(crate) fn slip_forces(&self, slip: &[f64]) -> Vec<f64> {
        match &self.tied {
            Some(tied) => {
                let mut forces = vec![0.0; self.n_pairs];
                let rest = tied.split_slip(slip).rest;
                self.contact_matrix
                    .add_product(rest.as_slice(), &mut forces);
                forces
            }
            None => Vec::new(),
        }
    }

    /// Splits the relative displacement `delta - gap` of the pairs into the part without rigid
    /// motions of floating bodies and the amplitude of each rigid motion. The rigid motions are
    /// split off before the difference is formed: however large the gaps through which a body
    /// falls, small deformations of the bodies keep their digits.
    pub(crate) fn split_slip(&self, delta: &[f64], gap: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let Some(tied) = &self.tied else {
            return (Vec::new(), Vec::new());
        };
        let [delta, gap] = [delta, gap].map(|values| tied.split_slip(values));
        let rest = delta.rest - gap.rest;
        let motions = delta.motions - gap.motions;
        (rest.as_slice().to_vec(), motions.as_slice().to_vec())
    }

    /// Returns a zero vector on zone and contact freedoms.
    pub fn zeros(&self) -> Trailing {
        Trailing::zeros(self.partition.zone.len(), self.partition.contact.len())
    }

    /// Operations and memory of the factorisation.
    pub fn cost(&self) -> linalg::Prediction {
        self.condensed.cost()
    }

    /// Lower bound of the condition of the factored matrix, scaled to a unit diagonal: the largest
    /// loss of a pivot to cancellation.
    ///
    /// # Source
    /// N. J. Higham, *Accuracy and Stability of Numerical Algorithms*, 2nd ed., section 10.3: with
    /// `a_jj = 1`, `1 / l_jj^2` is no more than a diagonal entry of the inverse.
    pub fn condition(&self) -> f64 {
        1.0 / self.condensed.weakest_pivot().ratio
    }

    /// Reduces a load on all freedoms to what does not depend on the choice of the zone.
    ///
    /// # Errors
    /// Failure of the backend's solve.
    pub fn reduce(&self, load: &[f64]) -> Result<Vec<f64>> {
        self.condensed.reduce_load(load)
    }

    /// Condenses a reduced load statically onto zone and contact freedoms.
    ///
    /// # Errors
    /// None for a load that this structure has reduced.
    pub fn condense(&self, reduced: &[f64]) -> Result<Trailing> {
        let mut out = self.zeros();
        self.condensed
            .condense_load(reduced, &mut out.zone, &mut out.contact)?;
        Ok(out)
    }

    /// Eliminates zone and tied contact freedoms. On entry `load` is a load; on return it holds the
    /// values that [`Substructure::recover`] needs, and `forces` (`n_pairs`) holds the forces `t`
    /// that the pairs would carry if tied without a gap.
    pub fn eliminate(&self, load: &mut Trailing, forces: &mut [f64]) {
        self.condensed
            .eliminate_zone(&mut load.zone, &mut load.contact);
        if let Some(tied) = &self.tied {
            tied.eliminate(&mut load.contact, forces);
        }
    }

    /// Recovers the displacements for relative displacements `slip = delta - g` of the pairs
    /// (paper's u^2 - u^1). On entry `load` holds the values that [`Substructure::eliminate`] left.
    pub fn recover(&self, load: &mut Trailing, slip: &[f64]) {
        self.recover_part(&ZonePart::default(), load, slip);
    }

    /// Recovers displacements as [`Substructure::recover`] does, but only in a part of the zone.
    pub fn recover_part(&self, part: &ZonePart, load: &mut Trailing, slip: &[f64]) {
        if let Some(tied) = &self.tied {
            tied.recover(&mut load.contact, slip);
        }
        self.condensed
            .recover_part(part, &mut load.zone, &load.contact);
    }

    /// The part of the zone that consists of the marked freedoms.
    pub fn part_of_zone(&self, marked: &[bool]) -> ZonePart {
        self.condensed.part_of_zone(marked)
    }

    /// Returns the structure with a stiffness that can be reduced in the zone; `None` if the
    /// backend cannot factor such a structure.
    pub(crate) fn softened(&self) -> Option<Softened> {
        Some(Softened::new(self.condensed.changed()?, self.n_pairs))
    }

    /// Estimated condition of the factored matrix ([`linalg::condition`]). Costs about six full
    /// solves and a factor of the condensed stiffness.
    ///
    /// # Errors
    /// Failure of the backend's solve.
    pub fn condition_estimate(&self, model: &Model, system: &System) -> Result<f64> {
        let shift = shift(model, system, &self.partition);
        linalg::condition(&*self.condensed, &system.stiffness, &self.partition, &shift)
    }

    /// Recovers the displacements of all freedoms from a reduced load and the displacements of zone
    /// and contact freedoms. Costs about half a full solve.
    ///
    /// # Errors
    /// Failure of the backend's solve.
    pub fn recover_all(&self, reduced: &[f64], u: &Trailing) -> Result<Vec<f64>> {
        self.condensed.recover_all(reduced, &u.zone, &u.contact)
    }

    /// Recovers the displacements of all freedoms without the rigid motions of floating bodies, and
    /// the amplitude of each rigid motion: strains of the former are free of the cancellation that
    /// strains of the sum suffer. `load` is on all freedoms and includes initial loads and contact
    /// forces; `reduced` are the external loads; `condensed` are the external and the initial loads
    /// on zone and contact freedoms; `slip` and `motions` are those of
    /// [`Substructure::split_slip`]. `beside` is as in [`linalg::recover_refined`].
    ///
    /// # Errors
    /// Failure of the backend's solve.
    pub(crate) fn recover_deformation(
        &self,
        system: &System,
        load: &[f64],
        reduced: &[f64],
        mut condensed: Trailing,
        (slip, mut motions): (Vec<f64>, Vec<f64>),
        beside: [f64; 2],
    ) -> Result<(Recovered, Vec<f64>)> {
        let mut forces = vec![0.0; self.n_pairs];
        self.eliminate(&mut condensed, &mut forces);
        if let Some(tied) = &self.tied {
            tied.split(&mut condensed.contact, &slip, &mut motions);
        }
        let Trailing { zone, contact } = &mut condensed;
        self.condensed.recover_zone(zone, contact);
        let recovered = linalg::recover_refined(
            &*self.condensed,
            &system.stiffness,
            system.norm,
            load,
            [reduced, zone, contact],
            &self.partition,
            beside,
        )?;
        Ok((recovered, motions))
    }

    /// Number of multiplications in two products with the weights by which leaders carry followers;
    /// the products combine the leaders and followers of the contact rows.
    pub fn tying_multiplications(&self) -> usize {
        self.tied.as_ref().map_or(0, TiedGroups::multiplications)
    }

    /// Bytes held by the dense contact matrices: `T`, its swept copy in the tableau, and factor and
    /// coupling of the tied structure.
    pub fn contact_bytes(&self) -> u64 {
        let tied = self.tied.as_ref().map_or(0, TiedGroups::n_entries);
        (size_of::<f64>() * (2 * self.contact_matrix.n_entries() + tied)) as u64
    }
}

/// Cost of the dense part of contact, known from the model alone. A group of pairs that are joined
/// by bodies, with `p` rows and `m` leaders, takes `m^3 / 3 + m^2 p + m p^2` operations once,
/// because no matrix of the method has zeros there.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize)]
pub struct ContactCost {
    /// Number of contact pairs.
    pub pairs: usize,
    /// Number of groups of pairs that share no body.
    pub groups: usize,
    /// Number of pairs of the largest group.
    pub largest_group: usize,
    /// Floating point operations of the factor, the coupling and the contact matrix of the tied
    /// pairs.
    pub flops: f64,
    /// Bytes at the peak, for the factor, the coupling and its transpose, and the contact matrix.
    pub memory_bytes: f64,
}

impl ContactCost {
    /// Predicts the cost of a model's contact.
    pub fn of(model: &Model) -> Self {
        let (rows, part) = (&model.rows.entries, &model.floating.part_of_contact);
        let mut sizes: Vec<usize> = Vec::new();
        let mut group_of = vec![0; part.len()];
        for (row, group) in rows
            .iter()
            .zip(groups::groups(rows, part, std::iter::empty()))
        {
            if group == sizes.len() {
                sizes.push(0);
            }
            sizes[group] += 1;
            row.iter().for_each(|&(i, _)| group_of[i] = group);
        }
        let mut freedoms = vec![0; sizes.len()];
        group_of.iter().for_each(|&group| freedoms[group] += 1);
        let (mut flops, mut entries) = (0.0, 0.0);
        for (&rows, &freedoms) in sizes.iter().zip(&freedoms) {
            let (p, m) = (rows as f64, (freedoms - rows) as f64);
            flops += m.powi(3) / 3.0 + m * m * p + m * p * p;
            entries += m * m + 2.0 * m * p + p * p;
        }
        ContactCost {
            pairs: model.pairs.len(),
            groups: sizes.len(),
            largest_group: sizes.iter().copied().max().unwrap_or(0),
            flops,
            memory_bytes: size_of::<f64>() as f64 * entries,
        }
    }

    /// Refuses a model whose contact matrices do not fit into the memory that is left.
    ///
    /// # Errors
    /// `Analysis` with the memory that is needed and the memory that is left.
    fn require(&self) -> Result<()> {
        let what = format!(
            "contact of {} pairs, {} of them joined by bodies (dense matrices: only fewer \
             pairs reduce them),",
            self.pairs, self.largest_group
        );
        memory::require(&what, self.memory_bytes)
    }
}

/// Shift of the diagonal on the contact freedoms: the stiffness's own diagonal on the freedoms of
/// bodies that supports do not hold, zero elsewhere. A rigid surface has no stiffness of its own
/// and gets the largest diagonal entry of all contact freedoms.
fn shift(model: &Model, system: &System, partition: &Partition) -> Vec<f64> {
    let own = |freedom: &usize| system.stiffness.diagonal(*freedom);
    let floats = &model.floating.of_contact;
    let of = |(freedom, floats): (&usize, &bool)| if *floats { own(freedom) } else { 0.0 };
    let mut shift: Vec<f64> = partition.contact.iter().zip(floats).map(of).collect();
    let rigid = model.rigid_contact();
    if rigid.contains(&true) {
        let largest = partition.contact.iter().map(own).fold(0.0, f64::max);
        let of_rigid = shift.iter_mut().zip(rigid).filter(|(_, rigid)| *rigid);
        of_rigid.for_each(|(shift, _)| *shift = largest);
    }
    shift
}
