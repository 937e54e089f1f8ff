//! Nodes and edges of the reference elements.

/// Reference coordinates of a point; coordinates beyond the dimension are zero.
pub type Place = [f64; 3];

/// Nodes of a triangle, corners first.
pub(super) const TRIANGLE: [Place; 6] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.5, 0.0, 0.0],
    [0.5, 0.5, 0.0],
    [0.0, 0.5, 0.0],
];

/// Nodes of a quadrilateral, corners first.
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

/// Corners of each edge of a tetrahedron, in the order of the mid-side nodes.
pub(super) const EDGES_OF_TETRAHEDRON: [[usize; 2]; 6] =
    [[0, 1], [1, 2], [0, 2], [0, 3], [1, 3], [2, 3]];
/// Corners of each edge of a prism, in the order of the mid-side nodes.
pub(super) const EDGES_OF_PRISM: [[usize; 2]; 9] = [
    [0, 1],
    [1, 2],
    [2, 0],
    [3, 4],
    [4, 5],
    [5, 3],
    [0, 3],
    [1, 4],
    [2, 5],
];
/// Corners of each edge of a hexahedron, in the order of the mid-side nodes.
pub(super) const EDGES_OF_CUBE: [[usize; 2]; 12] = [
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

/// Nodes of a tetrahedron.
pub(super) const TETRAHEDRON: [Place; 10] = with_middles(
    [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
    ],
    EDGES_OF_TETRAHEDRON,
);

/// Nodes of a prism.
pub(super) const PRISM: [Place; 15] = with_middles(
    [
        [0.0, 0.0, -1.0],
        [1.0, 0.0, -1.0],
        [0.0, 1.0, -1.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 1.0],
        [0.0, 1.0, 1.0],
    ],
    EDGES_OF_PRISM,
);

/// Corners of `[-1, 1]^3` in the order of a hexahedron's nodes; the first four are in the order of
/// a square's nodes.
pub const CORNERS_OF_CUBE: [Place; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];
pub(super) const CUBE: [Place; 20] = with_middles(CORNERS_OF_CUBE, EDGES_OF_CUBE);

/// The corners, followed by the middle of each edge.
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
