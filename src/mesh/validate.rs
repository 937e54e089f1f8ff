//! Checks that a mesh is fit for a computation.

use super::{Facet, Integration, Mesh, Shape, conformity, jacobian, pieces};
use crate::shape::{Functions, MAX_NODES};
use crate::space::{difference, length};
use crate::{Error, Result};
use rayon::prelude::*;
use std::collections::BTreeSet;

/// Smallest allowed ratio of the Jacobian determinant to (longest side)^2, about the inverse of the
/// aspect ratio. The condition number of an element grows with the square of the aspect ratio and
/// reaches 1/epsilon at an aspect ratio of 1/sqrt(epsilon).
const FLATTEST: f64 = 1.490_116_119_384_765_6e-8;
/// Least number of elements per thread: fewer elements take less time than waking the thread.
const GRAIN: usize = 512;

/// Checks a mesh: consistent arrays, finite coordinates, elements with distinct nodes and a
/// positive Jacobian at integration points (and at corners of linear elements), no unconnected
/// nodes, unique labels and body names, no empty body, set or surface, no surface that looks both
/// ways, no duplicate or overlapping elements, no hanging nodes, no body in several pieces.
///
/// # Errors
/// `Input`, naming the node, element, body or set by the number or name that the user knows, and
/// the value.
pub fn validate(mesh: &Mesh) -> Result<()> {
    check_arrays(mesh)?;
    check_labels(mesh)?;
    check_coordinates(mesh)?;
    check_sets(mesh)?;
    check_elements(mesh)?;
    check_unconnected(mesh)?;
    conformity::check(mesh)?;
    pieces::check(mesh)
}

/// Checks sizes and ranges of the arrays, so that later indexing cannot fail.
fn check_arrays(mesh: &Mesh) -> Result<()> {
    let inconsistent = |what: String| Err(Error::input(format!("inconsistent mesh: {what}")));
    let n_elements = mesh.n_elements();
    let dimension = mesh.dimension;
    if !(2..=3).contains(&dimension) {
        return inconsistent(format!("its dimension is {dimension}, not 2 or 3"));
    }
    if n_elements == 0 {
        return Err(Error::input("the mesh has no elements"));
    }
    if !mesh.coordinates.len().is_multiple_of(dimension) {
        return inconsistent(format!(
            "{} coordinates in {dimension}D",
            mesh.coordinates.len()
        ));
    }
    if let Some(e) = (mesh.shapes.iter()).position(|shape| shape.dimension() != dimension) {
        return inconsistent(format!(
            "element {} is a {} in {dimension}D",
            mesh.element_label(e),
            mesh.shapes[e].name()
        ));
    }
    if mesh.offsets.len() != n_elements + 1 || mesh.element_body.len() != n_elements {
        return inconsistent(format!(
            "{n_elements} shapes, {} offsets, {} element bodies",
            mesh.offsets.len(),
            mesh.element_body.len()
        ));
    }
    let fits = mesh.offsets[0] == 0
        && mesh.offsets[n_elements] == mesh.connectivity.len()
        && mesh
            .offsets
            .windows(2)
            .zip(&mesh.shapes)
            .all(|(pair, shape)| pair[0].checked_add(shape.n_nodes()) == Some(pair[1]));
    if !fits {
        return inconsistent("offsets do not fit the shapes".to_string());
    }
    let n_nodes = mesh.n_nodes();
    if let Some(node) = mesh.connectivity.iter().find(|&&n| n as usize >= n_nodes) {
        return inconsistent(format!("node index {node} with {n_nodes} nodes"));
    }
    if let Some(body) = mesh
        .element_body
        .iter()
        .find(|&&b| b as usize >= mesh.bodies.len())
    {
        return inconsistent(format!("body index {body} of {}", mesh.bodies.len()));
    }
    for (name, nodes) in &mesh.node_sets {
        if let Some(node) = nodes.iter().find(|&&n| n >= n_nodes) {
            return inconsistent(format!("node index {node} in set `{name}`"));
        }
    }
    for (name, surface) in &mesh.surfaces {
        let outside =
            |f: &&Facet| f.element >= n_elements || f.local >= mesh.shapes[f.element].n_facets();
        if let Some(facet) = surface.facets.iter().find(outside) {
            return inconsistent(format!("{facet:?} in surface `{name}`"));
        }
    }
    Ok(())
}

fn check_labels(mesh: &Mesh) -> Result<()> {
    for (what, labels, count) in [
        ("node", &mesh.node_labels, mesh.n_nodes()),
        ("element", &mesh.element_labels, mesh.n_elements()),
    ] {
        if !labels.is_empty() && labels.len() != count {
            return Err(Error::input(format!(
                "inconsistent mesh: {} {what} labels for {count} {what}s",
                labels.len()
            )));
        }
        let mut sorted = labels.clone();
        sorted.sort_unstable();
        if let Some(pair) = sorted.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(Error::input(format!(
                "{what} number {} is given twice: number the {what}s uniquely",
                pair[0]
            )));
        }
    }
    Ok(())
}

fn check_coordinates(mesh: &Mesh) -> Result<()> {
    match mesh.coordinates.iter().position(|c| !c.is_finite()) {
        Some(at) => Err(Error::input(format!(
            "node {}: coordinate {} is {}",
            mesh.node_label(at / mesh.dimension),
            ["x", "y", "z"][at % mesh.dimension],
            mesh.coordinates[at]
        ))),
        None => Ok(()),
    }
}

fn check_sets(mesh: &Mesh) -> Result<()> {
    let mut names = BTreeSet::new();
    let mut used = vec![false; mesh.bodies.len()];
    for &body in &mesh.element_body {
        used[body as usize] = true;
    }
    for (body, used) in mesh.bodies.iter().zip(used) {
        if !names.insert(body) {
            return Err(Error::input(format!("two bodies are named `{body}`")));
        }
        if !used {
            return Err(Error::input(format!("body `{body}` has no elements")));
        }
    }
    for (name, nodes) in &mesh.node_sets {
        if nodes.is_empty() {
            return Err(Error::input(format!("node set `{name}` is empty")));
        }
        if mesh.surfaces.contains_key(name) {
            return Err(Error::input(format!(
                "`{name}` is both a node set and a surface: rename one of them"
            )));
        }
        if nodes.windows(2).any(|pair| pair[0] >= pair[1]) {
            return Err(Error::input(format!(
                "inconsistent mesh: node set `{name}` is not sorted or names a node twice"
            )));
        }
    }
    for (name, surface) in &mesh.surfaces {
        if surface.facets.is_empty() {
            return Err(Error::input(format!("surface `{name}` is empty")));
        }
        let mut facets = surface.facets.clone();
        facets.sort_unstable();
        if let Some(pair) = facets.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(Error::input(format!(
                "surface `{name}` has the same facet of element {} twice",
                mesh.element_label(pair[0].element)
            )));
        }
        let corners = |facet: &Facet| -> Vec<usize> {
            let n = mesh.facet_corners(*facet);
            let mut corners: Vec<usize> = mesh.facet_nodes(*facet).take(n).collect();
            corners.sort_unstable();
            corners
        };
        facets.sort_by_cached_key(corners);
        let both_sides = |pair: &&[Facet]| corners(&pair[0]) == corners(&pair[1]);
        if let Some(pair) = facets.windows(2).find(both_sides) {
            let [one, two] = [pair[0], pair[1]].map(|f| mesh.element_label(f.element));
            return Err(Error::input(format!(
                "surface `{name}` contains both sides of the face between elements {one} and \
                 {two}: take the facet of one of them"
            )));
        }
    }
    Ok(())
}

/// Checks each element for distinct nodes and for a positive Jacobian at its integration points.
fn check_elements(mesh: &Mesh) -> Result<()> {
    let checks = Integration::ALL
        .map(|integration| Shape::ALL.map(|shape| jacobian::integrated(shape, integration)));
    let fault = |element: usize| -> Option<String> {
        let nodes = mesh.nodes(element);
        for (k, node) in nodes.iter().enumerate() {
            if nodes[..k].contains(node) {
                return Some(format!(
                    "has node {} twice: its corners and mid-side nodes must differ",
                    mesh.node_label(*node as usize)
                ));
            }
        }
        let shape = mesh.shapes[element];
        let places = &checks[mesh.integration_of(element) as usize][shape as usize];
        let worst = least_jacobian(mesh, element, places);
        if worst > FLATTEST {
            return None;
        }
        let reason = if worst > 0.0 {
            "is flat"
        } else {
            "is degenerate, inverted or too strongly distorted"
        };
        Some(format!(
            "{reason}: its smallest Jacobian is {worst:.3e} of (longest side)^{}, allowed is \
             {FLATTEST:.1e} and more; near node {} at {}",
            shape.reference().dimension,
            mesh.node_label(nodes[0] as usize),
            mesh.place(nodes[0] as usize)
        ))
    };
    let found = (0..mesh.n_elements())
        .into_par_iter()
        .with_min_len(GRAIN)
        .find_map_first(|element| fault(element).map(|fault| (element, fault)));
    match found {
        Some((element, fault)) => Err(Error::input(format!(
            "{} {fault}",
            mesh.element_in_words(element)
        ))),
        None => Ok(()),
    }
}

/// The smallest Jacobian of an element at the given places, divided by (longest side)^d.
fn least_jacobian(mesh: &Mesh, element: usize, places: &[Functions]) -> f64 {
    let nodes = mesh.nodes(element);
    let mut points = [[0.0; 3]; MAX_NODES];
    for (point, &node) in points.iter_mut().zip(nodes) {
        *point = mesh.point(node as usize);
    }
    // Positions are taken relative to the first node: the determinant of a small element far from
    // the origin would be lost in the round-off of its coordinates.
    let origin = points[0];
    for point in &mut points[..nodes.len()] {
        *point = difference(*point, origin);
    }
    let row = mesh.shapes[element].reference();
    let edges = row.edges.iter();
    let longest = edges
        .map(|&[a, b]| length(difference(points[b], points[a])))
        .fold(0.0, f64::max);
    let scale = row.unit_jacobian * longest.powi(row.dimension as i32);
    places
        .iter()
        .map(|at| jacobian::determinant(row.dimension, at, &points[..nodes.len()]) / scale)
        .fold(f64::INFINITY, |worst, j| {
            if j < worst || j.is_nan() { j } else { worst }
        })
}

/// A warning about quadratic elements that are turned inside out at a node, but not at integration
/// points. Such elements can be computed with, but results near these nodes are less accurate.
pub(crate) fn warning_of_folds(mesh: &Mesh) -> Option<String> {
    let at_nodes = Shape::ALL.map(jacobian::at_nodes);
    let is_folded = |element: &usize| {
        let shape = mesh.shapes[*element];
        shape.is_quadratic()
            && least_jacobian(mesh, *element, &at_nodes[shape as usize]) <= FLATTEST
    };
    let elements = (0..mesh.n_elements()).into_par_iter();
    let folded: Vec<usize> = elements.with_min_len(GRAIN).filter(is_folded).collect();
    let first = *folded.first()?;
    let others = match folded.len() - 1 {
        0 => String::new(),
        1 => " and another element".to_string(),
        n => format!(" and {n} other elements"),
    };
    Some(format!(
        "{}{others}: turned inside out at a node (negative Jacobian), not where stresses are \
         computed: there they are less accurate; mesh finer where the surface is curved, or with \
         straight or optimised sides (Gmsh: -optimize_ho, or Mesh.SecondOrderLinear = 1)",
        mesh.element_in_words(first)
    ))
}

fn check_unconnected(mesh: &Mesh) -> Result<()> {
    let mut used = vec![false; mesh.n_nodes()];
    for &node in &mesh.connectivity {
        used[node as usize] = true;
    }
    let loose: Vec<usize> = (0..used.len()).filter(|&n| !used[n]).collect();
    if loose.is_empty() {
        return Ok(());
    }
    let shown: Vec<String> = loose
        .iter()
        .take(5)
        .map(|&n| mesh.node_label(n).to_string())
        .collect();
    let more = if loose.len() > 5 { ", ..." } else { "" };
    Err(Error::input(format!(
        "{} nodes belong to no element: {}{more}",
        loose.len(),
        shown.join(", ")
    )))
}

#[cfg(test)]
mod tests;
