//! From what the file holds to a mesh: bodies, boundary edges, node sets.

use super::content::{Content, RawLine};
use super::cursor::Cursor;
use crate::mesh::{Facet, Mesh, Shape};
use crate::{Error, Result};
use std::collections::{BTreeMap, HashMap};

/// Makes the mesh; `cursor` gives line numbers to messages.
pub(super) fn assemble(content: Content, cursor: &Cursor) -> Result<Mesh> {
    if content.elements.is_empty() {
        return Err(cursor.error(
            "the file has no triangles or quadrilaterals: mesh the surfaces (gmsh -2) and export \
             those in a Physical Surface",
        ));
    }
    let mut mesh = Mesh {
        dimension: 2,
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
            "`{name}` is the name (or number) of both a physical curve and a physical point: \
             rename one of them"
        )));
    }
    Ok(mesh)
}

/// No node of a body.
const DROPPED: u32 = u32::MAX;

/// Keeps the nodes of elements, checks that they lie in a plane z = constant; returns new indices.
fn keep_nodes(content: &Content, cursor: &Cursor, mesh: &mut Mesh) -> Result<Vec<u32>> {
    let mut kept = vec![DROPPED; content.node_labels.len()];
    for &node in &content.connectivity {
        kept[node as usize] = 0;
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
        if !(x.is_finite() && y.is_finite() && off.is_finite()) {
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
        mesh.coordinates.extend([x, y]);
    }
    // Coordinates are often written with some ten digits.
    if highest.0 > 1e-9 * extent {
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
    let mut tags: Vec<u64> = content.elements.iter().map(|e| e.group).collect();
    tags.sort_unstable();
    tags.dedup();
    // Groups of one name are one body.
    let mut body_of: HashMap<u64, usize> = HashMap::new();
    for tag in tags {
        let name = content.group_name((2, tag));
        let body = mesh.bodies.iter().position(|b| *b == name);
        let body = body.unwrap_or_else(|| {
            mesh.bodies.push(name);
            mesh.bodies.len() - 1
        });
        body_of.insert(tag, body);
    }
    let mut start = 0;
    let mut last = None;
    for element in &content.elements {
        let n = element.shape.n_nodes();
        let mut nodes = [0u32; 8];
        for (new, &old) in nodes
            .iter_mut()
            .zip(&content.connectivity[start..start + n])
        {
            *new = kept[old as usize];
        }
        start += n;
        let nodes = &mut nodes[..n];
        if twice_area(mesh, element.shape, nodes) < 0.0 {
            turn_round(element.shape, nodes);
        }
        let body = match last {
            Some((group, body)) if group == element.group => body,
            // Every element's group was entered above.
            _ => body_of[&element.group],
        };
        last = Some((element.group, body));
        mesh.push_element(element.shape, body, nodes);
        mesh.element_labels.push(element.label);
    }
}

/// Twice the signed area of the polygon of the corners.
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

/// Reverses the order of an element's nodes; the first corner stays.
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
    for nodes in mesh.node_sets.values_mut() {
        nodes.sort_unstable();
        nodes.dedup();
    }
    Ok(())
}

/// Facets by their two end nodes, the smaller first; at most two elements share an edge.
type Edges = HashMap<[u32; 2], Vec<Facet>>;

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// The element facets that have the ends of boundary lines.
fn edges_on_lines(content: &Content, kept: &[u32], mesh: &Mesh) -> Edges {
    let mut edges = Edges::with_capacity(content.lines.len());
    // Few edges have both ends on a line: the marks spare the others the look-up.
    let mut marked = vec![false; mesh.n_nodes()];
    for line in &content.lines {
        let ends = line.ends.map(|n| kept[n as usize]);
        if ends.contains(&DROPPED) {
            continue;
        }
        edges.insert(sorted(ends), Vec::new());
        for end in ends {
            marked[end as usize] = true;
        }
    }
    if edges.is_empty() {
        return edges;
    }
    for element in 0..mesh.n_elements() {
        let nodes = mesh.nodes(element);
        let n = mesh.shapes[element].n_corners();
        for local in 0..n {
            let ends = [nodes[local], nodes[(local + 1) % n]];
            if ends.iter().all(|&end| marked[end as usize])
                && let Some(facets) = edges.get_mut(&sorted(ends))
            {
                facets.push(Facet { element, local });
            }
        }
    }
    edges
}

fn add_surfaces(content: &Content, cursor: &Cursor, kept: &[u32], mesh: &mut Mesh) -> Result<()> {
    let edges = edges_on_lines(content, kept, mesh);
    let mut names: BTreeMap<u64, String> = BTreeMap::new();
    for line in &content.lines {
        let name = names
            .entry(line.group)
            .or_insert_with(|| content.group_name((1, line.group)));
        let ends = line.ends.map(|n| kept[n as usize]);
        let facets = edges.get(&sorted(ends)).map_or(&[][..], Vec::as_slice);
        let facet =
            choose(mesh, facets, ends, name).ok_or_else(|| no_edge(content, cursor, line, name))?;
        let middle = mesh.facet_nodes(facet).nth(2);
        if let Some(given) = line.middle
            && middle != Some(kept[given as usize] as usize)
        {
            return Err(cursor.error_at(
                line.at,
                format!(
                    "the line's mid-side node {} is not that of the edge of element {}",
                    content.node_labels[given as usize],
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

/// Of the facets with a line's ends: that of the body whose name begins the surface's, else that of
/// the element on the left of the line.
fn choose(mesh: &Mesh, facets: &[Facet], ends: [u32; 2], name: &str) -> Option<Facet> {
    if facets.len() < 2 {
        return facets.first().copied();
    }
    let is_named = |facet: &&Facet| {
        let body = &mesh.bodies[mesh.element_body[facet.element] as usize];
        name.strip_prefix(body.as_str())
            .is_some_and(|rest| rest.starts_with('.'))
    };
    let is_left = |facet: &&Facet| mesh.nodes(facet.element)[facet.local] == ends[0];
    let mut named = facets.iter().filter(is_named);
    match (named.next(), named.next()) {
        (Some(only), None) => Some(*only),
        _ => facets.iter().find(is_left).or(facets.first()).copied(),
    }
}

fn no_edge(content: &Content, cursor: &Cursor, line: &RawLine, name: &str) -> Error {
    let [a, b] = line.ends.map(|n| content.node_labels[n as usize]);
    cursor.error_at(
        line.at,
        format!(
            "the line from node {a} to node {b} of physical curve `{name}` is the edge of no element: \
             mesh the surface beside it and put it into a Physical Surface"
        ),
    )
}
