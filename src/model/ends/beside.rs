//! Contacts and ties that may continue a contact beyond its end.

use crate::mesh::{Facet, Mesh};
use crate::model::pairs::resolved_tie::ResolvedTie;
use crate::model::{ContactSurface, Pair};
use crate::scene::Scene;
use std::collections::BTreeSet;

/// Surfaces and nodes of other contacts, and of ties, that may continue a contact at its end.
pub(super) struct Beside {
    /// Facets of the surfaces of all contacts and ties.
    pub(super) facets: BTreeSet<Facet>,
    /// Nodes of pairs and of ties, and nodes at which supports bear the contact force.
    pub(super) nodes: BTreeSet<usize>,
}

impl Beside {
    pub(super) fn new(
        scene: &Scene,
        mesh: &Mesh,
        (pairs, ties): (&[Pair], &[ResolvedTie]),
        contacts: &[ContactSurface],
    ) -> Self {
        let of_contacts = contacts.iter().flat_map(|contact| &contact.names);
        let of_ties = scene.tie.iter().flat_map(|tie| [&tie.first, &tie.second]);
        let surfaces = of_contacts.chain(of_ties);
        let surfaces = surfaces.filter_map(|name| mesh.surfaces.get(name));
        let held = contacts
            .iter()
            .flat_map(|contact| contact.held.iter().copied());
        let rows = pairs.iter().chain(ties.iter().flat_map(|tie| &tie.rows));
        Beside {
            facets: surfaces
                .flat_map(|surface| surface.facets.iter().copied())
                .collect(),
            nodes: rows.flat_map(Pair::nodes).chain(held).collect(),
        }
    }
}
