//! Data from which the pairs of a contact or a tie are found.

use super::stated::Stated;
use crate::error::{Error, Result};
use crate::mesh::{Mesh, Surface, surface};
use crate::scene::Contact;
use crate::space::{Space, Vector, direction, dot};

/// Data from which a contact is resolved.
pub(super) struct ContactInput<'a> {
    pub(super) index: usize,
    pub(super) contact: Contact,
    pub(super) stated: &'a Stated<'a>,
    /// First and second surface of the contact.
    pub(super) surfaces: [&'a Surface; 2],
    pub(super) mesh: &'a Mesh,
    pub(super) space: Space,
    /// Whether the scene comes from an input deck, whose faces have numbers.
    pub(super) is_of_deck: bool,
    /// Spacing of the decimal places of the mesh's coordinates ([`crate::mesh::rounding`]).
    pub(super) rounding: f64,
}

impl ContactInput<'_> {
    /// Converts a direction from the second body to the first into the direction from the slave's
    /// body to the other one.
    pub(super) fn towards_master(&self, normal: Vector, slave: usize) -> Vector {
        match slave {
            0 => normal.map(|n| -n),
            _ => normal,
        }
    }

    /// Refuses a given normal that leads into the second body instead of out of it.
    pub(super) fn check_normal(&self) -> Result<()> {
        let [_, second] = self.surfaces;
        let Some(normal) = self.contact.normal.map(|n| direction(n.vector())) else {
            return Ok(());
        };
        let nodes = surface::nodes(self.mesh, second)?;
        let outward = surface::normals(self.mesh, second, &nodes);
        let along: f64 = outward.iter().map(|n| dot(*n, normal)).sum();
        // For a closed ring the sum vanishes.
        if along >= -0.5 * outward.len() as f64 {
            return Ok(());
        }
        Err(Error::input(format!(
            "its normal leads from `{}` into the body behind it: it is the direction from the \
             second body to the first; reverse it, or leave it out",
            self.contact.second
        )))
    }
}
