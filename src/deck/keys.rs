//! The keys to which conditions apply: freedoms of nodes, faces, and bodies.

use super::Deck;
use super::bodies::{Bodies, unsupported};
use super::data::{Condition, ConditionKind, EntitySelection};
use super::facets::Key;
use super::rigid::rotations_among;
use super::sets::{At, What};
use crate::error::Result;

impl ConditionKind {
    /// The keyword that gives such conditions.
    pub(super) fn keyword(self) -> &'static str {
        match self {
            ConditionKind::Boundary => "BOUNDARY",
            ConditionKind::Force => "CLOAD",
            ConditionKind::Pressure | ConditionKind::Volume => "DLOAD",
            ConditionKind::Temperature => "TEMPERATURE",
        }
    }
}

impl Condition {
    /// The keys to which a condition applies. The direction out of a plane model is not among them.
    ///
    /// # Errors
    /// `Input` for undefined names and numbers.
    pub(super) fn keys(&self, deck: &Deck) -> Result<Vec<Key>> {
        let (lookup, at) = (deck.lookup(), (self.place, self.kind.keyword()));
        let [first, last] = self.range;
        if self.kind == ConditionKind::Volume {
            let bodies = whole_bodies(deck, &self.on, at)?;
            return Ok(bodies.into_iter().map(|body| (body, first as u8)).collect());
        }
        if self.kind != ConditionKind::Pressure {
            let dimension = lookup.mesh.dimension();
            let nodes = lookup.indices(What::Nodes, &self.on, at)?;
            let freedoms = first - 1..last.min(dimension);
            let of_node = |&node: &u32| freedoms.clone().map(move |freedom| (node, freedom as u8));
            let mut keys: Vec<Key> = nodes.iter().flat_map(of_node).collect();
            let rigid = &deck.properties.rigid;
            keys.extend(rotations_among(rigid, lookup, &nodes, [first, last])?);
            if self.kind == ConditionKind::Force && first > 3 && keys.is_empty() {
                let message = format!(
                    "degree of freedom {first}: moments act on the reference node of a *RIGID \
                     BODY or *COUPLING alone; press with forces along 1, 2 and 3"
                );
                return Err(lookup.error(at, message));
            }
            return Ok(keys);
        }
        match &self.on {
            EntitySelection::Set(name) if first == 0 => {
                lookup.surface(name, (self.place, "DSLOAD"))
            }
            on => {
                let elements = lookup.indices(What::Elements, on, at)?;
                let facet = |element: u32| lookup.facet(element, first, at);
                elements.into_iter().map(facet).collect()
            }
        }
    }
}

/// The bodies of which a set of elements consists.
///
/// # Errors
/// `Unsupported` if the set contains only a part of a body.
fn whole_bodies(deck: &Deck, on: &EntitySelection, at: At) -> Result<Vec<u32>> {
    let bodies = Bodies::of(deck)?;
    let mut counts = vec![[0usize; 2]; bodies.names.len()];
    for &body in &bodies.of_element {
        counts[body as usize][1] += 1;
    }
    for element in deck.lookup().indices(What::Elements, on, at)? {
        counts[bodies.of_element[element as usize] as usize][0] += 1;
    }
    let mut whole = Vec::new();
    for (body, [given, all]) in counts.into_iter().enumerate() {
        if given == all {
            whole.push(body as u32);
        } else if given > 0 {
            let message = format!(
                "it acts on {given} of the {all} elements of body {}: loads on volumes are \
                 those of whole bodies; give the part a section of its own",
                bodies.names[body]
            );
            return Err(unsupported(deck.lookup().error(at, message)));
        }
    }
    Ok(whole)
}
