//! Ends of the contact surfaces beyond which the boundary of a body goes on smoothly.
//!
//! A surface is named by the user or a generator; it may end in the middle of a smooth boundary.
//! The boundary beyond is not checked for contact, so a contact that reaches such an end is not
//! reliable. At a corner of one of the bodies, on a symmetry plane and on the axis of revolution
//! nothing more could touch.

mod beside;
mod solid;

use super::pairs::resolved_tie::ResolvedTie;
use super::{ContactSurface, Pair};
use crate::mesh::surface::FEATURE_ANGLE;
use crate::mesh::{Facet, Mesh};
use crate::scene::Scene;
use beside::Beside;
use std::collections::{BTreeMap, BTreeSet};

/// An end of a run of pairs: its last pair and the one before it.
struct End {
    contact: usize,
    last: usize,
    inner: Option<usize>,
}

/// Finds [`ContactSurface::goes_on`] of each contact.
pub(super) fn find(
    scene: &Scene,
    mesh: &Mesh,
    (pairs, ties): (&[Pair], &[ResolvedTie]),
    contacts: &mut [ContactSurface],
) {
    let beside = Beside::new(scene, mesh, (pairs, ties), contacts);
    match mesh.is_solid() {
        true => solid::find(mesh, pairs, contacts, &beside),
        false => find_in_plane(mesh, pairs, contacts, &beside),
    }
    for contact in contacts.iter_mut().filter(|contact| contact.is_partial) {
        contact.goes_on.clear();
    }
}

fn find_in_plane(mesh: &Mesh, pairs: &[Pair], contacts: &mut [ContactSurface], beside: &Beside) {
    let ends = ends(contacts);
    if ends.is_empty() {
        return;
    }
    let nodes: BTreeSet<usize> = ends
        .iter()
        .flat_map(|end| pairs[end.last].nodes())
        .collect();
    let boundary = Boundary::at(mesh, &nodes);
    for end in ends {
        let inner = end.inner.map(|k| &pairs[k]);
        let slave = boundary.beyond(pairs[end.last].slave, inner.map(|pair| pair.slave));
        let Some(slave) = slave else { continue };
        let follows = |side: &Beyond| {
            beside.facets.contains(&side.facet) && beside.nodes.contains(&side.next)
        };
        let (mut followed, mut turn) = (follows(&slave), slave.turn);
        if let Some(faced) = pairs[end.last].faced() {
            let inner = inner.and_then(Pair::faced);
            let Some(master) = boundary.beyond(faced, inner) else {
                continue;
            };
            // The surface may be closed, and this end its seam.
            followed &= follows(&master);
            turn += master.turn;
        } else {
            // The other surface continues beyond this end unless it ends among the masters of the
            // pair. Where it ends, a surface of another contact may begin.
            let contact = &contacts[end.contact];
            let other = mesh.surfaces.get(&contact.names[1 - contact.slave]);
            let other: BTreeSet<Facet> = (other.into_iter())
                .flat_map(|surface| surface.facets.iter().copied())
                .collect();
            let masters = pairs[end.last].masters.iter();
            let ends = masters.filter_map(|&(node, _)| boundary.end_of(node, &other));
            turn += ends.fold(0.0, |most: f64, turn| most.max(turn));
        }
        if !followed && turn < FEATURE_ANGLE {
            contacts[end.contact].goes_on.push(end.last);
        }
    }
}

/// Ends of all contacts except on the axis of revolution. At a plane of symmetry the boundary turns
/// away by a right angle, so these ends need no exception.
fn ends(contacts: &[ContactSurface]) -> Vec<End> {
    let mut out = Vec::new();
    for (contact, surface) in contacts.iter().enumerate() {
        let range = surface.range.clone();
        if range.is_empty() {
            continue;
        }
        let last = range.end - 1;
        let neighbour = |k: usize| Some(k).filter(|k| range.contains(k));
        for (end, inner, begins) in [
            (range.start, neighbour(range.start + 1), true),
            (last, last.checked_sub(1).and_then(neighbour), false),
        ] {
            let on_axis = surface
                .axis
                .as_ref()
                .is_some_and(|axis| axis.begins == begins);
            if !on_axis {
                out.push(End {
                    contact,
                    last: end,
                    inner,
                });
            }
        }
    }
    out
}

/// Continuation of a body's boundary beyond a node.
struct Beyond {
    /// Next facet of the boundary; `next` is its other end.
    facet: Facet,
    next: usize,
    /// Angle in degrees by which the boundary turns away from the other body; negative towards it.
    turn: f64,
}

/// The two boundary facets at each of the given nodes.
struct Boundary<'m> {
    mesh: &'m Mesh,
    at: BTreeMap<usize, Vec<Facet>>,
}

impl<'m> Boundary<'m> {
    fn at(mesh: &'m Mesh, nodes: &BTreeSet<usize>) -> Self {
        let mut owners: BTreeMap<[usize; 2], Vec<Facet>> = BTreeMap::new();
        for element in 0..mesh.n_elements() {
            if !mesh
                .nodes(element)
                .iter()
                .any(|&n| nodes.contains(&(n as usize)))
            {
                continue;
            }
            for local in 0..mesh.shapes[element].n_facets() {
                let facet = Facet { element, local };
                let mut ends: Vec<usize> = mesh.facet_nodes(facet).take(2).collect();
                ends.sort_unstable();
                if let [a, b] = ends[..] {
                    owners.entry([a, b]).or_default().push(facet);
                }
            }
        }
        let mut at: BTreeMap<usize, Vec<Facet>> = BTreeMap::new();
        for facets in owners.values() {
            let [only] = facets[..] else { continue };
            for node in mesh.facet_nodes(only).filter(|node| nodes.contains(node)) {
                at.entry(node).or_default().push(only);
            }
        }
        Boundary { mesh, at }
    }

    /// Continuation of the boundary at `node` on the side opposite to the `inner` node of the
    /// surface. `None` if the node does not have two boundary facets, or if `inner` does not lie on
    /// exactly one of them.
    fn beyond(&self, node: usize, inner: Option<usize>) -> Option<Beyond> {
        let [a, b] = self.at.get(&node)?[..] else {
            return None;
        };
        let inner = inner?;
        let holds = |facet: Facet| self.mesh.facet_nodes(facet).any(|n| n == inner);
        let (inside, outside) = match (holds(a), holds(b)) {
            (true, false) => (a, b),
            (false, true) => (b, a),
            _ => return None,
        };
        let (within, beyond) = (self.leaving(inside, node)?, self.leaving(outside, node)?);
        let next = self
            .mesh
            .facet_nodes(outside)
            .take(2)
            .find(|&n| n != node)?;
        // The body lies on the left of a facet from its first node to its second.
        let enters = self.mesh.facet_nodes(inside).nth(1) == Some(node);
        let [sine, cosine] = [
            beyond[0] * within[1] - beyond[1] * within[0],
            -(beyond[0] * within[0] + beyond[1] * within[1]),
        ];
        let left = sine.atan2(cosine).to_degrees();
        Some(Beyond {
            facet: outside,
            next,
            turn: if enters { left } else { -left },
        })
    }

    /// Angle by which the boundary turns away at a node where the contact surface ends.
    fn end_of(&self, node: usize, candidates: &BTreeSet<Facet>) -> Option<f64> {
        let facets = self.at.get(&node)?;
        let mut inside = facets.iter().filter(|facet| candidates.contains(facet));
        let (Some(inside), None) = (inside.next(), inside.next()) else {
            return None;
        };
        let inner = self.mesh.facet_nodes(*inside).take(2).find(|&n| n != node);
        Some(self.beyond(node, inner)?.turn)
    }

    /// Tangent of a facet at one of its ends, pointing away from the end.
    fn leaving(&self, facet: Facet, node: usize) -> Option<[f64; 2]> {
        let nodes: Vec<usize> = self.mesh.facet_nodes(facet).collect();
        let other = *nodes.iter().take(2).find(|&&n| n != node)?;
        let (x, y) = (self.mesh.in_plane(node), self.mesh.in_plane(other));
        let chord = [y[0] - x[0], y[1] - x[1]];
        let Some(&middle) = nodes.get(2) else {
            return Some(chord);
        };
        // Slope at the end of the parabola through the three nodes.
        let m = self.mesh.in_plane(middle);
        Some([0, 1].map(|d| 4.0 * (m[d] - x[d]) - chord[d]))
    }
}
