//! The sets of the mesh made from a deck: sets that the deck names, and sets that its conditions
//! need.

use super::super::Deck;
use super::super::data::{ConditionKind, EntitySelection};
use super::super::facets::Face;
use super::super::sets::What;
use super::super::source::LinePlace;
use crate::error::Result;
use std::collections::BTreeMap;

/// Sets by name: nodes of elements, and faces.
#[derive(Debug, Clone, Default)]
pub(crate) struct Geometry {
    pub(crate) node_sets: BTreeMap<String, Vec<u32>>,
    pub(crate) surfaces: BTreeMap<String, Vec<Face>>,
    /// Whether a node belongs to an element.
    pub(crate) is_used: Vec<bool>,
    /// Surfaces that include both sides of a face between two elements and are used for results
    /// only.
    pub(super) left_out: Vec<(String, LinePlace)>,
    /// Names of surfaces in the mesh, by their names in the deck in capitals.
    surface_names: BTreeMap<String, String>,
    /// Number of times that each name was requested.
    numbers: BTreeMap<String, usize>,
}

impl Geometry {
    /// The sets that the deck names. A surface that shares the name of a node set is renamed.
    ///
    /// # Errors
    /// `Input` for undefined names and numbers in the sets.
    pub(crate) fn of(deck: &Deck) -> Result<Geometry> {
        let (mesh, lookup, boundary) = (&deck.mesh, deck.lookup(), &deck.boundary);
        let mut out = Geometry {
            is_used: vec![false; mesh.n_nodes()],
            ..Geometry::default()
        };
        mesh.connectivity
            .iter()
            .for_each(|&node| out.is_used[node as usize] = true);
        for (name, members) in deck.sets.nodes.iter() {
            let Some((_, place)) = members.first() else {
                continue;
            };
            let set = EntitySelection::Set(name.to_string());
            let nodes = out.used(lookup.indices(What::Nodes, &set, (*place, "NSET"))?);
            if !nodes.is_empty() {
                out.node_sets.insert(name.to_string(), nodes);
            }
        }
        for (name, _) in deck.sets.elements.iter() {
            let lines = lookup.boundary_of(&EntitySelection::Set(name.to_string()));
            let faces = boundary.faces_of(&lines, mesh);
            let is_free = deck.sets.surfaces.get(name).is_none();
            // Curves of a solid are no faces: their set is one of nodes.
            if faces.is_empty() && is_free && !out.node_sets.contains_key(name) {
                let nodes = out.used(boundary.nodes_of(&lines, mesh));
                if !nodes.is_empty() {
                    out.node_sets.insert(name.to_string(), sorted(nodes));
                }
            }
            if is_free && !faces.is_empty() {
                out.add_named_surface(name, faces);
            }
        }
        for (name, parts) in deck.sets.surfaces.iter() {
            let Some((_, place)) = parts.first() else {
                continue;
            };
            if lookup.is_of_nodes_alone(name) {
                continue;
            }
            let faces = lookup.surface(name, (*place, "SURFACE"))?;
            if mesh.look_both_ways(&faces) && !presses_on(deck, name) {
                out.left_out.push((name.to_string(), *place));
                continue;
            }
            let own = out.add_named_surface(name, faces);
            out.surface_names.insert(name.to_uppercase(), own);
        }
        Ok(out)
    }

    /// Adds a surface that the deck names, renamed if a set of nodes has its name.
    fn add_named_surface(&mut self, name: &str, faces: Vec<Face>) -> String {
        match self.node_sets.contains_key(name) {
            true => self.add_surface(&format!("{name}_surface"), faces),
            false => self.add_surface(name, faces),
        }
    }

    /// The name in the mesh of a surface of the deck.
    pub(super) fn surface_name(&self, name: &str) -> String {
        let found = self.surface_names.get(&name.to_uppercase());
        found.map_or_else(|| name.to_string(), String::clone)
    }

    /// Adds a set of nodes under a free name, which is returned.
    pub(super) fn add_nodes(&mut self, name: &str, nodes: Vec<u32>) -> String {
        let name = self.free_name(name);
        self.node_sets.insert(name.clone(), nodes);
        name
    }

    /// Adds a surface under a free name, which is returned.
    pub(super) fn add_surface(&mut self, name: &str, faces: Vec<Face>) -> String {
        let name = self.free_name(name);
        self.surfaces.insert(name.clone(), faces);
        name
    }

    /// The name itself if it is free, otherwise the name with a number appended. Numbers only grow,
    /// so that the search does not begin anew for each of thousands of sets of one name.
    fn free_name(&mut self, name: &str) -> String {
        let number = self.numbers.entry(name.to_string()).or_default();
        loop {
            *number += 1;
            let name = match *number {
                1 => name.to_string(),
                number => format!("{name}-{number}"),
            };
            if !self.node_sets.contains_key(&name) && !self.surfaces.contains_key(&name) {
                return name;
            }
        }
    }

    /// Whether a node belongs to an element.
    pub(super) fn uses(&self, node: u32) -> bool {
        self.is_used.get(node as usize) == Some(&true)
    }

    /// Keeps only the nodes that belong to elements.
    pub(super) fn used(&self, mut nodes: Vec<u32>) -> Vec<u32> {
        nodes.retain(|node| self.is_used[*node as usize]);
        nodes
    }
}

fn sorted(mut nodes: Vec<u32>) -> Vec<u32> {
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// Whether a contact, a tie or a pressure refers to a surface.
fn presses_on(deck: &Deck, surface: &str) -> bool {
    let is_it = |name: &str| name.eq_ignore_ascii_case(surface);
    let properties = &deck.properties;
    let contacts = properties.contacts.iter().map(|c| [&c.slave, &c.master]);
    let ties = properties.ties.iter().map(|t| [&t.slave, &t.master]);
    let of_pairs = contacts.chain(ties).flatten().any(|name| is_it(name));
    let steps = deck.program.steps.iter().flat_map(|step| &step.conditions);
    let mut all = deck.program.initial.iter().chain(steps);
    of_pairs
        || all.any(|c| {
            c.kind == ConditionKind::Pressure
                && matches!(&c.on, EntitySelection::Set(name) if is_it(name))
        })
}
