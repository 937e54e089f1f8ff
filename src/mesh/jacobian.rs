//! The Jacobian of the map from the reference element, where an element is checked.
//!
//! Reference elements: triangle `r, s >= 0, r + s <= 1`; square `[-1, 1] x [-1, 1]`.

use super::Shape;

/// Gauss abscissa `1/sqrt(3)` of the 2 x 2 rule.
const G2: f64 = 0.577_350_269_189_625_8;
/// Gauss abscissa `sqrt(3/5)` of the 3 x 3 rule.
const G3: f64 = 0.774_596_669_241_483_4;

/// Derivatives of a shape function along the two reference directions.
type Gradient = [f64; 2];

/// Derivatives of the shape functions at one reference point, in node order.
pub(super) struct Gradients {
    values: [Gradient; 8],
    n: usize,
}

impl Gradients {
    /// Determinant of the Jacobian of an element with these node positions.
    pub(super) fn determinant(&self, points: &[[f64; 2]]) -> f64 {
        let mut j = [[0.0; 2]; 2];
        for (gradient, point) in self.values[..self.n].iter().zip(points) {
            for a in 0..2 {
                for b in 0..2 {
                    j[a][b] += gradient[a] * point[b];
                }
            }
        }
        j[0][0] * j[1][1] - j[0][1] * j[1][0]
    }
}

/// Gradients at the corners and at the integration points of a shape (of the full and the reduced
/// rule). The determinant of a linear triangle is constant and that of a bilinear quadrilateral
/// linear in each direction, so their corners say everything.
pub(super) fn check_points(shape: Shape) -> Vec<Gradients> {
    const TRIANGLE: [[f64; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    const SQUARE: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let mut points: Vec<[f64; 2]> = match shape {
        Shape::Tri3 => vec![TRIANGLE[0]],
        Shape::Tri6 => TRIANGLE.to_vec(),
        Shape::Quad4 | Shape::Quad8 => SQUARE.to_vec(),
    };
    match shape {
        Shape::Tri6 => {
            let (a, b) = (1.0 / 6.0, 2.0 / 3.0);
            points.extend([[a, a], [b, a], [a, b], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]]);
        }
        Shape::Quad8 => {
            points.extend(SQUARE.map(|[r, s]| [G2 * r, G2 * s]));
            points.extend(SQUARE.map(|[r, s]| [G3 * r, G3 * s]));
            points.extend([[0.0, 0.0], [G3, 0.0], [-G3, 0.0], [0.0, G3], [0.0, -G3]]);
        }
        Shape::Tri3 | Shape::Quad4 => {}
    }
    points.into_iter().map(|p| gradients(shape, p)).collect()
}

fn gradients(shape: Shape, [r, s]: [f64; 2]) -> Gradients {
    let mut values = [[0.0; 2]; 8];
    match shape {
        Shape::Tri3 => {
            values[..3].copy_from_slice(&[[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]]);
        }
        Shape::Tri6 => {
            let t = 1.0 - r - s;
            values[..6].copy_from_slice(&[
                [1.0 - 4.0 * t, 1.0 - 4.0 * t],
                [4.0 * r - 1.0, 0.0],
                [0.0, 4.0 * s - 1.0],
                [4.0 * (t - r), -4.0 * r],
                [4.0 * s, 4.0 * r],
                [-4.0 * s, 4.0 * (t - s)],
            ]);
        }
        Shape::Quad4 => {
            for (value, [a, b]) in values.iter_mut().zip(CORNERS) {
                *value = [0.25 * a * (1.0 + b * s), 0.25 * b * (1.0 + a * r)];
            }
        }
        Shape::Quad8 => {
            for (value, [a, b]) in values.iter_mut().zip(CORNERS) {
                *value = [
                    0.25 * a * (1.0 + b * s) * (2.0 * a * r + b * s),
                    0.25 * b * (1.0 + a * r) * (2.0 * b * s + a * r),
                ];
            }
            values[4] = [-r * (1.0 - s), -0.5 * (1.0 - r * r)];
            values[5] = [0.5 * (1.0 - s * s), -s * (1.0 + r)];
            values[6] = [-r * (1.0 + s), 0.5 * (1.0 - r * r)];
            values[7] = [-0.5 * (1.0 - s * s), -s * (1.0 - r)];
        }
    }
    Gradients {
        values,
        n: shape.n_nodes(),
    }
}

const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

#[cfg(test)]
mod tests {
    use super::*;

    /// Reference node positions in the crate's order.
    fn reference(shape: Shape) -> Vec<[f64; 2]> {
        let corners: Vec<[f64; 2]> = match shape.n_corners() {
            3 => vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
            _ => CORNERS.to_vec(),
        };
        let n = corners.len();
        let mut points = corners.clone();
        for k in 0..n {
            let (p, q) = (corners[k], corners[(k + 1) % n]);
            points.push([0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])]);
        }
        points.truncate(shape.n_nodes());
        points
    }

    #[test]
    fn gradients_reproduce_every_complete_polynomial() {
        for shape in [Shape::Tri3, Shape::Tri6, Shape::Quad4, Shape::Quad8] {
            let nodes = reference(shape);
            for p in [[0.2, 0.3], [0.0, 0.0], [0.7, -0.4]] {
                let g = gradients(shape, p);
                let derivative = |f: &dyn Fn([f64; 2]) -> f64| {
                    let mut d = [0.0; 2];
                    for (value, node) in g.values.iter().zip(&nodes) {
                        d[0] += value[0] * f(*node);
                        d[1] += value[1] * f(*node);
                    }
                    d
                };
                let mut cases: Vec<([f64; 2], [f64; 2])> = vec![
                    (derivative(&|_| 1.0), [0.0, 0.0]),
                    (derivative(&|[x, _]| x), [1.0, 0.0]),
                    (derivative(&|[_, y]| y), [0.0, 1.0]),
                ];
                if shape.is_quadratic() {
                    cases.push((derivative(&|[x, _]| x * x), [2.0 * p[0], 0.0]));
                    cases.push((derivative(&|[x, y]| x * y), [p[1], p[0]]));
                    cases.push((derivative(&|[_, y]| y * y), [0.0, 2.0 * p[1]]));
                }
                for (computed, exact) in cases {
                    for k in 0..2 {
                        let error = (computed[k] - exact[k]).abs();
                        assert!(
                            error < 32.0 * f64::EPSILON,
                            "{shape:?} {computed:?} {exact:?}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn the_determinant_of_a_scaled_reference_element_is_the_scale() {
        for shape in [Shape::Tri3, Shape::Tri6, Shape::Quad4, Shape::Quad8] {
            let points: Vec<[f64; 2]> = reference(shape)
                .iter()
                .map(|p| [3.0 * p[0] + 1.0, 0.5 * p[1]])
                .collect();
            let checks = check_points(shape);
            assert!(!checks.is_empty());
            for g in checks {
                assert!((g.determinant(&points) - 1.5).abs() < 64.0 * f64::EPSILON);
            }
        }
    }
}
