//! A mesh with every element cut in four: half the element size, the same bodies, sets and
//! surfaces.
//!
//! ```text
//!      2                    3────6────2
//!      ┌╲                   │  3 │ 2  │      children by the corner that they keep;
//!      │2╲                  7────8────5      of a triangle, 3 is the one between the
//!    5 ├──╲ 4               │  0 │ 1  │      middles of its sides
//!      │╲3 ├╲               0────4────1
//!      │0╲ │1╲
//!    0 └──┴───┘ 1
//! ```
//!
//! New nodes lie on the sides of the elements (halfway; on the parabola of quadratic ones), on a
//! surface whose [`Curve`] is known on that curve. Where a surface faces another one in a contact,
//! its new nodes are put where those of the other's face them, so that the nodes of the finer mesh
//! pair as those of the mesh did, and their gaps are those of the surfaces. Old nodes keep their
//! indices and labels.

use super::surface::{PAIRING, facing, longest_facet, normals};
use super::{Curve, Facet, Mesh, Surface};
use crate::scene::Contact;
use crate::space::direction;
use crate::{Error, Result};
use std::collections::{BTreeMap, HashMap};

/// Most elements that subdivision makes.
const MOST_ELEMENTS: usize = 50_000_000;
/// Steps of Newton's method for the place on a parabola: it converges quadratically from the middle
/// of its half.
const NEWTON: usize = 8;

/// The mesh `times` times subdivided. `contacts` say which surfaces face each other.
///
/// # Errors
/// Input errors: a node set that holds both ends of an element's side (it is not known whether the
/// node between belongs to it), a mesh that would become too large, a solid one.
pub fn subdivided(mesh: Mesh, times: usize, contacts: &[Contact]) -> Result<Mesh> {
    if mesh.is_solid() {
        return Err(Error::input(
            "mesh.subdivisions: solid meshes are not subdivided; mesh the bodies more finely",
        ));
    }
    let factor = 4usize.checked_pow(u32::try_from(times).unwrap_or(u32::MAX));
    let elements = factor.and_then(|f| f.checked_mul(mesh.n_elements()));
    if elements.is_none_or(|n| n > MOST_ELEMENTS) {
        return Err(Error::input(format!(
            "mesh.subdivisions = {times}: {} elements, each cut in four {times} times, are more \
             than {MOST_ELEMENTS}; give a smaller number",
            mesh.n_elements()
        )));
    }
    let mut out = mesh;
    for _ in 0..times {
        out = subdivided_once(&out, contacts)?;
    }
    Ok(out)
}

/// A side of elements.
struct Side {
    /// Its ends, in the direction of the first element that has it.
    ends: [u32; 2],
    /// Its node between, where elements are quadratic.
    middle: Option<u32>,
    /// The new nodes: half way; of a quadratic one a quarter from each end.
    new: [[f64; 2]; 2],
    /// The index of the first new node.
    first: u32,
}

impl Side {
    fn n_new(&self) -> usize {
        1 + usize::from(self.middle.is_some())
    }

    /// Parameter of new node `k`, from -1 at the first end to 1.
    fn parameter(&self, k: usize) -> f64 {
        match self.middle {
            None => 0.0,
            Some(_) => k as f64 - 0.5,
        }
    }

    /// The point at a parameter, and the derivative.
    fn at(&self, mesh: &Mesh, s: f64) -> ([f64; 2], [f64; 2]) {
        let [a, b] = self.ends.map(|n| mesh.in_plane(n as usize));
        let sag = match self.middle {
            None => [0.0; 2],
            Some(m) => {
                let m = mesh.in_plane(m as usize);
                [0, 1].map(|d| m[d] - 0.5 * (a[d] + b[d]))
            }
        };
        let point =
            [0, 1].map(|d| 0.5 * ((1.0 - s) * a[d] + (1.0 + s) * b[d]) + (1.0 - s * s) * sag[d]);
        (
            point,
            [0, 1].map(|d| 0.5 * (b[d] - a[d]) - 2.0 * s * sag[d]),
        )
    }
}

/// All sides of the elements, in the order of the elements.
struct Sides {
    list: Vec<Side>,
    by_ends: HashMap<[u32; 2], usize>,
}

impl Sides {
    fn new(mesh: &Mesh) -> Self {
        let mut out = Sides {
            list: Vec::new(),
            by_ends: HashMap::new(),
        };
        for element in 0..mesh.n_elements() {
            for local in 0..mesh.shapes[element].n_facets() {
                let mut nodes = mesh.facet_nodes(Facet { element, local }).map(|n| n as u32);
                let (Some(a), Some(b)) = (nodes.next(), nodes.next()) else {
                    continue;
                };
                let n = out.list.len();
                if *out.by_ends.entry(key([a, b])).or_insert(n) < n {
                    continue;
                }
                let mut side = Side {
                    ends: [a, b],
                    middle: nodes.next(),
                    new: [[0.0; 2]; 2],
                    first: 0,
                };
                for k in 0..side.n_new() {
                    side.new[k] = side.at(mesh, side.parameter(k)).0;
                }
                out.list.push(side);
            }
        }
        out
    }

    /// Index of the side of a facet, and whether the facet runs the other way.
    fn of(&self, mesh: &Mesh, facet: Facet) -> (usize, bool) {
        let mut nodes = mesh.facet_nodes(facet).map(|n| n as u32);
        let ends = [nodes.next().unwrap_or(0), nodes.next().unwrap_or(0)];
        // Every facet's side was entered.
        let index = self.by_ends[&key(ends)];
        (index, self.list[index].ends != ends)
    }

    /// Puts the new nodes of surfaces on their curves.
    fn lay_on_curves(&mut self, mesh: &Mesh) {
        for surface in mesh.surfaces.values() {
            let Some(Curve::Circle { center, radius, .. }) = surface.curve else {
                continue;
            };
            for &facet in &surface.facets {
                let (side, _) = self.of(mesh, facet);
                for x in &mut self.list[side].new {
                    *x = on_circle(*x, center, radius);
                }
            }
        }
    }

    /// Puts the new nodes of a contact's first surface where those of the second face them.
    fn face(&mut self, mesh: &Mesh, contact: &Contact) {
        let (Some(first), Some(second)) = (
            mesh.surfaces.get(&contact.first),
            mesh.surfaces.get(&contact.second),
        ) else {
            return;
        };
        let partner = partners(mesh, contact, first, second);
        for &facet in &second.facets {
            let (below, _) = self.of(mesh, facet);
            let ends = self.list[below].ends;
            let (Some(&a), Some(&b)) = (partner.get(&ends[0]), partner.get(&ends[1])) else {
                continue;
            };
            let Some(&above) = self.by_ends.get(&key([a, b])) else {
                continue;
            };
            let turned = self.list[above].ends != [a, b];
            for k in 0..self.list[below].n_new().min(self.list[above].n_new()) {
                let own = &self.list[below];
                let x = own.new[k];
                let normal = match (contact.normal, second.curve) {
                    (Some(n), _) => {
                        let [x, y, _] = n.vector();
                        [x, y]
                    }
                    (None, Some(Curve::Line { normal })) => normal,
                    (None, Some(Curve::Circle { center, .. })) => {
                        [x[0] - center[0], x[1] - center[1]]
                    }
                    (None, _) => {
                        let (_, [tx, ty]) = own.at(mesh, own.parameter(k));
                        [ty, -tx]
                    }
                };
                let opposite = &self.list[above];
                let k = if turned { opposite.n_new() - 1 - k } else { k };
                let found = match first.curve {
                    Some(Curve::Circle { center, radius, .. }) => {
                        line_on_circle(x, normal, center, radius, opposite.new[k])
                    }
                    _ => line_on_side(mesh, x, normal, opposite, k),
                };
                if let Some(found) = found {
                    self.list[above].new[k] = found;
                }
            }
        }
    }
}

fn key([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// The node of the first surface that faces each node of the second.
fn partners(
    mesh: &Mesh,
    contact: &Contact,
    first: &Surface,
    second: &Surface,
) -> BTreeMap<u32, u32> {
    let nodes = |name: &str| mesh.set_nodes(name).unwrap_or_default();
    let (above, below) = (nodes(&contact.first), nodes(&contact.second));
    let normals = match contact.normal {
        Some(n) => vec![direction(n.vector()); below.len()],
        None => normals(mesh, second, &below),
    };
    let tolerance = PAIRING * longest_facet(mesh, first).max(longest_facet(mesh, second));
    let found = below.iter().zip(normals).filter_map(|(&node, normal)| {
        let i = facing(mesh, mesh.point(node), normal, &above, tolerance)?;
        Some((node as u32, above[i] as u32))
    });
    found.collect()
}

/// The point of a circle nearest to `x`.
fn on_circle(x: [f64; 2], center: [f64; 2], radius: f64) -> [f64; 2] {
    let d = [x[0] - center[0], x[1] - center[1]];
    let length = d[0].hypot(d[1]);
    if length > 0.0 {
        [0, 1].map(|i| center[i] + radius * (d[i] / length))
    } else {
        x
    }
}

/// Where the line through `x` along `normal` meets a circle, on the side of `near`.
fn line_on_circle(
    x: [f64; 2],
    normal: [f64; 2],
    center: [f64; 2],
    radius: f64,
    near: [f64; 2],
) -> Option<[f64; 2]> {
    let length = normal[0].hypot(normal[1]);
    let n = normal.map(|c| c / length);
    let d = [x[0] - center[0], x[1] - center[1]];
    // Distance of the line from the centre, and of its foot from there along the line.
    let across = d[0] * n[1] - d[1] * n[0];
    let half = ((radius - across) * (radius + across)).sqrt();
    let along = (near[0] - center[0]) * n[0] + (near[1] - center[1]) * n[1];
    let t = if along >= 0.0 { half } else { -half };
    let found = [
        center[0] + across * n[1] + t * n[0],
        center[1] - across * n[0] + t * n[1],
    ];
    found.iter().all(|c| c.is_finite()).then_some(found)
}

/// Where the line through `x` along `normal` meets a side, near its new node `k`.
fn line_on_side(
    mesh: &Mesh,
    x: [f64; 2],
    normal: [f64; 2],
    side: &Side,
    k: usize,
) -> Option<[f64; 2]> {
    let cross = |d: [f64; 2]| d[0] * normal[1] - d[1] * normal[0];
    let mut s = side.parameter(k);
    for _ in 0..NEWTON {
        let (at, slope) = side.at(mesh, s);
        s -= cross([at[0] - x[0], at[1] - x[1]]) / cross(slope);
    }
    (s.abs() < 1.0).then(|| side.at(mesh, s).0)
}

fn subdivided_once(mesh: &Mesh, contacts: &[Contact]) -> Result<Mesh> {
    check_node_sets(mesh)?;
    let mut sides = Sides::new(mesh);
    sides.lay_on_curves(mesh);
    for contact in contacts {
        sides.face(mesh, contact);
    }
    let mut out = Mesh {
        dimension: mesh.dimension,
        coordinates: mesh.coordinates.clone(),
        bodies: mesh.bodies.clone(),
        node_sets: mesh.node_sets.clone(),
        ..Mesh::default()
    };
    for side in &mut sides.list {
        side.first = out.n_nodes() as u32;
        for x in &side.new[..side.n_new()] {
            out.coordinates.extend(x);
        }
    }
    for element in 0..mesh.n_elements() {
        cut(mesh, element, &sides, &mut out);
    }
    for (name, surface) in &mesh.surfaces {
        let parts = surface.facets.iter().flat_map(|&facet| parts(mesh, facet));
        let surface = Surface {
            facets: parts.collect(),
            curve: surface.curve,
        };
        out.surfaces.insert(name.clone(), surface);
    }
    if let Some(&largest) = mesh.node_labels.iter().max() {
        let new = (out.n_nodes() - mesh.n_nodes()) as u64;
        out.node_labels = mesh.node_labels.clone();
        out.node_labels
            .extend((1..=new).map(|i| largest.saturating_add(i)));
    }
    Ok(out)
}

/// A node set cannot say whether what lies between two of its nodes belongs to it; a surface can.
fn check_node_sets(mesh: &Mesh) -> Result<()> {
    let mut marked = vec![false; mesh.n_nodes()];
    for (name, nodes) in mesh.node_sets.iter().filter(|(_, nodes)| nodes.len() > 1) {
        for &node in nodes {
            marked[node] = true;
        }
        for element in 0..mesh.n_elements() {
            for local in 0..mesh.shapes[element].n_facets() {
                let ends: Vec<usize> = mesh.facet_nodes(Facet { element, local }).take(2).collect();
                if ends.iter().all(|&n| marked[n]) {
                    return Err(Error::input(format!(
                        "the mesh cannot be subdivided: node set `{name}` holds both ends of the \
                         side from node {} to node {} of element {}, and does not say whether a \
                         node between belongs to it; make that side a surface (in Gmsh a physical \
                         curve)",
                        mesh.node_label(ends[0]),
                        mesh.node_label(ends[1]),
                        mesh.element_label(element)
                    )));
                }
            }
        }
        for &node in nodes {
            marked[node] = false;
        }
    }
    Ok(())
}

/// Appends the children of an element.
fn cut(mesh: &Mesh, element: usize, sides: &Sides, out: &mut Mesh) {
    let shape = mesh.shapes[element];
    let Some(refinement) = shape.reference().refinement else {
        return;
    };
    let body = mesh.element_body[element] as usize;
    let mut nodes = mesh.nodes(element).to_vec();
    for local in 0..shape.n_facets() {
        let (index, turned) = sides.of(mesh, Facet { element, local });
        let side = &sides.list[index];
        let new = 0..side.n_new() as u32;
        if turned {
            nodes.extend(new.rev().map(|k| side.first + k));
        } else {
            nodes.extend(new.map(|k| side.first + k));
        }
    }
    for terms in refinement.inside {
        let mut x = [0.0; 2];
        for &(weight, local) in *terms {
            let [a, b] = out.in_plane(nodes[local] as usize);
            x[0] += weight * a;
            x[1] += weight * b;
        }
        nodes.push(out.n_nodes() as u32);
        out.coordinates.extend(x);
    }
    for child in refinement.children {
        let nodes: Vec<u32> = child.iter().map(|&local| nodes[local]).collect();
        out.push_element(shape, body, &nodes);
    }
}

/// The parts of a facet, as facets of the children.
fn parts(mesh: &Mesh, facet: Facet) -> impl Iterator<Item = Facet> {
    let refinement = mesh.shapes[facet.element].reference().refinement;
    refinement.into_iter().flat_map(move |refinement| {
        let first = refinement.children.len() * facet.element;
        let parts = refinement.of_facet[facet.local].iter();
        parts.map(move |&[child, local]| Facet {
            element: first + child,
            local,
        })
    })
}

#[cfg(test)]
mod tests;
