//! Resolution of names and numbers into indices of nodes, elements and faces.

use super::data::{Account, EntitySelection, Member, Members, Named, SurfacePart};
use super::facets::Face;
use super::keyword::no_such;
use super::source::LinePlace;
use super::{Deck, element_type};
use crate::error::Result;
use crate::labels::LabelIndex;
use std::collections::BTreeSet;

/// Selects between nodes and elements.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum What {
    Nodes,
    Elements,
}

impl What {
    /// The words for a node or element, and the keyword that defines sets of them.
    fn words(self) -> [&'static str; 2] {
        match self {
            What::Nodes => ["node", "NSET"],
            What::Elements => ["element", "ELSET"],
        }
    }
}

/// The place at which a name or number is used: line and keyword.
pub(super) type At<'k> = (LinePlace, &'k str);

impl Deck {
    fn table(&self, what: What) -> (&Named<Members>, &LabelIndex, &[u64]) {
        match what {
            What::Nodes => (&self.sets.nodes, &self.node_index, &self.nodes.labels),
            What::Elements => (
                &self.sets.elements,
                &self.element_index,
                &self.elements.labels,
            ),
        }
    }

    /// The indices of one node or element, or of a set, in ascending order without duplicates.
    ///
    /// # Errors
    /// `Input` for an undefined number or name, at the line that uses it.
    pub(super) fn indices(&self, what: What, target: &EntitySelection, at: At) -> Result<Vec<u32>> {
        let mut out = Vec::new();
        self.collect(what, target, at, &mut BTreeSet::new(), &mut out)?;
        out.sort_unstable();
        out.dedup();
        Ok(out)
    }

    fn collect(
        &self,
        what: What,
        target: &EntitySelection,
        at: At,
        seen: &mut BTreeSet<String>,
        out: &mut Vec<u32>,
    ) -> Result<()> {
        let [thing, key] = what.words();
        let (sets, index, _) = self.table(what);
        let name = match target {
            EntitySelection::Label(label)
                if what == What::Elements && self.boundary.has(*label) =>
            {
                return Ok(());
            }
            // An undefined number within a set has been reported already.
            EntitySelection::Label(label) if !seen.is_empty() && index.get(*label).is_none() => {
                return Ok(());
            }
            EntitySelection::Label(label) => {
                let found = index.get(*label).ok_or_else(|| {
                    let (shown, hint) = (self.instances.shown(*label), self.instances.hint(*label));
                    self.error(at.0, at.1, format!("there is no {thing} {shown}{hint}"))
                })?;
                out.push(found);
                return Ok(());
            }
            EntitySelection::Set(name) => name,
            EntitySelection::All => {
                out.extend(0..self.table(what).2.len() as u32);
                return Ok(());
            }
        };
        let members = sets
            .get(name)
            .ok_or_else(|| self.unknown(&format!("{thing} set"), name, sets.names(), at))?;
        // A set contributes only once, even if it contains itself.
        if !seen.insert(name.to_uppercase()) {
            return Ok(());
        }
        for (member, place) in members {
            let at = (*place, key);
            match member {
                Member::Of(target) => self.collect(what, target, at, seen, out)?,
                Member::Rows(first, last) => out.extend(*first as u32..*last as u32),
                Member::Range(first, last, step) => {
                    self.range(what, [*first, *last, *step], at, out)?;
                }
                Member::NodesOf(name) => {
                    let of = EntitySelection::Set(name.clone());
                    for element in self.indices(What::Elements, &of, at)? {
                        out.extend_from_slice(self.element_nodes(element as usize));
                    }
                    out.extend(self.nodes_of_boundary(&self.boundary_of(&of)));
                }
            }
        }
        Ok(())
    }

    /// Collects the numbers of `GENERATE`: those between its ends that are defined, as in CalculiX.
    /// They are looked up one by one if they are few, otherwise searched among all numbers.
    fn range(
        &self,
        what: What,
        [first, last, step]: [u64; 3],
        at: At,
        out: &mut Vec<u32>,
    ) -> Result<()> {
        let (_, index, labels) = self.table(what);
        let before = out.len();
        if (last - first) / step < labels.len() as u64 {
            let named = (first..=last).step_by(step as usize);
            out.extend(named.filter_map(|label| index.get(label)));
        } else {
            let is_named = |label: &u64| {
                (first..=last).contains(label) && (label - first).is_multiple_of(step)
            };
            let named = labels.iter().filter(|label| is_named(label));
            out.extend(named.filter_map(|&label| index.get(label)));
        }
        let of_lines = || what == What::Elements && self.boundary.any_of([first, last, step]);
        if out.len() == before && !of_lines() {
            let thing = what.words()[0];
            let message = format!(
                "GENERATE from {} to {} by {step}: there is no such {thing}",
                self.instances.shown(first),
                self.instances.shown(last)
            );
            return Err(self.error(at.0, at.1, message));
        }
        Ok(())
    }

    /// Adds remarks on undefined numbers in sets, as CalculiX does.
    ///
    /// # Errors
    /// `Input` if all members of a set are undefined.
    pub(super) fn leave_out_absent(&mut self) -> Result<()> {
        let mut notes = Vec::new();
        for what in [What::Nodes, What::Elements] {
            let (sets, index, _) = self.table(what);
            let [thing, key] = what.words();
            let is_absent = |label: u64| {
                let is_line = what == What::Elements && self.boundary.has(label);
                !is_line && index.get(label).is_none()
            };
            for (name, members) in sets.iter() {
                let absent = members.iter().filter_map(|(member, place)| match member {
                    Member::Of(EntitySelection::Label(label)) if is_absent(*label) => {
                        Some((*label, *place))
                    }
                    _ => None,
                });
                let absent: Vec<(u64, LinePlace)> = absent.collect();
                let Some(&(label, place)) = absent.first() else {
                    continue;
                };
                let (shown, hint) = (self.instances.shown(label), self.instances.hint(label));
                if absent.len() == members.len() {
                    let message = format!("there is no {thing} {shown}{hint}");
                    return Err(self.error(place, key, message));
                }
                let more = match absent.len() {
                    1 => String::new(),
                    n => format!(", nor {} more", n - 1),
                };
                let text = format!("{name}: there is no {thing} {shown}{more}: left out");
                notes.push((place, key, text));
            }
        }
        self.leave_out_of_surfaces(&mut notes)?;
        self.refuse_empty_circles()?;
        for (place, key, text) in notes {
            Account::add(&mut self.account.taken, &self.files, place, key, &text);
        }
        Ok(())
    }

    /// Takes undefined numbers out of surfaces, with a remark for each surface.
    ///
    /// # Errors
    /// `Input` if nothing of a surface is left.
    fn leave_out_of_surfaces(&mut self, notes: &mut Vec<(LinePlace, &str, String)>) -> Result<()> {
        let mut surfaces = std::mem::take(&mut self.sets.surfaces);
        let mut wrong = None;
        surfaces.for_each_named(|name, parts| {
            let n = parts.len();
            let mut first = None;
            parts.retain(|(part, place)| {
                let (what, on) = match part {
                    SurfacePart::Face(on, _) | SurfacePart::Free(on) => (What::Elements, on),
                    SurfacePart::OfNodes(on) => (What::Nodes, on),
                };
                let EntitySelection::Label(label) = on else {
                    return true;
                };
                let is_line = what == What::Elements && self.boundary.has(*label);
                let is_there = is_line || self.table(what).1.get(*label).is_some();
                if !is_there && first.is_none() {
                    first = Some((*place, what.words()[0], *label));
                }
                is_there
            });
            let Some((place, thing, label)) = first else {
                return;
            };
            let (shown, hint) = (self.instances.shown(label), self.instances.hint(label));
            if parts.is_empty() {
                let message = format!("there is no {thing} {shown}{hint}");
                wrong.get_or_insert_with(|| self.error(place, "SURFACE", message));
            }
            let more = match n - parts.len() {
                1 => String::new(),
                n => format!(", nor {} more", n - 1),
            };
            let text = format!("{name}: there is no {thing} {shown}{more}: left out");
            notes.push((place, "SURFACE", text));
        });
        self.sets.surfaces = surfaces;
        wrong.map_or(Ok(()), Err)
    }

    /// Checks that no set consists of nothing but sets that contain it.
    ///
    /// # Errors
    /// `Input`, at the line that names the other set.
    fn refuse_empty_circles(&self) -> Result<()> {
        for what in [What::Nodes, What::Elements] {
            let [thing, key] = what.words();
            for (name, members) in self.table(what).0.iter() {
                let other = members.iter().find_map(|(member, place)| match member {
                    Member::Of(EntitySelection::Set(other)) => Some((other, *place)),
                    _ => None,
                });
                let Some((other, place)) = other else {
                    continue;
                };
                let mut reached = BTreeSet::new();
                self.reach(what, name, &mut reached);
                if !reached.contains(&name.to_uppercase()) {
                    continue;
                }
                let mut found = Vec::new();
                let on = EntitySelection::Set(name.to_string());
                self.collect(what, &on, (place, key), &mut BTreeSet::new(), &mut found)?;
                if found.is_empty() && (what == What::Nodes || self.boundary_of(&on).is_empty()) {
                    let message = format!(
                        "{name} contains {other}, and that contains {name}, but no {thing} is in \
                         them: give the numbers of some"
                    );
                    return Err(self.error(place, key, message));
                }
            }
        }
        Ok(())
    }

    /// Collects the names, in capitals, of all sets that a set contains.
    fn reach(&self, what: What, name: &str, reached: &mut BTreeSet<String>) {
        for (member, _) in self.table(what).0.get(name).into_iter().flatten() {
            if let Member::Of(EntitySelection::Set(other)) = member
                && reached.insert(other.to_uppercase())
            {
                self.reach(what, other, reached);
            }
        }
    }

    fn unknown(&self, what: &str, name: &str, known: Vec<String>, at: At) -> crate::error::Error {
        let known = known.iter().map(String::as_str);
        let message = no_such(what, name, known, "name one that there is");
        self.error(at.0, at.1, message)
    }

    /// Indices of the nodes of an element.
    pub(crate) fn element_nodes(&self, element: usize) -> &[u32] {
        let offsets = &self.elements.offsets;
        &self.connectivity[offsets[element]..offsets[element + 1]]
    }

    /// The nodes of the given faces, in ascending order without duplicates.
    pub(super) fn nodes_of(&self, faces: &[Face]) -> Vec<u32> {
        let of_face = |&(element, local): &Face| {
            let nodes = self.element_nodes(element as usize);
            let shape = self.elements.types[element as usize].shape;
            shape.facet(local as usize).iter().map(|&k| nodes[k])
        };
        let mut nodes: Vec<u32> = faces.iter().flat_map(of_face).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// The local facet of an element's face number.
    pub(super) fn facet(&self, element: u32, number: usize, at: At) -> Result<Face> {
        let shape = self.elements.types[element as usize].shape;
        let local = element_type::facet(shape, number).ok_or_else(|| {
            let message = format!(
                "element {} is a {} and has {} faces, none with number {number}",
                self.element_name(element as usize),
                shape.name(),
                shape.n_facets()
            );
            self.error(at.0, at.1, message)
        })?;
        Ok((element, local as u8))
    }

    /// The faces of a surface, in ascending order without duplicates.
    ///
    /// # Errors
    /// `Input` for an undefined name, number or face, or for a surface without faces.
    pub(super) fn surface(&self, name: &str, at: At) -> Result<Vec<Face>> {
        let surfaces = &self.sets.surfaces;
        let parts = surfaces
            .get(name)
            .ok_or_else(|| self.unknown("surface", name, surfaces.names(), at))?;
        let mut out = Vec::new();
        for (part, place) in parts {
            let at = (*place, "SURFACE");
            match part {
                SurfacePart::Face(on, number) => {
                    for element in self.indices(What::Elements, on, at)? {
                        out.push(self.facet(element, *number, at)?);
                    }
                }
                SurfacePart::Free(on) => {
                    let elements = self.indices(What::Elements, on, at)?;
                    out.extend(self.free_faces_of(&elements));
                    out.extend(self.faces_of_boundary(&self.boundary_of(on)));
                }
                SurfacePart::OfNodes(_) => {}
            }
        }
        let mut nodes = Vec::new();
        for (part, place) in parts {
            if let SurfacePart::OfNodes(on) = part {
                nodes.extend(self.indices(What::Nodes, on, (*place, "SURFACE"))?);
            }
        }
        if !nodes.is_empty() {
            out.extend(self.free_faces_among(nodes));
        }
        out.sort_unstable();
        out.dedup();
        if out.is_empty() {
            let message = format!("the surface {name} has no faces of elements");
            return Err(self.error(at.0, at.1, message));
        }
        Ok(out)
    }
}
