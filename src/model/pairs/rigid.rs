//! Pairs of nodes with a rigid surface; gaps and normals are those of its exact form.
//!
//! The gap of a node is its distance from the surface; the normal is the normal of the surface at
//! the closest point. Sliding is assumed to be small, so the normal and the initial gap stay the
//! same when the bodies move.

use super::Pair;
use super::contact_input::ContactInput;
use super::found::Found;
use super::matching::nodal_areas;
use crate::error::{Error, Result};
use crate::mesh::surface::{longest_facet, nodes, normals};
use crate::model::rigid::RigidBody;
use crate::space::{Vector, difference, dot, length};
use std::collections::{BTreeMap, BTreeSet};

/// Cosine of the angle between the normals of the two surfaces up to which they face each other:
/// beyond 60 degrees a surface would have to turn further than small displacements allow.
const FACING: f64 = 0.5;

/// Finds the pairs of a mesh surface, number `slave` of the contact, with a rigid one.
///
/// # Errors
/// Surfaces that are not one curve, that face each other nowhere, or that overlap.
pub(super) fn pairs(entries: &ContactInput, slave: usize, body: &RigidBody) -> Result<Found> {
    let (mesh, surface) = (entries.mesh, entries.surfaces[slave]);
    let slaves = nodes(mesh, surface)?;
    let facet_length = longest_facet(mesh, surface);
    let outward = normals(mesh, surface, &slaves);
    let mut near: BTreeMap<usize, (f64, Vector)> = BTreeMap::new();
    for (&node, own) in slaves.iter().zip(&outward) {
        if let Some((gap, normal)) = body.form.near(mesh.point(node))
            && dot(*own, normal) <= -FACING
        {
            near.insert(node, (gap, normal.map(|n| -n)));
        }
    }
    // Nodes of facets whose nodes all face the rigid surface.
    let faces = surface.facets.iter().map(|&facet| mesh.facet_nodes(facet));
    let facing: BTreeSet<usize> = faces
        .filter(|nodes| nodes.clone().all(|node| near.contains_key(&node)))
        .flatten()
        .collect();
    let areas = nodal_areas(entries, surface, &facing);
    let mut pairs = Vec::new();
    let mut arc = 0.0;
    for (j, &node) in slaves.iter().enumerate() {
        let x = mesh.point(node);
        if j > 0 && !mesh.is_solid() {
            arc += length(difference(x, mesh.point(slaves[j - 1])));
        }
        let Some(&(gap, normal)) = near.get(&node).filter(|_| facing.contains(&node)) else {
            continue;
        };
        pairs.push(Pair {
            contact: entries.index,
            slave: node,
            masters: body.masters(),
            normal,
            gap: entries.stated.gap(node)?.unwrap_or(gap),
            interference: entries.stated.interference(node)?,
            unit_gap: 1.0,
            area: areas.get(&node).copied().unwrap_or(0.0),
            arc,
        });
    }
    if pairs.is_empty() {
        return Err(Error::input(format!(
            "no facet of the surface faces the rigid surface `{}`: is that one on the right side, \
             or its direction turned round?",
            body.name
        )));
    }
    check_apart(entries, &pairs, body, facet_length)?;
    Ok(Found::new(pairs, slave, facet_length))
}

/// Refuses a rigid surface that starts inside the body.
fn check_apart(
    entries: &ContactInput,
    pairs: &[Pair],
    body: &RigidBody,
    facet_length: f64,
) -> Result<()> {
    let (mesh, contact) = (entries.mesh, &entries.contact);
    let deepest = pairs.iter().min_by(|a, b| a.gap.total_cmp(&b.gap));
    let inside = |pair: &&Pair| pair.overlaps(facet_length, entries.rounding) && !contact.overlap;
    match deepest.filter(inside) {
        None => Ok(()),
        Some(pair) => Err(Error::input(format!(
            "the rigid surface `{}` starts inside the body, by {:.3e} at node {} at {}; move it \
             away, or say `overlap = true` where that is an interference",
            body.name,
            -pair.gap,
            mesh.node_label(pair.slave),
            mesh.place(pair.slave),
        ))),
    }
}
