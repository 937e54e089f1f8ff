//! Assignment of elements to bodies: the connected parts of each section.

use super::Deck;
use super::data::{EntitySelection, Member};
use super::sets::What;
use super::source::LinePlace;
use crate::classes::Classes;
use crate::error::{Error, Result};
use crate::space::Space;
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

impl Deck {
    /// The dimension and idealisation common to all elements.
    ///
    /// # Errors
    /// `Input` if there are no elements, or at the first element whose kind differs from that of
    /// the first one.
    pub(crate) fn space(&self) -> Result<Space> {
        let Some(first) = self.elements.types.first() else {
            return Err(self.error(self.end, "ELEMENT", "the deck has no elements"));
        };
        let types = &self.elements.types;
        match types.iter().position(|other| other.space != first.space) {
            Some(other) => {
                let message = format!(
                    "elements {} after others {}: a model is of plane strain (CPE), of plane \
                     stress (CPS), axisymmetric (CAX) or solid (C3D): give types of one kind",
                    types[other].name(),
                    first.name()
                );
                Err(self.error(self.elements.places[other], "ELEMENT", message))
            }
            None => Ok(first.space),
        }
    }

    /// The bodies of the deck, in the order of their first elements.
    ///
    /// # Errors
    /// `Input` if an element is in no section or in two.
    pub(crate) fn bodies(&self) -> Result<Bodies> {
        let section_of = self.section_of_elements()?;
        let part_of = self.parts(&section_of);
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
        out.names = self.body_names(&sections, &out.of_element)?;
        self.name_by_instances(&mut out);
        let has_sections = !self.properties.sections.is_empty();
        let section = |section: &u32| has_sections.then_some(*section as usize);
        out.sections = sections.iter().map(section).collect();
        Ok(out)
    }

    /// The section of each element. In a deck without sections, the number of the first element set
    /// that contains the element. A set of `*ELEMENT` gives way to one of `*ELSET` with the same
    /// elements: a mesher names parts of the geometry by the former, and its groups by the latter.
    fn section_of_elements(&self) -> Result<Vec<u32>> {
        let mut out = vec![NONE; self.n_elements()];
        if self.properties.sections.is_empty() {
            let mut groups: HashMap<Vec<u32>, u32> = HashMap::new();
            let mut all = Vec::new();
            for (number, (name, members)) in self.sets.elements.iter().enumerate() {
                let set = EntitySelection::Set(name.to_string());
                let elements = self.indices(What::Elements, &set, (self.end, "ELSET"))?;
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
        for (number, section) in self.properties.sections.iter().enumerate() {
            let at = (section.place, "SOLID SECTION");
            let set = EntitySelection::Set(section.elements.clone());
            self.refuse_boundary_section(&set, at)?;
            for element in self.indices(What::Elements, &set, at)? {
                if out[element as usize] != NONE {
                    let label = self.element_name(element as usize);
                    let message = format!("element {label} is in another section too: give it one");
                    return Err(self.error(at.0, at.1, message));
                }
                out[element as usize] = number as u32;
            }
        }
        match out.iter().position(|section| *section == NONE) {
            Some(element) => {
                let label = self.element_name(element);
                let message = format!(
                    "element {label} is in no *SOLID SECTION: give its set one, with a material"
                );
                Err(self.error(self.elements.places[element], "ELEMENT", message))
            }
            None => Ok(out),
        }
    }

    /// A number for each element, shared by all elements of its section to which it is connected
    /// through nodes.
    fn parts(&self, section_of: &[u32]) -> Vec<u32> {
        let mut classes = Classes::new(section_of.len());
        // For each node its first section and an element of it; the few nodes in several sections
        // are kept separately.
        let mut first = vec![(NONE, NONE); self.n_nodes()];
        let mut others: HashMap<(u32, u32), u32> = HashMap::new();
        for (element, &section) in section_of.iter().enumerate() {
            let element = element as u32;
            for &node in self.element_nodes(element as usize) {
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
        let n = self.instances.names().len();
        if n == 0 {
            return;
        }
        // For each body its instance, and for each instance its number of bodies.
        let mut of_body = vec![None; bodies.names.len()];
        for (element, &body) in bodies.of_element.iter().enumerate().rev() {
            of_body[body as usize] = self.instances.of(self.elements.labels[element]);
        }
        let mut n_bodies = vec![0; n];
        (of_body.iter().flatten()).for_each(|&instance: &usize| n_bodies[instance] += 1);
        for (name, instance) in bodies.names.iter_mut().zip(of_body) {
            if let Some(instance) = instance.filter(|&instance| n_bodies[instance] == 1) {
                name.clone_from(&self.instances.names()[instance]);
            }
        }
    }

    /// Names of the bodies, whose sections are given. A body is named after its section's set if it
    /// is the whole set, otherwise after an element set that is exactly the body, otherwise with a
    /// number appended.
    fn body_names(&self, sections: &[u32], of_element: &[u32]) -> Result<Vec<String>> {
        let of_section = |section: u32| match self.properties.sections.get(section as usize) {
            Some(section) => section.elements.as_str(),
            None => (self.sets.elements.iter().nth(section as usize)).map_or("body", |set| set.0),
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
            let name = self.sets.elements.written(of_section).unwrap_or(of_section);
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
        for (name, members) in self.sets.elements.iter() {
            let Some((_, place)) = members.first() else {
                continue;
            };
            let set = EntitySelection::Set(name.to_string());
            let elements = self.indices(What::Elements, &set, (*place, "ELSET"))?;
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

/// Turns an error into one of an effect that brinell does not have.
pub(super) fn unsupported(error: Error) -> Error {
    Error::new(crate::ErrorKind::Unsupported, error.message())
}
