//! Solid meshes swept from plane ones: extruded along z, or revolved about the y axis.
//!
//! Each plane element becomes a column of solid elements, one per layer: triangles become prisms,
//! quadrilaterals hexahedra. If an element is revolved about one of its edges on the axis, a
//! quadrilateral becomes a prism with this edge and a triangle becomes a tetrahedron. Corners of
//! quadratic elements have an additional node halfway between two layers.

use super::generate::{direction, limits};
use super::{Curve, Facet, Mesh, Shape, Surface};
use crate::scene::{Extrusion, Revolution};
use crate::{Error, Result};

/// Distance from the axis, as a fraction of the section's size, up to which a node counts as lying
/// on the axis.
const ON_AXIS: f64 = 1e-12;

/// Extrudes a plane mesh along z, from z = 0 to `depth`.
///
/// Edges of a surface become its faces; a node set contains the nodes of all layers. `BODY.front`
/// is the section at z = 0, `BODY.back` the section at `depth`.
///
/// # Errors
/// `Input` for a solid mesh or names that are already taken.
pub fn extruded(plane: &Mesh, extrusion: &Extrusion) -> Result<Mesh> {
    let n = extrusion.elements;
    check(plane, n)?;
    let along =
        |half: usize, [x, y]: [f64; 2]| [x, y, extrusion.depth * (half as f64 / (2 * n) as f64)];
    let curve = |curve: Curve, _: &[[f64; 2]]| match curve {
        Curve::Line { normal: [x, y] } => Some(Curve::Plane {
            normal: [x, y, 0.0],
        }),
        Curve::Circle {
            center: [x, y],
            radius,
            outward,
        } => Some(Curve::Cylinder {
            point: [x, y, 0.0],
            axis: [0.0, 0.0, 1.0],
            radius,
            outward,
        }),
        solid => Some(solid),
    };
    let on_axis = vec![false; plane.n_nodes()];
    SweptSection::new(plane, n, false, on_axis).mesh(along, curve)
}

/// Revolves a plane mesh in coordinates (r, y) about the y axis, from the x axis towards z.
///
/// Surfaces and node sets are treated as in [`extruded`]; a surface on the axis becomes a node set.
/// A full turn is closed and has neither `front` nor `back`.
///
/// # Errors
/// `Input` for a solid mesh, a node at r < 0, an element with a single corner on the axis, or names
/// that are already taken.
pub fn revolved(plane: &Mesh, revolution: &Revolution) -> Result<Mesh> {
    let (n, angle) = (revolution.elements, revolution.angle);
    check(plane, n)?;
    let radius = |node: usize| plane.in_plane(node)[0];
    let size = plane.coordinates.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    if let Some(node) = (0..plane.n_nodes()).find(|&node| radius(node) < -ON_AXIS * size) {
        return Err(Error::input(format!(
            "node {} at {} lies beyond the axis of revolution: give a section with x >= 0",
            plane.node_label(node),
            plane.place(node)
        )));
    }
    let on_axis: Vec<bool> = (0..plane.n_nodes())
        .map(|node| radius(node) <= ON_AXIS * size)
        .collect();
    let round = |half: usize, [r, y]: [f64; 2]| {
        let [c, s] = direction(angle * half as f64 / (2 * n) as f64);
        [r * c, y, r * s]
    };
    SweptSection::new(plane, n, angle == 360.0, on_axis).mesh(round, turned_curve)
}

/// Refuses to sweep a solid mesh, or to make so many layers that memory cannot hold the result.
fn check(plane: &Mesh, layers: usize) -> Result<()> {
    if plane.is_solid() {
        return Err(Error::input(
            "the mesh is solid; only plane meshes can be extruded or revolved",
        ));
    }
    let Some(&shape) = plane.shapes.first() else {
        return Ok(());
    };
    let mut of_body = vec![0.0; plane.bodies.len()];
    for &body in &plane.element_body {
        of_body[body as usize] += 1.0;
    }
    let cells = |elements: &f64| [elements.sqrt(), elements.sqrt(), layers as f64];
    let bodies: Vec<[f64; 3]> = of_body.iter().map(cells).collect();
    limits::solids("elements", &bodies, shape)
}

/// The exact shape that a line or circle through the given points becomes when it is revolved about
/// the y axis; `None` for a cone, which has no exact shape here.
fn turned_curve(curve: Curve, points: &[[f64; 2]]) -> Option<Curve> {
    let axis = [0.0, 1.0, 0.0];
    match curve {
        Curve::Line { normal: [0.0, y] } => Some(Curve::Plane {
            normal: [0.0, y, 0.0],
        }),
        Curve::Line { normal: [x, 0.0] } => Some(Curve::Cylinder {
            point: [0.0; 3],
            axis,
            radius: points.first()?[0],
            outward: x > 0.0,
        }),
        Curve::Line { .. } => None,
        Curve::Circle {
            center: [0.0, y],
            radius,
            outward,
        } => Some(Curve::Sphere {
            center: [0.0, y, 0.0],
            radius,
            outward,
        }),
        Curve::Circle {
            center: [ring, y],
            radius,
            outward,
        } => Some(Curve::Torus {
            center: [0.0, y, 0.0],
            axis,
            ring,
            radius,
            outward,
        }),
        solid => Some(solid),
    }
}

/// A section with the layers through which it is swept. Layers are numbered by half steps: even
/// ones hold corners, odd ones lie halfway between.
struct SweptSection<'a> {
    plane: &'a Mesh,
    layers: usize,
    closed: bool,
    on_axis: Vec<bool>,
    /// For each node of the section, whether it also has nodes halfway between layers, as corners
    /// of quadratic elements do.
    halved: Vec<bool>,
    /// Index of the first node that each node of the section becomes.
    start: Vec<usize>,
}

/// An element of the section swept through one layer.
struct Drawn {
    shape: Shape,
    /// For each node of the swept element, the node of the section and the half step within the
    /// layer.
    nodes: Vec<(usize, usize)>,
    /// The facet that each edge becomes; `None` if the edge lies on the axis.
    facets: Vec<Option<usize>>,
    /// The facets at the beginning and at the end of the layer.
    ends: [usize; 2],
}

impl<'a> SweptSection<'a> {
    fn new(plane: &'a Mesh, layers: usize, closed: bool, on_axis: Vec<bool>) -> Self {
        let mut halved = vec![false; plane.n_nodes()];
        for (element, shape) in plane.shapes.iter().enumerate() {
            if shape.is_quadratic() {
                for &node in &plane.nodes(element)[..shape.n_corners()] {
                    halved[node as usize] = true;
                }
            }
        }
        let mut out = SweptSection {
            plane,
            layers,
            closed,
            on_axis,
            halved,
            start: vec![0],
        };
        for node in 0..plane.n_nodes() {
            out.start.push(out.start[node] + out.copies(node));
        }
        out
    }

    /// Number of nodes that a node of the section becomes.
    fn copies(&self, node: usize) -> usize {
        let per_layer = if self.halved[node] { 2 } else { 1 };
        match (self.on_axis[node], self.closed) {
            (true, _) => 1,
            (false, true) => per_layer * self.layers,
            (false, false) => per_layer * self.layers + 1,
        }
    }

    /// The node that a node of the section becomes at a half step.
    fn node(&self, node: usize, half: usize) -> usize {
        let step = if self.halved[node] { half } else { half / 2 };
        self.start[node] + step % self.copies(node)
    }

    fn mesh(
        &self,
        place: impl Fn(usize, [f64; 2]) -> [f64; 3],
        curve: impl Fn(Curve, &[[f64; 2]]) -> Option<Curve>,
    ) -> Result<Mesh> {
        let plane = self.plane;
        let mut out = Mesh {
            dimension: 3,
            bodies: plane.bodies.clone(),
            ..Mesh::default()
        };
        for node in 0..plane.n_nodes() {
            let step = if self.halved[node] { 1 } else { 2 };
            for copy in 0..self.copies(node) {
                out.coordinates
                    .extend(place(step * copy, plane.in_plane(node)));
            }
        }
        let drawn: Vec<Drawn> = (0..plane.n_elements())
            .map(|element| self.drawn(element))
            .collect::<Result<_>>()?;
        for layer in 0..self.layers {
            for (drawn, &body) in drawn.iter().zip(&plane.element_body) {
                let node =
                    |&(node, half): &(usize, usize)| self.node(node, 2 * layer + half) as u32;
                let nodes: Vec<u32> = drawn.nodes.iter().map(node).collect();
                out.push_element(drawn.shape, body as usize, &nodes);
            }
        }
        self.sets(&mut out, &drawn, curve);
        self.ends(&mut out, &drawn)?;
        Ok(out)
    }

    /// Sweeps an element of the section through one layer.
    fn drawn(&self, element: usize) -> Result<Drawn> {
        let shape = self.plane.shapes[element];
        let n = shape.n_corners();
        let nodes: Vec<usize> = (self.plane.nodes(element).iter())
            .map(|&node| node as usize)
            .collect();
        let (corners, middles) = nodes.split_at(n);
        let quadratic = shape.is_quadratic();
        let touching: Vec<usize> = (0..n).filter(|&k| self.on_axis[corners[k]]).collect();
        // The edge on the axis runs from corner `a` to the next corner.
        let a = match touching[..] {
            [] => return Ok(Drawn::layer(corners, middles)),
            [a, b] if b == a + 1 => a,
            [a, b] if a == 0 && b == n - 1 => b,
            _ => {
                return Err(Error::input(format!(
                    "element {} ({}) touches the axis of revolution at a corner: give it an edge \
                     there, or none",
                    self.plane.element_label(element),
                    shape.name()
                )));
            }
        };
        let corner = |k: usize| corners[(a + k) % n];
        // The mid-side node of the edge that begins at corner k, counted from `a`.
        let middle = |k: usize| middles.get((a + k) % n).copied().unwrap_or(0);
        let mut facets = vec![None; n];
        let mut became = |k: usize, facet: usize| facets[(a + k) % n] = Some(facet);
        let mut places;
        let linear_and_quadratic;
        let ends;
        if n == 4 {
            // The edge on the axis joins the two triangles of the prism at its ends.
            let [a, b, c, d] = [0, 1, 2, 3].map(corner);
            places = vec![(a, 0), (d, 0), (d, 2), (b, 0), (c, 0), (c, 2)];
            let edges = [(3, 0), (3, 2), (1, 0), (1, 2), (0, 0), (2, 0), (2, 2)]
                .map(|(k, half)| (middle(k), half));
            let [da0, da2, bc0, bc2, ab, cd0, cd2] = edges;
            if quadratic {
                places.extend([da0, (d, 1), da2, bc0, (c, 1), bc2, ab, cd0, cd2]);
            }
            became(1, 1);
            became(2, 3);
            became(3, 0);
            linear_and_quadratic = [Shape::Prism6, Shape::Prism15];
            ends = [2, 4];
        } else {
            let [a, b, c] = [0, 1, 2].map(corner);
            places = vec![(a, 0), (b, 0), (c, 0), (c, 2)];
            if quadratic {
                let edges = [(0, 0), (1, 0), (2, 0), (2, 2), (1, 2)];
                places.extend(edges.map(|(k, half)| (middle(k), half)));
                places.push((c, 1));
            }
            became(1, 2);
            became(2, 3);
            linear_and_quadratic = [Shape::Tet4, Shape::Tet10];
            ends = [0, 1];
        }
        Ok(Drawn {
            shape: linear_and_quadratic[usize::from(quadratic)],
            nodes: places,
            facets,
            ends,
        })
    }

    /// Transfers the surfaces and node sets of the section to the solid.
    fn sets(
        &self,
        out: &mut Mesh,
        drawn: &[Drawn],
        curve: impl Fn(Curve, &[[f64; 2]]) -> Option<Curve>,
    ) {
        let plane = self.plane;
        let all = |nodes: &[usize]| -> Vec<usize> {
            let copies = nodes.iter().flat_map(|&n| self.start[n]..self.start[n + 1]);
            let mut copies: Vec<usize> = copies.collect();
            copies.sort_unstable();
            copies
        };
        for (name, nodes) in &plane.node_sets {
            out.node_sets.insert(name.clone(), all(nodes));
        }
        for (name, surface) in &plane.surfaces {
            let facets: Vec<Facet> = (0..self.layers)
                .flat_map(|layer| {
                    let facet = move |edge: &Facet| {
                        Some(Facet {
                            element: layer * plane.n_elements() + edge.element,
                            local: drawn[edge.element].facets[edge.local]?,
                        })
                    };
                    surface.facets.iter().filter_map(facet)
                })
                .collect();
            let nodes = plane.set_nodes(name).unwrap_or_default();
            if facets.is_empty() {
                out.node_sets.insert(name.clone(), all(&nodes));
                continue;
            }
            let points: Vec<[f64; 2]> = nodes.iter().map(|&n| plane.in_plane(n)).collect();
            let surface = Surface {
                facets,
                curve: surface.curve.and_then(|c| curve(c, &points)),
            };
            out.surfaces.insert(name.clone(), surface);
        }
    }

    /// Adds the surfaces `BODY.front` and `BODY.back`.
    fn ends(&self, out: &mut Mesh, drawn: &[Drawn]) -> Result<()> {
        let n = drawn.len();
        let last = (self.layers - 1) * n;
        for (end, name, first) in [(0, "front", 0), (1, "back", last)] {
            for (body, of) in out.bodies.iter().enumerate().filter(|_| !self.closed) {
                let name = format!("{of}.{name}");
                let of_body = (0..n).filter(|&e| self.plane.element_body[e] as usize == body);
                let facets = of_body.map(|e| Facet {
                    element: first + e,
                    local: drawn[e].ends[end],
                });
                let surface = Surface {
                    facets: facets.collect(),
                    curve: None,
                };
                let taken = out.node_sets.contains_key(&name);
                if out.surfaces.insert(name.clone(), surface).is_some() || taken {
                    return Err(Error::input(format!(
                        "the mesh has a set `{name}` already; what is drawn from it needs the \
                         name: rename the set"
                    )));
                }
            }
        }
        Ok(())
    }
}

impl Drawn {
    /// A hexahedron or prism through one layer.
    fn layer(corners: &[usize], middles: &[usize]) -> Drawn {
        let n = corners.len();
        let at = |nodes: &[usize], half: usize| -> Vec<(usize, usize)> {
            nodes.iter().map(|&node| (node, half)).collect()
        };
        let mut nodes = [at(corners, 0), at(corners, 2)].concat();
        if !middles.is_empty() {
            nodes.extend([at(middles, 0), at(middles, 2), at(corners, 1)].concat());
        }
        Drawn {
            shape: match (n, middles.is_empty()) {
                (3, true) => Shape::Prism6,
                (3, false) => Shape::Prism15,
                (_, true) => Shape::Hex8,
                (_, false) => Shape::Hex20,
            },
            nodes,
            facets: (0..n).map(|k| Some(2 + k)).collect(),
            ends: [0, 1],
        }
    }
}

#[cfg(test)]
mod tests;
