//! Element shapes: node order and facets.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The shape of an element. Nodes run counter-clockwise, corners first, then mid-side nodes
/// starting with the one between corners 0 and 1.
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
}

impl Shape {
    /// Number of nodes.
    pub fn n_nodes(self) -> usize {
        match self {
            Shape::Tri3 => 3,
            Shape::Tri6 => 6,
            Shape::Quad4 => 4,
            Shape::Quad8 => 8,
        }
    }

    /// Number of corners, which is the number of facets in two dimensions.
    pub fn n_corners(self) -> usize {
        match self {
            Shape::Tri3 | Shape::Tri6 => 3,
            Shape::Quad4 | Shape::Quad8 => 4,
        }
    }

    /// True where facets have a mid-side node.
    pub fn is_quadratic(self) -> bool {
        matches!(self, Shape::Tri6 | Shape::Quad8)
    }

    /// Local node numbers of a facet: its two ends (body on the left), then the mid-side node.
    pub fn facet(self, local: usize) -> &'static [usize] {
        const TRI3: [&[usize]; 3] = [&[0, 1], &[1, 2], &[2, 0]];
        const TRI6: [&[usize]; 3] = [&[0, 1, 3], &[1, 2, 4], &[2, 0, 5]];
        const QUAD4: [&[usize]; 4] = [&[0, 1], &[1, 2], &[2, 3], &[3, 0]];
        const QUAD8: [&[usize]; 4] = [&[0, 1, 4], &[1, 2, 5], &[2, 3, 6], &[3, 0, 7]];
        match self {
            Shape::Tri3 => TRI3[local],
            Shape::Tri6 => TRI6[local],
            Shape::Quad4 => QUAD4[local],
            Shape::Quad8 => QUAD8[local],
        }
    }

    /// The name used in scenes and messages.
    pub fn name(self) -> &'static str {
        match self {
            Shape::Tri3 => "tri3",
            Shape::Tri6 => "tri6",
            Shape::Quad4 => "quad4",
            Shape::Quad8 => "quad8",
        }
    }
}
