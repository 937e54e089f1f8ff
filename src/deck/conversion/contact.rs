//! Contact pairs and ties of a deck as those of the scene.

use super::super::data::{Account, Adjust, ContactPair};
use super::super::sets::What;
use super::Draft;
use crate::error::Result;
use crate::number::exact;
use crate::scene::{Contact, SlaveSide, Tie};

impl Draft<'_> {
    /// Adds the contact pairs, with the slave surface first. A clearance becomes a gap, or an
    /// interference if it is negative.
    pub(super) fn contacts(&mut self, account: &mut Account) -> Result<()> {
        let properties = &self.deck.properties;
        for pair in &properties.contacts {
            let at = (pair.place, "CONTACT PAIR");
            let Some(interaction) = properties.interactions.get(&pair.interaction) else {
                let message = format!("there is no *SURFACE INTERACTION {}", pair.interaction);
                return Err(self.deck.error(at.0, at.1, message));
            };
            for name in [&pair.slave, &pair.master] {
                self.deck.surface(name, at)?;
            }
            let mut contact = Contact {
                first: self.geometry.surface_name(&pair.slave),
                second: self.geometry.surface_name(&pair.master),
                stiffness: interaction.stiffness,
                ..Contact::default()
            };
            if let Some(Adjust::Nodes(set)) = &pair.adjust {
                self.deck.indices(What::Nodes, set, at)?;
            }
            contact.gap = pair.is_closed.then(|| 0.0.into());
            contact.held = true;
            self.clear(pair, &mut contact, account);
            contact.overlap = contact.gap.is_none();
            let key = format!("contact.{}", self.contacts.len());
            self.places.insert(key, self.deck.files.show(pair.place));
            self.contacts.push(contact);
        }
        self.require_pairs_of_clearances()
    }

    /// Requires a contact pair for each clearance.
    ///
    /// # Errors
    /// `Input`, at the clearance.
    fn require_pairs_of_clearances(&self) -> Result<()> {
        let properties = &self.deck.properties;
        let alike = |a: &str, b: &str| a.eq_ignore_ascii_case(b);
        for clearance in &properties.clearances {
            let mut pairs = properties.contacts.iter();
            let is_there = |pair: &ContactPair| {
                alike(&pair.slave, &clearance.slave) && alike(&pair.master, &clearance.master)
            };
            if !pairs.any(is_there) {
                let message = format!(
                    "no *CONTACT PAIR has {} as its slave surface and {} as its master surface: \
                     name both as in a *CONTACT PAIR",
                    clearance.slave, clearance.master
                );
                return Err(self.deck.error(clearance.place, "CLEARANCE", message));
            }
        }
        Ok(())
    }

    /// Adds the ties, with the deck's slave surface first and fixed as the slave.
    pub(super) fn ties(&mut self) -> Result<()> {
        for tie in &self.deck.properties.ties {
            for name in [&tie.slave, &tie.master] {
                self.deck.surface(name, (tie.place, "TIE"))?;
            }
            let key = format!("tie.{}", self.ties.len());
            self.places.insert(key, self.deck.files.show(tie.place));
            self.ties.push(Tie {
                first: self.geometry.surface_name(&tie.slave),
                second: self.geometry.surface_name(&tie.master),
                slave: SlaveSide::First,
                distance: tie.tolerance,
            });
        }
        Ok(())
    }

    fn clear(&self, pair: &ContactPair, contact: &mut Contact, account: &mut Account) {
        let alike = |a: &str, b: &str| a.eq_ignore_ascii_case(b);
        let clearances = self.deck.properties.clearances.iter();
        for clearance in
            clearances.filter(|c| alike(&c.slave, &pair.slave) && alike(&c.master, &pair.master))
        {
            contact.gap = Some(clearance.value.max(0.0).into());
            contact.interference = (-clearance.value).max(0.0).into();
            let text = match clearance.value < 0.0 {
                true => format!("an interference of {}", exact(-clearance.value)),
                false => format!("a gap of {} everywhere", exact(clearance.value)),
            };
            let list = &mut account.taken;
            Account::add(list, &self.deck.files, clearance.place, "CLEARANCE", &text);
        }
    }
}
