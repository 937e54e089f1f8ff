//! Ends of the contact surfaces of a solid beyond which both bodies go on: edges of faces that no
//! other contact surface shares.

use super::beside::Beside;
use crate::mesh::surface::FEATURE_ANGLE;
use crate::mesh::{Facet, Mesh};
use crate::model::{ContactSurface, Pair};
use crate::space::{Vector, along, difference, direction, dot};
use std::collections::{BTreeMap, BTreeSet};

/// Numbers of the two ends of an edge, ascending.
type EdgeEnds = [usize; 2];

/// Finds [`ContactSurface::goes_on`] of each contact.
pub(super) fn find(mesh: &Mesh, pairs: &[Pair], contacts: &mut [ContactSurface], beside: &Beside) {
    let outer: Vec<Vec<EdgeEnds>> = contacts.iter().map(outer_edges).collect();
    let at_edges = outer.iter().flatten().flatten();
    let nodes: BTreeSet<usize> = at_edges.flat_map(|&k| pairs[k].nodes()).collect();
    let boundary = EdgeBoundary::at(mesh, &nodes);
    for (contact, edges) in contacts.iter_mut().zip(outer) {
        let mut goes_on = BTreeSet::new();
        for edge in edges {
            let slaves = edge.map(|k| pairs[k].slave);
            let Some(slave) = boundary.beyond(slaves, beside) else {
                continue;
            };
            let [a, b] = edge.map(|k| &pairs[k]);
            let (mut is_followed, mut turn) = (slave.is_followed, slave.turn);
            if let (Some(a), Some(b)) = (a.faced(), b.faced()) {
                let Some(master) = boundary.beyond([a, b], beside) else {
                    continue;
                };
                is_followed &= master.is_followed;
                turn += master.turn;
            } else {
                turn += boundary.end_among([a, b], &beside.facets);
            }
            if !is_followed && turn < FEATURE_ANGLE {
                goes_on.extend(edge);
            }
        }
        contact.goes_on.extend(goes_on);
    }
}

/// Edges that belong to one face of a contact only, by the numbers of their pairs.
fn outer_edges(contact: &ContactSurface) -> Vec<EdgeEnds> {
    let mut faces_at: BTreeMap<EdgeEnds, usize> = BTreeMap::new();
    for face in &contact.faces {
        for (k, &pair) in face.iter().enumerate() {
            let next = face[(k + 1) % face.len()];
            *faces_at
                .entry([pair.min(next), pair.max(next)])
                .or_default() += 1;
        }
    }
    let outer = faces_at.into_iter().filter(|(_, faces)| *faces == 1);
    outer.map(|(edge, _)| edge).collect()
}

/// Continuation of a body's boundary beyond an edge of its contact surface.
struct BeyondEdge {
    /// Angle in degrees by which the boundary turns away from the other body; negative towards it.
    turn: f64,
    /// Whether the boundary beyond belongs to the surface of another contact, or to another part of
    /// this one.
    is_followed: bool,
}

/// Boundary facets at the edges between given nodes.
struct EdgeBoundary<'m> {
    mesh: &'m Mesh,
    at: BTreeMap<EdgeEnds, Vec<Facet>>,
}

impl<'m> EdgeBoundary<'m> {
    fn at(mesh: &'m Mesh, nodes: &BTreeSet<usize>) -> Self {
        // A facet that two elements share is in the interior; both elements have its nodes.
        let mut owners: BTreeMap<Vec<usize>, Vec<Facet>> = BTreeMap::new();
        let touches = |e: &usize| {
            mesh.nodes(*e)
                .iter()
                .any(|&n| nodes.contains(&(n as usize)))
        };
        for element in (0..mesh.n_elements()).filter(touches) {
            for local in 0..mesh.shapes[element].n_facets() {
                let facet = Facet { element, local };
                let mut corners = corners_of(mesh, facet);
                corners.sort_unstable();
                owners.entry(corners).or_default().push(facet);
            }
        }
        let mut at: BTreeMap<EdgeEnds, Vec<Facet>> = BTreeMap::new();
        for facets in owners.values() {
            let [only] = facets[..] else { continue };
            let outline = outline(mesh, only);
            for (k, &a) in outline.iter().enumerate() {
                let b = outline[(k + 1) % outline.len()];
                if nodes.contains(&a) && nodes.contains(&b) {
                    at.entry([a.min(b), a.max(b)]).or_default().push(only);
                }
            }
        }
        EdgeBoundary { mesh, at }
    }

    /// Continuation of the boundary beyond the edge of a paired face; `None` if the edge does not
    /// have two boundary facets.
    fn beyond(&self, [a, b]: EdgeEnds, beside: &Beside) -> Option<BeyondEdge> {
        let [one, two] = self.at.get(&[a.min(b), a.max(b)])?[..] else {
            return None;
        };
        let is_paired = |facet: Facet| {
            let corners = corners_of(self.mesh, facet);
            let all_are = corners.iter().all(|node| beside.nodes.contains(node));
            beside.facets.contains(&facet) && all_are
        };
        let (inside, outside) = if is_paired(one) {
            (one, two)
        } else {
            (two, one)
        };
        Some(BeyondEdge {
            turn: self.turn(inside, outside),
            is_followed: is_paired(inside) && is_paired(outside),
        })
    }

    /// Angle by which the boundary of the other body turns away at edges between masters of two
    /// pairs where the contact surface ends; 0 where it continues.
    fn end_among(&self, pairs: [&Pair; 2], candidates: &BTreeSet<Facet>) -> f64 {
        let masters: Vec<usize> = (pairs.iter().flat_map(|pair| &pair.masters))
            .map(|&(node, _)| node)
            .collect();
        let mut turn = 0.0f64;
        for (k, &a) in masters.iter().enumerate() {
            for &b in &masters[k + 1..] {
                let facets = self.at.get(&[a.min(b), a.max(b)]).map(Vec::as_slice);
                let Some(&[one, two]) = facets else { continue };
                if candidates.contains(&one) == candidates.contains(&two) {
                    continue;
                }
                let (inside, outside) = match candidates.contains(&one) {
                    true => (one, two),
                    false => (two, one),
                };
                turn = turn.max(self.turn(inside, outside));
            }
        }
        turn
    }

    /// Angle in degrees by which the boundary turns away from the other body between two facets.
    fn turn(&self, inside: Facet, outside: Facet) -> f64 {
        let (middle, normal) = self.plane(inside);
        let (beyond, other) = self.plane(outside);
        let angle = dot(normal, other).clamp(-1.0, 1.0).acos().to_degrees();
        match dot(difference(beyond, middle), normal) <= 0.0 {
            true => angle,
            false => -angle,
        }
    }

    /// Middle and outward normal of a facet.
    fn plane(&self, facet: Facet) -> (Vector, Vector) {
        let points: Vec<Vector> = (self.mesh.facet_nodes(facet))
            .map(|node| self.mesh.point(node))
            .collect();
        let corners = &points[..self.mesh.facet_corners(facet)];
        let share = 1.0 / corners.len() as f64;
        let middle = corners
            .iter()
            .fold([0.0; 3], |sum, x| along(sum, share, *x));
        let reference = self.mesh.facet_reference(facet);
        let at = (reference.functions)(reference.center());
        let area = reference.area(&at, &points);
        (middle, direction(area))
    }
}

/// Nodes around a facet, corners and mid-side nodes in turn.
fn outline(mesh: &Mesh, facet: Facet) -> Vec<usize> {
    let nodes: Vec<usize> = mesh.facet_nodes(facet).collect();
    let (corners, middles) = nodes.split_at(mesh.facet_corners(facet));
    let each = corners.iter().enumerate();
    each.flat_map(|(k, &corner)| std::iter::once(corner).chain(middles.get(k).copied()))
        .collect()
}

fn corners_of(mesh: &Mesh, facet: Facet) -> Vec<usize> {
    mesh.facet_nodes(facet)
        .take(mesh.facet_corners(facet))
        .collect()
}
