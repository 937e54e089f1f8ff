//! Shape functions and their derivatives along the reference coordinates. Lines, quadrilaterals and
//! hexahedra are defined on `[-1, 1]^d`; triangles and tetrahedra on coordinates that are not
//! negative and whose sum is at most one; prisms on such a triangle times `[-1, 1]`.

use super::nodes::{CUBE, EDGES_OF_TETRAHEDRON, Place};

/// Largest number of nodes of an element.
pub const MAX_NODES: usize = 20;

/// The shape functions at a place of an element; entries beyond the number of nodes are zero.
#[derive(Debug, Clone, Copy)]
pub struct Functions {
    /// Value of each node's shape function.
    pub values: [f64; MAX_NODES],
    /// Derivatives of each node's shape function along the reference coordinates.
    pub gradients: [[f64; 3]; MAX_NODES],
}

impl Functions {
    const NONE: Functions = Functions {
        values: [0.0; MAX_NODES],
        gradients: [[0.0; 3]; MAX_NODES],
    };
}

/// Corners of the reference square.
const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
/// Derivatives of the area coordinates of a triangle.
const SLOPES: [[f64; 2]; 3] = [[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]];

pub(super) fn line2([x, ..]: Place) -> Functions {
    let mut out = Functions::NONE;
    for (i, a) in [(0, -1.0), (1, 1.0)] {
        out.values[i] = 0.5 * (1.0 + a * x);
        out.gradients[i][0] = 0.5 * a;
    }
    out
}

pub(super) fn line3([x, ..]: Place) -> Functions {
    let mut out = Functions::NONE;
    out.values[..3].copy_from_slice(&[0.5 * x * (x - 1.0), 0.5 * x * (x + 1.0), 1.0 - x * x]);
    for (gradient, slope) in out.gradients.iter_mut().zip([x - 0.5, x + 0.5, -2.0 * x]) {
        gradient[0] = slope;
    }
    out
}

pub(super) fn tri3([x, y, _]: Place) -> Functions {
    let mut out = Functions::NONE;
    out.values[..3].copy_from_slice(&[1.0 - x - y, x, y]);
    for (gradient, [a, b]) in out.gradients.iter_mut().zip(SLOPES) {
        *gradient = [a, b, 0.0];
    }
    out
}

pub(super) fn tri6([x, y, _]: Place) -> Functions {
    let mut out = Functions::NONE;
    let l = [1.0 - x - y, x, y];
    for i in 0..3 {
        let j = (i + 1) % 3;
        out.values[i] = l[i] * (2.0 * l[i] - 1.0);
        out.values[i + 3] = 4.0 * l[i] * l[j];
        for d in 0..2 {
            out.gradients[i][d] = (4.0 * l[i] - 1.0) * SLOPES[i][d];
            out.gradients[i + 3][d] = 4.0 * (SLOPES[i][d] * l[j] + l[i] * SLOPES[j][d]);
        }
    }
    out
}

pub(super) fn quad4([x, y, _]: Place) -> Functions {
    let mut out = Functions::NONE;
    for (i, [a, b]) in CORNERS.into_iter().enumerate() {
        out.values[i] = 0.25 * (1.0 + a * x) * (1.0 + b * y);
        out.gradients[i] = [0.25 * a * (1.0 + b * y), 0.25 * b * (1.0 + a * x), 0.0];
    }
    out
}

pub(super) fn quad8([x, y, _]: Place) -> Functions {
    let mut out = Functions::NONE;
    for (i, [a, b]) in CORNERS.into_iter().enumerate() {
        let (p, q) = (1.0 + a * x, 1.0 + b * y);
        out.values[i] = 0.25 * p * q * (a * x + b * y - 1.0);
        out.gradients[i] = [
            0.25 * a * q * (2.0 * a * x + b * y),
            0.25 * b * p * (a * x + 2.0 * b * y),
            0.0,
        ];
    }
    for (i, b) in [(4, -1.0), (6, 1.0)] {
        out.values[i] = 0.5 * (1.0 - x * x) * (1.0 + b * y);
        out.gradients[i] = [-x * (1.0 + b * y), 0.5 * b * (1.0 - x * x), 0.0];
    }
    for (i, a) in [(5, 1.0), (7, -1.0)] {
        out.values[i] = 0.5 * (1.0 + a * x) * (1.0 - y * y);
        out.gradients[i] = [0.5 * a * (1.0 - y * y), -y * (1.0 + a * x), 0.0];
    }
    out
}

/// Derivatives of the volume coordinates of a tetrahedron.
const SLOPES_3: [Place; 4] = [
    [-1.0, -1.0, -1.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
];

pub(super) fn tet4([x, y, z]: Place) -> Functions {
    let mut out = Functions::NONE;
    out.values[..4].copy_from_slice(&[1.0 - x - y - z, x, y, z]);
    out.gradients[..4].copy_from_slice(&SLOPES_3);
    out
}

pub(super) fn tet10([x, y, z]: Place) -> Functions {
    let mut out = Functions::NONE;
    let l = [1.0 - x - y - z, x, y, z];
    for i in 0..4 {
        out.values[i] = l[i] * (2.0 * l[i] - 1.0);
        out.gradients[i] = SLOPES_3[i].map(|slope| (4.0 * l[i] - 1.0) * slope);
    }
    for (k, [i, j]) in EDGES_OF_TETRAHEDRON.into_iter().enumerate() {
        out.values[k + 4] = 4.0 * l[i] * l[j];
        for d in 0..3 {
            out.gradients[k + 4][d] = 4.0 * (SLOPES_3[i][d] * l[j] + l[i] * SLOPES_3[j][d]);
        }
    }
    out
}

pub(super) fn prism6([x, y, z]: Place) -> Functions {
    let mut out = Functions::NONE;
    let l = [1.0 - x - y, x, y];
    for (base, a) in [(0, -1.0), (3, 1.0)] {
        let along = 0.5 * (1.0 + a * z);
        for i in 0..3 {
            out.values[base + i] = l[i] * along;
            let [p, q] = SLOPES[i].map(|slope| slope * along);
            out.gradients[base + i] = [p, q, 0.5 * a * l[i]];
        }
    }
    out
}

pub(super) fn prism15([x, y, z]: Place) -> Functions {
    let mut out = Functions::NONE;
    let l = [1.0 - x - y, x, y];
    let bubble = 1.0 - z * z;
    for i in 0..3 {
        let j = (i + 1) % 3;
        for (base, a) in [(0, -1.0), (3, 1.0)] {
            let along = 1.0 + a * z;
            // Corners, then the middles of the edges of base and top (offset 6).
            let inner = 2.0 * l[i] - 1.0;
            out.values[base + i] = 0.5 * l[i] * (inner * along - bubble);
            let slope = 0.5 * ((4.0 * l[i] - 1.0) * along - bubble);
            let [p, q] = SLOPES[i].map(|s| s * slope);
            out.gradients[base + i] = [p, q, 0.5 * l[i] * (inner * a + 2.0 * z)];
            out.values[6 + base + i] = 2.0 * l[i] * l[j] * along;
            let [p, q] = [0, 1].map(|d| 2.0 * (SLOPES[i][d] * l[j] + l[i] * SLOPES[j][d]) * along);
            out.gradients[6 + base + i] = [p, q, 2.0 * l[i] * l[j] * a];
        }
        out.values[12 + i] = l[i] * bubble;
        let [p, q] = SLOPES[i].map(|slope| slope * bubble);
        out.gradients[12 + i] = [p, q, -2.0 * z * l[i]];
    }
    out
}

pub(super) fn hex8(at: Place) -> Functions {
    let mut out = Functions::NONE;
    for (i, corner) in CUBE[..8].iter().enumerate() {
        let f: [f64; 3] = std::array::from_fn(|d| 0.5 * (1.0 + corner[d] * at[d]));
        out.values[i] = f[0] * f[1] * f[2];
        for d in 0..3 {
            out.gradients[i][d] = 0.5 * corner[d] * f[(d + 1) % 3] * f[(d + 2) % 3];
        }
    }
    out
}

pub(super) fn hex20(at: Place) -> Functions {
    let mut out = Functions::NONE;
    for (i, node) in CUBE.iter().enumerate() {
        // The factor is 1 + a x along an axis with a = -1 or 1, and 1 - x^2 along the axis of an
        // edge with a middle node.
        let along = |d: usize| match node[d] == 0.0 {
            true => (1.0 - at[d] * at[d], -2.0 * at[d]),
            false => (1.0 + node[d] * at[d], node[d]),
        };
        let f: [(f64, f64); 3] = std::array::from_fn(along);
        let product = f[0].0 * f[1].0 * f[2].0;
        let slope = |d: usize| f[d].1 * f[(d + 1) % 3].0 * f[(d + 2) % 3].0;
        if i < 8 {
            let rest = node[0] * at[0] + node[1] * at[1] + node[2] * at[2] - 2.0;
            out.values[i] = 0.125 * product * rest;
            out.gradients[i] =
                std::array::from_fn(|d| 0.125 * (slope(d) * rest + product * node[d]));
        } else {
            out.values[i] = 0.25 * product;
            out.gradients[i] = std::array::from_fn(|d| 0.25 * slope(d));
        }
    }
    out
}
