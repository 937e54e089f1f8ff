//! Reads the mesh of a deck of Abaqus or CalculiX ([`crate::deck`]).

use super::{Facet, Mesh, Surface};
use crate::deck::{Bodies, Deck, Geometry, Options};
use crate::error::Result;
use crate::space::Space;
use std::path::Path;

/// Reads the mesh of a deck.
///
/// # Errors
/// Errors of [`Deck::read`] and [`mesh`].
pub fn read(path: &Path) -> Result<Mesh> {
    mesh(&Deck::read(path)?)
}

/// The mesh of a deck. Bodies are the deck's sections, or their connected parts. Node sets and
/// surfaces keep their names; sets on which loads and supports act are included. Nodes that belong
/// to no element are dropped. Features that brinell does not have are ignored here.
///
/// # Errors
/// `Input` for names and numbers that are not defined, elements in no section or of several kinds,
/// and nodes outside the plane of a plane mesh.
pub fn mesh(deck: &Deck) -> Result<Mesh> {
    let options = Options {
        small_strain: true,
        ..Options::default()
    };
    let geometry = match deck.convert(options) {
        Ok(conversion) => conversion.geometry,
        Err(_) => Geometry::of(deck)?,
    };
    let bodies = Bodies::of(deck)?;
    let mut mesh = Mesh {
        dimension: deck.space()?.dimension(),
        bodies: bodies.names,
        ..Mesh::default()
    };
    // New indices of the nodes that are kept; `u32::MAX` for others.
    let mut kept = vec![u32::MAX; deck.n_nodes()];
    for (node, kept) in kept.iter_mut().enumerate() {
        if geometry.is_used[node] {
            *kept = mesh.node_labels.len() as u32;
            mesh.node_labels.push(deck.mesh.node_label(node));
            mesh.coordinates
                .extend(&deck.mesh.point(node)[..mesh.dimension]);
        }
    }
    if mesh.dimension == 2 {
        check_plane(deck, &geometry.is_used)?;
    }
    if deck.space()? == Space::Axisymmetric {
        check_radii(deck, &geometry.is_used)?;
    }
    mesh.shapes.reserve(deck.n_elements());
    let mut nodes = Vec::new();
    for (element, &body) in bodies.of_element.iter().enumerate() {
        nodes.clear();
        nodes.extend(
            deck.mesh
                .element_nodes(element)
                .iter()
                .map(|&node| kept[node as usize]),
        );
        mesh.push_element(deck.mesh.shape(element), body as usize, &nodes);
        mesh.element_labels.push(deck.mesh.element_label(element));
    }
    let nodes = |nodes: Vec<u32>| nodes.iter().map(|&n| kept[n as usize] as usize).collect();
    mesh.node_sets = (geometry.node_sets.into_iter())
        .map(|(name, set)| (name, nodes(set)))
        .collect();
    for (name, faces) in geometry.surfaces {
        let facet = |(element, local): (u32, u8)| Facet {
            element: element as usize,
            local: local as usize,
        };
        let facets = faces.into_iter().map(facet).collect();
        mesh.surfaces.insert(
            name,
            Surface {
                facets,
                curve: None,
            },
        );
    }
    Ok(mesh)
}

/// Checks that no node of an axisymmetric mesh lies beyond the axis.
fn check_radii(deck: &Deck, is_used: &[bool]) -> Result<()> {
    let is_beyond = |node: &usize| is_used[*node] && deck.mesh.point(*node)[0] < 0.0;
    match (0..deck.n_nodes()).find(is_beyond) {
        Some(node) => {
            let (label, x) = (deck.mesh.node_label(node), deck.mesh.point(node)[0]);
            let message = format!(
                "node {label} lies at the negative radius {x}: of an axisymmetric model give the \
                 side x >= 0 of the axis"
            );
            Err(deck.node_error(node, message))
        }
        None => Ok(()),
    }
}

/// Checks that the nodes of a plane mesh lie in a plane z = constant.
fn check_plane(deck: &Deck, is_used: &[bool]) -> Result<()> {
    let nodes = || (0..deck.n_nodes()).filter(|&node| is_used[node]);
    let Some(first) = nodes().next() else {
        return Ok(());
    };
    let height = deck.mesh.point(first)[2];
    let extent = nodes().map(|node| {
        let [x, y, _] = deck.mesh.point(node);
        x.abs().max(y.abs())
    });
    let extent = extent.fold(0.0, f64::max);
    // The tolerance allows for coordinates written with about ten digits.
    let is_off = |node: &usize| (deck.mesh.point(*node)[2] - height).abs() > 1e-9 * extent;
    match nodes().find(is_off) {
        Some(node) => {
            let (label, z) = (deck.mesh.node_label(node), deck.mesh.point(node)[2]);
            let message = format!(
                "node {label} lies at z = {z}, others at {height}: a plane model lies in one plane"
            );
            Err(deck.node_error(node, message))
        }
        None => Ok(()),
    }
}
