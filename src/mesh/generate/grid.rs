//! Structured patches of elements: `cells[0] x cells[1]` quadrilateral cells, each of which is one
//! quadrilateral or two triangles with alternating diagonals.
//!
//! A patch is addressed by half steps: `(2 i, 2 j)` is a corner, `(2 i + 1, 2 j)` the mid-side
//! position between two corners, and `(2 i + 1, 2 j + 1)` the middle of a cell, which is a node of
//! six-node triangles only, on the diagonal. The directions of the first and the second index form
//! a right-handed system.

use crate::mesh::{Curve, Facet, Mesh, Shape, Surface};
use crate::{Error, Result};
use std::ops::Range;

/// A body under construction.
pub(super) struct BodyBuilder<'m> {
    mesh: &'m mut Mesh,
    body: usize,
    name: String,
    shape: Shape,
}

/// A finished patch: nodes by half steps, elements by cells.
pub(super) struct PatchGrid {
    cells: [usize; 2],
    stride: usize,
    nodes: Vec<u32>,
    first_element: usize,
    triangles: bool,
}

/// A side of a patch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    /// The side where the second index is 0.
    Bottom,
    /// The side where the first index ends.
    Right,
    /// The side where the second index ends.
    Top,
    /// The side where the first index is 0.
    Left,
}

/// Marks a position without a node: the middle of a cell.
const NONE: u32 = u32::MAX;

/// An empty mesh of dimension 2.
pub(super) fn empty_mesh() -> Mesh {
    Mesh {
        dimension: 2,
        ..Mesh::default()
    }
}

impl<'m> BodyBuilder<'m> {
    /// Begins a body in a mesh.
    pub(super) fn new(mesh: &'m mut Mesh, name: &str, shape: Shape) -> Self {
        mesh.bodies.push(name.to_string());
        BodyBuilder {
            body: mesh.bodies.len() - 1,
            name: name.to_string(),
            mesh,
            shape,
        }
    }

    /// Adds a patch. `point` gives positions by half steps. `shared` gives a node that an earlier
    /// patch of the body already has at a position. With `closed` the second index runs around a
    /// circle, and its last line is its first.
    pub(super) fn patch(
        &mut self,
        cells: [usize; 2],
        closed: bool,
        point: impl Fn(usize, usize) -> [f64; 2],
        shared: impl Fn(usize, usize) -> Option<u32>,
    ) -> PatchGrid {
        let stride = if self.shape.is_quadratic() { 1 } else { 2 };
        let [columns, rows] = cells.map(|n| 2 * n / stride + 1);
        let mut nodes = vec![NONE; columns * rows];
        for row in 0..rows {
            for column in 0..columns {
                let (i, j) = (column * stride, row * stride);
                let middle = i % 2 == 1 && j % 2 == 1;
                nodes[row * columns + column] = if middle && self.shape != Shape::Tri6 {
                    NONE
                } else if closed && row == rows - 1 {
                    nodes[column]
                } else if let Some(node) = shared(i, j) {
                    node
                } else {
                    self.mesh.coordinates.extend_from_slice(&point(i, j));
                    (self.mesh.n_nodes() - 1) as u32
                };
            }
        }
        let grid = PatchGrid {
            cells,
            stride,
            nodes,
            first_element: self.mesh.n_elements(),
            triangles: self.shape.n_corners() == 3,
        };
        for j in 0..cells[1] {
            for i in 0..cells[0] {
                self.cell(&grid, i, j);
            }
        }
        grid
    }

    /// Adds the elements of one cell.
    fn cell(&mut self, grid: &PatchGrid, i: usize, j: usize) {
        // Corners, mid-side nodes and middle of the cell, counter-clockwise from (0, 0).
        let at = |a: usize, b: usize| grid.node(2 * i + a, 2 * j + b);
        let [a, b, c, d] = [at(0, 0), at(2, 0), at(2, 2), at(0, 2)];
        let mid = |a: usize, b: usize| {
            if self.shape.is_quadratic() {
                at(a, b)
            } else {
                NONE
            }
        };
        let [ab, bc, cd, da, m] = [mid(1, 0), mid(2, 1), mid(1, 2), mid(0, 1), mid(1, 1)];
        let n = self.shape.n_nodes();
        let mut push = |corners_then_mids: &[u32]| {
            self.mesh
                .push_element(self.shape, self.body, &corners_then_mids[..n]);
        };
        if !grid.triangles {
            push(&[a, b, c, d, ab, bc, cd, da]);
        } else if (i + j).is_multiple_of(2) {
            push(&[a, b, c, ab, bc, m]);
            push(&[a, c, d, m, cd, da]);
        } else {
            push(&[a, b, d, ab, m, da]);
            push(&[b, c, d, bc, cd, m]);
        }
    }

    /// Names facets of the body as the surface `BODY.piece`.
    pub(super) fn surface(
        &mut self,
        piece: &str,
        facets: Vec<Facet>,
        curve: Option<Curve>,
    ) -> Result<()> {
        let name = self.free_name(piece)?;
        self.mesh.surfaces.insert(name, Surface { facets, curve });
        Ok(())
    }

    /// Names a node of the body as the node set `BODY.piece`.
    pub(super) fn node_set(&mut self, piece: &str, node: u32) -> Result<()> {
        let name = self.free_name(piece)?;
        self.mesh.node_sets.insert(name, vec![node as usize]);
        Ok(())
    }

    fn free_name(&self, piece: &str) -> Result<String> {
        let name = format!("{}.{piece}", self.name);
        if self.mesh.surfaces.contains_key(&name) || self.mesh.node_sets.contains_key(&name) {
            return Err(Error::input(format!(
                "the set name `{name}` is used twice; rename the piece or the body"
            )));
        }
        Ok(name)
    }
}

impl PatchGrid {
    /// The node at half steps `(i, j)`; with linear elements both must be even.
    pub(super) fn node(&self, i: usize, j: usize) -> u32 {
        let columns = 2 * self.cells[0] / self.stride + 1;
        self.nodes[(j / self.stride) * columns + i / self.stride]
    }

    /// All facets on a side of the patch.
    pub(super) fn side(&self, side: Side) -> Vec<Facet> {
        let n = match side {
            Side::Bottom | Side::Top => self.cells[0],
            Side::Right | Side::Left => self.cells[1],
        };
        self.side_range(side, 0..n)
    }

    /// The facets of a range of cells on a side of the patch.
    pub(super) fn side_range(&self, side: Side, cells: Range<usize>) -> Vec<Facet> {
        cells.map(|k| self.facet(side, k)).collect()
    }

    fn facet(&self, side: Side, k: usize) -> Facet {
        let (i, j, quad_facet) = match side {
            Side::Bottom => (k, 0, 0),
            Side::Right => (self.cells[0] - 1, k, 1),
            Side::Top => (k, self.cells[1] - 1, 2),
            Side::Left => (0, k, 3),
        };
        let cell = j * self.cells[0] + i;
        if !self.triangles {
            return Facet {
                element: self.first_element + cell,
                local: quad_facet,
            };
        }
        // The cell's triangle on this side, and the triangle's local facet, as laid out by
        // `BodyBuilder::cell`.
        let (triangle, local) = match (side, (i + j).is_multiple_of(2)) {
            (Side::Bottom, _) => (0, 0),
            (Side::Right, true) => (0, 1),
            (Side::Right, false) => (1, 0),
            (Side::Top, _) => (1, 1),
            (Side::Left, true) => (1, 2),
            (Side::Left, false) => (0, 2),
        };
        Facet {
            element: self.first_element + 2 * cell + triangle,
            local,
        }
    }
}
