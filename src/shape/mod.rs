//! Element shapes: one table row per reference element.
//!
//! All code that depends on a shape (readers, writers, facets, subdivision, quadrature, checks)
//! reads the shape's row ([`Shape::reference`]). A further element needs a further row only.

mod cut;
mod extrapolation;
mod facets;
mod functions;
mod integration;
mod nodes;
mod reference_element;
mod rows;

pub use cut::{Cut, WHOLE, can_be_cut_at, cut_of, cuts, partial_cuts};
pub use extrapolation::NodalExtrapolation;
pub use facets::FacetReference;
pub use functions::{Functions, MAX_NODES};
pub use integration::Integration;
pub use nodes::{CORNERS_OF_CUBE, Place};
pub use reference_element::{ReferenceElement, Rule};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Largest number of nodes of a facet.
pub const MAX_FACET_NODES: usize = 8;

/// The shape of an element. In the plane, nodes are numbered counter-clockwise: corners first, then
/// mid-side nodes beginning with the one between corners 0 and 1. In space, nodes are in the order
/// of VTK. For a hexahedron or a prism these are the corners of the base counter-clockwise seen
/// from inside, the corners of the top, and the middles of the edges of the base, of the top, and
/// between the two.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Shape {
    /// Linear triangle.
    Tri3,
    /// Quadratic triangle.
    Tri6,
    /// Bilinear quadrilateral.
    Quad4,
    /// Serendipity quadrilateral.
    Quad8,
    /// Linear tetrahedron.
    Tet4,
    /// Quadratic tetrahedron.
    Tet10,
    /// Trilinear hexahedron.
    Hex8,
    /// Serendipity hexahedron.
    Hex20,
    /// Linear prism on a triangle.
    Prism6,
    /// Quadratic prism on a triangle.
    Prism15,
}

impl Shape {
    /// All shapes, in the order of their numbers.
    pub const ALL: [Shape; 10] = [
        Shape::Tri3,
        Shape::Tri6,
        Shape::Quad4,
        Shape::Quad8,
        Shape::Tet4,
        Shape::Tet10,
        Shape::Hex8,
        Shape::Hex20,
        Shape::Prism6,
        Shape::Prism15,
    ];

    /// Shapes of elements in the plane.
    pub const PLANE: [Shape; 4] = [Shape::Tri3, Shape::Tri6, Shape::Quad4, Shape::Quad8];

    /// Shapes of elements in space.
    pub const SOLID: [Shape; 6] = [
        Shape::Tet4,
        Shape::Tet10,
        Shape::Hex8,
        Shape::Hex20,
        Shape::Prism6,
        Shape::Prism15,
    ];

    /// The reference data of the shape, its row of the table.
    pub fn reference(self) -> &'static ReferenceElement {
        rows::ROWS[self as usize]
    }

    /// The shape with a given element type number of Gmsh.
    pub(crate) fn of_gmsh(number: u64) -> Option<Shape> {
        Self::ALL
            .into_iter()
            .find(|shape| shape.reference().gmsh == number)
    }

    /// The linear shape with the same corners.
    pub fn linear(self) -> Shape {
        match self {
            Shape::Tri3 | Shape::Tri6 => Shape::Tri3,
            Shape::Quad4 | Shape::Quad8 => Shape::Quad4,
            Shape::Tet4 | Shape::Tet10 => Shape::Tet4,
            Shape::Hex8 | Shape::Hex20 => Shape::Hex8,
            Shape::Prism6 | Shape::Prism15 => Shape::Prism6,
        }
    }

    /// Number of reference coordinates of the shape.
    pub fn dimension(self) -> usize {
        self.reference().dimension
    }

    /// Number of nodes of the shape.
    pub fn n_nodes(self) -> usize {
        self.reference().nodes.len()
    }

    /// Number of corners of the shape.
    pub fn n_corners(self) -> usize {
        self.reference().n_corners
    }

    /// Number of facets of the shape.
    pub(crate) fn n_facets(self) -> usize {
        self.reference().facets.len()
    }

    /// Whether the strain is constant within an element. Such elements lock in isochoric plastic
    /// flow and have no points of superconvergent stress.
    pub(crate) fn has_constant_strain(self) -> bool {
        let row = self.reference();
        row.nodes.len() == row.dimension + 1
    }

    /// Whether facets have mid-side nodes.
    pub fn is_quadratic(self) -> bool {
        self.reference().degree == 2
    }

    /// Local node numbers of a facet: its corners, then its mid-side nodes.
    pub fn facet(self, local: usize) -> &'static [usize] {
        self.reference().facets[local]
    }

    /// Reference data of a facet as an element of its own.
    pub(crate) fn facet_reference(self, local: usize) -> &'static FacetReference {
        FacetReference::with_nodes(self.dimension() - 1, self.facet(local).len())
    }

    /// Whether an element has one corner more than it has dimensions.
    pub(crate) fn is_simplex(self) -> bool {
        self.n_corners() == self.dimension() + 1
    }

    /// Values and derivatives of the shape functions at a place.
    pub fn functions(self, at: Place) -> Functions {
        (self.reference().functions)(at)
    }

    /// The name used in scenes and messages.
    pub fn name(self) -> &'static str {
        self.reference().name
    }
}

#[cfg(test)]
mod tests;
