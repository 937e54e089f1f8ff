//! Tied surfaces: the rows of [`super::mortar`] by which their nodes follow others.

use super::contact_input::ContactInput;
use super::resolved_tie::ResolvedTie;
use super::stated::Stated;
use super::{ContactSurface, Pair, list, mortar};
use crate::error::{Error, Result};
use crate::mesh::surface::FEATURE_ANGLE;
use crate::mesh::{Facet, Mesh, Surface};
use crate::model::names::SceneEntry;
use crate::scene::{Contact, Scene, Tie};
use crate::space::dot;
use std::collections::{BTreeMap, BTreeSet};

/// Resolves the ties of a scene. A node of two ties has one row: the sum of both rows if the slave
/// surfaces form one smooth face at the node, or the row of the first tie if they meet there at a
/// corner.
///
/// # Errors
/// Input errors: surfaces that do not exist or do not lie on one another, a surface tied to a
/// surface with which it is in contact.
pub(in crate::model) fn resolve(
    scene: &Scene,
    mesh: &Mesh,
    contacts: &[ContactSurface],
    notes: &mut Vec<String>,
) -> Result<Vec<ResolvedTie>> {
    let mut out: Vec<ResolvedTie> = Vec::new();
    let mut row_of: BTreeMap<usize, [usize; 2]> = BTreeMap::new();
    for (index, tie) in scene.tie.iter().enumerate() {
        let entry = SceneEntry::of_list(scene, "tie", index);
        let surfaces = [
            entry.surface(mesh, "first", &tie.first)?,
            entry.surface(mesh, "second", &tie.second)?,
        ];
        let what = format!("tie {} (`{}` to `{}`)", index + 1, tie.first, tie.second);
        let refused = |error: Error| entry.refused(error.within(&what));
        check_no_contact(mesh, contacts, surfaces).map_err(refused)?;
        let mut of_tie = rows(scene, mesh, (index, tie), surfaces, notes).map_err(refused)?;
        for row in std::mem::take(&mut of_tie.rows) {
            match row_of.get(&row.slave) {
                Some(&[tie, place]) => {
                    let known = &mut out[tie].rows[place];
                    let is_one_face =
                        dot(known.normal, row.normal) > FEATURE_ANGLE.to_radians().cos();
                    let is_cut = mesh.degree() > 1 && share_a_facet(&scene.tie, mesh, [tie, index]);
                    if is_one_face && is_cut && *known != row {
                        return Err(refused(Error::input(format!(
                            "node {} follows in tie {} already, on the same quadratic facet: a \
                             facet may be tied to one surface; join the surfaces that it is tied \
                             to, or let the other surface follow (`slave`)",
                            mesh.node_label(row.slave),
                            tie + 1
                        ))));
                    }
                    match is_one_face {
                        true => join(known, &row),
                        false => of_tie.elsewhere.push(row),
                    }
                }
                None => {
                    row_of.insert(row.slave, [index, of_tie.rows.len()]);
                    of_tie.rows.push(row);
                }
            }
        }
        out.push(of_tie);
    }
    Ok(out)
}

/// Whether two ties have a facet of a slave surface in common.
fn share_a_facet(ties: &[Tie], mesh: &Mesh, two: [usize; 2]) -> bool {
    let facets = two.map(|index| {
        let names = [&ties[index].first, &ties[index].second];
        let surfaces = names.into_iter().filter_map(|name| mesh.surfaces.get(name));
        surfaces
            .flat_map(|s| s.facets.iter().copied())
            .collect::<BTreeSet<Facet>>()
    });
    !facets[0].is_disjoint(&facets[1])
}

/// Adds the row of the same slave in another tie: `D = D_1 + D_2`, `D w_k = D_1 w_1k + D_2 w_2k`.
fn join(row: &mut Pair, other: &Pair) {
    let area = row.area + other.area;
    for (_, weight) in &mut row.masters {
        *weight *= row.area / area;
    }
    for &(node, weight) in &other.masters {
        let share = weight * other.area / area;
        match row.masters.iter_mut().find(|(known, _)| *known == node) {
            Some((_, sum)) => *sum += share,
            None => row.masters.push((node, share)),
        }
    }
    row.area = area;
}

fn rows(
    scene: &Scene,
    mesh: &Mesh,
    (index, tie): (usize, &Tie),
    surfaces: [&Surface; 2],
    notes: &mut Vec<String>,
) -> Result<ResolvedTie> {
    let sides = Contact {
        first: tie.first.clone(),
        second: tie.second.clone(),
        slave: tie.slave,
        ..Contact::default()
    };
    let stated = Stated::default();
    let entries = ContactInput {
        rounding: 0.0,
        index,
        contact: sides,
        stated: &stated,
        surfaces,
        mesh,
        space: scene.kind,
        is_of_deck: scene.requests.is_of_deck(),
    };
    let (found, free) = mortar::tied(&entries, tie.distance)?;
    let names = [&tie.first, &tie.second];
    if !free.is_empty() {
        notes.push(format!(
            "tie {}: {} of `{}` lie opposite no part of `{}` and stay free",
            index + 1,
            list(mesh, &free),
            names[found.slave],
            names[1 - found.slave],
        ));
    }
    Ok(ResolvedTie {
        what: format!("tie {}", index + 1),
        slaves: names[found.slave].clone(),
        rows: found.pairs,
        elsewhere: Vec::new(),
    })
}

/// Refuses surfaces that are in contact with each other.
fn check_no_contact(
    mesh: &Mesh,
    contacts: &[ContactSurface],
    surfaces: [&Surface; 2],
) -> Result<()> {
    let tied = surfaces.map(|surface| surface.facets.iter().copied().collect::<BTreeSet<Facet>>());
    let shared = |name: &str, side: usize| {
        let mut facets = mesh.surfaces.get(name)?.facets.iter();
        facets.find(|facet| tied[side].contains(facet)).copied()
    };
    for (index, contact) in contacts.iter().enumerate() {
        let [first, second] = &contact.names;
        let sides = [
            [shared(first, 0), shared(second, 1)],
            [shared(first, 1), shared(second, 0)],
        ];
        if let Some([Some(facet), Some(_)]) = sides.iter().find(|[a, b]| a.is_some() && b.is_some())
        {
            return Err(Error::input(format!(
                "contact {} (`{first}` on `{second}`) has the same facets, such as that of element \
                 {}: surfaces that are tied cannot touch; take out one of the two",
                index + 1,
                mesh.element_label(facet.element),
            )));
        }
    }
    Ok(())
}
