//! The content of a file, common to both versions of the format, before a mesh is made of it.

use super::cursor::Cursor;
use super::kind::{ElementUse, TypeInFile};
use crate::labels::LabelIndex;
use crate::shape::MAX_NODES;
use crate::{Error, ErrorKind, Result};
use std::collections::BTreeMap;

/// A physical group, given by dimension and tag.
pub(super) type PhysicalGroup = (u64, u64);

/// Nodes, elements and physical groups of a file. Elements refer to nodes by index. Byte offsets
/// lead messages back to the line in the file.
#[derive(Default)]
pub(super) struct Content {
    /// Names of physical groups.
    pub names: BTreeMap<PhysicalGroup, String>,
    /// Node numbers as given in the file.
    pub node_labels: Vec<u64>,
    /// Coordinates, three per node.
    pub coordinates: Vec<f64>,
    /// Node indices by node number.
    pub node_index: LabelIndex,
    /// Lines that are in physical groups, and all faces and volumes.
    pub elements: Vec<RawElement>,
    /// Nodes of all elements, one element after the other.
    pub connectivity: Vec<u32>,
    /// Points in physical groups.
    pub points: Vec<RawPoint>,
    /// Number of elements with nodes at centres, which are left out.
    pub n_with_centers: usize,
}

/// An element of a body or of the boundary. Nodes are stored in [`Content::connectivity`] in the
/// order of the elements. An element in several groups is stored once for each.
pub(super) struct RawElement {
    pub kind: ElementUse,
    pub label: u64,
    /// Tag of the physical group; `None` if the element is in no group.
    pub group: Option<u64>,
    /// Byte offset of the element's line in the file.
    pub at: usize,
}

/// A point of a physical group as given in the file.
pub(super) struct RawPoint {
    pub node: u32,
    /// Tag of the physical point.
    pub group: u64,
    /// Byte offset of the point's line in the file.
    pub at: usize,
}

impl Content {
    /// Reads `$PhysicalNames`, which is the same in both versions of the format.
    pub(super) fn read_names(&mut self, cursor: &mut Cursor) -> Result<()> {
        let n = cursor.count("the number of physical names")?;
        cursor.end_line()?;
        for _ in 0..n {
            let dimension = cursor.unsigned("the dimension of a physical group")?;
            let tag = cursor.signed("the tag of a physical group")?.unsigned_abs();
            let name = cursor.quoted("the name of a physical group")?;
            self.names.insert((dimension, tag), name);
        }
        Ok(())
    }

    /// The name of a group, or its number if it has no name.
    pub(super) fn group_name(&self, group: PhysicalGroup) -> String {
        match self.names.get(&group) {
            Some(name) => name.clone(),
            None => group.1.to_string(),
        }
    }

    /// Builds the index of nodes by number, once all nodes have been read.
    pub(super) fn index_nodes(&mut self, cursor: &Cursor) -> Result<()> {
        if self.node_labels.len() >= u32::MAX as usize {
            return Err(cursor.error(format!(
                "{} nodes are more than brinell can number",
                self.node_labels.len()
            )));
        }
        self.node_index = LabelIndex::new(&self.node_labels)
            .map_err(|label| cursor.error(format!("node {label} is given twice in $Nodes")))?;
        Ok(())
    }

    /// The kind of an element type, or an error that names the unsupported type.
    pub(super) fn kind(cursor: &Cursor, at: usize, element_type: u64) -> Result<TypeInFile> {
        TypeInFile::of(element_type).map_err(|name| {
            let place = cursor.error_at(at, format!("unsupported {name}"));
            Error::new(
                ErrorKind::Unsupported,
                format!(
                    "{}; brinell reads 3- and 6-node triangles, 4- and 8-node quadrilaterals, \
                     4- and 10-node tetrahedra, 6- and 15-node prisms, 8- and 20-node hexahedra, \
                     2- and 3-node lines and points",
                    place.message()
                ),
            )
        })
    }

    /// Reads the nodes of an element to the end of the line, and stores the element once for each
    /// of `groups`.
    pub(super) fn read_element(
        &mut self,
        cursor: &mut Cursor,
        TypeInFile {
            element: kind,
            n_centers,
        }: TypeInFile,
        label: u64,
        groups: &[u64],
        at: usize,
    ) -> Result<()> {
        let mut nodes = [0u32; MAX_NODES];
        let n = kind.n_nodes();
        for node in &mut nodes[..n] {
            let place = cursor.at();
            let number = cursor.unsigned("a node number")?;
            *node = self.node_index.get(number).ok_or_else(|| {
                cursor.error_at(
                    place,
                    format!("element {label} refers to node {number}, which is not in $Nodes"),
                )
            })?;
        }
        for _ in 0..n_centers {
            cursor.unsigned("a node number")?;
        }
        self.n_with_centers += usize::from(n_centers > 0);
        cursor.end_line()?;
        match kind {
            ElementUse::Point => self.points.extend(groups.iter().map(|&group| RawPoint {
                node: nodes[0],
                group,
                at,
            })),
            ElementUse::Line(_) if groups.is_empty() => {}
            _ => {
                let several = groups.iter().copied().map(Some);
                let none = groups.is_empty().then_some(None);
                for group in several.chain(none) {
                    self.elements.push(RawElement {
                        kind,
                        label,
                        group,
                        at,
                    });
                    self.connectivity.extend_from_slice(&nodes[..n]);
                }
            }
        }
        Ok(())
    }

    /// All elements with their nodes, given as node indices.
    pub(super) fn with_nodes(&self) -> impl Iterator<Item = (&RawElement, &[u32])> {
        let mut rest = self.connectivity.as_slice();
        self.elements.iter().map(move |element| {
            let (nodes, after) = rest.split_at(element.kind.n_nodes());
            rest = after;
            (element, nodes)
        })
    }

    /// The elements of bodies, which are in a physical group of the mesh's dimension, with their
    /// nodes.
    pub(super) fn of_bodies(&self, dimension: u64) -> impl Iterator<Item = (&RawElement, &[u32])> {
        let is_of_body = move |e: &RawElement| e.kind.dimension() == dimension && e.group.is_some();
        self.with_nodes().filter(move |(e, _)| is_of_body(e))
    }

    /// Checks that no element is in several physical groups, and that some are in one. Returns a
    /// note on elements in no group, which Gmsh saves on request (`Mesh.SaveAll`).
    pub(super) fn require_one_body(
        &self,
        dimension: u64,
        cursor: &Cursor,
    ) -> Result<Option<String>> {
        let of_dimension = |e: &&RawElement| e.kind.dimension() == dimension;
        let mut elements = self.elements.iter().filter(of_dimension).peekable();
        let (mut n_kept, mut n_left, mut first_left) = (0, 0, None);
        while let Some(element) = elements.next() {
            let mut groups: Vec<u64> = element.group.into_iter().collect();
            // Copies of an element in several groups follow each other.
            while let Some(copy) = elements.next_if(|next| next.at == element.at) {
                groups.extend(copy.group);
            }
            match groups.len() {
                0 => {
                    n_left += 1;
                    first_left.get_or_insert(element);
                }
                1 => n_kept += 1,
                _ => {
                    let why = self.several_groups(dimension, element.label, &groups);
                    return Err(cursor.error_at(element.at, why));
                }
            }
        }
        let Some(first) = first_left else {
            return Ok(None);
        };
        let (what, group) = match dimension {
            3 => ("volume", "Volume"),
            _ => ("surface", "Surface"),
        };
        if n_kept == 0 {
            return Err(cursor.error_at(
                first.at,
                format!(
                    "element {} is in no physical {what}: in Gmsh, put every {what} into a \
                     Physical {group}; its name is the body's (files of version 2 that hold all \
                     elements, Mesh.SaveAll, have no groups: save them as version 4.1)",
                    first.label
                ),
            ));
        }
        Ok(Some(format!(
            "elements of the mesh file in no physical {what} are left out, {n_left} of them, such \
             as element {}: if they are a body, put it into a Physical {group} in Gmsh",
            first.label
        )))
    }

    /// A note on nodes at centres, if any element has some.
    pub(super) fn centers_left_out(&self) -> Option<String> {
        (self.n_with_centers > 0).then(|| {
            format!(
                "{} elements of the mesh file have nodes at centres of faces or of the element, \
                 which are left out: 9-node quadrilaterals are read as 8-node ones, 27-node \
                 hexahedra as 20-node ones, 18-node prisms as 15-node ones",
                self.n_with_centers
            )
        })
    }

    /// The reason why an element in several groups cannot be assigned to a body.
    fn several_groups(&self, dimension: u64, label: u64, groups: &[u64]) -> String {
        let what = if dimension == 3 { "volume" } else { "surface" };
        let name = |&g: &u64| self.group_name((dimension, g));
        let names: Vec<String> = groups.iter().map(name).collect();
        format!(
            "element {label} is in several physical {what}s ({}): put each {what} into exactly \
             one, which is its body",
            names.join(", ")
        )
    }
}
