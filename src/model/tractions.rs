//! Consistent nodal forces of loads on surfaces: `f = int N' t dA` over their facets.

use super::names::SceneEntry;
use super::on_mesh::OnMesh;
use crate::element::{FacetPoint, facet_points};
use crate::error::{Error, Result};
use crate::mesh::{Mesh, Surface};
use crate::scene::{Field, Load, Scene, VectorField};
use crate::space::{Space, Vector, length, unit};
use std::collections::BTreeMap;
use std::convert::Infallible;

/// Nodal forces, nodes ascending.
pub(super) type NodeForces = Vec<(usize, Vector)>;

/// Load of a scene that acts on a surface by a pressure or a traction.
pub(super) struct Tractions<'a> {
    scene: &'a Scene,
    mesh: &'a Mesh,
    entry: &'a SceneEntry<'a>,
    load: &'a Load,
}

impl<'a> Tractions<'a> {
    pub fn new(
        scene: &'a Scene,
        mesh: &'a Mesh,
        entry: &'a SceneEntry<'a>,
        load: &'a Load,
    ) -> Self {
        Tractions {
            scene,
            mesh,
            entry,
            load,
        }
    }

    /// Forces of a pressure, positive into the body, and its largest absolute value at a node or an
    /// integration point.
    ///
    /// # Errors
    /// `Input` if the pressure is not known everywhere.
    pub fn of_pressure(&self, pressure: &Field, surface: &Surface) -> Result<(NodeForces, f64)> {
        let field = OnMesh::new(pressure, "pressure", self.scene, self.mesh);
        let found = field.and_then(|field| {
            let traction = |nodes: &[usize], point: &FacetPoint| {
                let p = field.at_point(nodes, point)?;
                Ok((point.normal.map(|n| -p * n), p.abs()))
            };
            self.integrate(surface, traction, |node| Ok(field.at_node(node)?.abs()))
        });
        found.map_err(|error| self.refused(error))
    }

    /// Forces of a traction, and its largest size at a node or an integration point.
    ///
    /// # Errors
    /// `Input` if a component is not known everywhere.
    pub fn of_vector(
        &self,
        traction: &VectorField,
        surface: &Surface,
    ) -> Result<(NodeForces, f64)> {
        let fields = traction
            .iter()
            .map(|field| OnMesh::new(field, "traction", self.scene, self.mesh));
        let found = fields.collect::<Result<Vec<_>>>().and_then(|fields| {
            let vector = |at: &dyn Fn(&OnMesh) -> Result<f64>| {
                let mut t = [0.0; 3];
                for (t, field) in t.iter_mut().zip(&fields) {
                    *t = at(field)?;
                }
                Ok((t, length(t)))
            };
            let traction =
                |nodes: &[usize], point: &FacetPoint| vector(&|field| field.at_point(nodes, point));
            let size = |node: usize| Ok(vector(&|field| field.at_node(node))?.1);
            self.integrate(surface, traction, size)
        });
        found.map_err(|error| self.refused(error))
    }

    /// Forces of a traction that is given with its size, and the largest size.
    fn integrate(
        &self,
        surface: &Surface,
        traction: impl Fn(&[usize], &FacetPoint) -> Result<(Vector, f64)>,
        size_at: impl Fn(usize) -> Result<f64>,
    ) -> Result<(NodeForces, f64)> {
        let mut largest = 0.0f64;
        let forces = try_integrate(self.scene.kind, self.mesh, surface, |nodes, point| {
            let (traction, size) = traction(nodes, point)?;
            largest = largest.max(size);
            Ok::<_, Error>(traction)
        })?;
        // A formula need not be finite at a node, since forces come from integration points only.
        let at_nodes = forces.iter().filter_map(|(node, _)| size_at(*node).ok());
        let largest = at_nodes.fold(largest, f64::max);
        Ok((forces, largest))
    }

    fn refused(&self, error: Error) -> Error {
        self.entry
            .refused(error.within(self.entry.on(&self.load.on)))
    }
}

/// Area of a surface: length times thickness 1 in the plane, the whole annulus about an axis.
pub(super) fn area(space: Space, mesh: &Mesh, surface: &Surface) -> f64 {
    let forces = integrate(space, mesh, surface, |_| unit(0));
    forces.iter().map(|(_, f)| f[0]).sum()
}

/// Consistent nodal forces of a traction on a surface.
pub(super) fn integrate(
    space: Space,
    mesh: &Mesh,
    surface: &Surface,
    traction: impl Fn(&FacetPoint) -> Vector,
) -> NodeForces {
    let Ok(forces) = try_integrate(space, mesh, surface, |_, point| {
        Ok::<_, Infallible>(traction(point))
    });
    forces
}

/// Integrates as [`integrate`] does, for a traction that needs the facet's nodes and may fail.
fn try_integrate<E>(
    space: Space,
    mesh: &Mesh,
    surface: &Surface,
    mut traction: impl FnMut(&[usize], &FacetPoint) -> std::result::Result<Vector, E>,
) -> std::result::Result<NodeForces, E> {
    let mut forces = BTreeMap::new();
    for &facet in &surface.facets {
        let nodes: Vec<usize> = mesh.facet_nodes(facet).collect();
        let x: Vec<Vector> = nodes.iter().map(|&n| mesh.point(n)).collect();
        let reference = mesh.facet_reference(facet);
        for point in facet_points(space, reference, &x) {
            let t = traction(&nodes, &point)?;
            for (i, &node) in nodes.iter().enumerate() {
                let f: &mut Vector = forces.entry(node).or_default();
                for (f, t) in f.iter_mut().zip(t) {
                    *f += point.weight * point.values[i] * t;
                }
            }
        }
    }
    Ok(forces.into_iter().collect())
}
