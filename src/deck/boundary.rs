//! Elements that a mesh generator writes in order to name boundaries. Gmsh writes the curves of a
//! plane mesh as trusses (`T3D2`) and the surfaces of a solid mesh as plane elements (`CPS3`);
//! meshio writes beams, shells and rigid facets (`B31H`, `S8R5`, `R3D3`). A set of such elements
//! stands for the faces on which they lie.
//!
//! Boundary elements have no stiffness here. A deck that gives them a section is refused.

use super::data::{EntitySelection, Member, Members, Named};
use super::facets::Face;
use super::keyword::plain;
use super::mesh::{DeckElements, DeckMesh};
use super::source::LinePlace;
use crate::space::Space;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Boundary elements by their numbers: lines and shells, and plane elements in a mesh with solids.
#[derive(Debug, Clone, Default)]
pub(super) struct BoundaryElements {
    /// Nodes of each boundary element, as numbered in the deck.
    nodes: BTreeMap<u64, Vec<u64>>,
    /// Place at which each type is named first.
    types: BTreeMap<String, LinePlace>,
}

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

impl BoundaryElements {
    pub(super) fn add(&mut self, label: u64, nodes: Vec<u64>) {
        self.nodes.insert(label, nodes);
    }

    pub(super) fn note_type(&mut self, name: &str, place: LinePlace) {
        self.types.entry(name.to_string()).or_insert(place);
    }

    /// Names of the types, for messages.
    pub(super) fn types(&self) -> String {
        let types: Vec<&str> = self.types.keys().map(String::as_str).collect();
        types.join(", ")
    }

    pub(super) fn has(&self, label: u64) -> bool {
        self.nodes.contains_key(&label)
    }

    /// The boundary elements with a number in the range `[first, last, step]`.
    pub(super) fn in_range(&self, [first, last, step]: [u64; 3]) -> impl Iterator<Item = u64> {
        let between = self.nodes.range(first..=last).map(|(label, _)| *label);
        between.filter(move |label| (label - first).is_multiple_of(step))
    }

    /// Turns plane elements in a mesh with solids into boundary elements, also in the element sets.
    /// Returns the first element of each type.
    pub(super) fn take_faces_of_solids(
        &mut self,
        elements: &mut DeckElements,
        sets: &mut Named<Members>,
    ) -> Vec<(String, LinePlace)> {
        let is_face: Vec<bool> = (elements.types.iter())
            .map(|of| of.space != Space::Solid)
            .collect();
        if !is_face.contains(&true) || !is_face.contains(&false) {
            return Vec::new();
        }
        let mut found: Vec<(String, LinePlace)> = Vec::new();
        for element in (0..is_face.len()).filter(|&element| is_face[element]) {
            let nodes = &elements.nodes[elements.offsets[element]..elements.offsets[element + 1]];
            self.add(elements.labels[element], nodes.to_vec());
            let name = elements.types[element].name();
            if found.iter().all(|(known, _)| *known != name) {
                self.note_type(&name, elements.places[element]);
                found.push((name, elements.places[element]));
            }
        }
        // All elements of one keyword have the same type.
        let mut kept = vec![0; is_face.len() + 1];
        for element in 0..is_face.len() {
            kept[element + 1] = kept[element] + usize::from(!is_face[element]);
        }
        let labels = &elements.labels;
        sets.for_each(|members| {
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
        elements.retain(|element| !is_face[element]);
        found
    }

    /// The boundary elements in one of the sets of elements.
    pub(super) fn among(&self, sets: &Named<Members>, target: &EntitySelection) -> BTreeSet<u64> {
        let mut out = BTreeSet::new();
        if !self.nodes.is_empty() {
            self.collect(sets, target, &mut BTreeSet::new(), &mut out);
        }
        out
    }

    fn collect(
        &self,
        sets: &Named<Members>,
        target: &EntitySelection,
        seen: &mut BTreeSet<String>,
        out: &mut BTreeSet<u64>,
    ) {
        let name = match target {
            EntitySelection::Label(label) => {
                out.extend(Some(*label).filter(|label| self.has(*label)));
                return;
            }
            EntitySelection::Set(name) => name,
            EntitySelection::All => {
                out.extend(self.nodes.keys());
                return;
            }
        };
        if !seen.insert(name.to_uppercase()) {
            return;
        }
        for (member, _) in sets.get(name).into_iter().flatten() {
            match member {
                Member::Of(target) => self.collect(sets, target, seen, out),
                Member::Range(first, last, step) => {
                    out.extend(self.in_range([*first, *last, *step]))
                }
                Member::Rows(..) | Member::NodesOf(_) => {}
            }
        }
    }

    /// The nodes of the given boundary elements.
    pub(super) fn nodes_of(&self, lines: &BTreeSet<u64>, mesh: &DeckMesh) -> Vec<u32> {
        let nodes = lines.iter().flat_map(|label| &self.nodes[label]);
        let index = |node: &u64| mesh.node_index.get(*node);
        nodes.filter_map(index).collect()
    }

    /// The faces of elements on which the given boundary elements lie.
    pub(super) fn faces_of(&self, lines: &BTreeSet<u64>, mesh: &DeckMesh) -> Vec<Face> {
        if lines.is_empty() {
            return Vec::new();
        }
        let mut lines_at: HashMap<u32, Vec<u64>> = HashMap::new();
        for label in lines {
            let nodes = self.nodes[label].iter();
            for node in nodes.filter_map(|node| mesh.node_index.get(*node)) {
                lines_at.entry(node).or_default().push(*label);
            }
        }
        let on_one = |&face: &Face| {
            let mut at = mesh.corners(face).map(|corner| lines_at.get(&corner));
            let first = at.next().flatten();
            first.is_some_and(|first| {
                let rest: Vec<_> = at.collect();
                let all = |line: &u64| rest.iter().all(|at| at.is_some_and(|at| at.contains(line)));
                first.iter().any(all)
            })
        };
        let mut faces = mesh.free_faces_among(self.nodes_of(lines, mesh));
        faces.retain(on_one);
        faces
    }
}
