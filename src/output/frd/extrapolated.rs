//! Values at nodes, extrapolated from the integration points of the elements around them.

use crate::mesh::{Mesh, Shape};
use crate::results::PointValues;
use crate::shape::{Integration, NodalExtrapolation};

/// Extrapolated values at the nodes, averaged over the elements of each node.
pub(in crate::output) struct Extrapolated {
    /// Stress, `n_nodes x n_components`.
    pub(in crate::output) stress: Vec<f64>,
    /// Strain, `n_nodes x n_components`.
    pub(in crate::output) strain: Vec<f64>,
    /// Equivalent plastic strain, `n_nodes`.
    pub(in crate::output) plastic_strain: Vec<f64>,
    /// Extrapolations, indexed by the numbers of integration and shape.
    of_shapes: Vec<NodalExtrapolation>,
}

impl Extrapolated {
    pub(in crate::output) fn new(mesh: &Mesh, points: &PointValues) -> Self {
        let integrated = |by: Integration| {
            let of = move |shape: Shape| NodalExtrapolation::new(shape, shape.rule(by));
            Shape::ALL.into_iter().map(of)
        };
        let of_shapes: Vec<_> = Integration::ALL.into_iter().flat_map(integrated).collect();
        let n_elements = count(mesh);
        let mean = |values: &[f64], size: usize| {
            let mut out = vec![0.0; size * mesh.n_nodes()];
            for element in 0..mesh.n_elements() {
                let at_nodes = at_nodes(mesh, &of_shapes, points, (element, values, size));
                for (node, value) in at_nodes {
                    let n = f64::from(n_elements[node]);
                    for (sum, value) in out[size * node..].iter_mut().zip(value) {
                        *sum += value / n;
                    }
                }
            }
            out
        };
        let c = points.n_components();
        Extrapolated {
            stress: mean(&points.stress, c),
            strain: mean(&points.strain, c),
            plastic_strain: mean(&points.plastic_strain, 1),
            of_shapes,
        }
    }

    /// Returns the jump of the stress between elements at each node: the largest von Mises stress
    /// of the difference between an element's values at its nodes and the means there, in percent
    /// of the largest von Mises stress. At a node the largest value of its elements counts.
    pub(in crate::output) fn stress_jumps(&self, mesh: &Mesh, points: &PointValues) -> Vec<f64> {
        let c = points.n_components();
        let all = self.stress.chunks_exact(c);
        let largest = all.map(von_mises).fold(f64::MIN_POSITIVE, f64::max);
        let mut out = vec![0.0f64; mesh.n_nodes()];
        for element in 0..mesh.n_elements() {
            let stress = (element, &*points.stress, c);
            let mut of_element = 0.0f64;
            for (node, value) in at_nodes(mesh, &self.of_shapes, points, stress) {
                let mean = &self.stress[c * node..][..c];
                let jump: Vec<f64> = value.iter().zip(mean).map(|(v, m)| v - m).collect();
                of_element = of_element.max(100.0 * von_mises(&jump) / largest);
            }
            for &node in mesh.nodes(element) {
                out[node as usize] = out[node as usize].max(of_element);
            }
        }
        out
    }
}

/// Returns the number of elements of each node.
fn count(mesh: &Mesh) -> Vec<u32> {
    let mut out = vec![0; mesh.n_nodes()];
    for &node in &mesh.connectivity {
        out[node as usize] += 1;
    }
    out
}

/// Returns the values of an element at its nodes, indexed by node and component.
fn at_nodes<'a>(
    mesh: &'a Mesh,
    of_shapes: &'a [NodalExtrapolation],
    points: &PointValues,
    (element, values, size): (usize, &'a [f64], usize),
) -> impl Iterator<Item = (usize, Vec<f64>)> + 'a {
    let first = Shape::ALL.len() * mesh.integration_of(element) as usize;
    let of = &of_shapes[first + mesh.shapes[element] as usize];
    let range = points.of(element);
    let values = &values[size * range.start..size * range.end];
    let nodes = mesh.nodes(element).iter().enumerate();
    nodes.map(move |(k, &node)| {
        let components = (0..size).map(|c| of.at_node(k, values, size, c));
        (node as usize, components.collect())
    })
}

fn von_mises(stress: &[f64]) -> f64 {
    let [a, b, c] = [
        stress[0] - stress[1],
        stress[1] - stress[2],
        stress[2] - stress[0],
    ];
    let shear: f64 = stress[3..].iter().map(|t| t * t).sum();
    (0.5 * (a * a + b * b + c * c) + 3.0 * shear).sqrt()
}
