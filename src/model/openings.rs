//! Openings: changes of the gaps of contacts by loads.

use super::ContactSurface;
use super::contact_basis::ContactBasis;
use super::on_mesh::OnMesh;
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::scene::{Field, Load, Scene};
use std::collections::BTreeMap;

/// Distance by which a load at factor 1 moves the surfaces of a contact apart.
#[derive(Debug, Clone, PartialEq)]
pub enum Opening {
    /// One value for the whole contact.
    Uniform(f64),
    /// Values at the nodes of the slaves, or at their control points.
    At(BTreeMap<usize, f64>),
}

impl Opening {
    /// Value of the opening at a slave node.
    pub fn at(&self, node: usize) -> f64 {
        match self {
            Opening::Uniform(gap) => *gap,
            Opening::At(gaps) => gaps.get(&node).copied().unwrap_or(0.0),
        }
    }

    /// Largest absolute value of the opening.
    pub fn largest(&self) -> f64 {
        match self {
            Opening::Uniform(gap) => gap.abs(),
            Opening::At(gaps) => gaps.values().fold(0.0, |most, gap| most.max(gap.abs())),
        }
    }

    /// Converts the openings of middle nodes of edges to their control points.
    pub(super) fn restate(&mut self, basis: &ContactBasis) {
        if let Opening::At(gaps) = self {
            let nodal = gaps.clone();
            let at = |node: usize| nodal.get(&node).copied().unwrap_or(0.0);
            for (&node, gap) in gaps.iter_mut() {
                *gap = basis.number_at_control(node, at);
            }
        }
    }
}

/// Finds the contacts whose gaps a load on a surface changes, each with its opening.
pub(super) fn opened(
    load: &Load,
    (scene, contacts): (&Scene, &[ContactSurface]),
    mesh: &Mesh,
    gap: &Field,
) -> Result<Vec<(usize, Opening)>> {
    let mut found = Vec::new();
    for (index, contact) in contacts.iter().enumerate() {
        if contact.names.contains(&load.on) {
            let slaves = &contact.names[contact.slave];
            found.push((index, opening(gap, slaves, scene, mesh)?));
        }
    }
    if found.is_empty() {
        let of = scene
            .contact
            .iter()
            .flat_map(|c| [c.first.as_str(), c.second.as_str()]);
        let of: Vec<&str> = of.collect();
        return Err(Error::input(format!(
            "a load by `gap` on `{}`, which no contact has; surfaces in contact are `{}`",
            load.on,
            of.join("`, `")
        )));
    }
    Ok(found)
}

fn opening(gap: &Field, slaves: &str, scene: &Scene, mesh: &Mesh) -> Result<Opening> {
    if let Some(gap) = gap.uniform() {
        return Ok(Opening::Uniform(gap));
    }
    let field = OnMesh::new(gap, "gap", scene, mesh)?;
    let nodes = mesh.set_nodes(slaves).into_iter().flatten();
    let values = nodes.map(|node| Ok((node, field.at_node(node)?)));
    Ok(Opening::At(values.collect::<Result<_>>()?))
}
