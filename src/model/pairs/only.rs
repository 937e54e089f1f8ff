//! Contacts in which only some nodes of the slave surface may touch.

use crate::error::{Error, Result};
use crate::mesh::{Mesh, Surface};
use crate::model::names::SceneEntry;
use crate::scene::{Contact, SlaveSide};
use std::collections::BTreeSet;

/// The nodes of a slave surface that may touch.
pub(super) struct Only {
    pub(super) nodes: BTreeSet<usize>,
    /// Surface to which all these nodes belong.
    pub(super) side: SlaveSide,
    pub(super) name: String,
}

/// Returns the nodes to which a contact is restricted; `None` if all may touch.
///
/// # Errors
/// `Input` for a set that does not exist, or whose nodes belong to neither surface, or not to the
/// one that the scene makes the slave.
pub(super) fn nodes(
    contact: &Contact,
    (entry, mesh): (&SceneEntry, &Mesh),
    surfaces: [&Surface; 2],
) -> Result<Option<Only>> {
    let Some(name) = &contact.nodes else {
        return Ok(None);
    };
    let nodes: BTreeSet<usize> = entry.nodes(mesh, name)?.into_iter().collect();
    let outside = |surface: &Surface| {
        let own = surface.facets.iter().flat_map(|&f| mesh.facet_nodes(f));
        let own: BTreeSet<usize> = own.collect();
        nodes.iter().find(|node| !own.contains(node)).copied()
    };
    let sides = [(SlaveSide::First, 0), (SlaveSide::Second, 1)];
    let mut wrong = None;
    for (side, k) in sides {
        if ![SlaveSide::Auto, side].contains(&contact.slave) {
            continue;
        }
        match outside(surfaces[k]) {
            None => {
                let name = name.clone();
                return Ok(Some(Only { nodes, side, name }));
            }
            Some(node) => wrong = Some((node, [&contact.first, &contact.second][k])),
        }
    }
    Err(entry.refused(Error::input(match wrong {
        Some((node, surface)) => format!(
            "nodes = \"{name}\": node {} is not on `{surface}`; all of them must be on the surface \
             with the slaves",
            mesh.node_label(node)
        ),
        None => format!("nodes = \"{name}\": neither surface has them"),
    })))
}
