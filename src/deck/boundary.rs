//! Elements that a mesh generator writes in order to name boundaries. Gmsh writes the curves of a
//! plane mesh as trusses (`T3D2`) and the surfaces of a solid mesh as plane elements (`CPS3`);
//! meshio writes beams, shells and rigid facets (`B31H`, `S8R5`, `R3D3`). A set of such elements
//! stands for the faces on which they lie.
//!
//! Boundary elements have no stiffness here. A deck that gives them a section is refused.

use super::Deck;
use super::bodies::unsupported;
use super::data::{EntitySelection, Member};
use super::facets::Face;
use super::keyword::plain;
use super::sets::At;
use super::source::LinePlace;
use crate::error::Result;
use crate::space::Space;
use std::collections::{BTreeSet, HashMap};

/// The number of nodes of a type of lines or shells, which are boundary elements unless a section
/// gives them stiffness.
pub(super) fn nodes_of_boundary(name: &str) -> Option<usize> {
    match plain(name).trim_end_matches('H') {
        "T2D2" | "T3D2" | "B21" | "B23" | "B31" | "B33" => Some(2),
        "T2D3" | "T3D3" | "B22" | "B32" => Some(3),
        "S3" | "S3R" | "STRI3" | "M3D3" | "R3D3" => Some(3),
        "S4" | "S4R" | "M3D4" | "M3D4R" | "R3D4" => Some(4),
        "S6" | "STRI65" | "M3D6" => Some(6),
        "S8" | "S8R" | "S8R5" | "M3D8" | "M3D8R" => Some(8),
        _ => None,
    }
}

impl Deck {
    /// Turns plane elements in a mesh with solids into boundary elements. Returns the first element
    /// of each type.
    pub(super) fn take_faces_of_solids(&mut self) -> Vec<(String, LinePlace)> {
        let elements = &self.elements;
        let is_face: Vec<bool> = (elements.types.iter())
            .map(|of| of.space != Space::Solid)
            .collect();
        if !is_face.contains(&true) || !is_face.contains(&false) {
            return Vec::new();
        }
        let mut found: Vec<(String, LinePlace)> = Vec::new();
        for element in (0..is_face.len()).filter(|&element| is_face[element]) {
            let nodes = &elements.nodes[elements.offsets[element]..elements.offsets[element + 1]];
            self.boundary.add(elements.labels[element], nodes.to_vec());
            let name = elements.types[element].name();
            if found.iter().all(|(known, _)| *known != name) {
                self.boundary.note_type(&name, elements.places[element]);
                found.push((name, elements.places[element]));
            }
        }
        // All elements of one keyword have the same type.
        let mut kept = vec![0; is_face.len() + 1];
        for element in 0..is_face.len() {
            kept[element + 1] = kept[element] + usize::from(!is_face[element]);
        }
        let labels = &elements.labels;
        self.sets.elements.for_each(|members| {
            let old = std::mem::take(members);
            for (member, place) in old {
                match member {
                    Member::Rows(first, last) if is_face.get(first) == Some(&true) => {
                        let of = labels[first..last].iter();
                        members.extend(of.map(|&l| (Member::Of(EntitySelection::Label(l)), place)));
                    }
                    Member::Rows(first, last) => {
                        members.push((Member::Rows(kept[first], kept[last]), place));
                    }
                    other => members.push((other, place)),
                }
            }
        });
        self.elements.retain(|element| !is_face[element]);
        found
    }

    /// The boundary elements in a set of elements.
    pub(super) fn boundary_of(&self, target: &EntitySelection) -> BTreeSet<u64> {
        let mut out = BTreeSet::new();
        if !self.boundary.nodes.is_empty() {
            self.collect_boundary(target, &mut BTreeSet::new(), &mut out);
        }
        out
    }

    fn collect_boundary(
        &self,
        target: &EntitySelection,
        seen: &mut BTreeSet<String>,
        out: &mut BTreeSet<u64>,
    ) {
        let name = match target {
            EntitySelection::Label(label) => {
                out.extend(Some(*label).filter(|label| self.boundary.has(*label)));
                return;
            }
            EntitySelection::Set(name) => name,
            EntitySelection::All => {
                out.extend(self.boundary.nodes.keys());
                return;
            }
        };
        if !seen.insert(name.to_uppercase()) {
            return;
        }
        for (member, _) in self.sets.elements.get(name).into_iter().flatten() {
            match member {
                Member::Of(target) => self.collect_boundary(target, seen, out),
                Member::Range(first, last, step) => {
                    let between = self
                        .boundary
                        .nodes
                        .range(first..=last)
                        .map(|(label, _)| *label);
                    out.extend(between.filter(|label| (label - first).is_multiple_of(*step)));
                }
                Member::Rows(..) | Member::NodesOf(_) => {}
            }
        }
    }

    /// The nodes of the given boundary elements.
    pub(super) fn nodes_of_boundary(&self, lines: &BTreeSet<u64>) -> Vec<u32> {
        let nodes = lines.iter().flat_map(|label| &self.boundary.nodes[label]);
        nodes
            .filter_map(|node| self.node_index.get(*node))
            .collect()
    }

    /// The faces of elements on which the given boundary elements lie.
    pub(super) fn faces_of_boundary(&self, lines: &BTreeSet<u64>) -> Vec<Face> {
        if lines.is_empty() {
            return Vec::new();
        }
        let mut lines_at: HashMap<u32, Vec<u64>> = HashMap::new();
        for label in lines {
            let nodes = self.boundary.nodes[label].iter();
            for node in nodes.filter_map(|node| self.node_index.get(*node)) {
                lines_at.entry(node).or_default().push(*label);
            }
        }
        let on_one = |&(element, local): &Face| {
            let shape = self.elements.types[element as usize].shape;
            let n = shape.facet_reference(local as usize).n_corners;
            let corners = shape.facet(local as usize)[..n].iter();
            let nodes = self.element_nodes(element as usize);
            let mut at = corners.map(|&corner| lines_at.get(&nodes[corner]));
            let first = at.next().flatten();
            first.is_some_and(|first| {
                let rest: Vec<_> = at.collect();
                let all = |line: &u64| rest.iter().all(|at| at.is_some_and(|at| at.contains(line)));
                first.iter().any(all)
            })
        };
        let mut faces = self.free_faces_among(self.nodes_of_boundary(lines));
        faces.retain(on_one);
        faces
    }

    /// Refuses boundary elements to which a section would give a stiffness.
    ///
    /// # Errors
    /// `Unsupported`, at the section.
    pub(super) fn refuse_boundary_section(&self, set: &EntitySelection, at: At) -> Result<()> {
        let Some(&line) = self.boundary_of(set).first() else {
            return Ok(());
        };
        let types: Vec<&str> = self.boundary.types.keys().map(String::as_str).collect();
        let message = format!(
            "element {} ({}) is a truss, a beam, or plane beside solids: a section would give it \
             a stiffness, which brinell does not have",
            self.instances.shown(line),
            types.join(", ")
        );
        Err(unsupported(self.error(at.0, at.1, message)))
    }
}
