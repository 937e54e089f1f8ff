//! The order in which CalculiX lists the integration points of an element.
//!
//! Its elements of the plane are solids of one layer: their points repeat over the thickness.
//! Points of full integration are in its order from the first.

use crate::mesh::Shape;
#[cfg(test)]
use crate::shape::Integration;

/// Points whose mean is listed.
pub(super) type Mean = &'static [usize];

/// The points of an element of a shape that has `n_points` of its own, in the order of CalculiX.
pub(super) fn order(shape: Shape, n_points: usize) -> Vec<Mean> {
    // First along the first coordinate, then along the second, then along the third.
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
        // Two points there, on the axis.
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
