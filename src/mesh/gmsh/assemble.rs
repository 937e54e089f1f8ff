//! Assembly of a mesh from the content of a file: bodies, boundary facets, node sets.

use super::content::{Content, RawElement};
use super::cursor::Cursor;
use super::kind::ElementUse;
use crate::mesh::{Facet, Mesh, Shape};
use crate::shape::MAX_NODES;
use crate::{Error, Result};
use std::collections::{BTreeMap, HashMap};

/// Makes the mesh, a solid one if the file has volumes; `cursor` supplies line numbers for
/// messages.
pub(super) fn assemble(content: Content, cursor: &Cursor) -> Result<Mesh> {
    let dimensions = content.elements.iter().map(|e| e.kind.dimension());
    let dimension = dimensions.max().unwrap_or(0);
    if dimension < 2 {
        return Err(cursor.error(
            "the file has no triangles or quadrilaterals, and no volumes: mesh the surfaces (gmsh \
             -2) and export those in a Physical Surface, or volumes (gmsh -3) in a Physical Volume",
        ));
    }
    let left_out = content.require_one_body(dimension, cursor)?;
    let mut mesh = Mesh {
        dimension: dimension as usize,
        notes: [left_out, content.centers_left_out()]
            .into_iter()
            .flatten()
            .collect(),
        ..Mesh::default()
    };
    let kept = keep_nodes(&content, cursor, &mut mesh)?;
    add_elements(&content, &kept, &mut mesh);
    add_node_sets(&content, cursor, &kept, &mut mesh)?;
    add_surfaces(&content, cursor, &kept, &mut mesh)?;
    if let Some(name) = mesh
        .surfaces
        .keys()
        .find(|n| mesh.node_sets.contains_key(*n))
    {
        return Err(cursor.error(format!(
            "`{name}` is the name (or number) of both a physical {} and of physical {}: rename one \
             of them",
            if dimension == 3 { "surface" } else { "curve" },
            if dimension == 3 {
                "curves or points"
            } else {
                "points"
            }
        )));
    }
    Ok(mesh)
}

/// Marks a node that belongs to no body.
const DROPPED: u32 = u32::MAX;

/// Keeps the nodes of bodies and returns their new indices. Checks that the nodes of a plane mesh
/// lie in a plane z = constant.
fn keep_nodes(content: &Content, cursor: &Cursor, mesh: &mut Mesh) -> Result<Vec<u32>> {
    let mut kept = vec![DROPPED; content.node_labels.len()];
    for (_, nodes) in content.of_bodies(mesh.dimension as u64) {
        for &node in nodes {
            kept[node as usize] = 0;
        }
    }
    let mut flat: Option<f64> = None;
    let mut extent: f64 = 0.0;
    let mut highest: (f64, u64) = (0.0, 0);
    for (node, new) in kept.iter_mut().enumerate() {
        if *new == DROPPED {
            continue;
        }
        let [x, y, z] = [0, 1, 2].map(|k| content.coordinates[3 * node + k]);
        let label = content.node_labels[node];
        let first = *flat.get_or_insert(z);
        let off = (z - first).abs();
        if ![x, y, off].iter().all(|x| x.is_finite()) {
            return Err(cursor.error(format!(
                "node {label} has the coordinates ({x}, {y}, {z}); all must be finite"
            )));
        }
        if off > highest.0 {
            highest = (off, label);
        }
        extent = extent.max(x.abs()).max(y.abs());
        *new = (mesh.node_labels.len()) as u32;
        mesh.node_labels.push(label);
        mesh.coordinates.extend(&[x, y, z][..mesh.dimension]);
    }
    // The tolerance allows for coordinates written with about ten digits.
    if mesh.dimension == 2 && highest.0 > 1e-9 * extent {
        return Err(cursor.error(format!(
            "node {} lies {} outside of the plane z = {}: the mesh must be plane",
            highest.1,
            highest.0,
            flat.unwrap_or(0.0)
        )));
    }
    Ok(kept)
}

fn add_elements(content: &Content, kept: &[u32], mesh: &mut Mesh) {
    let dimension = mesh.dimension as u64;
    let of_bodies = || content.of_bodies(dimension);
    let mut tags: Vec<u64> = of_bodies().filter_map(|(e, _)| e.group).collect();
    tags.sort_unstable();
    tags.dedup();
    // Physical groups with the same name form one body.
    let mut body_of: HashMap<u64, usize> = HashMap::new();
    for tag in tags {
        let name = content.group_name((dimension, tag));
        let body = mesh.bodies.iter().position(|b| *b == name);
        let body = body.unwrap_or_else(|| {
            mesh.bodies.push(name);
            mesh.bodies.len() - 1
        });
        body_of.insert(tag, body);
    }
    let mut last = None;
    for (element, of_file) in of_bodies() {
        let (ElementUse::Element(shape), Some(group)) = (element.kind, element.group) else {
            continue;
        };
        let mut nodes = [0u32; MAX_NODES];
        for (own, &place) in nodes.iter_mut().zip(shape.reference().gmsh_order) {
            *own = kept[of_file[place] as usize];
        }
        let nodes = &mut nodes[..shape.n_nodes()];
        if dimension == 2 && twice_area(mesh, shape, nodes) < 0.0 {
            turn_round(shape, nodes);
        }
        let body = match last {
            Some((other, body)) if other == group => body,
            // The group of every element was entered above.
            _ => body_of[&group],
        };
        last = Some((group, body));
        mesh.push_element(shape, body, nodes);
        mesh.element_labels.push(element.label);
    }
}

/// Twice the signed area of the polygon formed by the corners.
fn twice_area(mesh: &Mesh, shape: Shape, nodes: &[u32]) -> f64 {
    let n = shape.n_corners();
    let [x0, y0] = mesh.in_plane(nodes[0] as usize);
    let from_first = |k: usize| {
        let [x, y] = mesh.in_plane(nodes[k] as usize);
        [x - x0, y - y0]
    };
    (1..n - 1)
        .map(|k| {
            let (p, q) = (from_first(k), from_first(k + 1));
            p[0] * q[1] - p[1] * q[0]
        })
        .sum()
}

/// Reverses the orientation of an element; the first corner stays first.
fn turn_round(shape: Shape, nodes: &mut [u32]) {
    let n = shape.n_corners();
    nodes[1..n].reverse();
    if shape.is_quadratic() {
        nodes[n..].reverse();
    }
}

fn add_node_sets(content: &Content, cursor: &Cursor, kept: &[u32], mesh: &mut Mesh) -> Result<()> {
    for point in &content.points {
        let name = content.group_name((0, point.group));
        let node = kept[point.node as usize];
        if node == DROPPED {
            return Err(cursor.error_at(
                point.at,
                format!(
                    "node {} of physical point `{name}` is a node of no element",
                    content.node_labels[point.node as usize]
                ),
            ));
        }
        mesh.node_sets.entry(name).or_default().push(node as usize);
    }
    // Lines of a solid mesh contribute their nodes only.
    let lines = content
        .with_nodes()
        .filter(|(e, _)| e.kind.dimension() == 1);
    for (line, nodes) in lines.filter(|_| mesh.dimension == 3) {
        let Some(group) = line.group else { continue };
        let name = content.group_name((1, group));
        let nodes = nodes.iter().map(|&node| kept[node as usize]);
        let nodes = nodes.filter(|&node| node != DROPPED).map(|n| n as usize);
        mesh.node_sets.entry(name).or_default().extend(nodes);
    }
    for nodes in mesh.node_sets.values_mut() {
        nodes.sort_unstable();
        nodes.dedup();
    }
    Ok(())
}

/// The corners of a facet in ascending order, padded with [`DROPPED`] to four.
type FacetKey = [u32; 4];

/// Facets by their corners; at most two elements share a facet.
type Facets = HashMap<FacetKey, Vec<Facet>>;

fn sorted(corners: impl Iterator<Item = u32>) -> FacetKey {
    let mut out = [DROPPED; 4];
    for (out, corner) in out.iter_mut().zip(corners) {
        *out = corner;
    }
    out.sort_unstable();
    out
}

/// The elements of the file in physical groups whose dimension is that of facets, with their group
/// and nodes.
fn boundary<'c>(
    content: &'c Content,
    mesh: &Mesh,
) -> impl Iterator<Item = (&'c RawElement, u64, &'c [u32])> {
    let dimension = mesh.dimension as u64 - 1;
    let of_boundary = content
        .with_nodes()
        .filter(move |(e, _)| e.kind.dimension() == dimension);
    of_boundary.filter_map(|(e, nodes)| Some((e, e.group?, nodes)))
}

/// The facets of mesh elements that have the same corners as boundary elements of the file.
fn facets_on_boundary(content: &Content, kept: &[u32], mesh: &Mesh) -> Facets {
    let mut out = Facets::new();
    // Few facets have all corners on the boundary: the marks avoid looking up the others.
    let mut marked = vec![false; mesh.n_nodes()];
    for (element, _, nodes) in boundary(content, mesh) {
        let corners = || {
            let of_file = &nodes[..element.kind.n_corners()];
            of_file.iter().map(|&n| kept[n as usize])
        };
        if corners().any(|n| n == DROPPED) {
            continue;
        }
        out.insert(sorted(corners()), Vec::new());
        corners().for_each(|corner| marked[corner as usize] = true);
    }
    if out.is_empty() {
        return out;
    }
    for element in 0..mesh.n_elements() {
        for local in 0..mesh.shapes[element].n_facets() {
            let facet = Facet { element, local };
            let n_corners = mesh.facet_corners(facet);
            let corners = || mesh.facet_nodes(facet).take(n_corners);
            if corners().all(|n| marked[n])
                && let Some(facets) = out.get_mut(&sorted(corners().map(|n| n as u32)))
            {
                facets.push(facet);
            }
        }
    }
    out
}

fn add_surfaces(content: &Content, cursor: &Cursor, kept: &[u32], mesh: &mut Mesh) -> Result<()> {
    let facets = facets_on_boundary(content, kept, mesh);
    let dimension = mesh.dimension as u64 - 1;
    let mut names: BTreeMap<u64, String> = BTreeMap::new();
    let given: Vec<_> = boundary(content, mesh).collect();
    for (element, group, nodes) in given {
        let name = names
            .entry(group)
            .or_insert_with(|| content.group_name((dimension, group)));
        let nodes: Vec<u32> = nodes.iter().map(|&n| kept[n as usize]).collect();
        let (corners, middles) = nodes.split_at(element.kind.n_corners());
        let found = facets.get(&sorted(corners.iter().copied()));
        let found = found.map_or(&[][..], Vec::as_slice);
        let facet = choose(mesh, found, corners, name)
            .ok_or_else(|| no_facet(content, cursor, element, name, mesh.dimension))?;
        let of_facet: Vec<usize> = mesh.facet_nodes(facet).skip(corners.len()).collect();
        if let Some(wrong) = middles.iter().find(|&&n| !of_facet.contains(&(n as usize))) {
            let label = match *wrong {
                DROPPED => "of no element".to_string(),
                node => mesh.node_label(node as usize).to_string(),
            };
            return Err(cursor.error_at(
                element.at,
                format!(
                    "the mid-side node {label} is not that of the {} of element {}",
                    if dimension == 2 { "face" } else { "edge" },
                    mesh.element_label(facet.element)
                ),
            ));
        }
        let surface = match mesh.surfaces.get_mut(name.as_str()) {
            Some(surface) => surface,
            None => mesh.surfaces.entry(name.clone()).or_default(),
        };
        surface.facets.push(facet);
    }
    for surface in mesh.surfaces.values_mut() {
        surface.facets.sort_unstable();
        surface.facets.dedup();
    }
    Ok(())
}

/// Chooses among facets with the same corners. The facet of the body whose name begins the
/// surface's name is preferred. Otherwise the facet of the element to the left of a line, or of the
/// element from which a face points outward, is taken.
fn choose(mesh: &Mesh, facets: &[Facet], corners: &[u32], name: &str) -> Option<Facet> {
    if facets.len() < 2 {
        return facets.first().copied();
    }
    let is_named = |facet: &&Facet| {
        let body = &mesh.bodies[mesh.element_body[facet.element] as usize];
        name.strip_prefix(body.as_str())
            .is_some_and(|rest| rest.starts_with('.'))
    };
    let runs_alike = |facet: &&Facet| {
        let own: Vec<u32> = (mesh.facet_nodes(**facet).map(|n| n as u32))
            .take(corners.len())
            .collect();
        let at = own.iter().position(|n| *n == corners[0]);
        at.is_some_and(|at| match own.len() {
            2 => at == 0,
            n => own[(at + 1) % n] == corners[1],
        })
    };
    let mut named = facets.iter().filter(is_named);
    match (named.next(), named.next()) {
        (Some(only), None) => Some(*only),
        _ => facets.iter().find(runs_alike).or(facets.first()).copied(),
    }
}

fn no_facet(
    content: &Content,
    cursor: &Cursor,
    element: &RawElement,
    name: &str,
    dimension: usize,
) -> Error {
    let mut nodes = content.with_nodes().filter(|(e, _)| e.at == element.at);
    let nodes = nodes.next().map_or(&[][..], |(_, nodes)| nodes);
    let label = |&n: &u32| content.node_labels[n as usize].to_string();
    let corners: Vec<String> = (nodes.iter().take(element.kind.n_corners()))
        .map(label)
        .collect();
    let why = if dimension == 2 {
        format!(
            "the line from node {} of physical curve `{name}` is the edge of no element: mesh the \
             surface beside it and put it into a Physical Surface",
            corners.join(" to node ")
        )
    } else {
        format!(
            "the face with the nodes {} of physical surface `{name}` is the face of no element: \
             mesh the volume beside it and put it into a Physical Volume",
            corners.join(", ")
        )
    };
    cursor.error_at(element.at, why)
}
