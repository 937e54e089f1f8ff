//! Whether a mesh fits its scene: dimension, places, radii, elements that lock.

use super::rigid::RigidBodies;
use crate::error::{Error, Result};
use crate::mesh::{self, Mesh, NearestNode};
use crate::number::significant;
use crate::scene::Scene;
use crate::shape::{Integration, Shape};
use std::path::Path;

/// Completes and checks the mesh of a scene, and adds the elements of rigid surfaces to it.
///
/// # Errors
/// A mesh that is damaged or does not fit the scene. For a damaged mesh from a file the message
/// names the file.
pub(super) fn prepare(scene: &Scene, mesh: &mut Mesh, file: Option<&Path>) -> Result<RigidBodies> {
    mesh.name_parts(scene.set_names());
    mesh.integration = integration(scene, mesh);
    mesh::validate(mesh).map_err(|error| match file {
        Some(file) => error.within(file.display()),
        None => error,
    })?;
    check_dimension(scene, mesh)?;
    check_places(scene, mesh)?;
    RigidBodies::add(scene, mesh)
}

/// Integration of each body; empty if all bodies have reduced integration.
fn integration(scene: &Scene, mesh: &Mesh) -> Vec<Integration> {
    let of = |name: &String| scene.bodies.get(name).map(|body| body.integration);
    let of_bodies = mesh.bodies.iter().map(|name| of(name).unwrap_or_default());
    let all: Vec<Integration> = of_bodies.collect();
    match all.contains(&Integration::Full) {
        true => all,
        false => Vec::new(),
    }
}

/// Warns of elements that lock in bodies that may yield, whether the mesh has them from the start
/// or a local refinement of quadrilaterals leaves them at its rim.
pub(super) fn warn_of_locking(
    scene: &Scene,
    mesh: &Mesh,
    may_yield: &[bool],
    warnings: &mut Vec<String>,
) {
    let locks = (0..mesh.n_elements())
        .filter(|&e| {
            mesh.shapes[e].has_constant_strain() && may_yield[mesh.element_body[e] as usize]
        })
        .count();
    let is_rim = !scene.mesh.refine.is_empty() && mesh.shapes.contains(&Shape::Quad4);
    if locks > 0 && is_rim {
        warnings.push(format!(
            "{locks} tri3 elements at the rim of what `mesh.refine` divides belong to bodies that \
             may yield: they are too stiff where plastic flow reaches them; a larger `radius` puts \
             them farther out, and quad8 elements have tri6 there, which do not lock"
        ));
    } else if locks > 0 {
        warnings.push(format!(
            "{locks} {} elements belong to bodies that may yield: they lock in isochoric plastic \
             flow, so that limit loads come out too high; use {}",
            if mesh.is_solid() { "tet4" } else { "tri3" },
            if mesh.is_solid() {
                "hex8, hex20 or tet10"
            } else {
                "quad4, quad8 or tri6"
            },
        ));
    }
}

/// Refuses a plane mesh in a solid scene, or the reverse.
fn check_dimension(scene: &Scene, mesh: &Mesh) -> Result<()> {
    if mesh.dimension == scene.kind.dimension() {
        return Ok(());
    }
    let (is, take) = match mesh.is_solid() {
        true => ("three-dimensional", "\"solid\""),
        false => (
            "plane",
            "\"plane_strain\", \"plane_stress\" or \"axisymmetric\"",
        ),
    };
    let error = Error::input(format!(
        "the mesh is {is}, kind = \"{}\" is not: take {take}, or another mesh",
        scene.kind.name()
    ));
    Err(scene.places.in_front("kind", error))
}

/// Refuses a reference whose place is farther from the nearest node than the longest edge at this
/// node.
fn check_places(scene: &Scene, mesh: &Mesh) -> Result<()> {
    for (index, entry) in scene.reference.iter().enumerate() {
        let Some(place) = entry.place() else { continue };
        let Some(near) = NearestNode::of(mesh, entry.body.as_deref(), place) else {
            continue;
        };
        if near.distance > near.edge {
            let [away, edge] = [near.distance, near.edge].map(|size| significant(size, 4));
            let (node, at) = (mesh.node_label(near.node), mesh.place(near.node));
            let key = format!("reference.{index}.at");
            let error = Error::input(format!(
                "{key}: the nearest node, {node} at {at}, is {away} away, more than an element is \
                 long there ({edge}): give a place of the mesh"
            ));
            return Err(scene.places.in_front(&key, error));
        }
    }
    Ok(())
}

/// Refuses nodes at a negative radius in an axisymmetric model.
pub(super) fn check_radii(mesh: &Mesh) -> Result<()> {
    match (0..mesh.n_nodes()).find(|&node| mesh.point(node)[0] < 0.0) {
        Some(node) => Err(Error::input(format!(
            "node {} lies at negative radius {}: an axisymmetric model needs x = r >= 0",
            mesh.node_label(node),
            mesh.point(node)[0]
        ))),
        None => Ok(()),
    }
}
