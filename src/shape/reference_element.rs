//! Reference data of an element.

use super::functions::Functions;
use super::nodes::Place;

/// Points of a quadrature rule with their weights.
pub type Rule = [(Place, f64)];

/// Reference data shared by all elements of one shape.
#[derive(Debug)]
pub struct ReferenceElement {
    /// The name used in scenes and messages.
    pub name: &'static str,
    /// Number of reference coordinates.
    pub dimension: usize,
    /// Number of corners, which come first among the nodes.
    pub n_corners: usize,
    /// Polynomial degree, 1 or 2.
    pub degree: usize,
    /// Reference coordinates of the nodes.
    pub nodes: &'static [Place],
    /// Values and derivatives of the shape functions.
    pub functions: fn(Place) -> Functions,
    /// The default rule for stiffness and forces: reduced integration for quadratic quadrilaterals,
    /// hexahedra and prisms.
    pub gauss: &'static Rule,
    /// The rule under which every deformation mode has stiffness; for most shapes the same as the
    /// default rule.
    pub full: &'static Rule,
    /// Points at which stress is most accurate (superconvergent): the centre of a bilinear element,
    /// the Gauss points of other elements.
    pub sampling: &'static Rule,
    /// Whether the mean dilatation of the element may replace the dilatation at the points (B-bar).
    pub has_mean_dilatation: bool,
    /// Jacobian determinant of an element whose sides at a corner are perpendicular and of length
    /// 1.
    pub unit_jacobian: f64,
    /// Local node numbers of each facet, in the order of the facet's own nodes. In the plane the
    /// body lies to the left of the line from the first end to the second. In space the nodes run
    /// counter-clockwise seen from outside.
    pub facets: &'static [&'static [usize]],
    /// Local node numbers of the two corners of each edge.
    pub edges: &'static [[usize; 2]],
    /// Number of the cell type in VTK; the node order is VTK's own.
    pub vtk: u8,
    /// Number of the element type in Gmsh.
    pub gmsh: u64,
    /// Position of each node in Gmsh's node order.
    pub gmsh_order: &'static [usize],
}
