//! Contact pairs and ties.

use super::super::data::{Account, ContactPair};
use super::super::facets::Face;
use super::Draft;
use crate::error::Result;
use crate::number::exact;
use crate::scene::{Contact, SlaveSide, Tie};
use crate::space::{difference, length};

impl Draft<'_> {
    /// The slave surface is the first one. A clearance is a gap, or an interference where it is
    /// negative.
    pub(super) fn contacts(&mut self, account: &mut Account) -> Result<()> {
        let properties = &self.deck.properties;
        for pair in &properties.contacts {
            let at = (pair.place, "CONTACT PAIR");
            let Some(interaction) = properties.interactions.get(&pair.interaction) else {
                let message = format!("there is no *SURFACE INTERACTION {}", pair.interaction);
                return Err(self.deck.error(at.0, at.1, message));
            };
            let [slave, master] = [&pair.slave, &pair.master].map(|s| self.deck.surface(s, at));
            let (slave, master) = (slave?, master?);
            let mut contact = Contact {
                first: self.geometry.surface_name(&pair.slave),
                second: self.geometry.surface_name(&pair.master),
                stiffness: interaction.stiffness,
                ..Contact::default()
            };
            if let Some(within) = pair.adjust {
                self.adjust(pair, within, [&slave, &master], &mut contact, account);
            }
            self.clear(pair, &mut contact, account);
            contact.overlap = contact.gap.is_none();
            let key = format!("contact.{}", self.contacts.len());
            self.places.insert(key, self.deck.files.show(pair.place));
            self.contacts.push(contact);
        }
        Ok(())
    }

    /// The slave surface is the first one, and stays it.
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

    /// Nodes within a distance of the other surface are meant to lie on it. Where all of them are,
    /// the gaps are zero; otherwise they stay what they are in the mesh.
    fn adjust(
        &self,
        pair: &ContactPair,
        within: f64,
        surfaces: [&[Face]; 2],
        contact: &mut Contact,
        account: &mut Account,
    ) {
        let [slave, master] = surfaces.map(|faces| self.nodes_of(faces));
        let point = |node: u32| self.deck.point(node as usize);
        let is_near = |node: &u32| {
            let mut others = master.iter();
            others.any(|&other| length(difference(point(*node), point(other))) <= within)
        };
        let near = slave.iter().filter(|node| is_near(node)).count();
        let text = if near == slave.len() {
            contact.gap = Some(0.0.into());
            format!(
                "ADJUST={}: all nodes of {} begin in contact",
                exact(within),
                pair.slave
            )
        } else {
            format!(
                "ADJUST={}: the {near} of {} nodes of {} that are so close to a node of {} stay \
                 where they are",
                exact(within),
                slave.len(),
                pair.slave,
                pair.master
            )
        };
        let list = &mut account.taken;
        Account::add(list, &self.deck.files, pair.place, "CONTACT PAIR", &text);
    }

    fn nodes_of(&self, faces: &[Face]) -> Vec<u32> {
        let of_face = |&(element, local): &Face| {
            let nodes = self.deck.element_nodes(element as usize);
            let shape = self.deck.elements.types[element as usize].shape;
            shape.facet(local as usize).iter().map(|&k| nodes[k])
        };
        let mut nodes: Vec<u32> = faces.iter().flat_map(of_face).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }
}
