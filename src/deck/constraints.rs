//! Equations that hold a surface plane, and local axes of nodes.

use super::data::{EntitySelection, LinearEquation, Transform};
use super::facets::Key;
use super::sets::{Lookup, What};
use super::source::LinePlace;
use crate::error::Result;
use crate::space::{Vector, along, cross, difference, direction, dot, length};
use std::collections::BTreeMap;

/// Nodes that share one displacement along an axis, that of the leader.
#[derive(Debug, Clone)]
pub(super) struct HeldPlane {
    /// The node and axis whose displacement all nodes follow.
    pub(super) leader: Key,
    /// The nodes that share the displacement, the leader included.
    pub(super) nodes: Vec<u32>,
    pub(super) place: LinePlace,
}

impl HeldPlane {
    /// Separates the equations that hold nodes plane, `u_i - u_leader = 0` along one axis, from all
    /// other equations.
    ///
    /// # Errors
    /// `Input` for names and numbers that are not defined.
    pub(super) fn among<'e>(
        equations: &'e [LinearEquation],
        lookup: Lookup,
    ) -> Result<(Vec<HeldPlane>, Vec<&'e LinearEquation>)> {
        let mut out: BTreeMap<Key, HeldPlane> = BTreeMap::new();
        let mut others = Vec::new();
        for equation in equations {
            let Some((leader, followers)) = equation.leader_and_followers(lookup)? else {
                others.push(equation);
                continue;
            };
            let plane = out.entry(leader).or_insert_with(|| HeldPlane {
                leader,
                nodes: vec![leader.0],
                place: equation.place,
            });
            plane.nodes.extend(followers);
        }
        let mut planes: Vec<HeldPlane> = out.into_values().collect();
        for plane in &mut planes {
            plane.nodes.sort_unstable();
            plane.nodes.dedup();
        }
        Ok((planes, others))
    }
}

impl LinearEquation {
    /// The leading node with its axis, and the nodes that follow, if the equation has this simple
    /// form.
    fn leader_and_followers(&self, lookup: Lookup) -> Result<Option<(Key, Vec<u32>)>> {
        let [(of, freedom, a), (to, other, b)] = &self.terms[..] else {
            return Ok(None);
        };
        if freedom != other || *a != -*b || *a == 0.0 || !(1..=3).contains(freedom) {
            return Ok(None);
        }
        let at = (self.place, "EQUATION");
        let followers = lookup.indices(What::Nodes, of, at)?;
        match lookup.indices(What::Nodes, to, at)?[..] {
            [leader] => Ok(Some(((leader, *freedom as u8 - 1), followers))),
            _ => Ok(None),
        }
    }
}

/// The axes of nodes without local axes: x, y and z.
pub(super) const GLOBAL: [Vector; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Local axes of nodes, by node.
pub(super) type LocalAxes = BTreeMap<u32, [Vector; 3]>;

/// Local axes of the nodes for which the deck defines some.
///
/// # Errors
/// `Input` for points that define no axes, and for names that are not defined.
pub(super) fn local_axes(transforms: &[Transform], lookup: Lookup) -> Result<LocalAxes> {
    let mut out = LocalAxes::new();
    for transform in transforms {
        let at = (transform.place, "TRANSFORM");
        let set = EntitySelection::Set(transform.nodes.clone());
        for node in lookup.indices(What::Nodes, &set, at)? {
            let x = lookup.mesh.point(node as usize);
            let axes = axes_at(transform, x).ok_or_else(|| {
                let label = lookup.mesh.node_name(node as usize);
                lookup.error(at, format!("the points give node {label} no axes"))
            })?;
            out.insert(node, axes);
        }
    }
    Ok(out)
}

/// The axes at a point. Cartesian: along the first vector, perpendicular to it in the plane of both
/// vectors, and normal to this plane. Cylindrical: outward from the axis through both points,
/// around it, and along it.
fn axes_at(transform: &Transform, x: Vector) -> Option<[Vector; 3]> {
    let [a, b] = transform.points;
    let (first, third) = match transform.is_cylindrical {
        true => {
            let axis = difference(b, a);
            if length(axis) == 0.0 {
                return None;
            }
            let axis = direction(axis);
            let from = difference(x, a);
            (along(from, -dot(from, axis), axis), axis)
        }
        false => (a, cross(a, b)),
    };
    if length(first) == 0.0 || length(third) == 0.0 {
        return None;
    }
    let (first, third) = (direction(first), direction(third));
    Some([first, cross(third, first), third])
}
