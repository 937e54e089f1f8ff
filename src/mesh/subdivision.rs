//! A mesh with every element cut in four, of a solid in eight: half the element size, the same
//! bodies, sets and surfaces ([`crate::shape::cuts`]).
//!
//! New nodes lie where the element's own map puts them (on the straight line or the parabola of a
//! side), on a surface whose [`Curve`] is known on that curve. Where a surface faces another one in
//! a contact, its new nodes are put where those of the other's face them, so that the nodes of the
//! finer mesh pair as those of the mesh did, and their gaps are those of the surfaces. Old nodes
//! keep their indices and labels.

use super::surface::{PAIRING, facing, longest_facet, normals};
use super::{Curve, Facet, Mesh, Surface};
use crate::scene::Contact;
use crate::shape::{Cut, Place, WHOLE, cut_of, cuts};
use crate::space::{Vector, along, difference, direction, dot, unit};
use crate::{Error, Result};
use nalgebra::{Matrix3, Vector3};
use std::collections::{BTreeMap, HashMap};

/// Most elements that subdivision makes.
const MOST_ELEMENTS: usize = 50_000_000;
/// Steps of Newton's method for a place on a facet or a curve: it converges quadratically from the
/// middle of a half of it.
const NEWTON: usize = 8;

/// The mesh `times` times subdivided. `contacts` say which surfaces face each other.
///
/// # Errors
/// Input errors: a node set that holds both ends of an element's edge (it is not known whether the
/// node between belongs to it), a mesh that would become too large.
pub fn subdivided(mesh: Mesh, times: usize, contacts: &[Contact]) -> Result<Mesh> {
    let (parts, word) = match mesh.is_solid() {
        true => (8usize, "eight"),
        false => (4, "four"),
    };
    let factor = parts.checked_pow(u32::try_from(times).unwrap_or(u32::MAX));
    let elements = factor.and_then(|f| f.checked_mul(mesh.n_elements()));
    if elements.is_none_or(|n| n > MOST_ELEMENTS) {
        return Err(Error::input(format!(
            "mesh.subdivisions = {times}: {} elements, each cut in {word} {times} times, are more \
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

fn subdivided_once(mesh: &Mesh, contacts: &[Contact]) -> Result<Mesh> {
    check_node_sets(mesh)?;
    let mut finer = Finer::new(mesh);
    finer.lay_on_curves();
    for contact in contacts {
        finer.face(contact);
    }
    finer.follow();
    Ok(finer.mesh())
}

/// A node set cannot say whether what lies between two of its nodes belongs to it; a surface can.
fn check_node_sets(mesh: &Mesh) -> Result<()> {
    let mut marked = vec![false; mesh.n_nodes()];
    for (name, nodes) in mesh.node_sets.iter().filter(|(_, nodes)| nodes.len() > 1) {
        for &node in nodes {
            marked[node] = true;
        }
        for element in 0..mesh.n_elements() {
            for edge in mesh.shapes[element].reference().edges {
                let ends = edge.map(|k| mesh.nodes(element)[k] as usize);
                if ends.iter().all(|&n| marked[n]) {
                    let (what, physical) = match mesh.is_solid() {
                        true => ("edge", "surface"),
                        false => ("side", "curve"),
                    };
                    return Err(Error::input(format!(
                        "the mesh cannot be subdivided: node set `{name}` holds both ends of the \
                         {what} from node {} to node {} of element {}, and does not say whether a \
                         node between belongs to it; make a surface of what it is to hold (in Gmsh \
                         a physical {physical})",
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

/// Corners of the mesh between which a new node lies, sorted, with their parts of [`WHOLE`].
type Between = [(u32, u32); 8];

fn sorted(corners: impl Iterator<Item = (u32, u32)>) -> Between {
    let mut out = [(u32::MAX, 0); 8];
    for (slot, corner) in out.iter_mut().zip(corners) {
        *slot = corner;
    }
    out.sort_unstable();
    out
}

/// A node that subdivision adds.
struct New {
    /// Coordinates to which the map of its element takes the node.
    mapped: Vector,
    /// Coordinates of the node.
    x: Vector,
    /// Whether a curve or a facing surface says where it lies.
    is_laid: bool,
}

/// The finer mesh while it is made.
struct Finer<'m> {
    mesh: &'m Mesh,
    cuts: Vec<&'static Cut>,
    /// Start of each element's nodes in `nodes`.
    offsets: Vec<usize>,
    /// The finer mesh's nodes in each element, in the order of [`Cut::places`].
    nodes: Vec<u32>,
    new: Vec<New>,
    by_corners: HashMap<Between, u32>,
}

impl<'m> Finer<'m> {
    fn new(mesh: &'m Mesh) -> Self {
        let mut out = Finer {
            mesh,
            cuts: Vec::with_capacity(mesh.n_elements()),
            offsets: vec![0],
            nodes: Vec::new(),
            new: Vec::new(),
            by_corners: HashMap::new(),
        };
        for element in 0..mesh.n_elements() {
            out.enter(element);
        }
        out
    }

    fn enter(&mut self, element: usize) {
        let (shape, own) = (self.mesh.shapes[element], self.mesh.nodes(element));
        let points: Vec<Vector> = own.iter().map(|&n| self.mesh.point(n as usize)).collect();
        let cut = &cuts(shape)[cut_of(shape, &points)];
        self.nodes.extend(own);
        let new = cut.places.iter().zip(&cut.between).skip(own.len());
        for (&place, between) in new {
            let corners = sorted(between.iter().map(|&(corner, part)| (own[corner], part)));
            let next = (self.mesh.n_nodes() + self.new.len()) as u32;
            let node = *self.by_corners.entry(corners).or_insert(next);
            if node == next {
                let values = shape.functions(place).values;
                let terms = values.iter().zip(&points);
                let mapped = terms.fold([0.0; 3], |sum, (value, x)| along(sum, *value, *x));
                self.new.push(New {
                    mapped,
                    x: mapped,
                    is_laid: false,
                });
            }
            self.nodes.push(node);
        }
        self.cuts.push(cut);
        self.offsets.push(self.nodes.len());
    }

    /// The finer mesh's nodes in an element.
    fn of(&self, element: usize) -> &[u32] {
        &self.nodes[self.offsets[element]..self.offsets[element + 1]]
    }

    /// The new nodes on a facet, with their places on it.
    fn on_facet(&self, facet: Facet) -> impl Iterator<Item = (u32, Place)> {
        let cut = self.cuts[facet.element];
        let corners = self.mesh.shapes[facet.element].facet(facet.local);
        let reference = self.mesh.facet_reference(facet);
        let nodes = self.of(facet.element);
        cut.on_facet[facet.local].iter().map(move |&k| {
            let mut place = [0.0; 3];
            for &(corner, part) in &cut.between[k] {
                // Bilinear functions reproduce the places themselves.
                let at = corners.iter().position(|&c| c == corner).unwrap_or(0);
                let share = f64::from(part) / f64::from(WHOLE);
                place = along(place, share, reference.nodes[at]);
            }
            (nodes[k], place)
        })
    }

    fn point(&self, node: u32) -> Vector {
        match (node as usize).checked_sub(self.mesh.n_nodes()) {
            Some(new) => self.new[new].x,
            None => self.mesh.point(node as usize),
        }
    }

    fn lay(&mut self, node: u32, x: Vector) {
        let new = &mut self.new[node as usize - self.mesh.n_nodes()];
        (new.x, new.is_laid) = (x, true);
    }

    /// Puts the new nodes of surfaces on their curves.
    fn lay_on_curves(&mut self) {
        let mesh = self.mesh;
        for surface in mesh.surfaces.values() {
            let Some(curve) = surface.curve else { continue };
            for &facet in &surface.facets {
                let nodes: Vec<u32> = self.on_facet(facet).map(|(node, _)| node).collect();
                for node in nodes {
                    if let Some((on, _)) = curve.nearest(self.point(node)) {
                        self.lay(node, on);
                    }
                }
            }
        }
    }

    /// Puts the new nodes of a contact's first surface where those of the second face them.
    fn face(&mut self, contact: &Contact) {
        let mesh = self.mesh;
        let (Some(first), Some(second)) = (
            mesh.surfaces.get(&contact.first),
            mesh.surfaces.get(&contact.second),
        ) else {
            return;
        };
        let partner = partners(mesh, contact, first, second);
        let on = |surface: &Surface| -> BTreeMap<u32, (Facet, Place)> {
            let facets = surface.facets.iter();
            let nodes = facets.flat_map(|&f| self.on_facet(f).map(move |(n, at)| (n, (f, at))));
            nodes.collect()
        };
        let (above, below) = (on(first), on(second));
        let mut opposite = HashMap::new();
        for (between, &node) in self
            .by_corners
            .iter()
            .filter(|(_, n)| below.contains_key(n))
        {
            let corners = between.iter().filter(|(_, part)| *part > 0);
            let faced: Option<Vec<(u32, u32)>> = corners
                .map(|(corner, part)| Some((*partner.get(corner)?, *part)))
                .collect();
            let faced = faced.and_then(|f| self.by_corners.get(&sorted(f.into_iter())));
            if let Some(&faced) = faced.filter(|n| above.contains_key(n)) {
                opposite.insert(node, faced);
            }
        }
        for (node, &(facet, place)) in &below {
            let Some(&faced) = opposite.get(node) else {
                continue;
            };
            let x = self.point(*node);
            let normal = match (contact.normal, second.curve) {
                (Some(n), _) => n.vector(),
                (None, Some(curve)) => curve.normal(x),
                (None, None) => {
                    let reference = mesh.facet_reference(facet);
                    reference.area(&(reference.functions)(place), &points(mesh, facet))
                }
            };
            let (normal, near) = (direction(normal), self.point(faced));
            let found = match first.curve {
                Some(curve) if curve.nearest(x).is_some() => on_curve(x, normal, curve, near),
                _ => on_facet(mesh, x, normal, above[&faced]),
            };
            if let Some(found) = found {
                self.lay(faced, found);
            }
        }
    }

    /// Moves new nodes inside faces and elements with those on their sides.
    fn follow(&mut self) {
        for corners in [4, 8] {
            for element in 0..self.mesh.n_elements() {
                let cut = self.cuts[element];
                let places = cut.follows.iter();
                for (place, terms) in places.filter(|(p, _)| cut.between[*p].len() == corners) {
                    let moved = terms.iter().fold([0.0; 3], |sum, &(weight, other)| {
                        let new = &self.new[self.of(element)[other] as usize - self.mesh.n_nodes()];
                        along(sum, weight, difference(new.x, new.mapped))
                    });
                    let node = self.of(element)[*place] as usize - self.mesh.n_nodes();
                    let new = &mut self.new[node];
                    if !new.is_laid {
                        new.x = along(new.mapped, 1.0, moved);
                    }
                }
            }
        }
    }

    fn mesh(&self) -> Mesh {
        let mesh = self.mesh;
        let mut out = Mesh {
            dimension: mesh.dimension,
            coordinates: mesh.coordinates.clone(),
            bodies: mesh.bodies.clone(),
            node_sets: mesh.node_sets.clone(),
            ..Mesh::default()
        };
        let new = self.new.iter().flat_map(|new| &new.x[..mesh.dimension]);
        out.coordinates.extend(new);
        // Elements have different numbers of children only where their dimensions differ.
        let mut first = Vec::with_capacity(mesh.n_elements());
        for element in 0..mesh.n_elements() {
            first.push(out.n_elements());
            let nodes = self.of(element);
            for child in &self.cuts[element].children {
                let child: Vec<u32> = child.iter().map(|&k| nodes[k]).collect();
                let body = mesh.element_body[element] as usize;
                out.push_element(mesh.shapes[element], body, &child);
            }
        }
        for (name, surface) in &mesh.surfaces {
            let parts = surface.facets.iter().flat_map(|facet| {
                let parts = &self.cuts[facet.element].of_facet[facet.local];
                let first = first[facet.element];
                parts.iter().map(move |&[child, local]| Facet {
                    element: first + child,
                    local,
                })
            });
            let surface = Surface {
                facets: parts.collect(),
                curve: surface.curve,
            };
            out.surfaces.insert(name.clone(), surface);
        }
        if let Some(&largest) = mesh.node_labels.iter().max() {
            let new = 1..=self.new.len() as u64;
            out.node_labels = mesh.node_labels.clone();
            out.node_labels
                .extend(new.map(|i| largest.saturating_add(i)));
        }
        out
    }
}

fn points(mesh: &Mesh, facet: Facet) -> Vec<Vector> {
    mesh.facet_nodes(facet).map(|n| mesh.point(n)).collect()
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

/// Where the line through `x` along `normal` meets a round surface, on the side of `near`: Newton's
/// method for the distance from the surface.
fn on_curve(x: Vector, normal: Vector, curve: Curve, near: Vector) -> Option<Vector> {
    let mut t = dot(difference(near, x), normal);
    for _ in 0..NEWTON {
        let at = along(x, t, normal);
        let (on, _) = curve.nearest(at)?;
        let out = curve.normal(at);
        t += dot(difference(on, at), out) / dot(normal, out);
    }
    let found = along(x, t, normal);
    found.iter().all(|c| c.is_finite()).then_some(found)
}

/// Where the line through `x` along `normal` meets a facet, from a place of it on: Newton's method
/// for the place and the way along the line.
fn on_facet(
    mesh: &Mesh,
    x: Vector,
    normal: Vector,
    (facet, place): (Facet, Place),
) -> Option<Vector> {
    let reference = mesh.facet_reference(facet);
    let nodes = points(mesh, facet);
    let (mut place, mut found) = (place, x);
    for _ in 0..NEWTON {
        let at = (reference.functions)(place);
        let terms = at.values.iter().zip(&nodes);
        found = terms.fold([0.0; 3], |sum, (value, node)| along(sum, *value, *node));
        let mut tangents = [[0.0; 3], unit(2)];
        for d in 0..reference.dimension() {
            let slopes = at.gradients.iter().zip(&nodes);
            tangents[d] = slopes.fold([0.0; 3], |sum, (slope, node)| along(sum, slope[d], *node));
        }
        let columns = [tangents[0], tangents[1], normal].map(Vector3::from);
        let step = Matrix3::from_columns(&columns)
            .lu()
            .solve(&Vector3::from(difference(found, x)))?;
        place = [place[0] - step[0], place[1] - step[1], 0.0];
    }
    Some(found)
}

#[cfg(test)]
mod tests;
