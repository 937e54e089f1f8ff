//! Slaves whose supports bear the contact force, and contacts that repeat the same facets.

use super::found::Found;
use super::{Pair, list};
use crate::error::{Error, Result};
use crate::mesh::{Facet, Mesh, Surface};
use crate::scene::Contact;
use std::collections::BTreeSet;

/// Removes the pairs of slaves that supports hold along their normals: the supports bear the
/// contact force there.
///
/// # Errors
/// An error if supports hold all slaves.
pub(super) fn leave_to_supports(
    found: &mut Found,
    is_held: impl Fn(&Pair) -> bool,
    (mesh, what): (&Mesh, &str),
    notes: &mut Vec<String>,
) -> Result<()> {
    let held: Vec<usize> = (found.pairs.iter().filter(|pair| is_held(pair)))
        .map(|pair| pair.slave)
        .collect();
    let Some(&node) = held.first() else {
        return Ok(());
    };
    let of_held = found.pairs.iter().filter(|pair| is_held(pair));
    found.held = of_held.flat_map(Pair::nodes).collect();
    found.pairs.retain(|pair| !is_held(pair));
    if found.pairs.is_empty() {
        return Err(Error::input(format!(
            "supports hold all nodes of both surfaces along the contact normal, such as node {}: \
             nothing can touch",
            mesh.node_label(node)
        )));
    }
    notes.push(format!(
        "{what}: supports hold {} along the contact normal: the supports carry the contact force \
         there, which is not part of the results",
        list(mesh, &held)
    ));
    Ok(())
}

/// Whether two contacts have facets in common on both sides.
pub(super) fn are_same(mesh: &Mesh, own: [&Surface; 2], other: &Contact) -> bool {
    let facets = own.map(|surface| surface.facets.iter().collect::<BTreeSet<&Facet>>());
    let shares = |side: usize, other: Option<&Surface>| {
        other.is_some_and(|other| {
            other
                .facets
                .iter()
                .any(|facet| facets[side].contains(facet))
        })
    };
    let [first, second] = [&other.first, &other.second].map(|name| mesh.surfaces.get(name));
    (shares(0, first) && shares(1, second)) || (shares(0, second) && shares(1, first))
}
