//! Contact pairs and ties of a deck as those of the scene.

use super::super::data::{Account, Adjust, ContactPair};
use super::super::node_slaves::NodeSlaves;
use super::super::sets::What;
use super::super::source::LinePlace;
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
            self.deck.surface(&pair.master, at)?;
            let (first, nodes) = match self.deck.node_slaves(pair)? {
                Some(slaves) => self.around(pair, slaves, account),
                None => {
                    self.deck.surface(&pair.slave, at)?;
                    (self.geometry.surface_name(&pair.slave), None)
                }
            };
            let mut contact = Contact {
                first,
                nodes,
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
        let clearances = properties.clearances.iter();
        let clearances = clearances.map(|c| (c.place, "CLEARANCE", [&c.slave, &c.master]));
        let resolved = properties.resolved.iter();
        let resolved = resolved.map(|r| (r.place, "CONTACT INTERFERENCE", [&r.slave, &r.master]));
        clearances
            .chain(resolved)
            .try_for_each(|of| self.require_pair(of))
    }

    /// Adds the faces around slave nodes as a surface, and the nodes as a set; returns both names.
    fn around(
        &mut self,
        pair: &ContactPair,
        slaves: NodeSlaves,
        account: &mut Account,
    ) -> (String, Option<String>) {
        let n = slaves.nodes.len();
        let text = format!(
            "the nodes of {} ({n}) touch alone, where they lie: they make up no whole faces of \
             one piece",
            pair.slave,
        );
        let list = &mut account.taken;
        Account::add(list, &self.deck.files, pair.place, "CONTACT PAIR", &text);
        let faces = format!("{}_faces", pair.slave);
        let nodes = format!("{}_nodes", pair.slave);
        (
            self.geometry.add_surface(&faces, slaves.faces),
            Some(self.geometry.add_nodes(&nodes, slaves.nodes)),
        )
    }

    /// Requires that a contact pair has the surfaces that a line names.
    ///
    /// # Errors
    /// `Input`, at the line.
    fn require_pair(&self, (place, keyword, names): (LinePlace, &str, [&String; 2])) -> Result<()> {
        let mut pairs = self.deck.properties.contacts.iter();
        let is_it = |pair: &ContactPair| {
            let own = [&pair.slave, &pair.master].into_iter().zip(names);
            own.into_iter().all(|(a, b)| a.eq_ignore_ascii_case(b))
        };
        if pairs.any(is_it) {
            return Ok(());
        }
        let message = format!(
            "no *CONTACT PAIR has {} as its slave surface and {} as its master surface: name both \
             as in a *CONTACT PAIR",
            names[0], names[1]
        );
        Err(self.deck.error(place, keyword, message))
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
