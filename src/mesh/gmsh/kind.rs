//! Element types of the Gmsh format.

use crate::mesh::Shape;
use crate::shape::FacetReference;

/// Number of the element type of a point.
const POINT: u64 = 15;

/// Use of an element of the file in brinell.
#[derive(Debug, Clone, Copy)]
pub(super) enum ElementUse {
    /// A point, which becomes a node of a node set.
    Point,
    /// A line, which is an edge of a plane surface. If it has three nodes, the last is the mid-side
    /// node.
    Line(&'static FacetReference),
    /// An element of a body, or a face of a solid body.
    Element(Shape),
}

/// An element type of the file: its use, and the number of its nodes that brinell leaves out.
#[derive(Debug, Clone, Copy)]
pub(super) struct TypeInFile {
    pub element: ElementUse,
    /// Number of nodes at the centres of faces and of the element, which come last and are left
    /// out.
    pub n_centers: usize,
}

impl TypeInFile {
    /// The use of a type number; an error with the name of the type if brinell has no such element.
    pub(super) fn of(number: u64) -> Result<TypeInFile, String> {
        let (shape, n_centers) = match number {
            10 => (Some(Shape::Quad8), 1),
            12 => (Some(Shape::Hex20), 7),
            13 => (Some(Shape::Prism15), 3),
            _ => (Shape::of_gmsh(number), 0),
        };
        let element = match shape {
            Some(shape) => ElementUse::Element(shape),
            None => ElementUse::of_boundary(number)?,
        };
        Ok(TypeInFile { element, n_centers })
    }
}

impl ElementUse {
    /// The use of a type number that is no element of a body.
    fn of_boundary(number: u64) -> Result<ElementUse, String> {
        if let Some(facet) = FacetReference::ALL
            .into_iter()
            .find(|f| f.gmsh == number && f.dimension() == 1)
        {
            return Ok(ElementUse::Line(facet));
        }
        let name = match number {
            POINT => return Ok(ElementUse::Point),
            7 => "5-node pyramid",
            14 => "14-node pyramid",
            19 => "13-node pyramid",
            20 => "9-node triangle",
            21 => "10-node triangle",
            22 => "12-node triangle",
            23 => "15-node triangle",
            24 => "15-node triangle",
            25 => "21-node triangle",
            26 => "4-node line",
            27 => "5-node line",
            28 => "6-node line",
            _ => "element",
        };
        Err(format!("{name} (type {number})"))
    }

    /// Number of nodes of the element.
    pub(super) fn n_nodes(self) -> usize {
        match self {
            ElementUse::Point => 1,
            ElementUse::Line(facet) => facet.nodes.len(),
            ElementUse::Element(shape) => shape.n_nodes(),
        }
    }

    /// Dimension of the physical groups that can hold such elements.
    pub(super) fn dimension(self) -> u64 {
        match self {
            ElementUse::Point => 0,
            ElementUse::Line(_) => 1,
            ElementUse::Element(shape) => shape.reference().dimension as u64,
        }
    }

    /// Number of corners of the element.
    pub(super) fn n_corners(self) -> usize {
        match self {
            ElementUse::Point => 1,
            ElementUse::Line(facet) => facet.n_corners,
            ElementUse::Element(shape) => shape.n_corners(),
        }
    }

    /// Number of the element type in Gmsh.
    pub(super) fn type_number(self) -> u64 {
        match self {
            ElementUse::Point => POINT,
            ElementUse::Line(facet) => facet.gmsh,
            ElementUse::Element(shape) => shape.reference().gmsh,
        }
    }
}
