//! Resolves all contacts of a scene, one after the other: which surface has the slaves, and which
//! pairs a contact adds to those of earlier contacts.

use super::contact_input::ContactInput;
use super::found::{Found, surface_of};
use super::only::Only;
use super::repeated::Repeated;
use super::stated::Stated;
use super::{ContactSurface, Pair, held, matching, mortar, only, pointwise, rigid};
use crate::error::{Error, Result};
use crate::mesh::{Mesh, rounding};
use crate::model::given::{Given, NodePair};
use crate::model::names::SceneEntry;
use crate::model::rigid::{RigidBodies, RigidBody};
use crate::model::supports::{Moved, Supports};
use crate::number::exact;
use crate::scene::{Contact, Scene, SlaveSide};
use std::collections::BTreeMap;

/// Finds the pairs of all contacts of a scene, and the contact surfaces.
///
/// # Errors
/// `Input` for surfaces that do not exist or cannot touch, and for nodes that would be the slaves
/// of two contacts.
pub(in crate::model) fn resolve(
    scene: &Scene,
    mesh: &Mesh,
    (given, rigid): (&Given, &RigidBodies),
    notes: &mut Vec<String>,
) -> Result<(Vec<Pair>, Vec<ContactSurface>)> {
    let mut resolver = Resolver {
        scene,
        mesh,
        supports: Supports::resolve(scene, mesh)?,
        moved: Supports::moved(scene, mesh)?,
        pairs: Vec::new(),
        slave_of: BTreeMap::new(),
        repeated: Repeated::default(),
        notes,
    };
    let rounding = if scene.contact.is_empty() {
        0.0
    } else {
        rounding(mesh)
    };
    let mut contacts = Vec::new();
    for (index, contact) in scene.contact.iter().enumerate() {
        let entry = SceneEntry::of_list(scene, "contact", index);
        let names = [&contact.first, &contact.second];
        let what = format!("contact {} (`{}` on `{}`)", index + 1, names[0], names[1]);
        let refused = |error: Error| entry.refused(error.within(&what));
        let stated = Stated::of(contact, scene, mesh).map_err(refused)?;
        let surfaces = [
            entry.surface(mesh, "first", names[0])?,
            entry.surface(mesh, "second", names[1])?,
        ];
        let only = only::nodes(contact, (&entry, mesh), surfaces)?;
        let mut input = ContactInput {
            index,
            contact: contact.clone(),
            stated: &stated,
            surfaces,
            mesh,
            space: scene.kind,
            is_of_deck: scene.requests.is_of_deck(),
            rounding,
        };
        if let Some(only) = &only {
            input.contact.slave = only.side;
        }
        let mut one = OneContact {
            contact,
            input,
            what: what.clone(),
            only,
            given: given.pairs.get(&index).map(Vec::as_slice),
            rigid: names.map(|name| rigid.named(name)),
        };
        contacts.push(resolver.add(&mut one).map_err(|error| match error {
            ContactRefusal::InContact(error) => refused(error),
            ContactRefusal::AtEntry(error) => entry.refused(error),
        })?);
    }
    Ok((resolver.pairs, contacts))
}

/// An error of a contact, and whether the message already says which contact it is.
enum ContactRefusal {
    InContact(Error),
    AtEntry(Error),
}

impl From<Error> for ContactRefusal {
    fn from(error: Error) -> Self {
        ContactRefusal::InContact(error)
    }
}

/// State of the resolution: the pairs of all contacts resolved so far.
struct Resolver<'s, 'n> {
    scene: &'s Scene,
    mesh: &'s Mesh,
    supports: Supports,
    moved: Moved,
    pairs: Vec<Pair>,
    /// Number of the contact in which each slave node is a slave.
    slave_of: BTreeMap<usize, usize>,
    repeated: Repeated,
    notes: &'n mut Vec<String>,
}

/// A contact to be resolved.
struct OneContact<'c> {
    contact: &'c Contact,
    /// The contact as it is resolved, with the choice of the slave.
    input: ContactInput<'c>,
    what: String,
    only: Option<Only>,
    given: Option<&'c [NodePair]>,
    /// The rigid bodies of the first and the second surface.
    rigid: [Option<&'c RigidBody>; 2],
}

/// Pairs of a contact for a choice of the slave.
struct SlaveChoice {
    found: Found,
    /// Slaves that are also slaves of an earlier contact, with the number of that contact.
    shared: Vec<(usize, usize)>,
    notes: Vec<String>,
}

/// Whether a support may and does hold the slave of a pair along the normal.
fn is_held(supports: &Supports, contact: &Contact, pair: &Pair) -> bool {
    contact.held && supports.hold_along(pair.slave, pair.normal)
}

impl Resolver<'_, '_> {
    /// Finds the pairs of a contact and adds them.
    fn add(&mut self, one: &mut OneContact) -> std::result::Result<ContactSurface, ContactRefusal> {
        one.input.check_normal()?;
        let mut attempt = self.attempt(one)?;
        self.try_other_slave(one, &mut attempt);
        self.notes.append(&mut attempt.notes);
        let SlaveChoice {
            mut found, shared, ..
        } = attempt;
        let supports = &self.supports;
        let is_held = |pair: &Pair| is_held(supports, one.contact, pair);
        let slaves = found.pairs.iter().filter(|pair| is_held(pair));
        for pair in slaves {
            supports.hold_throughout(self.scene, self.mesh, pair)?;
        }
        held::leave_to_supports(&mut found, is_held, (self.mesh, &one.what), self.notes)?;
        if let Some(&shared) = shared.first() {
            return Err(ContactRefusal::AtEntry(
                self.slave_of_two(one, &found, shared),
            ));
        }
        if found.pairs.is_empty() {
            let what = &one.what;
            self.notes.push(format!(
                "{what}: earlier contacts have all of its pairs of nodes"
            ));
        }
        self.repeated.share_areas(
            &found.repeated,
            &mut self.pairs,
            (self.mesh, one.input.surfaces),
            (one.contact, &self.scene.contact),
        )?;
        let slaves = found.pairs.iter().map(|pair| (pair.slave, one.input.index));
        self.slave_of.extend(slaves);
        self.take_off_round_off(one, &mut found);
        if one.contact.overlap {
            self.push_apart(one, &mut found);
        }
        let start = self.pairs.len();
        self.pairs.append(&mut found.pairs);
        let mut surface = surface_of(&one.input, &found, &mut self.pairs, start);
        surface.is_rigid = one.rigid.iter().any(Option::is_some);
        self.repeated.add(&self.pairs, start);
        Ok(surface)
    }

    /// Finds the pairs of a contact for the choice of the slave in its input.
    fn attempt(&self, one: &OneContact) -> Result<SlaveChoice> {
        let (input, mut notes) = (&one.input, Vec::new());
        let mut found = match (one.rigid, &one.only) {
            ([Some(body), _], _) => rigid::pairs(input, 1, body)?,
            ([_, Some(body)], _) => rigid::pairs(input, 0, body)?,
            (_, Some(only)) => pointwise::pairs(input, only)?,
            _ => {
                if one.given.is_none() && input.contact.normal.is_none() {
                    input.check_sides()?;
                }
                let found = match matching::pairs(input, one.given)? {
                    Some(found) => found,
                    None => mortar::pairs(input, &mut notes)?,
                };
                if one.given.is_none() {
                    input.check_overlap(found.slave, &found.pairs)?;
                }
                found
            }
        };
        if let Some(only) = &one.only {
            found.pairs.retain(|pair| only.nodes.contains(&pair.slave));
        }
        let is_same = |other: usize| self.are_same(input, other);
        self.repeated.take_from(&mut found, &self.pairs, is_same);
        let shared = |pair: &Pair| Some((pair.slave, *self.slave_of.get(&pair.slave)?));
        Ok(SlaveChoice {
            shared: found.pairs.iter().filter_map(shared).collect(),
            found,
            notes,
        })
    }

    /// Makes the other surface the slave if the scene leaves the choice open and the swap helps.
    fn try_other_slave(&self, one: &mut OneContact, attempt: &mut SlaveChoice) {
        if one.input.contact.slave != SlaveSide::Auto {
            return;
        }
        // A node may be the slave of only one contact, so shared slaves call for the other choice.
        // If both contacts have the same faces, either choice would hold these faces twice.
        let is_twice = |(_, other): &(usize, usize)| self.are_same(&one.input, *other);
        if !attempt.shared.is_empty() && !attempt.shared.iter().any(is_twice) {
            self.swap(one, attempt, |_| true);
        }
        // A node whose support bears the contact force needs no pair and is better as a master. A
        // node whose displacement is prescribed or follows others cannot be a slave.
        let n_unfit = |found: &Found| {
            let is_unfit = |pair: &&Pair| {
                is_held(&self.supports, one.contact, pair)
                    || self.moved.towards(pair.slave, pair.normal)
            };
            found.pairs.iter().filter(is_unfit).count()
        };
        let now = n_unfit(&attempt.found);
        if now > 0 {
            self.swap(one, attempt, |other| n_unfit(other) < now);
        }
    }

    /// Takes the other surface as the slave if that gives pairs which share no slave with another
    /// contact and which are better.
    fn swap(
        &self,
        one: &mut OneContact,
        attempt: &mut SlaveChoice,
        is_better: impl Fn(&Found) -> bool,
    ) {
        one.input.contact.slave = [SlaveSide::Second, SlaveSide::First][attempt.found.slave];
        if let Ok(other) = self.attempt(one)
            && other.shared.is_empty()
            && is_better(&other.found)
        {
            *attempt = other;
        }
    }

    /// Whether a contact and an earlier one have facets in common on both sides.
    fn are_same(&self, input: &ContactInput, other: usize) -> bool {
        held::are_same(self.mesh, input.surfaces, &self.scene.contact[other])
    }

    fn slave_of_two(
        &self,
        one: &OneContact,
        found: &Found,
        (node, other): (usize, usize),
    ) -> Error {
        Error::input(format!(
            "node {} is the slave of two contacts, {} and {} (`{}` on `{}`); a node may be that of \
             one: take it out of a surface, or let the other surface have the slaves (`slave = \
             \"{}\"`)",
            self.mesh.node_label(node),
            other + 1,
            one.input.index + 1,
            one.contact.first,
            one.contact.second,
            ["second", "first"][found.slave],
        ))
    }

    /// Sets gaps that are no more than round-off to zero; of surfaces whose gap is the mesh's alone
    /// also gaps that the decimal places of its coordinates explain.
    fn take_off_round_off(&mut self, one: &OneContact, found: &mut Found) {
        let is_of_mesh = one.contact.gap.is_none() && !one.contact.overlap && one.given.is_none();
        let rounding = if is_of_mesh { one.input.rounding } else { 0.0 };
        let taken = found.pairs.iter_mut();
        let taken = taken.filter_map(|pair| pair.take_off_round_off(self.mesh, rounding));
        let most = taken.fold(0.0f64, |most, gap| most.max(gap.abs()));
        if most > 0.0 {
            let what = &one.what;
            self.notes.push(format!(
                "{what}: gaps and overlaps of up to {most:.1e} count as none, because the mesh \
                 gives its coordinates to {rounding:e}"
            ));
        }
    }

    /// Makes the overlaps of the pairs in the mesh their interferences.
    fn push_apart(&mut self, one: &OneContact, found: &mut Found) {
        let deepest = found.pairs.iter_mut().map(Pair::overlap_interferes);
        let deepest = deepest.fold(0.0, f64::max);
        if deepest > 0.0 {
            let when = match self.scene.program.interference_until {
                Some(until) => format!("over load factors from 0 to {}", exact(until)),
                None => "before the load program".to_string(),
            };
            let what = &one.what;
            self.notes.push(format!(
                "{what}: the surfaces overlap by up to {deepest:.4e} in the mesh: an interference, \
                 applied {when}"
            ));
        }
    }
}
