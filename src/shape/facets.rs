//! Facets as elements of their own: lines in the plane, triangles and quadrilaterals in space.

use super::functions::{self, Functions};
use super::nodes::{Place, SQUARE, TRIANGLE};
use super::reference_element::Rule;
use crate::space::{Vector, cross, unit};

/// Reference data shared by all facets of one shape.
#[derive(Debug)]
pub struct FacetReference {
    /// Number of corners (for a line, its ends), which come first among the nodes.
    pub n_corners: usize,
    /// Reference coordinates of the nodes; on a line within `[-1, 1]`.
    pub nodes: &'static [Place],
    /// Values and derivatives of the shape functions.
    pub functions: fn(Place) -> Functions,
    /// The rule, exact to degree 5, for tractions and nodal areas on curved facets.
    pub rule: &'static Rule,
    /// Number of the element type in Gmsh.
    pub gmsh: u64,
}

/// Gauss abscissa `sqrt(3/5)`.
const G: f64 = 0.774_596_669_241_483_4;
const OUTER: f64 = 5.0 / 9.0;
const MIDDLE: f64 = 8.0 / 9.0;

const LINE_RULE: &Rule = &[
    ([-G, 0.0, 0.0], OUTER),
    ([0.0, 0.0, 0.0], MIDDLE),
    ([G, 0.0, 0.0], OUTER),
];

const QUADRILATERAL_RULE: &Rule = &[
    ([-G, -G, 0.0], OUTER * OUTER),
    ([0.0, -G, 0.0], MIDDLE * OUTER),
    ([G, -G, 0.0], OUTER * OUTER),
    ([-G, 0.0, 0.0], OUTER * MIDDLE),
    ([0.0, 0.0, 0.0], MIDDLE * MIDDLE),
    ([G, 0.0, 0.0], OUTER * MIDDLE),
    ([-G, G, 0.0], OUTER * OUTER),
    ([0.0, G, 0.0], MIDDLE * OUTER),
    ([G, G, 0.0], OUTER * OUTER),
];

/// Seven-point rule (J. Radon 1948; A. H. Stroud, *Approximate Calculation of Multiple Integrals*,
/// 1971, T2 5-1): the centroid, and two orbits at `(6 -+ sqrt 15)/21`.
const TRIANGLE_RULE: &Rule = {
    const NEAR: f64 = 0.470_142_064_105_115_1;
    const FAR: f64 = 0.101_286_507_323_456_34;
    const OF_NEAR: f64 = 0.066_197_076_394_253_1;
    const OF_FAR: f64 = 0.062_969_590_272_413_58;
    &[
        ([1.0 / 3.0, 1.0 / 3.0, 0.0], 0.1125),
        ([NEAR, NEAR, 0.0], OF_NEAR),
        ([1.0 - 2.0 * NEAR, NEAR, 0.0], OF_NEAR),
        ([NEAR, 1.0 - 2.0 * NEAR, 0.0], OF_NEAR),
        ([FAR, FAR, 0.0], OF_FAR),
        ([1.0 - 2.0 * FAR, FAR, 0.0], OF_FAR),
        ([FAR, 1.0 - 2.0 * FAR, 0.0], OF_FAR),
    ]
};

const LINE: [Place; 3] = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]];

/// A line with two nodes at its ends.
static LINE2: FacetReference = FacetReference {
    n_corners: 2,
    nodes: LINE.split_at(2).0,
    functions: functions::line2,
    rule: LINE_RULE,
    gmsh: 1,
};

/// A line with two nodes at its ends and one between them.
static LINE3: FacetReference = FacetReference {
    n_corners: 2,
    nodes: &LINE,
    functions: functions::line3,
    rule: LINE_RULE,
    gmsh: 8,
};

/// A triangular facet of a linear element.
static FACE3: FacetReference = FacetReference {
    n_corners: 3,
    nodes: TRIANGLE.split_at(3).0,
    functions: functions::tri3,
    rule: TRIANGLE_RULE,
    gmsh: 2,
};

/// A triangular facet of a quadratic element.
static FACE6: FacetReference = FacetReference {
    n_corners: 3,
    nodes: &TRIANGLE,
    functions: functions::tri6,
    rule: TRIANGLE_RULE,
    gmsh: 9,
};

/// A quadrilateral facet of a linear element.
static FACE4: FacetReference = FacetReference {
    n_corners: 4,
    nodes: SQUARE.split_at(4).0,
    functions: functions::quad4,
    rule: QUADRILATERAL_RULE,
    gmsh: 3,
};

/// A quadrilateral facet of a quadratic element.
static FACE8: FacetReference = FacetReference {
    n_corners: 4,
    nodes: &SQUARE,
    functions: functions::quad8,
    rule: QUADRILATERAL_RULE,
    gmsh: 16,
};

impl FacetReference {
    /// Reference data of all facets that shapes have.
    pub const ALL: [&'static FacetReference; 6] = [&LINE2, &LINE3, &FACE3, &FACE6, &FACE4, &FACE8];

    /// The facet of a given dimension and number of nodes.
    pub(super) fn with_nodes(dimension: usize, n: usize) -> &'static FacetReference {
        match (dimension, n) {
            (1, 2) => &LINE2,
            (1, _) => &LINE3,
            (_, 3) => &FACE3,
            (_, 4) => &FACE4,
            (_, 6) => &FACE6,
            _ => &FACE8,
        }
    }

    /// The triangular facet of a linear element.
    pub fn triangle() -> &'static FacetReference {
        &FACE3
    }

    /// Pieces with straight edges between all nodes of the facet, given by their corners: a linear
    /// facet is one piece.
    pub fn pieces(&self) -> &'static [&'static [usize]] {
        match self.nodes.len() {
            2 => &[&[0, 1]],
            3 if self.n_corners == 3 => &[&[0, 1, 2]],
            3 => &[&[0, 2], &[2, 1]],
            4 => &[&[0, 1, 2, 3]],
            6 => &[&[0, 3, 5], &[3, 1, 4], &[5, 4, 2], &[3, 4, 5]],
            _ => &[
                &[0, 4, 7],
                &[4, 1, 5],
                &[5, 2, 6],
                &[6, 3, 7],
                &[4, 5, 6, 7],
            ],
        }
    }

    /// Number of reference coordinates: 1 for a line, 2 for a face.
    pub fn dimension(&self) -> usize {
        if self.n_corners == 2 { 1 } else { 2 }
    }

    /// The reference coordinates of the middle of the facet.
    pub fn center(&self) -> Place {
        match self.n_corners {
            3 => [1.0 / 3.0, 1.0 / 3.0, 0.0],
            _ => [0.0; 3],
        }
    }

    /// The outward area vector of a facet per unit of its reference coordinates: the cross product
    /// of its two tangents, the second of which is the out-of-plane direction for a line.
    pub fn area(&self, at: &Functions, nodes: &[Vector]) -> Vector {
        let Some(origin) = nodes.first() else {
            return [0.0; 3];
        };
        let mut tangents = [[0.0; 3]; 2];
        for (slopes, x) in at.gradients.iter().zip(nodes) {
            for (tangent, slope) in tangents.iter_mut().zip(slopes) {
                (0..3).for_each(|d| tangent[d] += slope * (x[d] - origin[d]));
            }
        }
        if self.dimension() == 1 {
            tangents[1] = unit(2);
        }
        cross(tangents[0], tangents[1])
    }
}
