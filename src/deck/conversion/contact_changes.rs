//! Contact pairs that are active in some steps only.
//!
//! The surfaces of an inactive pair are kept apart by more than the bodies may move: a load by a
//! gap as long as the model. A step that switches the pair applies or removes this gap gradually
//! over its time.

use super::super::bodies::unsupported;
use super::super::data::{Account, ContactChange, ContactPair};
use super::super::series::Series;
use super::super::source::LinePlace;
use super::Draft;
use crate::error::Result;
use crate::scene::{Contact, Load};
use crate::space::{difference, length};

const KEYWORD: &str = "MODEL CHANGE";

impl Draft<'_> {
    /// Adds a gap load for each pair that is switched.
    ///
    /// # Errors
    /// `Input` for pairs that are not defined; `Unsupported` if both surfaces belong to other pairs
    /// too, because the gap would then act on all of these pairs.
    pub(super) fn contact_changes(&mut self, account: &mut Account) -> Result<()> {
        let alike = |a: &str, b: &str| a.eq_ignore_ascii_case(b);
        let pairs = &self.deck.properties.contacts;
        let mut changed: Vec<Option<(Series, LinePlace)>> = vec![None; pairs.len()];
        let apart = self.length_of_model();
        let mut time = 0.0;
        for (number, step) in self.deck.program.steps.iter().enumerate() {
            let end = time + step.period;
            for change in &step.contact_changes {
                let is_it = |pair: &ContactPair| {
                    alike(&pair.slave, &change.slave) && alike(&pair.master, &change.master)
                };
                let Some(index) = pairs.iter().position(is_it) else {
                    return Err(self.no_such_pair(change));
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
                let list = &mut account.taken;
                Account::add(list, &self.deck.files, change.place, KEYWORD, how);
            }
            time = end;
        }
        for (index, changed) in changed.into_iter().enumerate() {
            let Some((series, place)) = changed.filter(|(series, _)| !series.is_zero()) else {
                continue;
            };
            let load = Load {
                on: self.own_surface(index, place)?,
                gap: Some(series.largest().into()),
                ..Load::default()
            };
            self.add_load("gap", load, series, place);
        }
        Ok(())
    }

    fn no_such_pair(&self, change: &ContactChange) -> crate::Error {
        let message = format!(
            "there is no *CONTACT PAIR with the slave {} and the master {}",
            change.slave, change.master
        );
        self.deck.error(change.place, KEYWORD, message)
    }

    /// A surface of a contact pair that belongs to no other pair.
    fn own_surface(&self, index: usize, place: LinePlace) -> Result<String> {
        let contact = &self.contacts[index];
        let has = |contact: &Contact, name: &str| contact.first == name || contact.second == name;
        let others = || {
            let all = self.contacts.iter().enumerate();
            all.filter(move |(k, _)| *k != index)
                .map(|(_, contact)| contact)
        };
        let own = [&contact.first, &contact.second];
        let own = own
            .into_iter()
            .find(|&name| !others().any(|other| has(other, name)));
        own.cloned().ok_or_else(|| {
            let message = "both surfaces belong to other contact pairs too, which would be \
                           switched with it; define a surface for this pair alone";
            unsupported(self.deck.error(place, KEYWORD, message))
        })
    }

    /// The diagonal of the bounding box of all nodes.
    fn length_of_model(&self) -> f64 {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for node in 0..self.deck.nodes.labels.len() {
            for (d, x) in self.deck.point(node).into_iter().enumerate() {
                low[d] = low[d].min(x);
                high[d] = high[d].max(x);
            }
        }
        length(difference(high, low))
    }
}
