//! Patches of contact between solids: area, centroid, half axes.
//!
//! Where bodies touch smoothly the square of the pressure falls to zero linearly at the edge. At
//! the last pairs that touch it is not believed (how they share their force depends on where in the
//! face the contact ends): there, and up to the first open ones, it is what the pairs further
//! inside go on to, with the force of those at the edge ([`edge`]). The patch is where that is
//! positive, cut out of the faces by straight lines; half axes are those of the ellipse with the
//! same moments of area
//!
//! ```text
//! A = int dA,   c = int x dA/A,   M = int (x - c)(x - c)' dA/A = Q diag(a^2, b^2)/4 Q'
//! ```
//!
//! Where the other body covers only part of a face, only that part counts.
//!
//! Beyond a plane of symmetry the patch goes on as its mirror image. A patch between two parallel
//! planes of symmetry is a strip without end: its larger half axis is infinite, the smaller one
//! half its width. A patch that closes round a body, as in a press fit, has no mean normal: its
//! area is that of its surface, and its half axes are those of what is seen of it from one side.
//!
//! All of this is done in coordinates along the patch's principal axes, each over the spacing of
//! the pairs along it: oblong faces are squares there, and as many of them lie near along both
//! axes.

mod edge;
mod fit;
mod moments;
mod readings;
mod shape;
mod topology;

pub(super) use shape::ReadPatch;

use crate::model::Model;
use shape::Shape;
use std::collections::BTreeSet;
use topology::Topology;

/// The patches of all contacts, the strongest first; forces up to `vanishing` count as zero.
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
            let shape = Shape::new(model, (surface, &topology), pressure, members);
            let (moments, other) = shape.readings();
            out.push(shape.read(contact, force, moments, other));
        }
    }
    out.sort_by(|a, b| b.patch.force.total_cmp(&a.patch.force));
    out
}
