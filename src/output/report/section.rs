//! Cuts through solids: the plane pieces of their elements.

use super::contact_frame::ContactFrame;
use super::patchwork::{Mix, Patchwork, ring};
use super::window::Window;
use crate::mesh::{Facet, Mesh};
use crate::space::{Vector, cross, difference, dot};
use std::collections::BTreeMap;

/// A plane through solids.
pub(super) struct SectionPlane {
    /// A point of the plane.
    pub origin: Vector,
    /// Axes of the plane; their cross product points out of the drawing.
    pub axes: [Vector; 2],
}

/// Fraction of a window's size by which a cut is moved away from nodes on its plane.
const OFF: f64 = 1e-6;

/// Orders of a tetrahedron's corners, all even permutations: with the corners on the near side
/// first, every cut runs round in the same sense.
const ONE: [[usize; 4]; 4] = [[0, 1, 2, 3], [1, 0, 3, 2], [2, 3, 0, 1], [3, 2, 1, 0]];
const TWO: [[usize; 4]; 6] = [
    [0, 1, 2, 3],
    [0, 2, 3, 1],
    [0, 3, 1, 2],
    [1, 2, 0, 3],
    [1, 3, 2, 0],
    [2, 3, 0, 1],
];

impl SectionPlane {
    /// Returns the planes through the centre of a contact along its axes and normal.
    pub(super) fn both(frame: &ContactFrame) -> [SectionPlane; 2] {
        frame.axes.map(|axis| SectionPlane {
            origin: frame.center,
            axes: [axis, frame.up],
        })
    }

    /// Returns the cuts of the elements that have nodes on both sides of the plane and lie in a
    /// window, undeformed or in one of some states.
    pub(super) fn pieces(
        &self,
        mesh: &Mesh,
        window: Window,
        mirror: [bool; 2],
        displacements: &[&[f64]],
    ) -> Patchwork {
        // With the part behind the drawing counted as above, pieces run round counter-clockwise.
        let behind = cross(self.axes[1], self.axes[0]);
        let mut height: Vec<f64> = (0..mesh.n_nodes())
            .map(|node| dot(behind, difference(mesh.point(node), self.origin)))
            .collect();
        // If the plane is a plane of symmetry, all bodies are on one side and have nodes on it: the
        // cut is moved aside.
        let off = OFF * window.size()[0];
        let highest = height.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let shift = if highest > 2.0 * off { -off } else { off };
        height.iter_mut().for_each(|h| *h += shift);
        let mut pieces = CutPieces {
            mesh,
            height,
            faces: BTreeMap::new(),
            out: Patchwork::new(self.axes),
        };
        let elements = super::patchwork::seen(mesh, self.axes, window, mirror, displacements);
        for element in elements {
            let above = |&node: &u32| pieces.height[node as usize] >= 0.0;
            let nodes = mesh.nodes(element);
            let first = above(&nodes[0]);
            if nodes.iter().any(|node| above(node) != first) {
                pieces.element(element);
            }
        }
        pieces.out.finished()
    }
}

/// Pieces of a cut under construction.
struct CutPieces<'m> {
    mesh: &'m Mesh,
    /// Height of each node above the plane.
    height: Vec<f64>,
    /// Middles of faces, numbered after nodes and elements, by the corners of the face.
    faces: BTreeMap<[usize; 4], (usize, Mix)>,
    out: Patchwork,
}

/// A corner of a tetrahedron: its number, the nodes and elements of which it is a mean, its height.
type Corner = (usize, Mix, f64);

impl CutPieces<'_> {
    /// Adds the cut through an element as cuts through tetrahedra. Each tetrahedron lies between a
    /// side of a face, the middle of that face and the middle of the element. Elements of any shape
    /// then fit together.
    fn element(&mut self, element: usize) {
        let (mesh, body) = (self.mesh, self.mesh.element_body[element]);
        let middle = mesh.n_nodes() + element;
        let middle = self.corner(middle, vec![(middle, 1.0)]);
        for local in 0..mesh.shapes[element].n_facets() {
            let facet = Facet { element, local };
            let face = self.face(facet);
            let nodes: Vec<usize> = ring(mesh, facet).collect();
            for (k, &a) in nodes.iter().enumerate() {
                let b = nodes[(k + 1) % nodes.len()];
                let [a, b] = [a, b].map(|node| self.corner(node, vec![(node, 1.0)]));
                self.tetrahedron(body, [&a, &b, &middle, &face]);
            }
        }
    }

    fn corner(&self, number: usize, mix: Mix) -> Corner {
        let mesh = self.mesh;
        let height = |source: usize| match source.checked_sub(mesh.n_nodes()) {
            None => self.height[source],
            Some(element) => {
                let nodes = mesh.nodes(element);
                let sum: f64 = nodes.iter().map(|&n| self.height[n as usize]).sum();
                sum / nodes.len() as f64
            }
        };
        let height = mix
            .iter()
            .map(|&(source, weight)| weight * height(source))
            .sum();
        (number, mix, height)
    }

    /// Returns the middle of a face.
    fn face(&mut self, facet: Facet) -> Corner {
        let reference = self.mesh.facet_reference(facet);
        let mut key = [usize::MAX; 4];
        let corners = self.mesh.facet_nodes(facet).take(reference.n_corners);
        key.iter_mut().zip(corners).for_each(|(k, node)| *k = node);
        key.sort_unstable();
        let next = self.mesh.n_nodes() + self.mesh.n_elements() + self.faces.len();
        let (number, mix) = self.faces.entry(key).or_insert_with(|| {
            let weights = (reference.functions)(reference.center()).values;
            (next, self.mesh.facet_nodes(facet).zip(weights).collect())
        });
        let (number, mix) = (*number, mix.clone());
        self.corner(number, mix)
    }

    /// Adds the piece of a tetrahedron whose corners are in positive order.
    fn tetrahedron(&mut self, body: u32, corners: [&Corner; 4]) {
        let above = corners.map(|corner| corner.2 >= 0.0);
        let of = |count: usize, side: bool| {
            let order =
                |order: &&[usize; 4]| (0..4).all(|k| (above[order[k]] == side) == (k < count));
            match count {
                1 => ONE.iter().find(order),
                _ => TWO.iter().find(order),
            }
        };
        let mut at = |i: usize, j: usize| self.cut(body, corners[i], corners[j]);
        match above.iter().filter(|above| **above).count() {
            1 => {
                let Some(&[i, j, k, l]) = of(1, true) else {
                    return;
                };
                let piece = [at(i, j), at(i, k), at(i, l)];
                self.out.triangle(piece);
            }
            2 => {
                let Some(&[i, j, k, l]) = of(2, true) else {
                    return;
                };
                let [a, b, c, d] = [at(i, k), at(i, l), at(j, l), at(j, k)];
                self.out.triangle([a, b, c]);
                self.out.triangle([a, c, d]);
            }
            3 => {
                let Some(&[i, j, k, l]) = of(1, false) else {
                    return;
                };
                let piece = [at(i, j), at(i, l), at(i, k)];
                self.out.triangle(piece);
            }
            _ => {}
        }
    }

    /// Returns the point at which the plane cuts the side between two corners.
    fn cut(&mut self, body: u32, a: &Corner, b: &Corner) -> u32 {
        let (a, b) = if a.0 < b.0 { (a, b) } else { (b, a) };
        let share = a.2 / (a.2 - b.2);
        self.out.point(body, [a.0, b.0], || {
            let from =
                a.1.iter()
                    .map(|&(source, weight)| (source, (1.0 - share) * weight));
            let to = b.1.iter().map(|&(source, weight)| (source, share * weight));
            from.chain(to).collect()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::contours::area;
    use super::super::patchwork::place;
    use super::*;
    use crate::mesh::Shape;
    use crate::space::{along, direction, unit};

    /// A distorted block of two hexahedra, one of them also as prisms or tetrahedra. The areas of
    /// cuts add up to its volume, whatever their direction: by the trapezoid rule over the cuts, up
    /// to a piece at each end.
    #[test]
    fn the_areas_of_cuts_add_up_to_the_volume() {
        let mut mesh = Mesh {
            dimension: 3,
            bodies: vec!["block".into()],
            ..Mesh::default()
        };
        for k in 0..12 {
            let [x, y, z] = [k % 3, k / 3 % 2, k / 6].map(f64::from);
            mesh.coordinates.extend([x, y, z + 0.2 * x * y * z]);
        }
        mesh.push_element(Shape::Hex8, 0, &[0, 1, 4, 3, 6, 7, 10, 9]);
        mesh.push_element(Shape::Prism6, 0, &[1, 2, 5, 7, 8, 11]);
        mesh.push_element(Shape::Prism6, 0, &[1, 5, 4, 7, 11, 10]);
        // The warped faces are cut in four triangles: the block's volume is that of its tetrahedra.
        let volume = |mesh: &Mesh| -> f64 {
            let mut sum = 0.0;
            for element in 0..mesh.n_elements() {
                let c = place(mesh, None, mesh.n_nodes() + element);
                for local in 0..mesh.shapes[element].n_facets() {
                    let facet = Facet { element, local };
                    let nodes: Vec<Vector> = ring(mesh, facet).map(|n| mesh.point(n)).collect();
                    let share = 1.0 / nodes.len() as f64;
                    let f = nodes.iter().fold([0.0; 3], |sum, x| along(sum, share, *x));
                    for k in 0..nodes.len() {
                        let [a, b] =
                            [nodes[k], nodes[(k + 1) % nodes.len()]].map(|x| difference(x, c));
                        sum += dot(difference(f, c), cross(a, b)) / 6.0;
                    }
                }
            }
            sum
        };
        let wide = Window {
            low: [-10.0; 2],
            high: [10.0; 2],
        };
        for across in [unit(0), unit(1), unit(2), direction([1.0, 2.0, -1.5])] {
            let first = direction(cross(across, [0.3, -1.0, 0.2]));
            let axes = [first, cross(across, first)];
            let n = 400;
            let reach = 4.0;
            let mut sum = 0.0;
            for k in 0..=n {
                let t = reach * (2.0 * k as f64 / n as f64 - 1.0);
                let cut = SectionPlane {
                    origin: along([0.0; 3], t, across),
                    axes,
                };
                let patchwork = cut.pieces(&mesh, wide, [false; 2], &[]);
                let places = patchwork.places(&mesh, None);
                let values = vec![0.0; places.len()];
                let found = area(&patchwork.sheet(places, values).above(f64::NEG_INFINITY));
                assert!(found >= -1e-12, "{across:?} {t}: {found}");
                sum += found * 2.0 * reach / n as f64;
            }
            // The error is a piece at each end as long as the step, with an area below 3.
            let step = 2.0 * reach / f64::from(n);
            let off = 3.0 * step;
            assert!((sum - volume(&mesh)).abs() < off, "{across:?}: {sum}");
        }
    }
}
