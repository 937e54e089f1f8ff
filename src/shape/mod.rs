//! Element shapes: one table row per reference element.
//!
//! Whatever depends on a shape (readers, writers, facets, subdivision, quadrature, checks) reads
//! its row ([`Shape::reference`]); a further element is a further row.

mod cut;
mod extrapolation;
mod facets;
mod functions;
mod integration;
mod rows;

pub use cut::{Cut, WHOLE, cut_of, cuts};
pub use extrapolation::Extrapolation;
pub use facets::FacetReference;
pub use functions::Functions;
pub use integration::Integration;
pub use rows::CORNERS_OF_CUBE;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Most nodes of an element.
pub const MAX_NODES: usize = 20;
/// Most nodes of a facet.
pub const MAX_FACET_NODES: usize = 8;

/// The shape of an element. In the plane nodes run counter-clockwise, corners first, then mid-side
/// nodes starting with the one between corners 0 and 1. In space they are in the order of VTK: a
/// hexahedron's or prism's base counter-clockwise seen from inside, then its top, then the middles
/// of the edges of base, top, and between them.
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

/// Reference coordinates; those beyond the dimension are zero.
pub type Place = [f64; 3];
/// Points of a quadrature with their weights.
pub type Rule = [(Place, f64)];

/// What is the same for all elements of a shape.
#[derive(Debug)]
pub struct Reference {
    /// The name used in scenes and messages.
    pub name: &'static str,
    /// Number of reference coordinates.
    pub dimension: usize,
    /// Corners come first among the nodes.
    pub n_corners: usize,
    /// Polynomial degree, 1 or 2.
    pub degree: usize,
    /// Places of the nodes.
    pub nodes: &'static [Place],
    /// Values and derivatives of the shape functions.
    pub functions: fn(Place) -> Functions,
    /// The usual rule that integrates stiffness and forces: a reduced one of quadratic
    /// quadrilaterals, hexahedra and prisms.
    pub gauss: &'static Rule,
    /// The rule that sees every way to deform; of most shapes the usual one.
    pub full: &'static Rule,
    /// Where stress is most accurate (superconvergent): the centre of a bilinear element, the
    /// Gauss points of the others.
    pub sampling: &'static Rule,
    /// Whether the mean over the element may replace the dilatation at the points (B-bar).
    pub has_mean_dilatation: bool,
    /// Jacobian of the element whose sides at a corner are perpendicular and of length 1.
    pub unit_jacobian: f64,
    /// Local node numbers of each facet, in the order of the facet's own nodes. In the plane the
    /// body is on the left from the first end to the second; in space nodes run counter-clockwise
    /// seen from outside.
    pub facets: &'static [&'static [usize]],
    /// Local node numbers of the corners that edges join.
    pub edges: &'static [[usize; 2]],
    /// VTK's cell type; the node order is VTK's own.
    pub vtk: u8,
    /// Gmsh's element type.
    pub gmsh: u64,
    /// Place of each node in Gmsh's order.
    pub gmsh_order: &'static [usize],
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

    /// Shapes of the plane.
    pub const PLANE: [Shape; 4] = [Shape::Tri3, Shape::Tri6, Shape::Quad4, Shape::Quad8];

    /// Shapes of space.
    pub const SOLID: [Shape; 6] = [
        Shape::Tet4,
        Shape::Tet10,
        Shape::Hex8,
        Shape::Hex20,
        Shape::Prism6,
        Shape::Prism15,
    ];

    /// The row of the table.
    pub fn reference(self) -> &'static Reference {
        rows::ROWS[self as usize]
    }

    /// The shape with a number of Gmsh.
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

    /// Number of reference coordinates.
    pub fn dimension(self) -> usize {
        self.reference().dimension
    }

    /// Number of nodes.
    pub fn n_nodes(self) -> usize {
        self.reference().nodes.len()
    }

    /// Number of corners.
    pub fn n_corners(self) -> usize {
        self.reference().n_corners
    }

    /// Number of facets.
    pub(crate) fn n_facets(self) -> usize {
        self.reference().facets.len()
    }

    /// True where the strain is the same all over an element: such elements lock in isochoric
    /// plastic flow, and have no points of superconvergent stress.
    pub(crate) fn has_constant_strain(self) -> bool {
        let row = self.reference();
        row.nodes.len() == row.dimension + 1
    }

    /// True where facets have mid-side nodes.
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

    /// Whether an element has one corner more than dimensions.
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
