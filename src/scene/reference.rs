//! Published or exact values to compare with the computed ones.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Reference values: a closed form that applies to the scene, or single values with their source.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Reference {
    /// Hertz line contact at first yield (paper 5.1, Table I): radius of the cylinder.
    pub hertz_line: Option<RadiusOnly>,
    /// Hertz point contact at first yield: radius of the ball.
    pub hertz_point: Option<RadiusOnly>,
    /// Hertz' elliptical contact at first yield: the principal radii of the two bodies.
    pub hertz_ellipse: Option<TwoBodies>,
    /// Disc in a plate with a hole (paper 5.2, Table II).
    pub disc_in_plate: Option<NoParameters>,
    /// The quantity a single value is for: a path in `summary.json`, such as `yield.load` or
    /// `states.NAME.max_pressure`.
    pub quantity: Option<String>,
    /// The single value.
    pub value: Option<f64>,
    /// Where it comes from.
    pub source: Option<String>,
}

/// A closed form whose only geometric parameter is a radius.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RadiusOnly {
    /// The radius.
    pub radius: f64,
}

/// A closed form of two bodies whose principal directions are parallel.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TwoBodies {
    /// Principal radii of the first body: positive where convex, 0 or inf where flat.
    pub first: [f64; 2],
    /// Those of the second body, in the same directions.
    pub second: [f64; 2],
}

/// A closed form that needs no parameter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NoParameters {}
