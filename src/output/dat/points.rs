//! The order in which CalculiX lists the integration points of an element.
//!
//! Elements of the plane are solids of one layer in CalculiX, so their points repeat over the
//! thickness. Only the rules with two points in each direction and the six points of a linear prism
//! differ from the order of CalculiX.

use crate::mesh::Shape;
#[cfg(test)]
use crate::shape::Integration;

/// Indices of points whose mean is listed as one point.
pub(super) type Mean = &'static [usize];

/// Returns the points of an element in the order of CalculiX. `n_points` is the number of
/// integration points that the element has in brinell.
pub(super) fn order(shape: Shape, n_points: usize) -> Vec<Mean> {
    // The first coordinate varies fastest, then the second, then the third.
    const SQUARE: [Mean; 4] = [&[0], &[1], &[3], &[2]];
    const CUBE: [Mean; 8] = [&[0], &[1], &[3], &[2], &[4], &[5], &[7], &[6]];
    const EACH: [Mean; 27] = [
        &[0],
        &[1],
        &[2],
        &[3],
        &[4],
        &[5],
        &[6],
        &[7],
        &[8],
        &[9],
        &[10],
        &[11],
        &[12],
        &[13],
        &[14],
        &[15],
        &[16],
        &[17],
        &[18],
        &[19],
        &[20],
        &[21],
        &[22],
        &[23],
        &[24],
        &[25],
        &[26],
    ];
    match (shape, n_points) {
        (Shape::Quad4 | Shape::Quad8, 4) => SQUARE.repeat(2),
        (Shape::Quad8, 9) => EACH[..9].repeat(3),
        (Shape::Tri3, 1) => EACH[..1].repeat(2),
        (Shape::Tri6, 3) => EACH[..3].repeat(3),
        (Shape::Hex8 | Shape::Hex20, 8) => CUBE.to_vec(),
        // CalculiX has two points in a prism, both on its axis.
        (Shape::Prism6, 6) => vec![&[0, 1, 2], &[3, 4, 5]],
        _ => EACH.iter().copied().take(n_points).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every point of a shape is in the list.
    #[test]
    fn no_point_is_left_out() {
        let integrated = |by| Shape::ALL.into_iter().map(move |shape| (shape, by));
        for (shape, by) in Integration::ALL.into_iter().flat_map(integrated) {
            let n = shape.n_points(by);
            let mut found: Vec<usize> = order(shape, n).concat();
            found.sort_unstable();
            found.dedup();
            assert_eq!(found, (0..n).collect::<Vec<_>>(), "{shape:?}");
        }
    }
}
