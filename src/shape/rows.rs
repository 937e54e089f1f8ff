//! The rows of the table, in the order of [`Shape::ALL`](super::Shape::ALL).

use super::facets::{FACE3, FACE4, FACE6, FACE8, LINE2, LINE3};
use super::{Place, Reference, Refinement, Rule, functions};

pub(super) static ROWS: [&Reference; 8] =
    [&TRI3, &TRI6, &QUAD4, &QUAD8, &TET4, &TET10, &HEX8, &HEX20];

/// The order of nodes that is Gmsh's own.
const IN_ORDER: [usize; 8] = [0, 1, 2, 3, 4, 5, 6, 7];

pub(super) const TRIANGLE: [Place; 6] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.5, 0.0, 0.0],
    [0.5, 0.5, 0.0],
    [0.0, 0.5, 0.0],
];

pub(super) const SQUARE: [Place; 8] = [
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [0.0, -1.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [-1.0, 0.0, 0.0],
];

/// Gauss abscissa `1/sqrt(3)` of the 2 x 2 rule.
const G2: f64 = 0.577_350_269_189_625_8;
/// Gauss abscissa `sqrt(3/5)` of the 3 x 3 rule.
const G3: f64 = 0.774_596_669_241_483_4;

const GAUSS_2X2: &Rule = &[
    ([-G2, -G2, 0.0], 1.0),
    ([G2, -G2, 0.0], 1.0),
    ([G2, G2, 0.0], 1.0),
    ([-G2, G2, 0.0], 1.0),
];
const CENTER: &Rule = &[([0.0, 0.0, 0.0], 4.0)];

const SIXTH: f64 = 1.0 / 6.0;
const CENTROID: &Rule = &[([1.0 / 3.0, 1.0 / 3.0, 0.0], 0.5)];
const INNER_3: &Rule = &[
    ([SIXTH, SIXTH, 0.0], SIXTH),
    ([4.0 * SIXTH, SIXTH, 0.0], SIXTH),
    ([SIXTH, 4.0 * SIXTH, 0.0], SIXTH),
];

static TRI3: Reference = Reference {
    name: "tri3",
    dimension: 2,
    n_corners: 3,
    degree: 1,
    nodes: TRIANGLE.split_at(3).0,
    functions: functions::tri3,
    gauss: CENTROID,
    sampling: CENTROID,
    has_mean_dilatation: false,
    // Its Jacobian is constant.
    checked: TRIANGLE.split_at(1).0,
    unit_jacobian: 1.0,
    facet: &LINE2,
    facets: &[&[0, 1], &[1, 2], &[2, 0]],
    edges: SIDES_3,
    refinement: Some(&Refinement {
        on_facet: 1,
        inside: &[],
        children: &[&[0, 3, 5], &[1, 4, 3], &[2, 5, 4], &[3, 4, 5]],
        of_facet: OF_TRIANGLE,
    }),
    vtk: 5,
    gmsh: 2,
    gmsh_order: IN_ORDER.split_at(3).0,
};

static TRI6: Reference = Reference {
    name: "tri6",
    dimension: 2,
    n_corners: 3,
    degree: 2,
    nodes: &TRIANGLE,
    functions: functions::tri6,
    gauss: INNER_3,
    sampling: INNER_3,
    has_mean_dilatation: false,
    checked: &[
        TRIANGLE[0],
        TRIANGLE[1],
        TRIANGLE[2],
        INNER_3[0].0,
        INNER_3[1].0,
        INNER_3[2].0,
        TRIANGLE[3],
        TRIANGLE[4],
        TRIANGLE[5],
    ],
    unit_jacobian: 1.0,
    facet: &LINE3,
    facets: &[&[0, 1, 3], &[1, 2, 4], &[2, 0, 5]],
    edges: SIDES_3,
    refinement: Some(&Refinement {
        on_facet: 2,
        // The element's own shape functions at the middles of the new sides.
        inside: &[
            &[(-0.125, 1), (-0.125, 2), (0.5, 3), (0.5, 5), (0.25, 4)],
            &[(-0.125, 2), (-0.125, 0), (0.5, 4), (0.5, 3), (0.25, 5)],
            &[(-0.125, 0), (-0.125, 1), (0.5, 5), (0.5, 4), (0.25, 3)],
        ],
        children: &[
            &[0, 3, 5, 6, 12, 11],
            &[1, 4, 3, 8, 13, 7],
            &[2, 5, 4, 10, 14, 9],
            &[3, 4, 5, 13, 14, 12],
        ],
        of_facet: OF_TRIANGLE,
    }),
    vtk: 22,
    gmsh: 9,
    gmsh_order: IN_ORDER.split_at(6).0,
};

static QUAD4: Reference = Reference {
    name: "quad4",
    dimension: 2,
    n_corners: 4,
    degree: 1,
    nodes: SQUARE.split_at(4).0,
    functions: functions::quad4,
    gauss: GAUSS_2X2,
    sampling: CENTER,
    has_mean_dilatation: true,
    // Its Jacobian is linear along each reference coordinate.
    checked: SQUARE.split_at(4).0,
    unit_jacobian: 0.25,
    facet: &LINE2,
    facets: &[&[0, 1], &[1, 2], &[2, 3], &[3, 0]],
    edges: SIDES_4,
    refinement: Some(&Refinement {
        on_facet: 1,
        inside: &[&[
            (-0.25, 0),
            (-0.25, 1),
            (-0.25, 2),
            (-0.25, 3),
            (0.5, 4),
            (0.5, 5),
            (0.5, 6),
            (0.5, 7),
        ]],
        children: &[&[0, 4, 8, 7], &[1, 5, 8, 4], &[2, 6, 8, 5], &[3, 7, 8, 6]],
        of_facet: OF_SQUARE,
    }),
    vtk: 9,
    gmsh: 3,
    gmsh_order: IN_ORDER.split_at(4).0,
};

static QUAD8: Reference = Reference {
    name: "quad8",
    dimension: 2,
    n_corners: 4,
    degree: 2,
    nodes: &SQUARE,
    functions: functions::quad8,
    // Reduced integration.
    gauss: GAUSS_2X2,
    sampling: GAUSS_2X2,
    has_mean_dilatation: false,
    checked: &[
        SQUARE[0],
        SQUARE[1],
        SQUARE[2],
        SQUARE[3],
        GAUSS_2X2[0].0,
        GAUSS_2X2[1].0,
        GAUSS_2X2[2].0,
        GAUSS_2X2[3].0,
        [-G3, -G3, 0.0],
        [G3, -G3, 0.0],
        [G3, G3, 0.0],
        [-G3, G3, 0.0],
        [0.0, 0.0, 0.0],
        [G3, 0.0, 0.0],
        [-G3, 0.0, 0.0],
        [0.0, G3, 0.0],
        [0.0, -G3, 0.0],
    ],
    unit_jacobian: 0.25,
    facet: &LINE3,
    facets: &[&[0, 1, 4], &[1, 2, 5], &[2, 3, 6], &[3, 0, 7]],
    edges: SIDES_4,
    refinement: Some(&Refinement {
        on_facet: 2,
        // The centre, and the middles of the new sides: the element's own shape functions.
        inside: &[
            &[
                (-0.25, 0),
                (-0.25, 1),
                (-0.25, 2),
                (-0.25, 3),
                (0.5, 4),
                (0.5, 5),
                (0.5, 6),
                (0.5, 7),
            ],
            &beside(4, 5, 6, 7),
            &beside(5, 6, 7, 4),
            &beside(6, 7, 4, 5),
            &beside(7, 4, 5, 6),
        ],
        children: &[
            &[0, 4, 16, 7, 8, 17, 20, 15],
            &[1, 5, 16, 4, 10, 18, 17, 9],
            &[2, 6, 16, 5, 12, 19, 18, 11],
            &[3, 7, 16, 6, 14, 20, 19, 13],
        ],
        of_facet: OF_SQUARE,
    }),
    vtk: 23,
    gmsh: 16,
    gmsh_order: IN_ORDER.split_at(8).0,
};

const SIDES_3: &[[usize; 2]] = &[[0, 1], [1, 2], [2, 0]];
const SIDES_4: &[[usize; 2]] = &[[0, 1], [1, 2], [2, 3], [3, 0]];

/// Half way from the middle of a side to the centre of a quadrilateral, for the middles of the
/// sides from that one on.
const fn beside(own: usize, next: usize, opposite: usize, last: usize) -> [(f64, usize); 8] {
    [
        (-0.1875, 0),
        (-0.1875, 1),
        (-0.1875, 2),
        (-0.1875, 3),
        (0.75, own),
        (0.375, next),
        (0.25, opposite),
        (0.375, last),
    ]
}

/// Children keep the corner of their number as their first node; the fourth of a triangle is the
/// one between the middles of its sides.
const OF_TRIANGLE: &[&[[usize; 2]]] = &[&[[0, 0], [1, 2]], &[[1, 0], [2, 2]], &[[2, 0], [0, 2]]];
const OF_SQUARE: &[&[[usize; 2]]] = &[
    &[[0, 0], [1, 3]],
    &[[1, 0], [2, 3]],
    &[[2, 0], [3, 3]],
    &[[3, 0], [0, 3]],
];

/// Corners of each edge of a tetrahedron, in the order of the nodes between them.
pub(super) const EDGES_OF_TETRAHEDRON: [[usize; 2]; 6] =
    [[0, 1], [1, 2], [0, 2], [0, 3], [1, 3], [2, 3]];
/// Corners of each edge of a hexahedron, in the order of the nodes between them.
const EDGES_OF_CUBE: [[usize; 2]; 12] = [
    [0, 1],
    [1, 2],
    [2, 3],
    [3, 0],
    [4, 5],
    [5, 6],
    [6, 7],
    [7, 4],
    [0, 4],
    [1, 5],
    [2, 6],
    [3, 7],
];

const TETRAHEDRON: [Place; 10] = with_middles(
    [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
    ],
    EDGES_OF_TETRAHEDRON,
);

pub(super) const CUBE: [Place; 20] = with_middles(
    [
        [-1.0, -1.0, -1.0],
        [1.0, -1.0, -1.0],
        [1.0, 1.0, -1.0],
        [-1.0, 1.0, -1.0],
        [-1.0, -1.0, 1.0],
        [1.0, -1.0, 1.0],
        [1.0, 1.0, 1.0],
        [-1.0, 1.0, 1.0],
    ],
    EDGES_OF_CUBE,
);

/// The corners, then the middle of each edge.
const fn with_middles<const C: usize, const E: usize, const N: usize>(
    corners: [Place; C],
    edges: [[usize; 2]; E],
) -> [Place; N] {
    let mut out = [[0.0; 3]; N];
    let mut k = 0;
    while k < N {
        if k < C {
            out[k] = corners[k];
        } else {
            let [a, b] = edges[k - C];
            let mut d = 0;
            while d < 3 {
                out[k][d] = 0.5 * (corners[a][d] + corners[b][d]);
                d += 1;
            }
        }
        k += 1;
    }
    out
}

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
const CENTER_OF_CUBE: &Rule = &[([0.0, 0.0, 0.0], 8.0)];
const CENTROID_OF_TETRAHEDRON: &Rule = &[([0.25, 0.25, 0.25], 1.0 / 6.0)];
/// Four points, exact to degree 2: `(5 -+ sqrt 5)/20`.
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

static TET4: Reference = Reference {
    name: "tet4",
    dimension: 3,
    n_corners: 4,
    degree: 1,
    nodes: TETRAHEDRON.split_at(4).0,
    functions: functions::tet4,
    gauss: CENTROID_OF_TETRAHEDRON,
    sampling: CENTROID_OF_TETRAHEDRON,
    has_mean_dilatation: false,
    checked: TETRAHEDRON.split_at(1).0,
    unit_jacobian: 1.0,
    facet: &FACE3,
    facets: &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]],
    edges: &EDGES_OF_TETRAHEDRON,
    refinement: None,
    vtk: 10,
    gmsh: 4,
    gmsh_order: IN_ORDER.split_at(4).0,
};

static TET10: Reference = Reference {
    name: "tet10",
    dimension: 3,
    n_corners: 4,
    degree: 2,
    nodes: &TETRAHEDRON,
    functions: functions::tet10,
    gauss: INNER_4,
    sampling: INNER_4,
    has_mean_dilatation: false,
    checked: &{
        let mut places = [[0.0; 3]; 14];
        let mut k = 0;
        while k < 14 {
            places[k] = if k < 10 {
                TETRAHEDRON[k]
            } else {
                INNER_4[k - 10].0
            };
            k += 1;
        }
        places
    },
    unit_jacobian: 1.0,
    facet: &FACE6,
    facets: &[
        &[0, 2, 1, 6, 5, 4],
        &[0, 1, 3, 4, 8, 7],
        &[1, 2, 3, 5, 9, 8],
        &[2, 0, 3, 6, 7, 9],
    ],
    edges: &EDGES_OF_TETRAHEDRON,
    refinement: None,
    vtk: 24,
    gmsh: 11,
    gmsh_order: &[0, 1, 2, 3, 4, 5, 6, 7, 9, 8],
};

/// Corners and Gauss points.
const CHECKED_OF_CUBE: [Place; 16] = {
    let mut places = [[0.0; 3]; 16];
    let mut k = 0;
    while k < 16 {
        places[k] = if k < 8 { CUBE[k] } else { GAUSS_2X2X2[k - 8].0 };
        k += 1;
    }
    places
};

static HEX8: Reference = Reference {
    name: "hex8",
    dimension: 3,
    n_corners: 8,
    degree: 1,
    nodes: CUBE.split_at(8).0,
    functions: functions::hex8,
    gauss: GAUSS_2X2X2,
    sampling: CENTER_OF_CUBE,
    has_mean_dilatation: true,
    checked: &CHECKED_OF_CUBE,
    unit_jacobian: 0.125,
    facet: &FACE4,
    facets: &[
        &[0, 3, 2, 1],
        &[4, 5, 6, 7],
        &[0, 1, 5, 4],
        &[1, 2, 6, 5],
        &[2, 3, 7, 6],
        &[3, 0, 4, 7],
    ],
    edges: &EDGES_OF_CUBE,
    refinement: None,
    vtk: 12,
    gmsh: 5,
    gmsh_order: &IN_ORDER,
};

static HEX20: Reference = Reference {
    name: "hex20",
    dimension: 3,
    n_corners: 8,
    degree: 2,
    nodes: &CUBE,
    functions: functions::hex20,
    // Reduced integration.
    gauss: GAUSS_2X2X2,
    sampling: GAUSS_2X2X2,
    has_mean_dilatation: false,
    checked: &CHECKED_OF_CUBE,
    unit_jacobian: 0.125,
    facet: &FACE8,
    facets: &[
        &[0, 3, 2, 1, 11, 10, 9, 8],
        &[4, 5, 6, 7, 12, 13, 14, 15],
        &[0, 1, 5, 4, 8, 17, 12, 16],
        &[1, 2, 6, 5, 9, 18, 13, 17],
        &[2, 3, 7, 6, 10, 19, 14, 18],
        &[3, 0, 4, 7, 11, 16, 15, 19],
    ],
    edges: &EDGES_OF_CUBE,
    refinement: None,
    vtk: 25,
    gmsh: 17,
    gmsh_order: &[
        0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15,
    ],
};
