//! Gaps and interferences that a contact states instead of taking them from the mesh.

use super::super::contact_basis::ContactBasis;
use super::super::names::SceneEntry;
use super::super::on_mesh::OnMesh;
use super::{ContactSurface, Pair};
use crate::error::Result;
use crate::mesh::Mesh;
use crate::scene::{Contact, Field, Scene};

/// Gap and interference stated by a contact, at the slave nodes.
#[derive(Default)]
pub(super) struct Stated<'a> {
    gap: Option<OnMesh<'a>>,
    interference: Option<OnMesh<'a>>,
}

impl<'a> Stated<'a> {
    /// Reads the fields that the contact states.
    ///
    /// # Errors
    /// `Input` if a formula or a file is invalid.
    pub fn of(contact: &'a Contact, scene: &Scene, mesh: &'a Mesh) -> Result<Self> {
        let gap = contact.gap.as_ref();
        let gap = gap.map(|gap| OnMesh::new(gap, "gap", scene, mesh));
        let interference = OnMesh::new(&contact.interference, "interference", scene, mesh)?;
        Ok(Stated {
            gap: gap.transpose()?,
            interference: Some(interference),
        })
    }

    /// Stated gap at a slave node; `None` if the contact states none.
    ///
    /// # Errors
    /// `Input` if the gap is negative or not known at the node.
    pub fn gap(&self, slave: usize) -> Result<Option<f64>> {
        at(self.gap.as_ref(), "gap", slave)
    }

    /// Interference at a slave node; zero if the contact states none.
    ///
    /// # Errors
    /// `Input` if the interference is negative or not known at the node.
    pub fn interference(&self, slave: usize) -> Result<f64> {
        Ok(at(self.interference.as_ref(), "interference", slave)?.unwrap_or(0.0))
    }
}

fn at(field: Option<&OnMesh>, key: &str, node: usize) -> Result<Option<f64>> {
    let instead = Contact::instead_of_negative(key);
    field
        .map(|field| field.not_negative(node, instead))
        .transpose()
}

/// Converts quantities that depend on the position from slave nodes to the control points of their
/// faces. Pairs of nodes that face each other are converted as a whole ([`ContactBasis::restate`]).
///
/// # Errors
/// `Input` if a value at a node of a face is not known.
pub(in crate::model) fn at_control_points(
    scene: &Scene,
    mesh: &Mesh,
    basis: &ContactBasis,
    (pairs, contacts): (&mut [Pair], &[ContactSurface]),
) -> Result<()> {
    if basis.is_empty() {
        return Ok(());
    }
    for (index, (contact, surface)) in scene.contact.iter().zip(contacts).enumerate() {
        let own = &mut pairs[surface.range.clone()];
        let is_uniform = |field: &Field| field.uniform().is_some();
        if contact.fields().iter().all(|(_, field)| is_uniform(field))
            || surface.is_rigid
            || own.iter().all(|pair| pair.faced().is_some())
        {
            continue;
        }
        let refused = |error| SceneEntry::of_list(scene, "contact", index).refused(error);
        let stated = Stated::of(contact, scene, mesh).map_err(refused)?;
        for pair in own {
            let Some(ends) = basis.ends(pair.slave) else {
                continue;
            };
            let [a, b] = ends;
            let change = |at: &dyn Fn(usize) -> Result<f64>| -> Result<f64> {
                let values = [at(pair.slave)?, at(a)?, at(b)?];
                let of = |node: usize| match node {
                    n if n == a => values[1],
                    n if n == b => values[2],
                    _ => values[0],
                };
                Ok(pair.unit_gap * (basis.number_at_control(pair.slave, of) - values[0]))
            };
            let gap = |node: usize| Ok(stated.gap(node)?.unwrap_or(0.0));
            let by_gap = change(&gap).map_err(refused)?;
            let by_interference = change(&|node| stated.interference(node)).map_err(refused)?;
            pair.gap += by_gap;
            pair.interference += by_interference;
        }
    }
    Ok(())
}
