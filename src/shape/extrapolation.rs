//! Values at the nodes of an element from those at its integration points.

use super::{Rule, Shape};
use nalgebra::DMatrix;

/// Relative size below which a singular value is none.
const SINGULAR: f64 = 1e-10;

/// Carries values from the integration points of an element to its nodes: the field that is linear
/// along each reference coordinate and fits the points best; at the middle of an edge the mean of
/// its corners.
#[derive(Debug, Clone)]
pub struct Extrapolation {
    n_points: usize,
    /// Weights of the points, node by node.
    weights: Vec<f64>,
}

impl Extrapolation {
    /// From the points of a rule.
    ///
    /// With `N_c` the shape functions of the linear element with the same corners, the values
    /// `v_c` at the corners are the smallest ones for which `sum_c N_c(x_g) v_c` is closest to the
    /// values at the points `x_g`.
    pub fn new(shape: Shape, rule: &Rule) -> Self {
        let (n_corners, n_points) = (shape.n_corners(), rule.len());
        let linear = shape.linear();
        let functions: Vec<_> = rule.iter().map(|(at, _)| linear.functions(*at)).collect();
        let matrix = DMatrix::from_fn(n_points, n_corners, |g, c| functions[g].values[c]);
        let largest = matrix.norm();
        // Fails for a negative tolerance only.
        let inverse = matrix
            .pseudo_inverse(SINGULAR * largest)
            .unwrap_or_else(|_| DMatrix::zeros(n_corners, n_points));
        let mut weights = Vec::with_capacity(shape.n_nodes() * n_points);
        for node in 0..shape.n_nodes() {
            for g in 0..n_points {
                weights.push(match node.checked_sub(n_corners) {
                    None => inverse[(node, g)],
                    Some(edge) => {
                        let [a, b] = shape.reference().edges[edge];
                        0.5 * (inverse[(a, g)] + inverse[(b, g)])
                    }
                });
            }
        }
        Extrapolation { n_points, weights }
    }

    /// The value at a node of one component of values at the points, each of `size` components one
    /// after the other.
    pub fn at_node(&self, node: usize, values: &[f64], size: usize, component: usize) -> f64 {
        let weights = &self.weights[self.n_points * node..][..self.n_points];
        let at_points = values.iter().skip(component).step_by(size);
        weights.iter().zip(at_points).map(|(w, v)| w * v).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Linear fields are exact where the points tell them apart, constant ones everywhere.
    #[test]
    fn fields_are_carried_to_the_nodes() {
        for shape in Shape::ALL {
            let row = shape.reference();
            let of = Extrapolation::new(shape, row.gauss);
            for (k, node) in row.nodes.iter().enumerate() {
                let constant = vec![7.0; row.gauss.len()];
                assert!((of.at_node(k, &constant, 1, 0) - 7.0).abs() < 1e-12);
                if shape.has_constant_strain() {
                    continue;
                }
                let field = |x: &[f64; 3]| 2.0 + x[0] - 3.0 * x[1] + 0.5 * x[2];
                let values: Vec<f64> = (row.gauss.iter())
                    .flat_map(|(at, _)| [0.0, field(at)])
                    .collect();
                let found = of.at_node(k, &values, 2, 1);
                assert!((found - field(node)).abs() < 1e-12, "{shape:?} {k}");
            }
        }
    }

    /// The two points of a prism of six nodes tell its height only.
    #[test]
    fn what_points_do_not_tell_is_constant() {
        let at = |z: f64| ([1.0 / 3.0, 1.0 / 3.0, z], 0.5);
        let of = Extrapolation::new(Shape::Prism6, &[at(-0.5), at(0.5)]);
        for (k, node) in Shape::Prism6.reference().nodes.iter().enumerate() {
            let found = of.at_node(k, &[1.0, 3.0], 1, 0);
            assert!((found - (2.0 + 2.0 * node[2])).abs() < 1e-12, "{k} {found}");
        }
    }
}
