//! Pairs that were found for a contact, and the contact surface made of them.

use super::contact_input::ContactInput;
use super::covered::{Covered, Pieces, extent};
use super::{AxisPoint, ContactSurface, NO_AREA, Pair};
use crate::mesh::surface::PAIRING;
use crate::mesh::{Curve, Mesh, Surface};
use crate::space::{difference, length};
use std::collections::BTreeSet;

/// Pairs found for a contact, with the choice of the slave surface.
pub(super) struct Found {
    pub(super) pairs: Vec<Pair>,
    /// Number of the surface with the slaves.
    pub(super) slave: usize,
    pub(super) facet_length: f64,
    pub(super) covered: Covered,
    /// Nodes of pairs that were dropped because supports hold the slaves.
    pub(super) held: Vec<usize>,
    /// Pairs that an earlier contact already has.
    pub(super) repeated: Vec<Pair>,
}

impl Found {
    /// Stores pairs of whole facets, none of which was dropped for a support or an earlier contact.
    pub(super) fn new(pairs: Vec<Pair>, slave: usize, facet_length: f64) -> Self {
        Found {
            pairs,
            slave,
            facet_length,
            covered: Covered::default(),
            held: Vec::new(),
            repeated: Vec::new(),
        }
    }
}

/// Makes the contact surface of the pairs from `start` on.
pub(super) fn surface_of(
    entries: &ContactInput,
    found: &Found,
    pairs: &mut Vec<Pair>,
    start: usize,
) -> ContactSurface {
    let surface = entries.surfaces[found.slave];
    let axis = take_axis_pair(entries, pairs, start);
    let pieces = Pieces::new(
        entries.mesh,
        surface,
        &found.covered,
        (&pairs[start..], start),
    );
    ContactSurface {
        names: [
            entries.contact.first.clone(),
            entries.contact.second.clone(),
        ],
        slave: found.slave,
        is_rigid: false,
        range: start..pairs.len(),
        circle: match surface.curve {
            Some(Curve::Circle { center, radius, .. }) => Some((center, radius)),
            _ => None,
        },
        stiffness: entries.contact.stiffness,
        facet_length: found.facet_length,
        axis,
        goes_on: Vec::new(),
        is_partial: entries.contact.nodes.is_some(),
        faces: pieces.faces,
        covered: pieces.covered,
        slivers: pieces.slivers,
        extent: extent(entries.mesh, surface, &pairs[start..], &found.covered),
        turn: turn(entries.mesh, surface, &pairs[start..]),
        held: found.held.clone(),
        mirrors: Vec::new(),
    }
}

/// Length of a closed slave surface, for [`ContactSurface::turn`].
fn turn(mesh: &Mesh, surface: &Surface, pairs: &[Pair]) -> Option<f64> {
    let nodes = surface.facets.iter().flat_map(|&f| mesh.facet_nodes(f));
    let nodes: BTreeSet<usize> = nodes.collect();
    let ends = |node: usize| {
        let facets = surface.facets.iter();
        let at = facets
            .flat_map(|&f| mesh.facet_nodes(f).take(2))
            .filter(|&n| n == node);
        at.count()
    };
    let (first, last) = (pairs.first()?, pairs.last()?);
    let closed = !mesh.is_solid() && nodes.len() == pairs.len() && ends(first.slave) == 2;
    let way = difference(mesh.point(first.slave), mesh.point(last.slave));
    closed.then(|| last.arc - first.arc + length(way))
}

/// Removes the pair on the axis of revolution if this pair can carry no force. Only the first and
/// the last of the pairs from number `start` on are considered.
fn take_axis_pair(
    entries: &ContactInput,
    pairs: &mut Vec<Pair>,
    start: usize,
) -> Option<AxisPoint> {
    let last = pairs.len().checked_sub(1).filter(|last| *last > start)?;
    if !entries.space.is_axisymmetric() {
        return None;
    }
    let radius = |k: usize| entries.mesh.point(pairs[k].slave)[0];
    for (end, beside) in [(start, start + 1), (last, last - 1)] {
        let on_axis = radius(end).abs() <= PAIRING * radius(beside).abs();
        if on_axis && pairs[end].area <= NO_AREA * pairs[beside].area {
            let pair = pairs.remove(end);
            return Some(AxisPoint {
                pair,
                begins: end == start,
            });
        }
    }
    None
}
