//! Extrapolation of values from the integration points of an element to its nodes.

use super::{Rule, Shape};
use nalgebra::DMatrix;

/// Relative size below which a singular value counts as zero.
const SINGULAR: f64 = 1e-10;

/// Extrapolates values from the integration points of an element to its nodes, by the field that
/// fits the points best. If there are at least as many points as nodes, the field is spanned by the
/// element's own shape functions. Otherwise it is linear along each reference coordinate, and the
/// value at the middle of an edge is the mean of the edge's two corners.
#[derive(Debug, Clone)]
pub struct NodalExtrapolation {
    n_points: usize,
    /// Factors by which the values at the integration points are multiplied and summed to give the
    /// value at a node: all points of the first node, then of the next.
    weights: Vec<f64>,
}

impl NodalExtrapolation {
    /// The extrapolation from the points of a rule.
    ///
    /// With `N_c` the shape functions of the element itself, or of the linear element with the same
    /// corners, the values `v_c` at the nodes are the smallest ones for which `sum_c N_c(x_g) v_c`
    /// is closest to the values at the points `x_g`.
    pub fn new(shape: Shape, rule: &Rule) -> Self {
        let n_points = rule.len();
        let fitted = match n_points < shape.n_nodes() {
            true => shape.linear(),
            false => shape,
        };
        let n_fitted = fitted.n_nodes();
        let functions: Vec<_> = rule.iter().map(|(at, _)| fitted.functions(*at)).collect();
        let matrix = DMatrix::from_fn(n_points, n_fitted, |g, c| functions[g].values[c]);
        let largest = matrix.norm();
        // Can fail only for a negative tolerance.
        let inverse = matrix
            .clone()
            .pseudo_inverse(SINGULAR * largest)
            .unwrap_or_else(|_| DMatrix::zeros(n_fitted, n_points));
        // Equal singular values are found to half the digits only; one step of Newton's method
        // recovers all digits (A. Ben-Israel, Math. Comp. 19 (1965) 452).
        let inverse = 2.0 * &inverse - &inverse * &matrix * &inverse;
        let mut weights = Vec::with_capacity(shape.n_nodes() * n_points);
        for node in 0..shape.n_nodes() {
            for g in 0..n_points {
                weights.push(match node.checked_sub(n_fitted) {
                    None => inverse[(node, g)],
                    Some(edge) => {
                        let [a, b] = shape.reference().edges[edge];
                        0.5 * (inverse[(a, g)] + inverse[(b, g)])
                    }
                });
            }
        }
        NodalExtrapolation { n_points, weights }
    }

    /// The value of one component at a node. `values` holds `size` components of each point, one
    /// point after the other.
    pub fn at_node(&self, node: usize, values: &[f64], size: usize, component: usize) -> f64 {
        let weights = &self.weights[self.n_points * node..][..self.n_points];
        let at_points = values.iter().skip(component).step_by(size);
        weights.iter().zip(at_points).map(|(w, v)| w * v).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::Integration;

    /// Linear fields are extrapolated exactly if the points determine them, constant fields always.
    #[test]
    fn fields_are_carried_to_the_nodes() {
        let integrated = |by| Shape::ALL.map(|shape| (shape, shape.rule(by)));
        for (shape, rule) in Integration::ALL.into_iter().flat_map(integrated) {
            let row = shape.reference();
            let of = NodalExtrapolation::new(shape, rule);
            for (k, node) in row.nodes.iter().enumerate() {
                let constant = vec![7.0; rule.len()];
                assert!((of.at_node(k, &constant, 1, 0) - 7.0).abs() < 1e-12);
                if shape.has_constant_strain() {
                    continue;
                }
                let field = |x: &[f64; 3]| 2.0 + x[0] - 3.0 * x[1] + 0.5 * x[2];
                let values: Vec<f64> = (rule.iter()).flat_map(|(at, _)| [0.0, field(at)]).collect();
                let found = of.at_node(k, &values, 2, 1);
                assert!(
                    (found - field(node)).abs() < 1e-12,
                    "{shape:?} {k}: {found}"
                );
            }
        }
    }

    /// The two points of this prism determine a variation along its height only.
    #[test]
    fn what_points_do_not_tell_is_constant() {
        let at = |z: f64| ([1.0 / 3.0, 1.0 / 3.0, z], 0.5);
        let of = NodalExtrapolation::new(Shape::Prism6, &[at(-0.5), at(0.5)]);
        for (k, node) in Shape::Prism6.reference().nodes.iter().enumerate() {
            let found = of.at_node(k, &[1.0, 3.0], 1, 0);
            assert!((found - (2.0 + 2.0 * node[2])).abs() < 1e-12, "{k} {found}");
        }
    }
}
