//! Displacements and forces of nodes without elements, which are sums over nodes of the mesh.

use super::tables::Tables;
use crate::interpolation::interpolate;
use crate::results::Fields;
use crate::scene::LooseNode;
use crate::space::{Vector, along, dot, unit};

impl Tables<'_> {
    /// Returns a vector of a node that the mesh does not have, along x, y and z; zero if no
    /// equation has the node.
    pub(super) fn of_loose(&self, label: u64, own: impl Fn(&LooseNode) -> Vector) -> Vector {
        let requests = &self.model.scene.requests;
        let vector = requests.loose.get(&label).map_or([0.0; 3], own);
        let axes = self.axes_of(label).into_iter().zip(vector);
        axes.fold([0.0; 3], |sum, (axis, value)| along(sum, value, axis))
    }

    /// Returns the displacement of a node at a time, along its own axes.
    pub(super) fn displacement_of(&self, loose: &LooseNode, fields: &Fields, time: f64) -> Vector {
        std::array::from_fn(|k| {
            let axis = &loose.axes[k];
            let prescribed = interpolate(&axis.prescribed, time);
            prescribed + self.sum(&axis.displacement, &fields.displacement)
        })
    }

    /// Returns the force on a node along its own axes.
    pub(super) fn force_of(&self, loose: &LooseNode, fields: &Fields) -> Vector {
        let of_axis = |k: usize| self.of_forces * self.sum(&loose.axes[k].force, &fields.force);
        std::array::from_fn(of_axis)
    }

    /// Returns the sum over nodes of the mesh of a coefficient times the component of a vector
    /// along one of the node's axes.
    fn sum(&self, terms: &[(u64, u8, f64)], values: &[f64]) -> f64 {
        let terms = terms.iter().filter_map(|&(label, axis, c)| {
            let node = self.nodes.get(label)? as usize;
            let axis = self.axes_of(label)[usize::from(axis)];
            Some(c * dot(axis, self.vector(node, values)))
        });
        terms.sum()
    }

    fn axes_of(&self, label: u64) -> [Vector; 3] {
        let own = self.model.scene.requests.axes.get(&label);
        own.copied().unwrap_or([0, 1, 2].map(unit))
    }
}
