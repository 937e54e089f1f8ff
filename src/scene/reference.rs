//! Published or exact values to compare with the computed ones.

use crate::space::{Space, Vector};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A reference value: either a closed form that applies to the scene, or a single value with its
/// source.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Reference {
    /// Hertz line contact at first yield (paper, sec. 5.1, Table I), with the radius of the
    /// cylinder.
    pub hertz_line: Option<RadiusOnly>,
    /// Hertz point contact at first yield, with the radius of the ball.
    pub hertz_point: Option<RadiusOnly>,
    /// Hertz's elliptical contact at first yield, with the principal radii of the two bodies.
    pub hertz_ellipse: Option<TwoBodies>,
    /// Disc in a plate with a hole (paper, sec. 5.2, Table II).
    pub disc_in_plate: Option<NoParameters>,
    /// Quantity of the single value: a path in `summary.json`, such as `yield.load` or
    /// `states.NAME.max_pressure`. With `at` it may also be a quantity at a point: `states.NAME.`
    /// followed by `pressure`, `displacement_x`, ... or a stress `stress_xx`, ... (axisymmetric:
    /// `stress_rr`, `stress_zz`, `stress_tt`, `stress_rz`).
    pub quantity: Option<String>,
    /// Coordinates of the point. The value at the nearest node is compared, or for a pressure the
    /// value at the nearest contact pair.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<Vec<f64>>,
    /// Body whose nodes are considered in the search for the nearest node; by default all bodies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub body: Option<String>,
    /// The reference value of `quantity`.
    pub value: Option<f64>,
    /// Source of the reference value.
    pub source: Option<String>,
}

impl Reference {
    /// The point that `at` gives, with missing coordinates set to 0.
    pub(crate) fn place(&self) -> Option<Vector> {
        let at = self.at.as_ref()?;
        Some(std::array::from_fn(|axis| {
            at.get(axis).copied().unwrap_or(0.0)
        }))
    }
}

/// A quantity at a point in a state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PlaceQuantity {
    /// Contact pressure.
    Pressure,
    /// Displacement along an axis, by its index.
    Displacement(usize),
    /// A component of stress, by its index in [`Space::components`].
    Stress(usize),
}

impl PlaceQuantity {
    /// Splits a path `states.NAME.KEY` into the name of the state and the quantity.
    pub(crate) fn of(path: &str, space: Space) -> Option<(&str, Self)> {
        let (state, key) = path.strip_prefix("states.")?.rsplit_once('.')?;
        let index = |of: &[&str], name| of.iter().position(|of| *of == name);
        let quantity = if key == "pressure" {
            PlaceQuantity::Pressure
        } else if let Some(axis) = key.strip_prefix("displacement_") {
            PlaceQuantity::Displacement(index(&["x", "y", "z"][..space.dimension()], axis)?)
        } else {
            let component = key.strip_prefix("stress_")?;
            PlaceQuantity::Stress(index(space.components(), component)?)
        };
        Some((state, quantity))
    }
}

/// A closed form whose only geometric parameter is a radius.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RadiusOnly {
    /// Radius of the cylinder or the ball in the closed form.
    pub radius: f64,
}

/// A closed form of two bodies whose principal directions are parallel.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TwoBodies {
    /// Principal radii of the first body: positive if convex, negative if hollow, 0 or inf if flat.
    pub first: [f64; 2],
    /// Principal radii of the second body, along the same directions as those of the first.
    pub second: [f64; 2],
}

/// A closed form that needs no parameter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NoParameters {}
