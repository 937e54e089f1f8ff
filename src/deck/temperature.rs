//! Temperatures of a deck: initial temperatures and their changes, and the material properties at
//! these temperatures.

use super::Deck;
use super::bodies::{Bodies, unsupported};
use super::data::{ConditionKind, DeckProgram, MaterialData};
use super::expansion::Expansion;
use super::history::histories;
use super::series::{Series, are_alike};
use super::source::LinePlace;
use crate::error::Result;
use crate::scene::{Material, MaterialRow};
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

/// Largest number of increments of a step at whose ends thermal strains are exact.
const MOST_INCREMENTS: usize = 100;

/// The initial temperature of a body and its change over time.
pub(super) struct OfBody {
    /// Initial temperature of the body's first node, and whether all nodes share it.
    pub(super) initial: (f64, bool),
    /// Change of temperature of the node at which the change is largest.
    pub(super) change: Series,
    /// Whether all nodes have the same change; otherwise their changes are in proportion to it.
    pub(super) is_uniform: bool,
    /// The line that gave the temperature last; `None` for a body without temperatures.
    pub(super) place: Option<LinePlace>,
}

impl OfBody {
    fn none() -> Self {
        OfBody {
            initial: (0.0, true),
            change: Series::starting(0.0),
            is_uniform: true,
            place: None,
        }
    }
}

/// The initial temperature of a node and its change over time.
#[derive(Clone)]
struct OfNode {
    initial: f64,
    change: Series,
    place: Option<LinePlace>,
}

impl OfNode {
    /// The changes of temperature that give, with the scene's coefficient, the strains of an
    /// expansion that depends on temperature.
    fn expanded(&self, expansion: &Expansion, times: &[f64]) -> Series {
        expansion.equivalents(self.initial, &self.change, times)
    }
}

/// The largest change of temperature at each node that belongs to an element, with the node's
/// number.
///
/// # Errors
/// `Input` for undefined sets and nodes; `Unsupported` for a node to which two materials give
/// different equivalent changes.
pub(crate) fn largest_changes(deck: &Deck) -> Result<Vec<(u64, f64)>> {
    let nodes = of_nodes(deck)?;
    let bodies = &Bodies::of(deck)?;
    let program = &deck.program;
    let mut out = BTreeMap::new();
    for (element, &body) in bodies.of_element.iter().enumerate() {
        let expansion = varying_expansion(deck, bodies, body as usize);
        for &node in deck.mesh.element_nodes(element) {
            let of_node = &nodes[node as usize];
            let value = match expansion {
                Some(expansion) => of_node.expanded(expansion, &program.step_ends()).largest(),
                None => of_node.change.largest(),
            };
            if *out.entry(node).or_insert(value) != value {
                let message = format!(
                    "node {} belongs to two materials whose *EXPANSION differs by temperature, \
                     and its body has several temperatures: give one *EXPANSION to both, or \
                     each body its own nodes and a *TIE",
                    deck.mesh.node_name(node as usize)
                );
                let place = of_node.place.unwrap_or(deck.end);
                return Err(unsupported(deck.error(place, "TEMPERATURE", message)));
            }
        }
    }
    let value = |(node, value): (u32, f64)| (deck.mesh.node_label(node as usize), value);
    Ok(out.into_iter().map(value).collect())
}

/// The temperatures of each body of a deck.
///
/// # Errors
/// `Unsupported` if temperatures within a body do not change in proportion to each other.
pub(super) fn of_bodies(deck: &Deck, bodies: &Bodies) -> Result<Vec<OfBody>> {
    let steps = deck.program.steps.iter().flat_map(|step| &step.conditions);
    let mut conditions = deck.program.initial.iter().chain(steps);
    if !conditions.any(|condition| condition.kind == ConditionKind::Temperature) {
        let none = bodies.names.iter().map(|_| OfBody::none());
        return Ok(none.collect());
    }
    let nodes = of_nodes(deck)?;
    let mut members: Vec<BTreeSet<u32>> = vec![BTreeSet::new(); bodies.names.len()];
    for (element, &body) in bodies.of_element.iter().enumerate() {
        members[body as usize].extend(deck.mesh.element_nodes(element));
    }
    let names = bodies.names.iter().zip(&members);
    let expansions = (0..).map(|body| varying_expansion(deck, bodies, body));
    names
        .zip(expansions)
        .map(|((name, members), expansion)| {
            of_body(deck, name, &expanded(deck, members, &nodes, expansion))
        })
        .collect()
}

fn of_nodes(deck: &Deck) -> Result<Vec<OfNode>> {
    let mut initial: BTreeMap<u32, f64> = BTreeMap::new();
    let given = deck.program.initial.iter();
    for condition in given.filter(|condition| condition.kind == ConditionKind::Temperature) {
        for (node, _) in condition.keys(deck)? {
            initial.insert(node, condition.value);
        }
    }
    let histories = histories(deck, ConditionKind::Temperature)?;
    let of_node = |node: u32| {
        let initial = initial.get(&node).copied().unwrap_or(0.0);
        let mut change = Series::starting(0.0);
        let entry = histories.get(&(node, 0));
        if let Some(entry) = entry {
            change = entry.series.clone();
            change.add(&Series::starting(initial), -1.0);
        }
        OfNode {
            initial,
            change,
            place: entry.map(|entry| entry.place),
        }
    };
    Ok((0..deck.n_nodes() as u32).map(of_node).collect())
}

impl DeckProgram {
    /// The ends of all steps and of their increments.
    fn increment_ends(&self) -> Vec<f64> {
        let mut out = Vec::new();
        let mut begin = 0.0;
        for (end, step) in self.step_ends().into_iter().zip(&self.steps) {
            let n = step.increments.clamp(1, MOST_INCREMENTS);
            let at = |k: usize| begin + (end - begin) * k as f64 / n as f64;
            out.extend((1..n).map(at));
            out.push(end);
            begin = end;
        }
        out
    }
}

/// The expansion of a body's material, if it depends on temperature.
fn varying_expansion<'d>(deck: &'d Deck, bodies: &Bodies, body: usize) -> Option<&'d Expansion> {
    let section = bodies.sections.get(body).copied().flatten()?;
    let properties = &deck.properties;
    let material = &properties.sections.get(section)?.material;
    let expansion = properties.materials.get(material)?.expansion.as_ref()?;
    (!expansion.is_constant()).then_some(expansion)
}

/// The nodes of a body, with equivalent changes of temperature if the expansion depends on
/// temperature.
fn expanded<'a>(
    deck: &Deck,
    of_body: &BTreeSet<u32>,
    nodes: &'a [OfNode],
    expansion: Option<&Expansion>,
) -> Vec<(u32, Cow<'a, OfNode>)> {
    let members = || (of_body.iter()).map(|&node| (node, &nodes[node as usize]));
    let Some(expansion) = expansion else {
        let as_they_are = |(node, of_node)| (node, Cow::Borrowed(of_node));
        return members().map(as_they_are).collect();
    };
    // Several different temperatures can stay in proportion only if no intermediate times are
    // added.
    let mut all = members().map(|(_, of_node)| (of_node.initial, of_node.change.bits()));
    let first = all.next();
    let times = match all.all(|other| Some(&other) == first.as_ref()) {
        true => deck.program.increment_ends(),
        false => deck.program.step_ends(),
    };
    let of = |(node, of_node): (u32, &OfNode)| {
        let change = of_node.expanded(expansion, &times);
        let place = of_node.place;
        let initial = of_node.initial;
        let of_node = OfNode {
            initial,
            change,
            place,
        };
        (node, Cow::Owned(of_node))
    };
    members().map(of).collect()
}

fn of_body(deck: &Deck, name: &str, nodes: &[(u32, Cow<OfNode>)]) -> Result<OfBody> {
    let members = || nodes.iter().map(|(node, of_node)| (*node, &**of_node));
    let size = |of_node: &OfNode| of_node.change.largest().abs();
    let most = members().reduce(|a, b| if size(b.1) > size(a.1) { b } else { a });
    let Some((first, most)) = most else {
        return Ok(OfBody::none());
    };
    let shape = most.change.shape();
    let is_in_proportion =
        |of_node: &OfNode| of_node.change.is_zero() || are_alike(&of_node.change.shape(), &shape);
    if let Some((node, other)) = members().find(|(_, of_node)| !is_in_proportion(of_node)) {
        let label = |node: u32| deck.mesh.node_name(node as usize);
        let message = format!(
            "the temperatures of nodes {} and {} of body {name} do not change in proportion: \
             those of a body do",
            label(first),
            label(node)
        );
        let place = other.place.or(most.place).unwrap_or(deck.end);
        return Err(unsupported(deck.error(place, "TEMPERATURE", message)));
    }
    let initial = members().next().map_or(0.0, |(_, of_node)| of_node.initial);
    Ok(OfBody {
        initial: (initial, members().all(|(_, n)| n.initial == initial)),
        change: most.change.clone(),
        is_uniform: members().all(|(_, n)| n.change.bits() == most.change.bits()),
        place: members().find_map(|(_, of_node)| of_node.place),
    })
}

impl MaterialData {
    /// The material of a scene, with rows over temperature if the deck's tables have several
    /// temperatures; `None` without an elastic law.
    pub(super) fn material(&self) -> Option<Material> {
        let (_, [youngs_modulus, poissons_ratio]) = *self.elastic.first()?;
        let of_elastic = several(&self.elastic).iter().map(|(t, _)| *t);
        let of_plastic = several(&self.plastic).iter().map(|(t, _)| *t);
        let mut temperatures: Vec<f64> = of_elastic.chain(of_plastic).collect();
        temperatures.sort_by(f64::total_cmp);
        temperatures.dedup();
        let row = |temperature: f64| {
            let elastic = at(several(&self.elastic), temperature);
            let law = at(several(&self.plastic), temperature).map(|law| self.hardening(law));
            let law = law.unwrap_or_default();
            MaterialRow {
                temperature,
                youngs_modulus: elastic.map(|law| law[0]),
                poissons_ratio: elastic.map(|law| law[1]),
                yield_stress: law.yield_stress,
                kinematic_modulus: law.kinematic_modulus,
                hardening_table: law.hardening_table,
                ..MaterialRow::default()
            }
        };
        let law = self.plastic.first().map(|(_, law)| self.hardening(law));
        Some(Material {
            youngs_modulus,
            poissons_ratio,
            density: self.density,
            thermal_expansion: self.expansion.as_ref().map(Expansion::coefficient),
            over_temperature: temperatures.into_iter().map(row).collect(),
            ..law.unwrap_or_default()
        })
    }

    /// The plastic law given by one table, in the form that is common to all tables of the
    /// material.
    fn hardening(&self, rows: &[[f64; 2]]) -> Material {
        let harden = self.plastic.iter().any(|(_, rows)| rows.len() > 1);
        let (curved, moves) = (harden && !self.is_kinematic, harden && self.is_kinematic);
        Material {
            yield_stress: rows.first().filter(|_| !curved).map(|row| row[1]),
            kinematic_modulus: moves.then(|| slope(rows)),
            hardening_table: curved.then(|| rows.to_vec()),
            ..Material::default()
        }
    }
}

/// The tables of a law that depends on temperature; empty if it does not.
fn several<T>(tables: &[T]) -> &[T] {
    if tables.len() > 1 { tables } else { &[] }
}

/// The table for a temperature.
fn at<T>(tables: &[(f64, T)], temperature: f64) -> Option<&T> {
    let found = tables.iter().find(|(t, _)| *t == temperature);
    found.map(|(_, table)| table)
}

/// The slope of hardening between the first and the last row; 0 for a single row.
fn slope(rows: &[[f64; 2]]) -> f64 {
    match (rows.first(), rows.last()) {
        (Some([from, low]), Some([to, high])) if to > from => (high - low) / (to - from),
        _ => 0.0,
    }
}
