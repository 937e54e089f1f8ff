//! Decimal places to which a mesh file gives its coordinates.

use super::Mesh;

/// Fewest digits of a coordinate that counts as rounded. A coordinate with fewer digits is more
/// likely to be meant as it is written.
const FEWEST_DIGITS: usize = 6;
/// Most digits of a coordinate that counts as rounded: a number with more has the precision of the
/// computer.
const MOST_DIGITS: usize = 14;

/// Spacing of the decimal places to which the coordinates of a mesh were rounded: that of its file
/// if the mesh was refined since, otherwise that of its coordinates.
pub(crate) fn rounding(mesh: &Mesh) -> f64 {
    mesh.places.max(last_place(mesh))
}

/// Spacing of the last decimal place to which the largest coordinates of a mesh were rounded when
/// it was written, for instance `1e-6`; 0 if the coordinates have the precision of the computer, or
/// so few digits that they are likely to be exact.
pub(crate) fn last_place(mesh: &Mesh) -> f64 {
    // The most digits of a coordinate, and the largest exponent of those with as many.
    let mut most = (0, i32::MIN);
    for x in mesh.coordinates.iter().filter(|x| **x != 0.0) {
        let (digits, exponent) = digits_of(*x);
        if digits > MOST_DIGITS {
            return 0.0;
        }
        most = most.max((digits, exponent));
    }
    let (most, largest) = most;
    match most < FEWEST_DIGITS {
        true => 0.0,
        // The reader of numbers gives the nearest power of ten, which `powi` misses.
        false => format!("1e{}", largest + 1 - most as i32)
            .parse()
            .unwrap_or(0.0),
    }
}

/// Number of digits of the shortest decimal number that is read as `x`, and the power of ten of the
/// first digit.
fn digits_of(x: f64) -> (usize, i32) {
    let text = format!("{x:e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let digits = mantissa.bytes().filter(u8::is_ascii_digit).count();
    (digits, exponent.parse().unwrap_or(0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(coordinates: &[f64]) -> f64 {
        last_place(&Mesh {
            coordinates: coordinates.to_vec(),
            ..Mesh::default()
        })
    }

    #[test]
    fn places_are_counted_from_the_largest_coordinate() {
        assert_eq!(of(&[1.234567, -12.5, 0.000001, 0.0]), 1e-6);
        assert_eq!(of(&[123.4567, 0.01234567]), 1e-4);
        assert_eq!(of(&[0.04231509, -0.0389]), 1e-8);
    }

    /// A grid of few digits is exact, and computed coordinates are not rounded to decimal places.
    #[test]
    fn exact_and_computed_coordinates_are_not_rounded() {
        assert_eq!(of(&[0.5, 0.125, 12.0, -3.75]), 0.0);
        assert_eq!(of(&[1.5, 0.1 + 0.2]), 0.0);
        assert_eq!(of(&[1.0 / 3.0, 1.234567]), 0.0);
        assert_eq!(of(&[]), 0.0);
    }
}
