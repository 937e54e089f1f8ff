//! Shape functions and their reference gradients.

use super::MAX_NODES;
use crate::mesh::Shape;

/// Values and gradients `(d/dxi, d/deta)` of the shape functions at a reference point:
/// quadrilaterals on `[-1, 1]^2`, triangles on `xi, eta >= 0, xi + eta <= 1`.
pub fn shape_functions(
    shape: Shape,
    [x, y]: [f64; 2],
) -> ([f64; MAX_NODES], [[f64; 2]; MAX_NODES]) {
    let mut n = [0.0; MAX_NODES];
    let mut g = [[0.0; 2]; MAX_NODES];
    match shape {
        Shape::Tri3 => {
            n[..3].copy_from_slice(&[1.0 - x - y, x, y]);
            g[..3].copy_from_slice(&[[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]]);
        }
        Shape::Tri6 => {
            let l = [1.0 - x - y, x, y];
            let dl = [[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]];
            for i in 0..3 {
                let j = (i + 1) % 3;
                n[i] = l[i] * (2.0 * l[i] - 1.0);
                n[i + 3] = 4.0 * l[i] * l[j];
                for d in 0..2 {
                    g[i][d] = (4.0 * l[i] - 1.0) * dl[i][d];
                    g[i + 3][d] = 4.0 * (dl[i][d] * l[j] + l[i] * dl[j][d]);
                }
            }
        }
        Shape::Quad4 => {
            for (i, [a, b]) in CORNERS.into_iter().enumerate() {
                n[i] = 0.25 * (1.0 + a * x) * (1.0 + b * y);
                g[i] = [0.25 * a * (1.0 + b * y), 0.25 * b * (1.0 + a * x)];
            }
        }
        Shape::Quad8 => {
            for (i, [a, b]) in CORNERS.into_iter().enumerate() {
                let (p, q) = (1.0 + a * x, 1.0 + b * y);
                n[i] = 0.25 * p * q * (a * x + b * y - 1.0);
                g[i] = [
                    0.25 * a * q * (2.0 * a * x + b * y),
                    0.25 * b * p * (a * x + 2.0 * b * y),
                ];
            }
            for (i, b) in [(4, -1.0), (6, 1.0)] {
                n[i] = 0.5 * (1.0 - x * x) * (1.0 + b * y);
                g[i] = [-x * (1.0 + b * y), 0.5 * b * (1.0 - x * x)];
            }
            for (i, a) in [(5, 1.0), (7, -1.0)] {
                n[i] = 0.5 * (1.0 + a * x) * (1.0 - y * y);
                g[i] = [0.5 * a * (1.0 - y * y), -y * (1.0 + a * x)];
            }
        }
    }
    (n, g)
}

const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
