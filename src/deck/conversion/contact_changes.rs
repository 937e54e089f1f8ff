//! Contact pairs that are active in some steps only.
//!
//! The surfaces of an inactive pair are kept apart by a gap load as large as the diagonal of the
//! mesh, which is more than the bodies can move. A step that switches the pair applies or removes
//! this gap gradually over its time.

use super::super::Deck;
use super::super::bodies::unsupported;
use super::super::data::{ContactChange, ContactPair};
use super::super::series::Series;
use super::super::source::LinePlace;
use super::contact::ScenePairs;
use super::draft::Draft;
use crate::error::Result;
use crate::scene::{Contact, Load};

const KEYWORD: &str = "MODEL CHANGE";

impl ScenePairs {
    /// Adds a gap load for each pair that is switched.
    ///
    /// # Errors
    /// `Input` for pairs that are not defined; `Unsupported` if both surfaces belong to other pairs
    /// too, because the gap would then act on all of these pairs.
    pub(super) fn add_changes(&self, draft: &mut Draft) -> Result<()> {
        let deck = draft.deck;
        let pairs = &deck.properties.contacts;
        let mut changed: Vec<Option<(Series, LinePlace)>> = vec![None; pairs.len()];
        let apart = deck.mesh.diagonal();
        let mut time = 0.0;
        for (number, step) in deck.program.steps.iter().enumerate() {
            let end = time + step.period;
            for change in &step.contact_changes {
                let is_it = |pair: &ContactPair| pair.is_of(&change.slave, &change.master);
                let Some(index) = pairs.iter().position(is_it) else {
                    return Err(no_such_pair(deck, change));
                };
                let value = if change.is_on { 0.0 } else { apart };
                let at_first = if number == 0 { value } else { 0.0 };
                let new = || (Series::starting(at_first), change.place);
                let (series, place) = changed[index].get_or_insert_with(new);
                *place = change.place;
                if number > 0 {
                    series.stay(time);
                    series.push(end, value);
                }
                let how = match change.is_on {
                    true => "the surfaces are brought together over the step",
                    false if number == 0 => "the surfaces begin apart",
                    false => "the surfaces are taken apart over the step",
                };
                draft.remark(change.place, KEYWORD, how);
            }
            time = end;
        }
        for (index, changed) in changed.into_iter().enumerate() {
            let Some((series, place)) = changed.filter(|(series, _)| !series.is_zero()) else {
                continue;
            };
            let load = Load {
                on: self.own_surface(index).ok_or_else(|| shared(deck, place))?,
                gap: Some(series.largest().into()),
                ..Load::default()
            };
            draft.add_load("gap", load, series, place);
        }
        Ok(())
    }

    /// A surface of a contact pair that belongs to no other pair.
    fn own_surface(&self, index: usize) -> Option<String> {
        let has = |contact: &Contact, name: &str| contact.first == name || contact.second == name;
        let (before, rest) = self.contacts.split_at(index);
        let (contact, after) = rest.split_first()?;
        let others = || before.iter().chain(after);
        let mut own = [&contact.first, &contact.second].into_iter();
        let own = own.find(|name| !others().any(|other| has(other, name)));
        own.cloned()
    }
}

fn shared(deck: &Deck, place: LinePlace) -> crate::Error {
    let message = "both surfaces belong to other contact pairs too, which would be switched with \
                   it; define a surface for this pair alone";
    unsupported(deck.error(place, KEYWORD, message))
}

fn no_such_pair(deck: &Deck, change: &ContactChange) -> crate::Error {
    let message = format!(
        "there is no *CONTACT PAIR with the slave {} and the master {}",
        change.slave, change.master
    );
    deck.error(change.place, KEYWORD, message)
}
