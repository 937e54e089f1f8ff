//! Rows of solid shapes.

use super::plane::{G2, IN_ORDER, LINE3, SIXTH, W3};
use crate::shape::nodes::{
    CUBE, EDGES_OF_CUBE, EDGES_OF_PRISM, EDGES_OF_TETRAHEDRON, PRISM, TETRAHEDRON,
};
use crate::shape::{ReferenceElement, Rule, functions};

const GAUSS_2X2X2: &Rule = &[
    ([-G2, -G2, -G2], 1.0),
    ([G2, -G2, -G2], 1.0),
    ([G2, G2, -G2], 1.0),
    ([-G2, G2, -G2], 1.0),
    ([-G2, -G2, G2], 1.0),
    ([G2, -G2, G2], 1.0),
    ([G2, G2, G2], 1.0),
    ([-G2, G2, G2], 1.0),
];
/// The 3 x 3 x 3 rule; the first coordinate runs fastest, then the second.
const GAUSS_3X3X3: &Rule = &{
    let mut points = [([0.0; 3], 0.0); 27];
    let mut n = 0;
    while n < 27 {
        let [i, j, k] = [n % 3, n / 3 % 3, n / 9];
        points[n] = ([LINE3[i], LINE3[j], LINE3[k]], W3[i] * W3[j] * W3[k]);
        n += 1;
    }
    points
};
const CENTER_OF_CUBE: &Rule = &[([0.0, 0.0, 0.0], 8.0)];
const CENTROID_OF_TETRAHEDRON: &Rule = &[([0.25, 0.25, 0.25], 1.0 / 6.0)];
/// Four-point rule of the tetrahedron, exact to degree 2: at each point one of the four barycentric
/// coordinates is `(5 + 3 sqrt 5)/20` and the others are `(5 - sqrt 5)/20`.
const INNER_4: &Rule = {
    const NEAR: f64 = 0.138_196_601_125_010_5;
    const FAR: f64 = 1.0 - 3.0 * NEAR;
    const WEIGHT: f64 = 1.0 / 24.0;
    &[
        ([NEAR, NEAR, NEAR], WEIGHT),
        ([FAR, NEAR, NEAR], WEIGHT),
        ([NEAR, FAR, NEAR], WEIGHT),
        ([NEAR, NEAR, FAR], WEIGHT),
    ]
};

pub(super) static TET4: ReferenceElement = ReferenceElement {
    name: "tet4",
    dimension: 3,
    n_corners: 4,
    degree: 1,
    nodes: TETRAHEDRON.split_at(4).0,
    functions: functions::tet4,
    gauss: CENTROID_OF_TETRAHEDRON,
    full: CENTROID_OF_TETRAHEDRON,
    sampling: CENTROID_OF_TETRAHEDRON,
    has_mean_dilatation: false,
    unit_jacobian: 1.0,
    facets: &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]],
    edges: &EDGES_OF_TETRAHEDRON,
    vtk: 10,
    gmsh: 4,
    gmsh_order: IN_ORDER.split_at(4).0,
};

pub(super) static TET10: ReferenceElement = ReferenceElement {
    name: "tet10",
    dimension: 3,
    n_corners: 4,
    degree: 2,
    nodes: &TETRAHEDRON,
    functions: functions::tet10,
    gauss: INNER_4,
    full: INNER_4,
    sampling: INNER_4,
    has_mean_dilatation: false,
    unit_jacobian: 1.0,
    facets: &[
        &[0, 2, 1, 6, 5, 4],
        &[0, 1, 3, 4, 8, 7],
        &[1, 2, 3, 5, 9, 8],
        &[2, 0, 3, 6, 7, 9],
    ],
    edges: &EDGES_OF_TETRAHEDRON,
    vtk: 24,
    gmsh: 11,
    gmsh_order: &[0, 1, 2, 3, 4, 5, 6, 7, 9, 8],
};

/// Three points of a triangle at two heights. The rule leaves a prism with fifteen nodes three
/// modes without stiffness, and neighbouring elements share none of them (four prisms side by side,
/// two on top of each other). Similarly the reduced rule of the serendipity hexahedron leaves six
/// such modes.
const INNER_3X2: &Rule = &[
    ([SIXTH, SIXTH, -G2], SIXTH),
    ([4.0 * SIXTH, SIXTH, -G2], SIXTH),
    ([SIXTH, 4.0 * SIXTH, -G2], SIXTH),
    ([SIXTH, SIXTH, G2], SIXTH),
    ([4.0 * SIXTH, SIXTH, G2], SIXTH),
    ([SIXTH, 4.0 * SIXTH, G2], SIXTH),
];
/// Three points of a triangle at three heights.
const INNER_3X3: &Rule = &{
    let mut points = [([0.0; 3], 0.0); 9];
    let mut n = 0;
    while n < 9 {
        let ([x, y, _], _) = INNER_3X2[n % 3];
        points[n] = ([x, y, LINE3[n / 3]], SIXTH * W3[n / 3]);
        n += 1;
    }
    points
};
const CENTER_OF_PRISM: &Rule = &[([1.0 / 3.0, 1.0 / 3.0, 0.0], 1.0)];

pub(super) static PRISM6: ReferenceElement = ReferenceElement {
    name: "prism6",
    dimension: 3,
    n_corners: 6,
    degree: 1,
    nodes: PRISM.split_at(6).0,
    functions: functions::prism6,
    gauss: INNER_3X2,
    full: INNER_3X2,
    sampling: CENTER_OF_PRISM,
    has_mean_dilatation: true,
    unit_jacobian: 0.5,
    facets: &[
        &[0, 2, 1],
        &[3, 4, 5],
        &[0, 1, 4, 3],
        &[1, 2, 5, 4],
        &[2, 0, 3, 5],
    ],
    edges: &EDGES_OF_PRISM,
    vtk: 13,
    gmsh: 6,
    gmsh_order: IN_ORDER.split_at(6).0,
};

pub(super) static PRISM15: ReferenceElement = ReferenceElement {
    name: "prism15",
    dimension: 3,
    n_corners: 6,
    degree: 2,
    nodes: &PRISM,
    functions: functions::prism15,
    // Reduced integration.
    gauss: INNER_3X2,
    full: INNER_3X3,
    sampling: INNER_3X2,
    has_mean_dilatation: false,
    unit_jacobian: 0.5,
    facets: &[
        &[0, 2, 1, 8, 7, 6],
        &[3, 4, 5, 9, 10, 11],
        &[0, 1, 4, 3, 6, 13, 9, 12],
        &[1, 2, 5, 4, 7, 14, 10, 13],
        &[2, 0, 3, 5, 8, 12, 11, 14],
    ],
    edges: &EDGES_OF_PRISM,
    vtk: 26,
    gmsh: 18,
    gmsh_order: &[0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11],
};

pub(super) static HEX8: ReferenceElement = ReferenceElement {
    name: "hex8",
    dimension: 3,
    n_corners: 8,
    degree: 1,
    nodes: CUBE.split_at(8).0,
    functions: functions::hex8,
    gauss: GAUSS_2X2X2,
    full: GAUSS_2X2X2,
    sampling: CENTER_OF_CUBE,
    has_mean_dilatation: true,
    unit_jacobian: 0.125,
    facets: &[
        &[0, 3, 2, 1],
        &[4, 5, 6, 7],
        &[0, 1, 5, 4],
        &[1, 2, 6, 5],
        &[2, 3, 7, 6],
        &[3, 0, 4, 7],
    ],
    edges: &EDGES_OF_CUBE,
    vtk: 12,
    gmsh: 5,
    gmsh_order: &IN_ORDER,
};

pub(super) static HEX20: ReferenceElement = ReferenceElement {
    name: "hex20",
    dimension: 3,
    n_corners: 8,
    degree: 2,
    nodes: &CUBE,
    functions: functions::hex20,
    // Reduced integration.
    gauss: GAUSS_2X2X2,
    full: GAUSS_3X3X3,
    sampling: GAUSS_2X2X2,
    has_mean_dilatation: false,
    unit_jacobian: 0.125,
    facets: &[
        &[0, 3, 2, 1, 11, 10, 9, 8],
        &[4, 5, 6, 7, 12, 13, 14, 15],
        &[0, 1, 5, 4, 8, 17, 12, 16],
        &[1, 2, 6, 5, 9, 18, 13, 17],
        &[2, 3, 7, 6, 10, 19, 14, 18],
        &[3, 0, 4, 7, 11, 16, 15, 19],
    ],
    edges: &EDGES_OF_CUBE,
    vtk: 25,
    gmsh: 17,
    gmsh_order: &[
        0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15,
    ],
};
