//! Element types of the format.

use crate::mesh::Shape;
use crate::shape::FacetReference;

/// The type of a point.
const POINT: u64 = 15;

/// What an element of the file is to brinell.
#[derive(Debug, Clone, Copy)]
pub(super) enum Kind {
    /// A point: a node of a node set.
    Point,
    /// A line: an edge of a plane surface. With three nodes the last is the mid-side node.
    Line(&'static FacetReference),
    /// An element of a body, or a face of a solid one.
    Element(Shape),
}

impl Kind {
    /// The kind of a type number; the name of the type where brinell has no such element.
    pub(super) fn from_type(number: u64) -> Result<Kind, String> {
        if let Some(shape) = Shape::of_gmsh(number) {
            return Ok(Kind::Element(shape));
        }
        if let Some(facet) = FacetReference::ALL
            .into_iter()
            .find(|f| f.gmsh == number && f.dimension() == 1)
        {
            return Ok(Kind::Line(facet));
        }
        let name = match number {
            POINT => return Ok(Kind::Point),
            10 => {
                return Err(
                    "9-node quadrilateral (type 10): set Mesh.SecondOrderIncomplete = 1 in Gmsh \
                     for 8-node quadrilaterals"
                        .to_string(),
                );
            }
            12 => {
                return Err(
                    "27-node hexahedron (type 12): set Mesh.SecondOrderIncomplete = 1 in Gmsh for \
                     20-node hexahedra"
                        .to_string(),
                );
            }
            7 => "5-node pyramid",
            13 => {
                return Err(
                    "18-node prism (type 13): set Mesh.SecondOrderIncomplete = 1 in Gmsh for \
                     15-node prisms"
                        .to_string(),
                );
            }
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

    /// Number of nodes.
    pub(super) fn n_nodes(self) -> usize {
        match self {
            Kind::Point => 1,
            Kind::Line(facet) => facet.nodes.len(),
            Kind::Element(shape) => shape.n_nodes(),
        }
    }

    /// Dimension of the physical groups that hold such elements.
    pub(super) fn dimension(self) -> u64 {
        match self {
            Kind::Point => 0,
            Kind::Line(_) => 1,
            Kind::Element(shape) => shape.reference().dimension as u64,
        }
    }

    /// Number of corners.
    pub(super) fn n_corners(self) -> usize {
        match self {
            Kind::Point => 1,
            Kind::Line(facet) => facet.n_corners,
            Kind::Element(shape) => shape.n_corners(),
        }
    }

    /// The type number.
    pub(super) fn type_number(self) -> u64 {
        match self {
            Kind::Point => POINT,
            Kind::Line(facet) => facet.gmsh,
            Kind::Element(shape) => shape.reference().gmsh,
        }
    }
}
