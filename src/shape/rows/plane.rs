//! Rows of plane shapes.

use crate::shape::nodes::{SQUARE, TRIANGLE};
use crate::shape::{ReferenceElement, Rule, functions};

/// Node order of the shapes whose nodes Gmsh numbers in the same way.
pub(super) const IN_ORDER: [usize; 8] = [0, 1, 2, 3, 4, 5, 6, 7];

/// Gauss abscissa `1/sqrt(3)` of the 2 x 2 rule.
pub(super) const G2: f64 = 0.577_350_269_189_625_8;
/// Gauss abscissa `sqrt(3/5)` of the 3 x 3 rule.
const G3: f64 = 0.774_596_669_241_483_4;
/// Abscissas of the 3-point rule.
pub(super) const LINE3: [f64; 3] = [-G3, 0.0, G3];

const GAUSS_2X2: &Rule = &[
    ([-G2, -G2, 0.0], 1.0),
    ([G2, -G2, 0.0], 1.0),
    ([G2, G2, 0.0], 1.0),
    ([-G2, G2, 0.0], 1.0),
];
/// Weights of the 3-point rule.
pub(super) const W3: [f64; 3] = [5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0];
/// The 3 x 3 rule; the first coordinate runs fastest.
const GAUSS_3X3: &Rule = &{
    let mut points = [([0.0; 3], 0.0); 9];
    let mut k = 0;
    while k < 9 {
        let [i, j] = [k % 3, k / 3];
        points[k] = ([LINE3[i], LINE3[j], 0.0], W3[i] * W3[j]);
        k += 1;
    }
    points
};
const CENTER: &Rule = &[([0.0, 0.0, 0.0], 4.0)];

pub(super) const SIXTH: f64 = 1.0 / 6.0;
const CENTROID: &Rule = &[([1.0 / 3.0, 1.0 / 3.0, 0.0], 0.5)];
const INNER_3: &Rule = &[
    ([SIXTH, SIXTH, 0.0], SIXTH),
    ([4.0 * SIXTH, SIXTH, 0.0], SIXTH),
    ([SIXTH, 4.0 * SIXTH, 0.0], SIXTH),
];

pub(super) static TRI3: ReferenceElement = ReferenceElement {
    name: "tri3",
    dimension: 2,
    n_corners: 3,
    degree: 1,
    nodes: TRIANGLE.split_at(3).0,
    functions: functions::tri3,
    gauss: CENTROID,
    full: CENTROID,
    sampling: CENTROID,
    has_mean_dilatation: false,
    unit_jacobian: 1.0,
    facets: &[&[0, 1], &[1, 2], &[2, 0]],
    edges: SIDES_3,
    vtk: 5,
    gmsh: 2,
    gmsh_order: IN_ORDER.split_at(3).0,
};

pub(super) static TRI6: ReferenceElement = ReferenceElement {
    name: "tri6",
    dimension: 2,
    n_corners: 3,
    degree: 2,
    nodes: &TRIANGLE,
    functions: functions::tri6,
    gauss: INNER_3,
    full: INNER_3,
    sampling: INNER_3,
    has_mean_dilatation: false,
    unit_jacobian: 1.0,
    facets: &[&[0, 1, 3], &[1, 2, 4], &[2, 0, 5]],
    edges: SIDES_3,
    vtk: 22,
    gmsh: 9,
    gmsh_order: IN_ORDER.split_at(6).0,
};

pub(super) static QUAD4: ReferenceElement = ReferenceElement {
    name: "quad4",
    dimension: 2,
    n_corners: 4,
    degree: 1,
    nodes: SQUARE.split_at(4).0,
    functions: functions::quad4,
    gauss: GAUSS_2X2,
    full: GAUSS_2X2,
    sampling: CENTER,
    has_mean_dilatation: true,
    // The Jacobian determinant of a bilinear element is linear along each reference coordinate.
    unit_jacobian: 0.25,
    facets: &[&[0, 1], &[1, 2], &[2, 3], &[3, 0]],
    edges: SIDES_4,
    vtk: 9,
    gmsh: 3,
    gmsh_order: IN_ORDER.split_at(4).0,
};

pub(super) static QUAD8: ReferenceElement = ReferenceElement {
    name: "quad8",
    dimension: 2,
    n_corners: 4,
    degree: 2,
    nodes: &SQUARE,
    functions: functions::quad8,
    // Reduced integration.
    gauss: GAUSS_2X2,
    full: GAUSS_3X3,
    sampling: GAUSS_2X2,
    has_mean_dilatation: false,
    unit_jacobian: 0.25,
    facets: &[&[0, 1, 4], &[1, 2, 5], &[2, 3, 6], &[3, 0, 7]],
    edges: SIDES_4,
    vtk: 23,
    gmsh: 16,
    gmsh_order: IN_ORDER.split_at(8).0,
};

const SIDES_3: &[[usize; 2]] = &[[0, 1], [1, 2], [2, 0]];
const SIDES_4: &[[usize; 2]] = &[[0, 1], [1, 2], [2, 3], [3, 0]];
