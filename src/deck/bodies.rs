//! Assignment of elements to bodies: the connected parts of each section.

use super::Deck;
use super::data::{EntitySelection, Member, Section};
use super::sets::{At, Lookup, What};
use super::source::LinePlace;
use crate::classes::Classes;
use crate::error::{Error, Result};
use std::collections::{BTreeMap, HashMap};

/// The bodies of a deck.
#[derive(Debug, Clone, Default)]
pub(crate) struct Bodies {
    pub(crate) names: Vec<String>,
    /// Body of each element.
    pub(crate) of_element: Vec<u32>,
    /// Section of each body; `None` if the deck has no sections.
    pub(super) sections: Vec<Option<usize>>,
}

/// Marks an element without a section.
const NONE: u32 = u32::MAX;

impl Bodies {
    /// The bodies of the deck, in the order of their first elements.
    ///
    /// # Errors
    /// `Input` if an element is in no section or in two.
    pub(crate) fn of(deck: &Deck) -> Result<Bodies> {
        let assignment = Assignment {
            lookup: deck.lookup(),
            sections: &deck.properties.sections,
            end: deck.end,
        };
        let section_of = assignment.section_of_elements()?;
        let part_of = assignment.parts(&section_of);
        let mut out = Bodies::default();
        // The number of the body, by section and part.
        let mut known: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        let mut sections = Vec::new();
        for (&section, &part) in section_of.iter().zip(&part_of) {
            let next = known.len() as u32;
            let body = *known.entry((section, part)).or_insert(next);
            if body == next {
                sections.push(section);
            }
            out.of_element.push(body);
        }
        out.names = assignment.body_names(&sections, &out.of_element)?;
        assignment.name_by_instances(&mut out);
        let has_sections = !assignment.sections.is_empty();
        let section = |section: &u32| has_sections.then_some(*section as usize);
        out.sections = sections.iter().map(section).collect();
        Ok(out)
    }
}

/// The assignment of elements to bodies.
struct Assignment<'d> {
    lookup: Lookup<'d>,
    sections: &'d [Section],
    /// Place of the end of the deck.
    end: LinePlace,
}

impl Assignment<'_> {
    /// The section of each element. In a deck without sections, the number of the first element
    /// set, in alphabetical order, that contains the element. If an `*ELSET` has the same elements
    /// as a set of `*ELEMENT`, the `*ELSET` counts: mesh generators name groups by `*ELSET`, and
    /// parts of the geometry by `*ELEMENT`.
    fn section_of_elements(&self) -> Result<Vec<u32>> {
        let mut out = vec![NONE; self.lookup.mesh.n_elements()];
        if self.sections.is_empty() {
            let mut groups: HashMap<Vec<u32>, u32> = HashMap::new();
            let mut all = Vec::new();
            for (number, (name, members)) in self.lookup.sets.elements.iter().enumerate() {
                let set = EntitySelection::Set(name.to_string());
                let elements = self
                    .lookup
                    .indices(What::Elements, &set, (self.end, "ELSET"))?;
                let is_row = |(member, _): &(Member, LinePlace)| matches!(member, Member::Rows(..));
                if !members.iter().all(is_row) {
                    groups.entry(elements.clone()).or_insert(number as u32);
                }
                all.push(elements);
            }
            for (number, elements) in all.iter().enumerate() {
                let number = groups.get(elements).copied().unwrap_or(number as u32);
                for &element in elements {
                    if out[element as usize] == NONE {
                        out[element as usize] = number;
                    }
                }
            }
            return Ok(out);
        }
        for (number, section) in self.sections.iter().enumerate() {
            let at = (section.place, "SOLID SECTION");
            let set = EntitySelection::Set(section.elements.clone());
            self.refuse_boundary(&set, at)?;
            for element in self.lookup.indices(What::Elements, &set, at)? {
                if out[element as usize] != NONE {
                    let label = self.lookup.mesh.element_name(element as usize);
                    let message = format!("element {label} is in another section too: give it one");
                    return Err(self.lookup.error(at, message));
                }
                out[element as usize] = number as u32;
            }
        }
        match out.iter().position(|section| *section == NONE) {
            Some(element) => {
                let label = self.lookup.mesh.element_name(element);
                let message = format!(
                    "element {label} is in no *SOLID SECTION: give its set one, with a material"
                );
                let place = self.lookup.mesh.elements.places[element];
                Err(self.lookup.error((place, "ELEMENT"), message))
            }
            None => Ok(out),
        }
    }

    /// Refuses boundary elements to which a section would give a stiffness.
    ///
    /// # Errors
    /// `Unsupported`, at the section.
    fn refuse_boundary(&self, set: &EntitySelection, at: At) -> Result<()> {
        let Some(&line) = self.lookup.boundary_of(set).first() else {
            return Ok(());
        };
        let message = format!(
            "element {} ({}) is a truss, a beam, or plane beside solids: a section would give it \
             a stiffness, which brinell does not have",
            self.lookup.mesh.instances.shown(line),
            self.lookup.boundary.types()
        );
        Err(unsupported(self.lookup.error(at, message)))
    }

    /// A number for each element, shared by all elements of its section to which it is connected
    /// through nodes.
    fn parts(&self, section_of: &[u32]) -> Vec<u32> {
        let mut classes = Classes::new(section_of.len());
        // For each node its first section and an element of it; the few nodes in several sections
        // are kept separately.
        let mut first = vec![(NONE, NONE); self.lookup.mesh.n_nodes()];
        let mut others: HashMap<(u32, u32), u32> = HashMap::new();
        for (element, &section) in section_of.iter().enumerate() {
            let element = element as u32;
            for &node in self.lookup.mesh.element_nodes(element as usize) {
                let (of, other) = &mut first[node as usize];
                if *other == NONE {
                    (*of, *other) = (section, element);
                    continue;
                }
                let other = match *of == section {
                    true => *other,
                    false => *others.entry((node, section)).or_insert(element),
                };
                classes.join(other as usize, element as usize);
            }
        }
        (classes.firsts().into_iter())
            .map(|first| first as u32)
            .collect()
    }

    /// Names each body that is a whole instance of a part after the instance.
    fn name_by_instances(&self, bodies: &mut Bodies) {
        let (elements, instances) = (&self.lookup.mesh.elements, &self.lookup.mesh.instances);
        let n = instances.names().len();
        if n == 0 {
            return;
        }
        // For each body its instance, and for each instance its number of bodies.
        let mut of_body = vec![None; bodies.names.len()];
        for (element, &body) in bodies.of_element.iter().enumerate().rev() {
            of_body[body as usize] = instances.of(elements.labels[element]);
        }
        let mut n_bodies = vec![0; n];
        (of_body.iter().flatten()).for_each(|&instance: &usize| n_bodies[instance] += 1);
        for (name, instance) in bodies.names.iter_mut().zip(of_body) {
            if let Some(instance) = instance.filter(|&instance| n_bodies[instance] == 1) {
                name.clone_from(&instances.names()[instance]);
            }
        }
    }

    /// Names of the bodies, whose sections are given. A body is named after its section's set if it
    /// is the whole set, otherwise after an element set that is exactly the body, otherwise with a
    /// number appended.
    fn body_names(&self, sections: &[u32], of_element: &[u32]) -> Result<Vec<String>> {
        let of_section = |section: u32| match self.sections.get(section as usize) {
            Some(section) => section.elements.as_str(),
            None => {
                (self.lookup.sets.elements.iter().nth(section as usize)).map_or("body", |set| set.0)
            }
        };
        let mut parts: BTreeMap<u32, usize> = BTreeMap::new();
        let numbers = sections.iter().map(|section| {
            let number = parts.entry(*section).or_insert(0);
            *number += 1;
            *number
        });
        let numbers: Vec<usize> = numbers.collect();
        let mut own: BTreeMap<u32, String> = BTreeMap::new();
        if parts.values().any(|parts| *parts > 1) {
            own = self.sets_that_are_bodies(sections.len(), of_element)?;
        }
        let name = |(body, section): (usize, &u32)| {
            let of_section = of_section(*section);
            let name = self
                .lookup
                .sets
                .elements
                .written(of_section)
                .unwrap_or(of_section);
            match own.get(&(body as u32)) {
                _ if parts[section] == 1 => name.to_string(),
                Some(own) => own.clone(),
                None => format!("{name}-{}", numbers[body]),
            }
        };
        Ok(sections.iter().enumerate().map(name).collect())
    }

    /// Element sets that contain exactly the elements of one body, by body.
    fn sets_that_are_bodies(
        &self,
        n_bodies: usize,
        of_element: &[u32],
    ) -> Result<BTreeMap<u32, String>> {
        let mut sizes = vec![0; n_bodies];
        of_element
            .iter()
            .for_each(|&body| sizes[body as usize] += 1);
        let mut out = BTreeMap::new();
        for (name, members) in self.lookup.sets.elements.iter() {
            let Some((_, place)) = members.first() else {
                continue;
            };
            let set = EntitySelection::Set(name.to_string());
            let elements = self
                .lookup
                .indices(What::Elements, &set, (*place, "ELSET"))?;
            let Some(&first) = elements.first() else {
                continue;
            };
            let body = of_element[first as usize];
            let is_of = |element: &u32| of_element[*element as usize] == body;
            if elements.len() == sizes[body as usize] && elements.iter().all(is_of) {
                out.entry(body).or_insert_with(|| name.to_string());
            }
        }
        Ok(out)
    }
}

/// Turns an error into one of kind `Unsupported`.
pub(super) fn unsupported(error: Error) -> Error {
    Error::new(crate::ErrorKind::Unsupported, error.message())
}
