//! Structured bodies in space, made of `nx x ny x nz` hexahedral cells.
//!
//! Points are addressed by half steps, as in the plane (`grid`): three even indices address a
//! corner, and two even indices with an odd one address the middle of an edge.

use crate::mesh::{Facet, Mesh, Shape, Surface};
use crate::{Error, Result};
use std::ops::Range;

/// A side of a structured body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum BrickSide {
    /// The side where the first index is 0.
    Left,
    /// The side where the first index ends.
    Right,
    /// The side where the second index is 0.
    Front,
    /// The side where the second index ends.
    Back,
    /// The side where the third index is 0.
    Bottom,
    /// The side where the third index ends.
    Top,
}

impl BrickSide {
    /// All sides, each with its name.
    pub(super) const ALL: [(&'static str, BrickSide); 6] = [
        ("left", BrickSide::Left),
        ("right", BrickSide::Right),
        ("front", BrickSide::Front),
        ("back", BrickSide::Back),
        ("bottom", BrickSide::Bottom),
        ("top", BrickSide::Top),
    ];

    /// Axis normal to the side, and whether the side lies at the end of this axis.
    fn place(self) -> (usize, bool) {
        match self {
            BrickSide::Left => (0, false),
            BrickSide::Right => (0, true),
            BrickSide::Front => (1, false),
            BrickSide::Back => (1, true),
            BrickSide::Bottom => (2, false),
            BrickSide::Top => (2, true),
        }
    }

    /// Local number of the facet of a hexahedron that lies on this side.
    fn facet(self) -> usize {
        match self {
            BrickSide::Left => 5,
            BrickSide::Right => 3,
            BrickSide::Front => 2,
            BrickSide::Back => 4,
            BrickSide::Bottom => 0,
            BrickSide::Top => 1,
        }
    }
}

/// A finished structured body of hexahedra.
pub(super) struct Brick {
    cells: [usize; 3],
    first_element: usize,
    name: String,
    /// Nodes by half steps; [`NONE`] in the middle of faces and cells.
    nodes: Vec<u32>,
}

/// Marks a place that has no node.
const NONE: u32 = u32::MAX;

impl Brick {
    /// Adds a body of hexahedra to the mesh; `point` gives the position for each triple of half
    /// steps.
    ///
    /// # Errors
    /// `Input` for a shape that is not a hexahedron.
    pub(super) fn add(
        mesh: &mut Mesh,
        name: &str,
        shape: Shape,
        cells: [usize; 3],
        point: impl Fn([usize; 3]) -> [f64; 3],
    ) -> Result<Self> {
        if !matches!(shape, Shape::Hex8 | Shape::Hex20) {
            return Err(Error::input(format!(
                "element = \"{}\": a generator of solids makes hex8 or hex20",
                shape.name()
            )));
        }
        mesh.bodies.push(name.to_string());
        let body = mesh.bodies.len() - 1;
        let mut out = Brick {
            cells,
            first_element: mesh.n_elements(),
            name: name.to_string(),
            nodes: vec![NONE; cells.iter().map(|n| 2 * n + 1).product()],
        };
        let [nx, ny, nz] = cells.map(|n| 2 * n + 1);
        for k in 0..nz {
            for j in 0..ny {
                for i in 0..nx {
                    let odd = [i, j, k].iter().filter(|index| *index % 2 == 1).count();
                    if odd == 0 || odd == 1 && shape.is_quadratic() {
                        let at = out.index([i, j, k]);
                        out.nodes[at] = mesh.n_nodes() as u32;
                        mesh.coordinates.extend(point([i, j, k]));
                    }
                }
            }
        }
        let row = shape.reference();
        for k in 0..cells[2] {
            for j in 0..cells[1] {
                for i in 0..cells[0] {
                    // Reference coordinates -1, 0, 1 correspond to half steps 0, 1, 2 of the cell.
                    let node = |place: &[f64; 3]| {
                        let step = |d: usize, cell: usize| 2 * cell + (place[d] + 1.0) as usize;
                        out.nodes[out.index([step(0, i), step(1, j), step(2, k)])]
                    };
                    let nodes: Vec<u32> = row.nodes.iter().map(node).collect();
                    mesh.push_element(shape, body, &nodes);
                }
            }
        }
        Ok(out)
    }

    fn index(&self, [i, j, k]: [usize; 3]) -> usize {
        let [nx, ny, _] = self.cells.map(|n| 2 * n + 1);
        (k * ny + j) * nx + i
    }

    /// The node at the given half steps.
    pub(super) fn node(&self, at: [usize; 3]) -> usize {
        self.nodes[self.index(at)] as usize
    }

    /// Names a part of a side as a surface: the cells within `ranges` that `takes` accepts. The
    /// ranges are given along the two axes in the side, in ascending order of the axes.
    pub(super) fn surface(
        &self,
        mesh: &mut Mesh,
        name: &str,
        face: BrickSide,
        ranges: [Range<usize>; 2],
        takes: impl Fn(usize, usize) -> bool,
    ) {
        let (axis, at_end) = face.place();
        let others: Vec<usize> = (0..3).filter(|d| *d != axis).collect();
        let mut facets = Vec::new();
        for b in ranges[1].clone() {
            for a in ranges[0].clone().filter(|a| takes(*a, b)) {
                let mut cell = [0; 3];
                cell[axis] = if at_end { self.cells[axis] - 1 } else { 0 };
                (cell[others[0]], cell[others[1]]) = (a, b);
                let [i, j, k] = cell;
                let element = (k * self.cells[1] + j) * self.cells[0] + i;
                facets.push(Facet {
                    element: self.first_element + element,
                    local: face.facet(),
                });
            }
        }
        if !facets.is_empty() {
            let surface = Surface {
                facets,
                curve: None,
            };
            mesh.surfaces
                .insert(format!("{}.{name}", self.name), surface);
        }
    }

    /// Names a whole side of the body as a surface.
    pub(super) fn side(&self, mesh: &mut Mesh, name: &str, face: BrickSide) {
        let (axis, _) = face.place();
        let others: Vec<usize> = (0..3).filter(|d| *d != axis).collect();
        let ranges = [0..self.cells[others[0]], 0..self.cells[others[1]]];
        self.surface(mesh, name, face, ranges, |_, _| true);
    }
}
