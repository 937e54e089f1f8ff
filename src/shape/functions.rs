//! Shape functions and their derivatives along the reference coordinates: quadrilaterals on
//! `[-1, 1]^2`, triangles on `xi, eta >= 0, xi + eta <= 1`.

use super::{MAX_NODES, Place};

/// The shape functions at a place of an element; zero beyond its nodes.
#[derive(Debug, Clone, Copy)]
pub struct Functions {
    /// Of each node.
    pub values: [f64; MAX_NODES],
    /// Derivatives of each node's along the reference coordinates.
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
/// Derivatives of the area coordinates.
const SLOPES: [[f64; 2]; 3] = [[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]];

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
