//! Loads by a change of temperature.
//!
//! A point that may expand freely has the strain `alpha dT` along all axes. It enters as plastic
//! strains do, as an initial load:
//!
//! ```text
//! sigma = D (eps - eps_p - alpha dT 1),   f = sum_g w_g B' D alpha dT 1
//! ```
//!
//! The free strain is interpolated between the nodes; linear elements have the mean of theirs, as
//! their stress can follow no more than that.

use super::Model;
use crate::element::{Gradients, Kernel};
use crate::material::Lame;
use crate::mesh::Mesh;
use crate::scene::Formulation;
use crate::space::{Space, Vector, along};
use std::collections::BTreeMap;

/// The free strain at an element's nodes: of linear elements their mean.
fn of_element<const N: usize>(mesh: &Mesh, element: usize, nodal: &[f64]) -> [f64; N] {
    let mut out = [0.0; N];
    let nodes = mesh.nodes(element);
    for (value, &node) in out.iter_mut().zip(nodes) {
        *value = nodal[node as usize];
    }
    if !mesh.shapes[element].is_quadratic() {
        let mean = out.iter().sum::<f64>() / nodes.len() as f64;
        out[..nodes.len()].fill(mean);
    }
    out
}

/// Nodal forces of the free strains `nodal` of a body, nodes ascending.
pub(super) fn forces(
    (space, formulation): (Space, Formulation),
    mesh: &Mesh,
    (body, law): (usize, Lame),
    nodal: &[f64],
) -> Vec<(usize, Vector)> {
    match space {
        Space::Solid => {
            let kernel = Kernel::solid().integrated(formulation);
            forces_of(&kernel, mesh, (body, law), nodal)
        }
        space => {
            let kernel = Kernel::plane(space).integrated(formulation);
            forces_of(&kernel, mesh, (body, law), nodal)
        }
    }
}

fn forces_of<const D: usize, const S: usize, const P: usize, const N: usize>(
    kernel: &Kernel<D, S, P, N>,
    mesh: &Mesh,
    (body, law): (usize, Lame),
    nodal: &[f64],
) -> Vec<(usize, Vector)> {
    let mut out: BTreeMap<usize, Vector> = BTreeMap::new();
    for element in (0..mesh.n_elements()).filter(|&e| mesh.element_body[e] as usize == body) {
        let mut x = [[0.0; D]; N];
        for (x, &node) in x.iter_mut().zip(mesh.nodes(element)) {
            x.copy_from_slice(&mesh.point(node as usize)[..D]);
        }
        let gradients: Gradients<D, S, P, N> = kernel.gauss(mesh.shapes[element], &x);
        let free = gradients.at_points(&of_element(mesh, element, nodal));
        let mut stress = [[0.0; P]; S];
        for g in 0..gradients.n_points() {
            let strain: [f64; S] = std::array::from_fn(|k| if k < 3 { free[g] } else { 0.0 });
            for (lanes, s) in stress.iter_mut().zip(law.times(&strain)) {
                lanes[g] = s;
            }
        }
        for (force, &node) in gradients.forces(&stress).iter().zip(mesh.nodes(element)) {
            let sum = out.entry(node as usize).or_default();
            let force = std::array::from_fn(|d| force.get(d).copied().unwrap_or(0.0));
            *sum = along(*sum, 1.0, force);
        }
    }
    out.into_iter().collect()
}

impl Model {
    /// The free strains at an element's nodes that loads give it at factor 1, with the loads'
    /// indices.
    #[inline]
    pub fn free_strains<const N: usize>(
        &self,
        element: usize,
    ) -> impl Iterator<Item = (usize, [f64; N])> + '_ {
        let body = self.mesh.element_body[element];
        let loads = self
            .loads
            .iter()
            .enumerate()
            .filter(move |(_, l)| l.body == body);
        loads.filter_map(move |(index, load)| {
            let nodal = load.free_strain.as_ref()?;
            Some((index, of_element(&self.mesh, element, nodal)))
        })
    }
}
