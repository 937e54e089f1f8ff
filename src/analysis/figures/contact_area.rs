//! Patches of contact between solids: area, centroid, half axes.
//!
//! At the edge of a smooth contact the square of the pressure falls to zero linearly. The pressures
//! of the last pairs in contact are not trusted: the share of the force that each of them carries
//! depends on where in the face the contact ends. From these pairs up to the first open pairs, the
//! square of the pressure is extrapolated from the pairs further inside, such that the pressure at
//! the edge pairs adds up to the total force of these pairs ([`edge`]). The patch is the region in
//! which the square is positive, cut out of the faces by straight lines. Its half axes are those of
//! the ellipse with the same moments of area
//!
//! ```text
//! A = int dA,   c = int x dA/A,   M = int (x - c)(x - c)' dA/A = Q diag(a^2, b^2)/4 Q'
//! ```
//!
//! If the other body covers only part of a face, only that part counts.
//!
//! Beyond a plane of symmetry the patch continues as its mirror image. A patch between two parallel
//! planes of symmetry is an endless strip: its larger half axis is infinite, its smaller one is
//! half its width. A patch that closes round a body, as in a press fit, has no mean normal: its
//! area is that of its surface, and its half axes are those of its projection, seen from one side.
//!
//! All of this is computed in coordinates along the patch's principal axes, each in units of the
//! pairs' spacing along that axis. Oblong faces are squares in these coordinates, and as many faces
//! are near along one axis as along the other.

mod edge;
mod fit;
mod moments;
mod readings;
mod shape;
mod topology;

pub(super) use shape::ReadPatch;

use crate::model::Model;
use shape::ProjectedPatch;
use std::collections::BTreeSet;
use topology::Topology;

/// The patches of all contacts, the strongest first. Forces up to `vanishing` count as zero.
pub(super) fn patches(
    model: &Model,
    force: &[f64],
    pressure: &[f64],
    vanishing: f64,
) -> Vec<ReadPatch> {
    let mut out = Vec::new();
    for (contact, surface) in model.contacts.iter().enumerate() {
        let topology = Topology::new(surface);
        let closed: BTreeSet<usize> = surface
            .range
            .clone()
            .filter(|&k| force[k] > vanishing)
            .collect();
        for members in topology.connected(&closed) {
            let shape = ProjectedPatch::new(model, (surface, &topology), pressure, members);
            let (moments, other) = shape.readings();
            out.push(shape.read(contact, force, moments, other));
        }
    }
    out.sort_by(|a, b| b.patch.force.total_cmp(&a.patch.force));
    out
}
