//! Pairs of nodes that an earlier contact already has: on an edge that two contacts share, or if
//! two contacts name the same surfaces in opposite order.

use super::found::Found;
use super::{Pair, held};
use crate::error::{Error, Result};
use crate::mesh::{Mesh, Surface};
use crate::scene::Contact;
use std::collections::BTreeMap;

/// Numbers of the pairs of two nodes that face each other, by these nodes in ascending order.
#[derive(Default)]
pub(super) struct Repeated {
    pair_of: BTreeMap<[usize; 2], usize>,
}

fn nodes(pair: &Pair) -> Option<[usize; 2]> {
    let faced = pair.faced()?;
    Some([pair.slave.min(faced), pair.slave.max(faced)])
}

impl Repeated {
    /// Adds the pairs from `start` on.
    pub(super) fn add(&mut self, pairs: &[Pair], start: usize) {
        let own = pairs.iter().enumerate().skip(start);
        let own = own.filter_map(|(number, pair)| Some((nodes(pair)?, number)));
        self.pair_of.extend(own);
    }

    /// Moves pairs that an earlier contact already has to [`Found::repeated`]: two conditions on
    /// the same two nodes would leave open how they share the force. Pairs of a contact that
    /// repeats an earlier one with the same slaves are kept, since that contact is refused.
    pub(super) fn take_from(
        &self,
        found: &mut Found,
        earlier: &[Pair],
        is_same: impl Fn(usize) -> bool,
    ) {
        let is_new = |pair: &Pair| {
            let number = nodes(pair).and_then(|nodes| self.pair_of.get(&nodes));
            let before = number.map(|&number| &earlier[number]);
            before.is_none_or(|other| other.slave == pair.slave && is_same(other.contact))
        };
        let (own, repeated) = std::mem::take(&mut found.pairs)
            .into_iter()
            .partition(is_new);
        (found.pairs, found.repeated) = (own, repeated);
    }

    /// Gives the area of repeated pairs to the earlier ones, unless the contacts state the same
    /// facets twice.
    ///
    /// # Errors
    /// Contacts of different stiffness.
    pub(super) fn share_areas(
        &self,
        repeated: &[Pair],
        earlier: &mut [Pair],
        (mesh, surfaces): (&Mesh, [&Surface; 2]),
        (contact, contacts): (&Contact, &[Contact]),
    ) -> Result<()> {
        for pair in repeated {
            let Some(&number) = nodes(pair).and_then(|nodes| self.pair_of.get(&nodes)) else {
                continue;
            };
            let other = &contacts[earlier[number].contact];
            if other.stiffness != contact.stiffness {
                return Err(Error::input(format!(
                    "nodes {} and {} are a pair of contact {}, too, which has another stiffness; \
                     give both contacts the same, or take the nodes out of one of them",
                    mesh.node_label(pair.slave),
                    mesh.node_label(pair.masters[0].0),
                    earlier[number].contact + 1
                )));
            }
            if !held::are_same(mesh, surfaces, other) {
                earlier[number].area += pair.area;
            }
        }
        Ok(())
    }
}
