//! Subdivision of a mesh: every element is divided into four, in a solid into eight. The element
//! size is halved; bodies, sets and surfaces stay the same ([`crate::shape::cuts`]).
//!
//! New nodes lie where the element's own map puts them (on the straight line or the parabola of a
//! side), or on the surface's [`Curve`] if it is known. If a surface faces another in a contact,
//! its new nodes are put opposite the new nodes of the other surface. The nodes of the finer mesh
//! then pair as those of the coarser mesh did, and their gaps are those of the surfaces. Old nodes
//! keep their indices and labels.

use super::surface::{PAIRING, facing, longest_facet, normals};
use super::{Curve, Facet, Mesh, Surface};
use crate::scene::Contact;
use crate::shape::{Cut, Place, WHOLE, cut_of, cuts};
use crate::space::{Vector, along, difference, direction, dot, unit};
use crate::{Error, Result};
use nalgebra::{Matrix3, Vector3};
use std::collections::{BTreeMap, HashMap};

/// Largest number of elements that subdivision makes.
pub(super) const MOST_ELEMENTS: usize = 50_000_000;
/// Steps of Newton's method for a point on a facet or a curve: it converges quadratically from the
/// middle of half a facet.
const NEWTON: usize = 8;

/// The mesh after `times` subdivisions. `contacts` lists the surfaces that face each other.
///
/// # Errors
/// `Input` for a node set that contains both ends of an element's edge (it is then unknown whether
/// the node between them belongs to the set), or for a mesh that would become too large.
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
    let cut = |mesh: &Mesh, element: usize| {
        let shape = mesh.shapes[element];
        &cuts(shape)[cut_of(shape, &of_element(mesh, element))]
    };
    for _ in 0..times {
        check_node_sets(&out, |_| true)?;
        let finer = Finer::new(&out, |element| cut(&out, element));
        out = finer.laid(contacts).mesh();
    }
    Ok(out)
}

/// Refuses node sets that contain both ends of an edge that is divided: a node set, unlike a
/// surface, does not determine whether the new node on the edge belongs to it.
pub(super) fn check_node_sets(mesh: &Mesh, is_divided: impl Fn([u32; 2]) -> bool) -> Result<()> {
    let mut marked = vec![false; mesh.n_nodes()];
    for (name, nodes) in mesh.node_sets.iter().filter(|(_, nodes)| nodes.len() > 1) {
        for &node in nodes {
            marked[node] = true;
        }
        for element in 0..mesh.n_elements() {
            for edge in mesh.shapes[element].reference().edges {
                let ends = edge.map(|k| mesh.nodes(element)[k] as usize);
                let is_held = ends.iter().all(|&n| marked[n]);
                if is_held && is_divided(ends.map(|n| n as u32)) {
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

/// Corners of the mesh between which a new node lies, sorted, each with its weight in parts of
/// [`WHOLE`].
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
    /// Coordinates to which the element's map takes the node.
    mapped: Vector,
    /// Coordinates of the node.
    x: Vector,
    /// Whether the position is determined by a curve or a facing surface.
    is_laid: bool,
}

/// The finer mesh under construction.
pub(super) struct Finer<'m> {
    mesh: &'m Mesh,
    cuts: Vec<&'static Cut>,
    /// Index in `nodes` at which each element's nodes begin.
    offsets: Vec<usize>,
    /// Nodes of the finer mesh in each element, in the order of [`Cut::places`].
    nodes: Vec<u32>,
    new: Vec<New>,
    by_corners: HashMap<Between, u32>,
}

impl<'m> Finer<'m> {
    /// The mesh with each element divided by a cut.
    pub(super) fn new(mesh: &'m Mesh, cut: impl Fn(usize) -> &'static Cut) -> Self {
        let mut out = Finer {
            mesh,
            cuts: Vec::with_capacity(mesh.n_elements()),
            offsets: vec![0],
            nodes: Vec::new(),
            new: Vec::new(),
            by_corners: HashMap::new(),
        };
        for element in 0..mesh.n_elements() {
            out.enter(element, cut(element));
        }
        out
    }

    /// Moves the new nodes onto the curves and opposite the surfaces that face them.
    pub(super) fn laid(mut self, contacts: &[Contact]) -> Self {
        self.lay_on_curves();
        for contact in contacts {
            self.face(contact);
        }
        self.follow();
        self
    }

    fn enter(&mut self, element: usize, cut: &'static Cut) {
        let (shape, own) = (self.mesh.shapes[element], self.mesh.nodes(element));
        let points = of_element(self.mesh, element);
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

    /// The nodes of the finer mesh in an element.
    fn of(&self, element: usize) -> &[u32] {
        &self.nodes[self.offsets[element]..self.offsets[element + 1]]
    }

    /// The new nodes on a facet, with their reference coordinates on it.
    fn on_facet(&self, facet: Facet) -> impl Iterator<Item = (u32, Place)> {
        let cut = self.cuts[facet.element];
        let corners = self.mesh.shapes[facet.element].facet(facet.local);
        let reference = self.mesh.facet_reference(facet);
        let nodes = self.of(facet.element);
        cut.on_facet[facet.local].iter().map(move |&k| {
            let mut place = [0.0; 3];
            for &(corner, part) in &cut.between[k] {
                // Linear interpolation between the corners reproduces the reference coordinates
                // exactly.
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

    /// Moves the new nodes of surfaces onto their known curves.
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

    /// Moves the new nodes of a contact's first surface to the points opposite the new nodes of the
    /// second surface.
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

    /// Moves new nodes inside faces and elements along with the nodes on their sides.
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

    /// The finer mesh.
    pub(super) fn mesh(&self) -> Mesh {
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
        let mut first = Vec::with_capacity(mesh.n_elements());
        for element in 0..mesh.n_elements() {
            first.push(out.n_elements());
            let nodes = self.of(element);
            for child in &self.cuts[element].children {
                let own: Vec<u32> = child.nodes.iter().map(|&k| nodes[k]).collect();
                let body = mesh.element_body[element] as usize;
                out.push_element(child.shape, body, &own);
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

fn of_element(mesh: &Mesh, element: usize) -> Vec<Vector> {
    let nodes = mesh.nodes(element).iter();
    nodes.map(|&n| mesh.point(n as usize)).collect()
}

fn points(mesh: &Mesh, facet: Facet) -> Vec<Vector> {
    mesh.facet_nodes(facet).map(|n| mesh.point(n)).collect()
}

/// The node of the first surface that faces each node of the second surface, if there is one.
pub(super) fn partners(
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

/// Intersection of the line through `x` along `normal` with a round surface, on the side of `near`,
/// by Newton's method for the distance from the surface.
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

/// Intersection of the line through `x` along `normal` with a facet, by Newton's method for the
/// place on the facet and the distance along the line, beginning at the given place.
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
