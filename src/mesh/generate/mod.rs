//! Mesh generators that a scene calls in a few lines. Their meshes are structured, graded and exact
//! on circles.
//!
//! Every generator builds its bodies from structured patches (`grid`), so all four plane element
//! shapes are made from one set of corner and mid-side positions. Mid-side nodes lie on their grid
//! line: exactly on the circle for circles, halfway for straight lines. Bodies never share nodes.

mod angle;
mod brick;
pub(crate) mod contact_size;
mod curved_bodies;
mod cylinder;
mod disc;
pub(crate) mod ellipse_size;
mod family;
mod grading;
mod grid;
pub(super) mod limits;
mod o_grid;
mod parts;
mod polar;
#[cfg(feature = "cli")]
pub(crate) mod raceways;
#[cfg(test)]
mod tests;

pub(crate) use angle::direction;
pub use curved_bodies::{EllipseSize, curved_bodies};
pub use cylinder::{ContactSize, WIDEST, cylinder_on_half_plane};
pub use disc::disc_in_plate;
pub use family::Family;
pub use parts::parts;

use super::{Mesh, gmsh, inp};
use crate::deck;
use crate::scene::{CurvedBodies, CylinderOnHalfPlane, MeshSource};
use crate::{Error, Result};
use std::path::Path;

/// The mesh that a scene's `[mesh]` asks for.
///
/// A relative `file` is looked up in `directory` (the scene file's). `contact` gives the size of
/// the contact of a cylinder on a half plane, `ellipse` that of curved bodies; each is called for
/// its own geometry only. Further steps are left to the caller: circles ([`super::lay_on`]) and
/// subdivisions ([`super::subdivided`]) of a mesh from a file, and the sweep into a solid
/// ([`super::extruded`], [`super::revolved`]).
///
/// # Errors
/// `Input` unless exactly one source is given; also the errors of the source itself.
pub(crate) fn from_source(
    source: &MeshSource,
    directory: Option<&Path>,
    contact: impl FnOnce(&CylinderOnHalfPlane) -> Result<ContactSize>,
    ellipse: impl FnOnce(&CurvedBodies) -> Result<EllipseSize>,
) -> Result<Mesh> {
    let given = [
        source.curved_bodies.is_some(),
        source.cylinder_on_half_plane.is_some(),
        source.disc_in_plate.is_some(),
        source.parts.is_some(),
        source.file.is_some(),
    ];
    let count = given.iter().filter(|&&g| g).count();
    if count != 1 {
        return Err(Error::input(format!(
            "mesh: {count} sources are given; give exactly one of cylinder_on_half_plane, \
             disc_in_plate, curved_bodies, parts and file"
        )));
    }
    if let Some(p) = &source.cylinder_on_half_plane {
        cylinder_on_half_plane(p, contact(p)?)
    } else if let Some(p) = &source.disc_in_plate {
        disc_in_plate(p)
    } else if let Some(p) = &source.curved_bodies {
        curved_bodies(p, ellipse(p)?)
    } else if let Some(p) = &source.parts {
        parts(p)
    } else {
        let file = source.file.as_deref().unwrap_or(Path::new(""));
        let path = directory.map_or_else(|| file.to_path_buf(), |directory| directory.join(file));
        match deck::is_deck(&path) {
            true => inp::read(&path),
            false => gmsh::read(&path),
        }
    }
}
