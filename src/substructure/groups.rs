//! The tied structure by groups of pairs: bodies that nothing joins with others are tied and solved
//! separately.
//!
//! Pairs belong to one group if their nodes are coupled by the condensed stiffness (as the nodes of
//! one body are) or by a rigid motion. A group of `p` pairs costs `p^3` operations once and `p^2`
//! stored numbers from then on, whatever other groups there are: the cost of many separate joints
//! is the sum over the joints.

use super::rows::{RowEntries, Rows};
use super::tied::{SplitSlip, Tied};
use super::trace::Trace;
use super::{PairBlock, PairMatrix};
use crate::classes::Classes;
use crate::error::Result;
use crate::linalg::{ContactStiffness, Partition};
use crate::model::{Model, RigidMotion, Work};
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeMap;
use std::sync::Arc;

/// All groups of tied pairs of a structure.
pub(super) struct TiedGroups {
    groups: Vec<TiedGroup>,
    n_pairs: usize,
    n_motions: usize,
}

/// One group of tied pairs, coupled by stiffness or by rigid motions.
struct TiedGroup {
    /// Numbers of the pairs of the group, ascending.
    pairs: Vec<usize>,
    /// Contact freedoms of the pairs, ascending.
    contact: Vec<usize>,
    /// Rigid motions of the model that move these pairs.
    motions: Vec<usize>,
    tied: Tied,
}

/// Contact rows from which groups are made. For each contact freedom: its number among the free
/// freedoms, the part it belongs to, and whether it is the motion of a rigid surface.
#[derive(Clone, Copy)]
pub(super) struct GroupedRows<'a> {
    pub rows: &'a [RowEntries],
    pub freedoms: &'a [usize],
    pub part: &'a [usize],
    pub rigid: &'a [bool],
}

impl TiedGroups {
    /// Builds the tied structures and the contact matrix from the condensed stiffness and the rigid
    /// motions of floating parts.
    ///
    /// # Errors
    /// Errors of [`Tied::new`].
    pub(super) fn new(
        stiffness: ContactStiffness,
        motions: &[RigidMotion],
        of: GroupedRows,
    ) -> Result<(Self, PairMatrix)> {
        let (n, n_contact) = (of.rows.len(), of.freedoms.len());
        let coupled = stiffness.blocks().map(|block| block.freedoms.as_slice());
        let group_of = groups(of.rows, of.part, coupled);
        let n_groups = group_of.iter().max().map_or(0, |last| last + 1);
        let mut pairs = vec![Vec::new(); n_groups];
        let mut group_of_freedom = vec![0; n_contact];
        for (k, &group) in group_of.iter().enumerate() {
            pairs[group].push(k);
            of.rows[k]
                .iter()
                .for_each(|&(i, _)| group_of_freedom[i] = group);
        }
        let mut place = vec![(0, 0); n_contact];
        let mut contact = vec![Vec::new(); n_groups];
        let mut group_of_part = BTreeMap::new();
        for (i, &group) in group_of_freedom.iter().enumerate() {
            place[i] = (group, contact[group].len());
            contact[group].push(i);
            group_of_part.insert(of.part[i], group);
        }
        let mut motions_of = vec![Vec::new(); n_groups];
        for (j, motion) in motions.iter().enumerate() {
            if let Some(&group) = group_of_part.get(&motion.part) {
                motions_of[group].push(j);
            }
        }
        let mut out = Vec::with_capacity(n_groups);
        let mut blocks = Vec::with_capacity(n_groups);
        let stiffness = stiffness.split(&place, n_groups).into_iter();
        let members = pairs.into_iter().zip(contact).zip(motions_of);
        for (stiffness, ((pairs, contact), of_group)) in stiffness.zip(members) {
            let own_part: Vec<usize> = contact.iter().map(|&i| of.part[i]).collect();
            let own_freedoms: Vec<usize> = contact.iter().map(|&i| of.freedoms[i]).collect();
            let traces = traces(motions, &of_group, &own_freedoms);
            let own_row = |&k: &usize| of.rows[k].iter().map(|&(i, b)| (place[i].1, b)).collect();
            let entries: Vec<RowEntries> = pairs.iter().map(own_row).collect();
            // Freedoms of rigid surfaces lead: each counts as stiff as the stiffest contact
            // freedom.
            let diagonals = (0..contact.len()).map(|i| stiffness.diagonal(i));
            let stiffest = diagonals.fold(0.0, f64::max);
            let diagonal = |i: usize| match of.rigid[contact[i]] {
                true => stiffest,
                false => stiffness.diagonal(i),
            };
            let rows = Rows::of_contact(entries, contact.len(), diagonal)?;
            let (tied, matrix) = Tied::new(&stiffness, rows, &traces, &own_part)?;
            blocks.push(PairBlock {
                pairs: pairs.clone(),
                matrix: Arc::new(matrix),
            });
            out.push(TiedGroup {
                pairs,
                contact,
                motions: of_group,
                tied,
            });
        }
        let groups = TiedGroups {
            groups: out,
            n_pairs: n,
            n_motions: motions.len(),
        };
        Ok((groups, PairMatrix::new(blocks)))
    }

    /// Eliminates each group as [`Tied::eliminate`] does. The unknowns that [`TiedGroups::recover`]
    /// needs are left in the places of the contact freedoms of each group.
    pub(super) fn eliminate(&self, contact: &mut [f64], forces: &mut [f64]) {
        if let [only] = self.groups.as_slice() {
            return only.tied.eliminate(contact, forces);
        }
        let mut own_forces = Vec::new();
        for group in &self.groups {
            let mut own = take(group, contact);
            own_forces.clear();
            own_forces.resize(group.pairs.len(), 0.0);
            group.tied.eliminate(&mut own, &mut own_forces);
            put(group, &own, contact);
            for (&k, &force) in group.pairs.iter().zip(&own_forces) {
                forces[k] = force;
            }
        }
    }

    /// Recovers the displacements of each group as [`Tied::recover`] does.
    pub(super) fn recover(&self, contact: &mut [f64], slip: &[f64]) {
        if let [only] = self.groups.as_slice() {
            return only.tied.recover(contact, slip);
        }
        for group in &self.groups {
            let mut own = take(group, contact);
            group.tied.recover(&mut own, &of_pairs(group, slip));
            put(group, &own, contact);
        }
    }

    /// Splits slips as [`Tied::split_slip`] does, with amplitudes of all rigid motions of the
    /// model.
    pub(super) fn split_slip(&self, slip: &[f64]) -> SplitSlip {
        let mut rest = DVector::zeros(self.n_pairs);
        let mut motions = DVector::zeros(self.n_motions);
        for group in &self.groups {
            let split = group.tied.split_slip(&of_pairs(group, slip));
            for (&k, &value) in group.pairs.iter().zip(split.rest.iter()) {
                rest[k] = value;
            }
            for (&j, &value) in group.motions.iter().zip(split.motions.iter()) {
                motions[j] += value;
            }
        }
        SplitSlip { rest, motions }
    }

    /// Splits displacements as [`Tied::split`] does. The displacements go to `contact`; the
    /// amplitudes of rigid motions are added to `motions`.
    pub(super) fn split(&self, contact: &mut [f64], slip: &[f64], motions: &mut [f64]) {
        for group in &self.groups {
            let own = take(group, contact);
            let split = group.tied.split(&own, &of_pairs(group, slip));
            put(group, &split.contact, contact);
            for (&j, &value) in group.motions.iter().zip(split.motions.iter()) {
                motions[j] += value;
            }
        }
    }

    /// For each group that `asked_for` selects and that rigid motions move: the pairs of the group,
    /// and their displacements in the rigid motions (`pairs x motions`, orthonormal).
    pub(super) fn rigid_slips(
        &self,
        asked_for: impl Fn(&[usize]) -> bool,
    ) -> Vec<(&[usize], DMatrix<f64>)> {
        let groups = self.groups.iter().filter(|group| asked_for(&group.pairs));
        groups
            .filter_map(|group| Some((group.pairs.as_slice(), group.tied.rigid_slips()?)))
            .collect()
    }

    /// Corrects forces on the pairs so that their work on each rigid motion of the model is the
    /// known `work`.
    pub(super) fn balance(&self, forces: &mut [f64], work: impl Fn(usize) -> Work) {
        for group in &self.groups {
            let work = |motion: usize| work(group.motions[motion]);
            group.tied.balance(&group.pairs, forces, work);
        }
    }

    /// Number of multiplications that combining leaders and followers took.
    pub(super) fn multiplications(&self) -> usize {
        let groups = self.groups.iter();
        groups.map(|group| group.tied.multiplications).sum()
    }

    /// Number of values that the tied structures hold.
    pub(super) fn n_entries(&self) -> usize {
        self.groups.iter().map(|group| group.tied.n_entries()).sum()
    }
}

fn take(group: &TiedGroup, contact: &[f64]) -> Vec<f64> {
    group.contact.iter().map(|&i| contact[i]).collect()
}

fn put(group: &TiedGroup, own: &[f64], contact: &mut [f64]) {
    for (&i, &value) in group.contact.iter().zip(own) {
        contact[i] = value;
    }
}

fn of_pairs(group: &TiedGroup, values: &[f64]) -> Vec<f64> {
    group.pairs.iter().map(|&k| values[k]).collect()
}

/// Restricts the rigid motions of a group to its contact freedoms.
fn traces(motions: &[RigidMotion], of_group: &[usize], freedoms: &[usize]) -> Vec<Trace> {
    let own = of_group.iter().enumerate();
    own.map(|(j, &motion)| {
        let values = freedoms.iter().map(|&f| motions[motion].at(f));
        Trace {
            part: motions[motion].part,
            values: DVector::from_iterator(freedoms.len(), values),
            of_motion: DVector::from_fn(of_group.len(), |i, _| f64::from(u8::from(i == j))),
        }
    })
    .collect()
}

/// Returns the group of each row; groups are numbered in the order of their first rows. Two rows
/// are in one group if they have freedoms of one part, or if a list of `coupled` contact freedoms
/// has some of both.
pub(super) fn groups<'a>(
    rows: &[RowEntries],
    part: &[usize],
    coupled: impl Iterator<Item = &'a [usize]>,
) -> Vec<usize> {
    let n = rows.len();
    let mut classes = Classes::new(n);
    let mut first_of_part = BTreeMap::new();
    let mut row_of = vec![0; part.len()];
    for (k, row) in rows.iter().enumerate() {
        for &(i, _) in row {
            classes.join(k, *first_of_part.entry(part[i]).or_insert(k));
            row_of[i] = k;
        }
    }
    for freedoms in coupled {
        for &freedom in freedoms {
            classes.join(row_of[freedom], row_of[freedoms[0]]);
        }
    }
    let mut number = vec![usize::MAX; n];
    let mut count = 0;
    (0..n)
        .map(|k| {
            let first = classes.first(k);
            if first == k {
                number[k] = count;
                count += 1;
            }
            number[first]
        })
        .collect()
}

/// Builds the tied structure of a condensed stiffness and its contact matrix.
pub(super) fn tie(
    model: &Model,
    partition: &Partition,
    stiffness: ContactStiffness,
) -> Result<(TiedGroups, PairMatrix)> {
    let contact = GroupedRows {
        rows: &model.rows.entries,
        freedoms: &partition.contact,
        part: &model.floating.part_of_contact,
        rigid: &model.rigid_contact(),
    };
    TiedGroups::new(stiffness, &model.floating.motions, contact)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_are_joined_by_parts_and_by_stiffness() {
        // Four pairs on six parts: 0 and 2 share part 5; the first nodes of 1 and 3 are coupled
        // although they belong to different parts.
        let part = [0, 1, 5, 3, 5, 2, 4, 6];
        let rows: Vec<RowEntries> = (0..4).map(|k| vec![(k, -1.0), (4 + k, 1.0)]).collect();
        assert_eq!(groups(&rows, &part, std::iter::empty()), [0, 1, 0, 2]);
        let coupled: [&[usize]; 2] = [&[1, 3], &[6]];
        assert_eq!(groups(&rows, &part, coupled.into_iter()), [0, 1, 0, 1]);
        assert!(groups(&[], &[], std::iter::empty()).is_empty());
    }
}
