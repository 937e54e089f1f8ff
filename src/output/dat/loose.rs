//! Vectors of nodes by their labels. Displacements and forces of nodes without elements are sums
//! over nodes of the mesh.

use crate::interpolation::interpolate;
use crate::labels::LabelIndex;
use crate::model::Model;
use crate::results::Fields;
use crate::scene::LooseNode;
use crate::space::{Vector, along, dot, unit};

/// Displacements and forces of nodes by label, whether or not elements have the node.
pub(super) struct NodeVectors<'a> {
    model: &'a Model,
    nodes: LabelIndex,
}

impl<'a> NodeVectors<'a> {
    pub(super) fn new(model: &'a Model) -> Self {
        let labels = (0..model.mesh.n_nodes()).map(|n| model.mesh.node_label(n));
        let labels: Vec<u64> = labels.collect();
        NodeVectors {
            model,
            nodes: LabelIndex::new(&labels).unwrap_or_default(),
        }
    }

    /// Returns the vector of a node of the mesh, from the components of all nodes.
    pub(super) fn at(&self, node: usize, values: &[f64]) -> Vector {
        let d = self.model.mesh.dimension;
        let own = &values[d * node..d * (node + 1)];
        std::array::from_fn(|k| own.get(k).copied().unwrap_or(0.0))
    }

    /// Returns the displacement of a node at a time.
    pub(super) fn displacement(&self, label: u64, fields: &Fields, time: f64) -> Vector {
        let values = &fields.displacement;
        self.of_label(label, (values, 1.0), |loose, k| {
            let axis = &loose.axes[k];
            interpolate(&axis.prescribed, time) + self.sum(&axis.displacement, values)
        })
    }

    /// Returns the force on a node times a factor.
    pub(super) fn force(&self, label: u64, fields: &Fields, factor: f64) -> Vector {
        self.of_label(label, (&fields.force, factor), |loose, k| {
            factor * self.sum(&loose.axes[k].force, &fields.force)
        })
    }

    /// Returns the vector of the node with the given label. For a node of the mesh, this is its
    /// part of `values` times `factor`. For another node, `along_own` gives the component along
    /// each of its axes; the vector is zero if no equation contains the node.
    fn of_label(
        &self,
        label: u64,
        (values, factor): (&[f64], f64),
        along_own: impl Fn(&LooseNode, usize) -> f64,
    ) -> Vector {
        if let Some(node) = self.nodes.get(label) {
            return self.at(node as usize, values).map(|v| factor * v);
        }
        let Some(loose) = self.model.scene.requests.loose.get(&label) else {
            return [0.0; 3];
        };
        let axes = self.axes_of(label).into_iter().enumerate();
        axes.fold([0.0; 3], |sum, (k, axis)| {
            along(sum, along_own(loose, k), axis)
        })
    }

    /// Returns the sum over nodes of the mesh of a coefficient times the component of a vector
    /// along one of the node's axes.
    fn sum(&self, terms: &[(u64, u8, f64)], values: &[f64]) -> f64 {
        let terms = terms.iter().filter_map(|&(label, axis, c)| {
            let node = self.nodes.get(label)? as usize;
            let axis = self.axes_of(label)[usize::from(axis)];
            Some(c * dot(axis, self.at(node, values)))
        });
        terms.sum()
    }

    fn axes_of(&self, label: u64) -> [Vector; 3] {
        let own = self.model.scene.requests.axes.get(&label);
        own.copied().unwrap_or([0, 1, 2].map(unit))
    }
}
