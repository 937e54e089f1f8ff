//! The size of the bodies of a generated contact, which closed forms assume to be infinite.

use crate::mesh::generate::contact_size;
use crate::number::significant;
use crate::scene::Scene;

/// Returns a line on the size of the bodies, in units of the contact; `None` if no generator made
/// them.
pub(super) fn in_words(scene: &Scene) -> Option<String> {
    let mesh = &scene.mesh;
    let solid = (mesh.curved_bodies.as_ref()).map(|p| (p.far_size, "half axes"));
    let plane = mesh.cylinder_on_half_plane.as_ref();
    let plane = plane.map(|p| (contact_size::far_size(scene, p), "half widths"));
    let (far, of) = solid.or(plane)?;
    Some(format!(
        "Closed forms assume infinite bodies; these end at {} {of} at first yield. Meshes with \
         the same `far_size` do not show this effect: one with twice the size does.",
        significant(far, 3)
    ))
}
