//! Line elements that a mesher writes to name boundaries: Gmsh writes the curves of a plane mesh as
//! trusses (`T3D2`). A set of them stands for the faces that they lie on.
//!
//! They have no stiffness here. A deck that gives them a section is refused.

use super::Deck;
use super::bodies::unsupported;
use super::data::{Member, Target};
use super::facets::Face;
use super::keyword::plain;
use super::sets::At;
use super::source::Place;
use crate::error::Result;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Line elements by their numbers.
#[derive(Debug, Clone, Default)]
pub(super) struct LineElements {
    /// Nodes of each, as numbered in the deck.
    nodes: BTreeMap<u64, Vec<u64>>,
    /// Where each type is named first.
    types: BTreeMap<String, Place>,
}

/// The number of nodes of a line element's type.
pub(super) fn nodes_of_line(name: &str) -> Option<usize> {
    match plain(name).trim_end_matches('H') {
        "T2D2" | "T3D2" | "B21" | "B23" | "B31" | "B33" => Some(2),
        "T2D3" | "T3D3" | "B22" | "B32" => Some(3),
        _ => None,
    }
}

impl LineElements {
    pub(super) fn add(&mut self, label: u64, nodes: Vec<u64>) {
        self.nodes.insert(label, nodes);
    }

    pub(super) fn note_type(&mut self, name: &str, place: Place) {
        self.types.entry(name.to_string()).or_insert(place);
    }

    pub(super) fn has(&self, label: u64) -> bool {
        self.nodes.contains_key(&label)
    }

    /// Whether one has a number that is named: from, to, by steps of.
    pub(super) fn any_of(&self, [first, last, step]: [u64; 3]) -> bool {
        let mut between = self.nodes.range(first..=last);
        between.any(|(label, _)| (label - first).is_multiple_of(step))
    }
}

impl Deck {
    /// The line elements of a set of elements.
    pub(super) fn lines_of(&self, target: &Target) -> BTreeSet<u64> {
        let mut out = BTreeSet::new();
        if !self.lines.nodes.is_empty() {
            self.collect_lines(target, &mut BTreeSet::new(), &mut out);
        }
        out
    }

    fn collect_lines(&self, target: &Target, seen: &mut BTreeSet<String>, out: &mut BTreeSet<u64>) {
        let name = match target {
            Target::Label(label) => {
                out.extend(Some(*label).filter(|label| self.lines.has(*label)));
                return;
            }
            Target::Set(name) => name,
        };
        if !seen.insert(name.to_uppercase()) {
            return;
        }
        for (member, _) in self.sets.elements.get(name).into_iter().flatten() {
            match member {
                Member::Of(target) => self.collect_lines(target, seen, out),
                Member::Range(first, last, step) => {
                    let between = self
                        .lines
                        .nodes
                        .range(first..=last)
                        .map(|(label, _)| *label);
                    out.extend(between.filter(|label| (label - first).is_multiple_of(*step)));
                }
                Member::Rows(..) | Member::NodesOf(_) => {}
            }
        }
    }

    /// The nodes of line elements.
    pub(super) fn nodes_of_lines(&self, lines: &BTreeSet<u64>) -> Vec<u32> {
        let nodes = lines.iter().flat_map(|label| &self.lines.nodes[label]);
        nodes
            .filter_map(|node| self.node_index.get(*node))
            .collect()
    }

    /// The faces of elements on which line elements lie.
    pub(super) fn faces_of_lines(&self, lines: &BTreeSet<u64>) -> Vec<Face> {
        if lines.is_empty() {
            return Vec::new();
        }
        let mut lines_at: HashMap<u32, Vec<u64>> = HashMap::new();
        for label in lines {
            let nodes = self.lines.nodes[label].iter();
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
        let mut faces = self.free_faces_among(self.nodes_of_lines(lines));
        faces.retain(on_one);
        faces
    }

    /// Line elements that a section gives a stiffness.
    ///
    /// # Errors
    /// At the section.
    pub(super) fn refuse_line_section(&self, set: &Target, at: At) -> Result<()> {
        let Some(&line) = self.lines_of(set).first() else {
            return Ok(());
        };
        let types: Vec<&str> = self.lines.types.keys().map(String::as_str).collect();
        let message = format!(
            "element {} is a truss or beam ({}), which is not among the elements of brinell",
            self.instances.shown(line),
            types.join(", ")
        );
        Err(unsupported(self.error(at.0, at.1, message)))
    }
}
