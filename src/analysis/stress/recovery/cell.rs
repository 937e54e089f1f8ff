//! Cells of an element in which the maximum of the stress is searched: images of a square or cube.

use crate::shape::{CORNERS_OF_CUBE, Place, Shape};
use crate::space::along;

/// An element, or the part of a triangle, prism or tetrahedron round one of its corners, as the
/// image of `[-1, 1]^D`.
pub(super) struct Cell<const D: usize, const N: usize> {
    pub(super) element: u32,
    shape: Shape,
    nodes: [[f64; D]; N],
    /// Reference coordinates of the cell's corners, in the order of [`CORNERS_OF_CUBE`].
    corners: [Place; 8],
}

impl<const D: usize, const N: usize> Cell<D, N> {
    /// The cells that together make up an element.
    pub(super) fn of(element: u32, shape: Shape, nodes: [[f64; D]; N]) -> Vec<Self> {
        let cell = |corners: [Place; 8]| Cell {
            element,
            shape,
            nodes,
            corners,
        };
        let row = shape.reference();
        if row.n_corners == 1 << D {
            return vec![cell(
                CORNERS_OF_CUBE.map(|[x, y, z]| [x, y, if D == 2 { 0.0 } else { z }]),
            )];
        }
        let mean = |of: &[usize]| {
            let share = 1.0 / of.len() as f64;
            let sum = |sum, &k: &usize| along(sum, share, row.nodes[k]);
            of.iter().fold([0.0; 3], sum)
        };
        let round = |a: usize| {
            if !row.n_corners.is_multiple_of(4) {
                // The element is a triangle, or a prism with a base and a top.
                let [b, c] = [(a + 1) % 3, (a + 2) % 3];
                let at = |start: usize| {
                    let [a, b, c] = [a, b, c].map(|k| start + k);
                    [mean(&[a]), mean(&[a, b]), mean(&[a, b, c]), mean(&[a, c])]
                };
                let [base, top] = [at(0), at(row.n_corners - 3)];
                return cell(std::array::from_fn(|k| [base, top][k / 4][k % 4]));
            }
            let [b, c, d] = [(a + 1) % 4, (a + 2) % 4, (a + 3) % 4];
            cell([
                mean(&[a]),
                mean(&[a, b]),
                mean(&[a, b, c]),
                mean(&[a, c]),
                mean(&[a, d]),
                mean(&[a, b, d]),
                mean(&[a, b, c, d]),
                mean(&[a, c, d]),
            ])
        };
        let n = if row.n_corners == 4 { 4 } else { 3 };
        (0..n).map(round).collect()
    }

    /// The coordinates of a point of the cell.
    pub(super) fn point(&self, at: [f64; D]) -> [f64; D] {
        let mut place = [0.0; 3];
        for (corner, sign) in self.corners.iter().zip(CORNERS_OF_CUBE).take(1 << D) {
            let weight: f64 = (0..D).map(|d| 0.5 * (1.0 + sign[d] * at[d])).product();
            place = along(place, weight, *corner);
        }
        let functions = self.shape.functions(place).values;
        let mut point = [0.0; D];
        for (n, node) in functions.iter().zip(&self.nodes) {
            for d in 0..D {
                point[d] += n * node[d];
            }
        }
        point
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Maximum, SPACINGS};
    use super::*;

    /// The search covers a whole triangle, whichever of its corners comes first. The highest point
    /// of this function lies on the side between the last two corners of one numbering, and the
    /// corners are higher than the points between them.
    #[test]
    fn a_triangle_is_searched_whole() {
        let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let f = |[x, y]: [f64; 2]| 1.0 + 0.02 * (y - 1.0) + 0.04 * x - 0.05 * x * x;
        // On x + y = 1 the function is 1 + 0.02 x - 0.05 x^2, with its maximum at x = 0.2.
        for first in 0..3 {
            let mut nodes = [[0.0; 2]; 8];
            for (i, node) in nodes.iter_mut().take(3).enumerate() {
                *node = corners[(first + i) % 3];
            }
            let highest = Cell::of(0, Shape::Tri3, nodes).into_iter().map(|cell| {
                let mut top = Maximum::unknown();
                for spacing in SPACINGS {
                    top.look_around(spacing, &mut |at, _| f(cell.point(at)));
                }
                (top.value, cell.point(top.at))
            });
            let (value, at) = highest.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
            assert!((value - 1.002).abs() < 1e-9, "{first}: {value}");
            assert!((at[0] - 0.2).abs() < 1e-4 && (at[0] + at[1] - 1.0).abs() < 1e-12);
        }
    }
}
