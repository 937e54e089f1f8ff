//! Contact pairs and ties of a deck as those of the scene.

use super::super::Deck;
use super::super::data::{Adjust, ContactPair};
use super::super::node_slaves::NodeSlaves;
use super::super::sets::What;
use super::super::source::LinePlace;
use super::draft::Draft;
use crate::error::Result;
use crate::number::exact;
use crate::scene::{Contact, SlaveSide, Tie};

/// Contacts and ties of a scene.
#[derive(Default)]
pub(super) struct ScenePairs {
    pub(super) contacts: Vec<Contact>,
    pub(super) ties: Vec<Tie>,
}

impl ScenePairs {
    /// Adds the contact pairs, with the slave surface first. A clearance becomes a gap, or an
    /// interference if it is negative.
    pub(super) fn add_contacts(&mut self, draft: &mut Draft) -> Result<()> {
        let (deck, lookup) = (draft.deck, draft.deck.lookup());
        let properties = &deck.properties;
        for pair in &properties.contacts {
            let at = (pair.place, "CONTACT PAIR");
            let Some(interaction) = properties.interactions.get(&pair.interaction) else {
                let message = format!("there is no *SURFACE INTERACTION {}", pair.interaction);
                return Err(lookup.error(at, message));
            };
            lookup.surface(&pair.master, at)?;
            let (first, nodes) = match lookup.node_slaves(pair)? {
                Some(slaves) => around(draft, pair, slaves),
                None => {
                    lookup.surface(&pair.slave, at)?;
                    (draft.geometry.surface_name(&pair.slave), None)
                }
            };
            let mut contact = Contact {
                first,
                nodes,
                second: draft.geometry.surface_name(&pair.master),
                stiffness: interaction.stiffness,
                ..Contact::default()
            };
            if let Some(Adjust::Nodes(set)) = &pair.adjust {
                lookup.indices(What::Nodes, set, at)?;
            }
            contact.gap = pair.is_closed.then(|| 0.0.into());
            contact.held = true;
            clear(draft, pair, &mut contact);
            contact.overlap = contact.gap.is_none();
            let key = format!("contact.{}", self.contacts.len());
            draft.places.insert(key, deck.files.show(pair.place));
            self.contacts.push(contact);
        }
        let clearances = properties.clearances.iter();
        let clearances = clearances.map(|c| (c.place, "CLEARANCE", [&c.slave, &c.master]));
        let resolved = properties.resolved.iter();
        let resolved = resolved.map(|r| (r.place, "CONTACT INTERFERENCE", [&r.slave, &r.master]));
        clearances
            .chain(resolved)
            .try_for_each(|of| require_pair(deck, of))
    }

    /// Adds the ties, with the deck's slave surface first and fixed as the slave.
    pub(super) fn add_ties(&mut self, draft: &mut Draft) -> Result<()> {
        let deck = draft.deck;
        for tie in &deck.properties.ties {
            for name in [&tie.slave, &tie.master] {
                deck.lookup().surface(name, (tie.place, "TIE"))?;
            }
            let key = format!("tie.{}", self.ties.len());
            draft.places.insert(key, deck.files.show(tie.place));
            self.ties.push(Tie {
                first: draft.geometry.surface_name(&tie.slave),
                second: draft.geometry.surface_name(&tie.master),
                slave: SlaveSide::First,
                distance: tie.tolerance,
            });
        }
        Ok(())
    }
}

/// Adds the faces around slave nodes as a surface, and the nodes as a set; returns both names.
fn around(draft: &mut Draft, pair: &ContactPair, slaves: NodeSlaves) -> (String, Option<String>) {
    let n = slaves.nodes.len();
    let text = format!(
        "only the nodes of {} ({n}) can touch, at their positions: they do not make up whole \
         faces of one piece",
        pair.slave,
    );
    draft.remark(pair.place, "CONTACT PAIR", &text);
    let faces = format!("{}_faces", pair.slave);
    let nodes = format!("{}_nodes", pair.slave);
    (
        draft.geometry.add_surface(&faces, slaves.faces),
        Some(draft.geometry.add_nodes(&nodes, slaves.nodes)),
    )
}

/// Requires that a contact pair has the surfaces that a line names.
///
/// # Errors
/// `Input`, at the line.
fn require_pair(
    deck: &Deck,
    (place, keyword, [slave, master]): (LinePlace, &str, [&String; 2]),
) -> Result<()> {
    let mut pairs = deck.properties.contacts.iter();
    if pairs.any(|pair| pair.is_of(slave, master)) {
        return Ok(());
    }
    let message = format!(
        "no *CONTACT PAIR has {slave} as its slave surface and {master} as its master surface: \
         name both as in a *CONTACT PAIR"
    );
    Err(deck.error(place, keyword, message))
}

/// Gives a contact the clearances of its pair.
fn clear(draft: &mut Draft, pair: &ContactPair, contact: &mut Contact) {
    let clearances = draft.deck.properties.clearances.iter();
    for clearance in clearances.filter(|c| pair.is_of(&c.slave, &c.master)) {
        contact.gap = Some(clearance.value.max(0.0).into());
        contact.interference = (-clearance.value).max(0.0).into();
        let text = match clearance.value < 0.0 {
            true => format!("an interference of {}", exact(-clearance.value)),
            false => format!("a gap of {} everywhere", exact(clearance.value)),
        };
        draft.remark(clearance.place, "CLEARANCE", &text);
    }
}
