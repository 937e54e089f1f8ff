//! The size of a round body or of a bore, by radius or diameter.

use crate::cli::values::positive;
use clap::Args;

/// A radius, if one is given.
#[derive(Debug, Args)]
pub(in crate::cli) struct Size {
    /// Radius of the ball, the roller or the bore [mm]; by default 10 on a flat, 5 in a groove and
    /// for `iso76` and `hardness`, 50 for a bore
    #[arg(
        long,
        value_name = "R",
        value_parser = positive,
        allow_negative_numbers = true
    )]
    radius: Option<f64>,
    /// Diameter in place of the radius [mm]
    #[arg(
        long,
        value_name = "D",
        value_parser = positive,
        allow_negative_numbers = true,
        conflicts_with = "radius"
    )]
    diameter: Option<f64>,
}

impl Size {
    /// Returns the radius, given as radius or diameter; `by_default` if neither is given.
    pub fn radius_or(&self, by_default: f64) -> f64 {
        let by_diameter = self.diameter.map(|diameter| 0.5 * diameter);
        self.radius.or(by_diameter).unwrap_or(by_default)
    }
}
