//! Smaller elements around points of a plane mesh.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Makes the elements of a plane mesh smaller around a point, by repeatedly dividing them into
/// four. Beyond `radius`, element sizes double each time that the distance from the point doubles.
/// A quadrilateral beside divided ones may become three triangles. `subdivisions` come first, an
/// extrusion or revolution comes afterwards.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LocalRefinement {
    /// Point around which elements become smaller.
    pub at: [f64; 2],
    /// Distance from the point up to which elements have the smallest size.
    pub radius: f64,
    /// Number of times that elements within the radius are divided: their size becomes `2^-times`.
    pub times: usize,
}

impl LocalRefinement {
    /// Largest number of times: the size becomes a millionth.
    pub(crate) const MOST_TIMES: usize = 20;

    /// Distance up to which elements are divided in a pass, the first of which has number 1.
    pub(crate) fn radius_in(&self, pass: usize) -> f64 {
        self.radius * 2f64.powi(self.times.saturating_sub(pass) as i32)
    }
}
