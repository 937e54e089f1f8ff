//! Principal radii of a body on the command line.

use std::str::FromStr;

/// Radii in two planes at right angles: positive if convex, negative if hollow, infinite if flat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Radii(pub [f64; 2]);

impl FromStr for Radii {
    type Err = String;

    fn from_str(text: &str) -> Result<Radii, String> {
        let radii = text.split(',').map(|word| radius(word.trim()));
        let radii = radii.collect::<Option<Vec<f64>>>();
        match radii.as_deref() {
            Some(&[both]) => Ok(Radii([both; 2])),
            Some(&[first, second]) => Ok(Radii([first, second])),
            _ => Err(
                "one radius or two separated by a comma are wanted: positive convex, negative \
                 hollow, or flat"
                    .to_string(),
            ),
        }
    }
}

/// Reads a radius; a flat body may also be given as 0, as in scenes.
fn radius(word: &str) -> Option<f64> {
    match word {
        "flat" => Some(f64::INFINITY),
        _ => match word.parse::<f64>() {
            Ok(0.0) => Some(f64::INFINITY),
            Ok(radius) if !radius.is_nan() => Some(radius),
            _ => None,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn radii_in_every_form() {
        let flat = f64::INFINITY;
        for (text, radii) in [
            ("5", [5.0, 5.0]),
            ("-5.2,20", [-5.2, 20.0]),
            ("4, flat", [4.0, flat]),
            ("0,inf", [flat, flat]),
            ("flat", [flat, flat]),
        ] {
            assert_eq!(text.parse(), Ok(Radii(radii)), "{text}");
        }
        for text in ["", "5,", "1,2,3", "round", "nan"] {
            assert!(text.parse::<Radii>().is_err(), "{text}");
        }
    }
}
