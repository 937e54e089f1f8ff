//! Resolution of names and numbers into indices of nodes, elements and faces.

use super::boundary::BoundaryElements;
use super::data::{EntitySelection, Member, Members, Named, Sets, SurfacePart};
use super::element_type;
use super::facets::Face;
use super::keyword::no_such;
use super::mesh::DeckMesh;
use super::source::{Files, LinePlace};
use crate::error::{Error, Result};
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
    pub(super) fn words(self) -> [&'static str; 2] {
        match self {
            What::Nodes => ["node", "NSET"],
            What::Elements => ["element", "ELSET"],
        }
    }
}

/// The place at which a name or number is used: line and keyword.
pub(super) type At<'k> = (LinePlace, &'k str);

/// The nodes, elements and faces for which names and numbers in a deck stand.
#[derive(Clone, Copy)]
pub(super) struct Lookup<'d> {
    pub(super) mesh: &'d DeckMesh,
    pub(super) boundary: &'d BoundaryElements,
    pub(super) sets: &'d Sets,
    pub(super) files: &'d Files,
}

impl<'d> Lookup<'d> {
    /// The sets of nodes or of elements.
    pub(super) fn sets_of(self, what: What) -> &'d Named<Members> {
        match what {
            What::Nodes => &self.sets.nodes,
            What::Elements => &self.sets.elements,
        }
    }

    /// The numbers of all nodes or elements, and their index.
    fn numbers(self, what: What) -> (&'d LabelIndex, &'d [u64]) {
        let mesh = self.mesh;
        match what {
            What::Nodes => (&mesh.node_index, &mesh.nodes.labels),
            What::Elements => (&mesh.element_index, &mesh.elements.labels),
        }
    }

    /// Whether a number is that of a boundary element.
    fn is_boundary(self, what: What, label: u64) -> bool {
        what == What::Elements && self.boundary.has(label)
    }

    /// Whether there is a node or element, a boundary element too, with a number.
    pub(super) fn has(self, what: What, label: u64) -> bool {
        self.is_boundary(what, label) || self.numbers(what).0.get(label).is_some()
    }

    /// An error for an undefined number.
    pub(super) fn undefined(self, what: What, label: u64, at: At) -> Error {
        let (thing, instances) = (what.words()[0], &self.mesh.instances);
        let (shown, hint) = (instances.shown(label), instances.hint(label));
        self.error(at, format!("there is no {thing} {shown}{hint}"))
    }

    /// An error at the line that uses a name or number.
    pub(super) fn error(self, (place, keyword): At, message: impl std::fmt::Display) -> Error {
        self.files.error(place, keyword, message)
    }

    /// The boundary elements in a set of elements.
    pub(super) fn boundary_of(self, target: &EntitySelection) -> BTreeSet<u64> {
        self.boundary.among(&self.sets.elements, target)
    }

    /// The indices of one node or element, or of a set, in ascending order without duplicates.
    ///
    /// # Errors
    /// `Input` for an undefined number or name, at the line that uses it.
    pub(super) fn indices(self, what: What, target: &EntitySelection, at: At) -> Result<Vec<u32>> {
        let mut out = Vec::new();
        self.collect(what, target, at, &mut BTreeSet::new(), &mut out)?;
        out.sort_unstable();
        out.dedup();
        Ok(out)
    }

    fn collect(
        self,
        what: What,
        target: &EntitySelection,
        at: At,
        seen: &mut BTreeSet<String>,
        out: &mut Vec<u32>,
    ) -> Result<()> {
        let [thing, key] = what.words();
        let (index, labels) = self.numbers(what);
        let sets = self.sets_of(what);
        let name = match target {
            EntitySelection::Label(label) if self.is_boundary(what, *label) => return Ok(()),
            // An undefined number within a set has been reported already.
            EntitySelection::Label(label) if !seen.is_empty() && index.get(*label).is_none() => {
                return Ok(());
            }
            EntitySelection::Label(label) => {
                let found = index.get(*label);
                let found = found.ok_or_else(|| self.undefined(what, *label, at))?;
                out.push(found);
                return Ok(());
            }
            EntitySelection::Set(name) => name,
            EntitySelection::All => {
                out.extend(0..labels.len() as u32);
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
                        out.extend_from_slice(self.mesh.element_nodes(element as usize));
                    }
                    out.extend(self.boundary.nodes_of(&self.boundary_of(&of), self.mesh));
                }
            }
        }
        Ok(())
    }

    /// Collects the defined numbers of `GENERATE`; undefined numbers between its ends are skipped,
    /// as in CalculiX. Few numbers are looked up one by one; for many numbers, all nodes or
    /// elements of the deck are searched.
    fn range(
        self,
        what: What,
        [first, last, step]: [u64; 3],
        at: At,
        out: &mut Vec<u32>,
    ) -> Result<()> {
        let (index, labels) = self.numbers(what);
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
        let of_lines = || {
            what == What::Elements && self.boundary.in_range([first, last, step]).next().is_some()
        };
        if out.len() == before && !of_lines() {
            let thing = what.words()[0];
            let message = format!(
                "GENERATE from {} to {} by {step}: there is no such {thing}",
                self.mesh.instances.shown(first),
                self.mesh.instances.shown(last)
            );
            return Err(self.error(at, message));
        }
        Ok(())
    }

    /// Checks that no set consists of nothing but sets that contain it.
    ///
    /// # Errors
    /// `Input`, at the line that names the other set.
    pub(super) fn refuse_empty_circles(self) -> Result<()> {
        for what in [What::Nodes, What::Elements] {
            let [thing, key] = what.words();
            for (name, members) in self.sets_of(what).iter() {
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
                    return Err(self.error((place, key), message));
                }
            }
        }
        Ok(())
    }

    /// Collects the names, in capitals, of all sets that a set contains.
    fn reach(self, what: What, name: &str, reached: &mut BTreeSet<String>) {
        for (member, _) in self.sets_of(what).get(name).into_iter().flatten() {
            if let Member::Of(EntitySelection::Set(other)) = member
                && reached.insert(other.to_uppercase())
            {
                self.reach(what, other, reached);
            }
        }
    }

    fn unknown(self, what: &str, name: &str, known: Vec<String>, at: At) -> Error {
        let known = known.iter().map(String::as_str);
        let message = no_such(what, name, known, "name one that there is");
        self.error(at, message)
    }

    /// The local facet of an element's face number.
    pub(super) fn facet(self, element: u32, number: usize, at: At) -> Result<Face> {
        let shape = self.mesh.shape(element as usize);
        let local = element_type::facet(shape, number).ok_or_else(|| {
            let message = format!(
                "element {} is a {} and has {} faces, none with number {number}",
                self.mesh.element_name(element as usize),
                shape.name(),
                shape.n_facets()
            );
            self.error(at, message)
        })?;
        Ok((element, local as u8))
    }

    /// The faces of a surface, in ascending order without duplicates.
    ///
    /// # Errors
    /// `Input` for an undefined name, number or face, or for a surface without faces.
    pub(super) fn surface(self, name: &str, at: At) -> Result<Vec<Face>> {
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
                    out.extend(self.mesh.free_faces_of(&elements));
                    let lines = self.boundary_of(on);
                    out.extend(self.boundary.faces_of(&lines, self.mesh));
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
            out.extend(self.mesh.free_faces_among(nodes));
        }
        out.sort_unstable();
        out.dedup();
        if out.is_empty() {
            let message = format!("the surface {name} has no faces of elements");
            return Err(self.error(at, message));
        }
        Ok(out)
    }
}
