//! Strains without stress: from a change of temperature, or initial ones of a body.
//!
//! If a point can expand freely, its free strain `eps_0` is `alpha dT` along all axes. Where a body
//! has residual stress, the free strain is the one that causes this stress. The free strain enters
//! like plastic strains, as an initial load:
//!
//! ```text
//! sigma = D (eps - eps_p - eps_0),   f = sum_g w_g B' D eps_0
//! ```
//!
//! The free strain is interpolated between the nodes. Linear elements take the mean of their nodes'
//! values, because their stress cannot follow a free strain that varies within the element.

use crate::element::{Gradients, Kernel, with_kernel};
use crate::material::Lame;
use crate::mesh::Mesh;
use crate::scene::Formulation;
use crate::space::{Space, Vector, along};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;

/// Components of a free strain that share one value at each node.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct FreeStrain {
    /// Range of the strain components that share the value.
    pub components: Range<usize>,
    /// Value of these components at each node of the mesh.
    pub nodal: Vec<f64>,
}

impl FreeStrain {
    /// Whether the free strain is zero everywhere.
    pub(super) fn is_none(&self) -> bool {
        self.nodal.iter().all(|strain| *strain == 0.0)
    }
}

/// Free strain at an element's nodes; in linear elements the mean at each node.
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

/// Nodal forces of the free strains of a body, nodes ascending.
pub(super) fn forces(
    (space, formulation): (Space, Formulation),
    mesh: &Mesh,
    (body, law): (usize, Lame),
    free: &[FreeStrain],
) -> Vec<(usize, Vector)> {
    with_kernel!(space, formulation, mesh, kernel => forces_of(&kernel, mesh, (body, law), free))
}

fn forces_of<const D: usize, const S: usize, const P: usize, const N: usize>(
    kernel: &Kernel<D, S, P, N>,
    mesh: &Mesh,
    (body, law): (usize, Lame),
    free: &[FreeStrain],
) -> Vec<(usize, Vector)> {
    let mut out: BTreeMap<usize, Vector> = BTreeMap::new();
    for element in (0..mesh.n_elements()).filter(|&e| mesh.element_body[e] as usize == body) {
        let mut x = [[0.0; D]; N];
        for (x, &node) in x.iter_mut().zip(mesh.nodes(element)) {
            x.copy_from_slice(&mesh.point(node as usize)[..D]);
        }
        let gradients: Gradients<D, S, P, N> =
            kernel.gauss((mesh.shapes[element], mesh.integration_of(element)), &x);
        let mut strains = [[0.0; P]; S];
        for free in free {
            let at_points = gradients.at_points(&of_element(mesh, element, &free.nodal));
            for lanes in strains
                .iter_mut()
                .take(free.components.end)
                .skip(free.components.start)
            {
                *lanes = at_points;
            }
        }
        let mut stress = [[0.0; P]; S];
        for g in 0..gradients.n_points() {
            let strain = strains.each_ref().map(|lanes| lanes[g]);
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

/// A free strain that belongs to a load.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct FreeOfLoad<'a> {
    /// Index of the load.
    pub load: usize,
    /// Number of the body whose elements have the strain.
    body: u32,
    strain: Cow<'a, FreeStrain>,
}

impl<'a> FreeOfLoad<'a> {
    /// A strain that the load with a number causes in the elements of a body.
    pub(super) fn new(load: usize, body: u32, strain: &'a FreeStrain) -> Self {
        FreeOfLoad {
            load,
            body,
            strain: Cow::Borrowed(strain),
        }
    }

    /// Components in which the load has a free strain.
    pub fn components(&self) -> &Range<usize> {
        &self.strain.components
    }

    /// Free strain at an element's nodes at load factor 1; `None` for an element of another body.
    #[inline]
    pub fn at_nodes<const N: usize>(&self, mesh: &Mesh, element: usize) -> Option<[f64; N]> {
        let is_own = mesh.element_body[element] == self.body;
        is_own.then(|| of_element(mesh, element, &self.strain.nodal))
    }

    /// Restricts the free strain to some nodes, which are renumbered in the given order.
    pub fn part(&self, nodes: &[u32]) -> FreeOfLoad<'static> {
        let nodal = nodes.iter().map(|&node| self.strain.nodal[node as usize]);
        let strain = FreeStrain {
            components: self.components().clone(),
            nodal: nodal.collect(),
        };
        FreeOfLoad {
            load: self.load,
            body: self.body,
            strain: Cow::Owned(strain),
        }
    }
}
