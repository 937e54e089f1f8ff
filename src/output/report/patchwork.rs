//! A mesh as triangles of a plane, with their mirror images: plane elements, cuts through solids,
//! or faces of a contact.

use super::contours::{TriangleSheet, border};
use super::window::Window;
use crate::mesh::{Facet, Mesh};
use crate::space::{Vector, along, dot, unit};
use std::collections::BTreeMap;

/// Sources of a point: nodes, and elements numbered after the nodes, each with its weight. The
/// point is the weighted mean of its sources.
pub(super) type Mix = Vec<(usize, f64)>;

/// A point of a patchwork.
#[derive(Clone)]
struct PatchworkPoint {
    mix: Mix,
    body: u32,
    /// -1 along the axes in which the point is a mirror image, else 1.
    sign: [f64; 2],
}

/// Triangles that meet along whole sides; triangles of different bodies do not share points.
pub(super) struct Patchwork {
    /// Axes of the plane in space.
    axes: [Vector; 2],
    points: Vec<PatchworkPoint>,
    known: BTreeMap<(u32, [usize; 2]), u32>,
    triangles: Vec<[u32; 3]>,
    border: Vec<[u32; 2]>,
}

impl Patchwork {
    /// Creates a patchwork without triangles.
    pub(super) fn new(axes: [Vector; 2]) -> Self {
        Patchwork {
            axes,
            points: Vec::new(),
            known: BTreeMap::new(),
            triangles: Vec::new(),
            border: Vec::new(),
        }
    }

    /// Returns the elements of a plane mesh, each as a fan of triangles round its middle.
    pub(super) fn of_plane(mesh: &Mesh, elements: &[usize]) -> Self {
        let mut out = Patchwork::new([unit(0), unit(1)]);
        for &element in elements {
            let body = mesh.element_body[element];
            let middle = mesh.n_nodes() + element;
            let middle = out.point(body, [middle; 2], || vec![(middle, 1.0)]);
            for local in 0..mesh.shapes[element].n_facets() {
                let side = ring(mesh, Facet { element, local });
                let side: Vec<u32> = side
                    .map(|node| out.point(body, [node; 2], || vec![(node, 1.0)]))
                    .collect();
                for ends in side.windows(2) {
                    out.triangle([ends[0], ends[1], middle]);
                }
            }
        }
        out.finished()
    }

    /// Returns a patchwork of polygons, each given by its nodes.
    pub(super) fn of_polygons<'p>(
        axes: [Vector; 2],
        polygons: impl Iterator<Item = &'p [usize]>,
    ) -> Self {
        let mut out = Patchwork::new(axes);
        for polygon in polygons {
            let points: Vec<u32> = polygon
                .iter()
                .map(|&node| out.point(0, [node; 2], || vec![(node, 1.0)]))
                .collect();
            for k in 2..points.len() {
                out.triangle([points[0], points[k - 1], points[k]]);
            }
        }
        out.finished()
    }

    /// Returns the number of a point, which `key` identifies within its body.
    pub(super) fn point(&mut self, body: u32, key: [usize; 2], mix: impl FnOnce() -> Mix) -> u32 {
        let points = &mut self.points;
        *self.known.entry((body, key)).or_insert_with(|| {
            points.push(PatchworkPoint {
                mix: mix(),
                body,
                sign: [1.0; 2],
            });
            (points.len() - 1) as u32
        })
    }

    pub(super) fn triangle(&mut self, corners: [u32; 3]) {
        self.triangles.push(corners);
    }

    /// Completes the patchwork with its border, once all triangles are added.
    pub(super) fn finished(mut self) -> Self {
        let sides = self.triangles.iter();
        let sides = sides.flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
        self.border = border(sides).into_iter().map(|(a, b)| [a, b]).collect();
        self.known = BTreeMap::new();
        self
    }

    /// Returns the patchwork with its mirror images in the lines on which an axis is zero; points
    /// nearer to such a line than `small` are their own images.
    pub(super) fn mirrored(mut self, mesh: &Mesh, mirror: [bool; 2], small: f64) -> Self {
        for axis in (0..2).filter(|&axis| mirror[axis]) {
            let places = self.places(mesh, None);
            let mut image = Vec::with_capacity(places.len());
            for (k, place) in places.iter().enumerate() {
                if place[axis].abs() <= small {
                    image.push(k as u32);
                    continue;
                }
                image.push(self.points.len() as u32);
                let mut point = self.points[k].clone();
                point.sign[axis] = -1.0;
                self.points.push(point);
            }
            let images = self.triangles.iter();
            let images: Vec<[u32; 3]> = images
                .map(|t| [t[2], t[1], t[0]].map(|k| image[k as usize]))
                .collect();
            self.triangles.extend(images);
        }
        self.finished()
    }

    /// Whether there are no triangles.
    pub(super) fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// Returns the body of a point.
    pub(super) fn body(&self, point: u32) -> u32 {
        self.points[point as usize].body
    }

    /// Returns the positions of the points, displaced or not.
    pub(super) fn places(&self, mesh: &Mesh, displacement: Option<&[f64]>) -> Vec<[f64; 2]> {
        let at = |source: usize| place(mesh, displacement, source);
        let place = |point: &PatchworkPoint| {
            let sum = |sum, &(source, weight): &(usize, f64)| along(sum, weight, at(source));
            let x = point.mix.iter().fold([0.0; 3], sum);
            [0, 1].map(|d| point.sign[d] * dot(self.axes[d], x))
        };
        self.points.iter().map(place).collect()
    }

    /// Returns values of elements at the points: at a node the mean over the elements of the body
    /// round it.
    pub(super) fn of_elements(&self, mesh: &Mesh, value: impl Fn(usize) -> f64) -> Vec<f64> {
        let n = mesh.n_nodes();
        let mut out = vec![0.0; self.points.len()];
        for body in 0..mesh.bodies.len() as u32 {
            let mut sums = vec![(0.0, 0u32); n];
            for element in (0..mesh.n_elements()).filter(|&e| mesh.element_body[e] == body) {
                for &node in mesh.nodes(element) {
                    let sum = &mut sums[node as usize];
                    *sum = (sum.0 + value(element), sum.1 + 1);
                }
            }
            let at = |source: usize| match source.checked_sub(n) {
                Some(element) => value(element),
                None => sums[source].0 / f64::from(sums[source].1.max(1)),
            };
            for (out, point) in out
                .iter_mut()
                .zip(&self.points)
                .filter(|(_, p)| p.body == body)
            {
                *out = point
                    .mix
                    .iter()
                    .map(|&(source, weight)| weight * at(source))
                    .sum();
            }
        }
        out
    }

    /// Returns values at the points from values at nodes. No point may have an element as a source.
    pub(super) fn of_nodes(&self, value: impl Fn(usize) -> f64) -> Vec<f64> {
        let mixed = |point: &PatchworkPoint| {
            point
                .mix
                .iter()
                .map(|&(node, weight)| weight * value(node))
                .sum()
        };
        self.points.iter().map(mixed).collect()
    }

    /// Returns a sheet with values at the points.
    pub(super) fn sheet(&self, places: Vec<[f64; 2]>, values: Vec<f64>) -> TriangleSheet<'_> {
        TriangleSheet {
            triangles: &self.triangles,
            border: &self.border,
            places,
            values,
        }
    }
}

/// Returns the nodes of a facet, in a plane mesh from end to end, in a solid mesh round the facet:
/// corners and mid-side nodes alternate.
pub(super) fn ring(mesh: &Mesh, facet: Facet) -> impl Iterator<Item = usize> + '_ {
    let corners = mesh.facet_corners(facet);
    let nodes: Vec<usize> = mesh.facet_nodes(facet).collect();
    let sides = nodes.len() - corners;
    (0..corners).flat_map(move |k| {
        let side = (k < sides).then(|| nodes[corners + k]);
        [Some(nodes[k]), side].into_iter().flatten()
    })
}

/// Returns the position of a node, or of the middle of an element's nodes.
pub(super) fn place(mesh: &Mesh, displacement: Option<&[f64]>, source: usize) -> Vector {
    let node = |node: usize| {
        let mut x = mesh.point(node);
        if let Some(u) = displacement {
            (0..mesh.dimension).for_each(|d| x[d] += u[mesh.dimension * node + d]);
        }
        x
    };
    match source.checked_sub(mesh.n_nodes()) {
        None => node(source),
        Some(element) => {
            let nodes = mesh.nodes(element);
            let share = 1.0 / nodes.len() as f64;
            let sum = |sum, &n: &u32| along(sum, share, node(n as usize));
            nodes.iter().fold([0.0; 3], sum)
        }
    }
}

/// Returns the elements that a window of a plane shows, directly or as a mirror image, undeformed
/// or in one of some states.
pub(super) fn seen(
    mesh: &Mesh,
    axes: [Vector; 2],
    window: Window,
    mirror: [bool; 2],
    displacements: &[&[f64]],
) -> Vec<usize> {
    let window = match mirror {
        [false, false] => window,
        // The part that only a mirror image shows lies at the same distance on the other side.
        _ => window.mirrored(mirror),
    };
    let sees = |element: usize, u: Option<&[f64]>| {
        let at = |&node: &u32| axes.map(|axis| dot(axis, place(mesh, u, node as usize)));
        let corners: Vec<[f64; 2]> = mesh.nodes(element).iter().map(at).collect();
        window.sees(&corners)
    };
    (0..mesh.n_elements())
        .filter(|&element| {
            sees(element, None) || displacements.iter().any(|u| sees(element, Some(u)))
        })
        .collect()
}
