//! Nodes, elements, bodies and named sets: geometry only, without mechanics.
//!
//! The dimension is data ([`Mesh::dimension`]). Element shapes define their own node order and
//! facets ([`Shape`]).

mod conformity;
mod curve;
mod decimal_places;
pub mod generate;
pub mod gmsh;
pub mod inp;
mod jacobian;
mod local_refinement;
mod nearest;
pub(crate) mod node_values;
mod of_body;
mod part;
mod pieces;
mod round;
mod subdivision;
pub mod surface;
mod sweep;
mod validate;

use crate::shape::{FacetReference, Rule};
pub use crate::shape::{Integration, Shape};
use crate::space::{Vector, in_words};
pub use curve::Curve;
pub(crate) use decimal_places::{last_place, rounding};
pub use local_refinement::refined;
pub(crate) use nearest::NearestNode;
pub use round::{declared, lay_on};
pub use subdivision::subdivided;
pub use sweep::{extruded, revolved};
pub use validate::validate;
pub(crate) use validate::warning_of_folds;

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A facet of an element: an edge in the plane, a face in space.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Facet {
    /// Index of the element.
    pub element: usize,
    /// Local facet number, see [`Shape::facet`].
    pub local: usize,
}

/// A named surface: facets of one body's boundary.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Surface {
    /// Facets of the surface, in any order.
    pub facets: Vec<Facet>,
    /// The exact shape of the surface, if it is known.
    pub curve: Option<Curve>,
}

/// A finite element mesh.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Mesh {
    /// Space dimension, 2 or 3.
    pub dimension: usize,
    /// `n_nodes x dimension` coordinates, node by node; (r, z) in an axisymmetric model.
    pub coordinates: Vec<f64>,
    /// Shape of each element.
    pub shapes: Vec<Shape>,
    /// Index in [`Mesh::connectivity`] at which each element's nodes begin; length
    /// `n_elements + 1`.
    pub offsets: Vec<usize>,
    /// Node indices of all elements, one element after the other; corners first, in the order of
    /// [`Shape`].
    pub connectivity: Vec<u32>,
    /// Body index of each element.
    pub element_body: Vec<u32>,
    /// Names of the bodies.
    pub bodies: Vec<String>,
    /// Named node sets (sorted, without duplicates).
    pub node_sets: BTreeMap<String, Vec<usize>>,
    /// Named surfaces. A surface's nodes may be used wherever a node set may.
    pub surfaces: BTreeMap<String, Surface>,
    /// Node numbers as given in the mesh file, for messages; empty for a generated mesh (then
    /// 1-based).
    pub node_labels: Vec<u64>,
    /// Element numbers as given in the mesh file; empty for a generated mesh (then 1-based).
    pub element_labels: Vec<u64>,
    /// Integration of each body's elements; empty if all bodies use reduced integration.
    pub integration: Vec<Integration>,
    /// Remarks on what was left out when the mesh was read, for the warnings of a model.
    pub notes: Vec<String>,
    /// Spacing of the last decimal place to which the coordinates were rounded before the mesh was
    /// refined; 0 if they were not.
    #[serde(skip)]
    pub places: f64,
}

impl Mesh {
    /// Number of nodes of the mesh.
    pub fn n_nodes(&self) -> usize {
        self.coordinates
            .len()
            .checked_div(self.dimension)
            .unwrap_or(0)
    }

    /// Number of elements of the mesh.
    pub fn n_elements(&self) -> usize {
        self.shapes.len()
    }

    /// The integration (reduced or full) of an element.
    #[inline]
    pub fn integration_of(&self, element: usize) -> Integration {
        let body = self.element_body[element] as usize;
        self.integration.get(body).copied().unwrap_or_default()
    }

    /// The rule with which an element is integrated.
    pub fn rule(&self, element: usize) -> &'static Rule {
        self.shapes[element].rule(self.integration_of(element))
    }

    /// Length of the diagonal of the box around the nodes.
    pub(crate) fn diagonal(&self) -> f64 {
        let along = |axis: usize| {
            let places = (0..self.n_nodes()).map(|node| self.point(node)[axis]);
            let ends = places.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| {
                [a.min(x), b.max(x)]
            });
            ends[1] - ends[0]
        };
        (0..3).map(|axis| along(axis).powi(2)).sum::<f64>().sqrt()
    }

    /// Number of integration points of an element.
    #[inline]
    pub(crate) fn n_points(&self, element: usize) -> usize {
        self.rule(element).len()
    }

    /// Largest number of integration points of an element, at least 1.
    pub(crate) fn most_points(&self) -> usize {
        let each = (0..self.n_elements()).map(|e| self.n_points(e));
        each.max().unwrap_or(1)
    }

    /// Whether any body is fully integrated.
    pub(crate) fn has_full_integration(&self) -> bool {
        self.integration.contains(&Integration::Full)
    }

    /// Lowest polynomial degree of the elements, 1 or 2.
    pub fn degree(&self) -> usize {
        let quadratic = self.shapes.iter().all(|shape| shape.is_quadratic());
        if quadratic { 2 } else { 1 }
    }

    /// Coordinates of a node; z = 0 in a plane mesh.
    #[inline]
    pub fn point(&self, node: usize) -> Vector {
        let at = self.dimension * node;
        match self.dimension {
            2 => [self.coordinates[at], self.coordinates[at + 1], 0.0],
            _ => [
                self.coordinates[at],
                self.coordinates[at + 1],
                self.coordinates[at + 2],
            ],
        }
    }

    /// The first two coordinates of a node, which are all its coordinates in a plane mesh.
    pub fn in_plane(&self, node: usize) -> [f64; 2] {
        let [x, y, _] = self.point(node);
        [x, y]
    }

    /// The coordinates of a node, in words: `(x, y)` or `(x, y, z)`.
    pub fn place(&self, node: usize) -> String {
        in_words(self.point(node), self.dimension)
    }

    /// Whether the mesh is three-dimensional.
    pub fn is_solid(&self) -> bool {
        self.dimension == 3
    }

    /// Reference data of a facet as an element of its own.
    pub(crate) fn facet_reference(&self, facet: Facet) -> &'static FacetReference {
        self.shapes[facet.element].facet_reference(facet.local)
    }

    /// Number of corners of a facet.
    pub(crate) fn facet_corners(&self, facet: Facet) -> usize {
        self.facet_reference(facet).n_corners
    }

    /// Coordinates of an element's nodes, at the front of an array of fixed length.
    #[inline]
    pub fn element_coordinates<const D: usize, const N: usize>(
        &self,
        element: usize,
    ) -> [[f64; D]; N] {
        let mut out = [[0.0; D]; N];
        let (coordinates, _) = self.coordinates.as_chunks::<D>();
        for (x, &node) in out.iter_mut().zip(self.nodes(element)) {
            *x = coordinates[node as usize];
        }
        out
    }

    /// Node indices of an element.
    pub fn nodes(&self, element: usize) -> &[u32] {
        &self.connectivity[self.offsets[element]..self.offsets[element + 1]]
    }

    /// Node indices of a facet: its corners first, then any mid-side nodes.
    pub fn facet_nodes(&self, facet: Facet) -> impl Iterator<Item = usize> + Clone + '_ {
        let nodes = self.nodes(facet.element);
        self.shapes[facet.element]
            .facet(facet.local)
            .iter()
            .map(move |&i| nodes[i] as usize)
    }

    /// Nodes of a node set or of a surface, sorted, without duplicates; `None` if there is no set
    /// of this name.
    pub fn set_nodes(&self, name: &str) -> Option<Vec<usize>> {
        if let Some(nodes) = self.node_sets.get(name) {
            return Some(nodes.clone());
        }
        let surface = self.surfaces.get(name)?;
        let mut nodes: Vec<usize> = surface
            .facets
            .iter()
            .flat_map(|&f| self.facet_nodes(f))
            .collect();
        nodes.sort_unstable();
        nodes.dedup();
        Some(nodes)
    }

    /// All names of node sets and surfaces, for messages.
    pub fn set_names(&self) -> Vec<&str> {
        self.node_sets
            .keys()
            .chain(self.surfaces.keys())
            .map(String::as_str)
            .collect()
    }

    /// The number by which the user knows a node.
    pub fn node_label(&self, node: usize) -> u64 {
        self.node_labels
            .get(node)
            .copied()
            .unwrap_or(node as u64 + 1)
    }

    /// The number by which the user knows an element.
    pub(crate) fn element_label(&self, element: usize) -> u64 {
        self.element_labels
            .get(element)
            .copied()
            .unwrap_or(element as u64 + 1)
    }

    /// Describes an element by its number, shape and body.
    pub(crate) fn element_in_words(&self, element: usize) -> String {
        format!(
            "element {} ({}, body `{}`)",
            self.element_label(element),
            self.shapes[element].name(),
            self.bodies[self.element_body[element] as usize]
        )
    }

    /// Appends an element to the mesh.
    pub fn push_element(&mut self, shape: Shape, body: usize, nodes: &[u32]) {
        if self.offsets.is_empty() {
            self.offsets.push(0);
        }
        self.shapes.push(shape);
        self.connectivity.extend_from_slice(nodes);
        self.offsets.push(self.connectivity.len());
        self.element_body.push(body as u32);
    }
}
