//! Data from which stresses follow once the displacements are known: mesh, materials, yield
//! stresses.

use super::YieldByDepth;
use crate::element::{Gradients, Kernel};
use crate::material::Material;
use crate::mesh::Mesh;
use crate::scene::Formulation;
use crate::space::{Space, Vector};
use serde::{Deserialize, Serialize};

/// Bodies as a continuum: all bodies of a model, or a self-contained part of their elements.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Continuum {
    /// Plane strain, plane stress, axisymmetric or solid.
    pub kind: Space,
    /// Integration of the elements: with the mean dilatation or without.
    pub formulation: Formulation,
    /// The mesh of all bodies.
    pub mesh: Mesh,
    /// Material of each body.
    pub materials: Vec<Material>,
    /// Whether each body may yield.
    pub may_yield: Vec<bool>,
    /// Yield stress by depth, for each body that has such a profile.
    pub yield_by_depth: Vec<Option<YieldByDepth>>,
    /// Whether fields are written at the integration points, too.
    pub point_values: bool,
}

impl Continuum {
    /// Extracts some elements, ascending, on their own nodes; also returns the numbers of these
    /// nodes.
    pub fn part(&self, elements: &[usize]) -> (Continuum, Vec<u32>) {
        let (mesh, nodes) = self.mesh.part(elements);
        let part = Continuum {
            mesh,
            materials: self.materials.clone(),
            may_yield: self.may_yield.clone(),
            yield_by_depth: self.yield_by_depth.clone(),
            ..*self
        };
        (part, nodes)
    }

    /// Gradients at the Gauss points of an element.
    #[inline]
    pub fn gradients<const D: usize, const S: usize, const P: usize, const N: usize>(
        &self,
        kernel: &Kernel<D, S, P, N>,
        element: usize,
    ) -> Gradients<D, S, P, N> {
        let nodes = self.mesh.element_coordinates(element);
        let integration = self.mesh.integration_of(element);
        kernel.gauss((self.mesh.shapes[element], integration), &nodes)
    }

    /// Initial yield stress of a body at a point; infinite for an elastic material.
    #[inline]
    pub fn yield_stress(&self, body: usize, place: Vector) -> f64 {
        match &self.yield_by_depth[body] {
            Some(profile) => profile.at(place),
            None => self.materials[body].yield_stress(),
        }
    }

    /// Material of an element.
    pub fn material(&self, element: usize) -> &Material {
        &self.materials[self.mesh.element_body[element] as usize]
    }
}
