//! Estimated errors of the figures of a run, and the outcome of a demanded accuracy.

use super::number::number;
use serde::{Deserialize, Serialize};

/// Estimated errors of the figures of a run.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Accuracy {
    /// Method by which the discretisation error was estimated.
    pub method: EstimateMethod,
    /// The other meshes that were run for the estimate, finest first.
    pub companions: Vec<Companion>,
    /// A row per reported quantity.
    pub quantities: Vec<QuantityError>,
    /// The demanded accuracy with the choices made and the accuracy reached, if the scene demands
    /// one.
    pub demand: Option<Demand>,
    /// Seconds that the estimate took.
    #[serde(deserialize_with = "number")]
    pub seconds: f64,
    /// Floating point operations of the factorisations and solves of the runs that were made for
    /// the estimate.
    #[serde(default, deserialize_with = "number")]
    pub work: f64,
    /// Limits of the estimate: what it could not do, and why.
    pub notes: Vec<String>,
}

/// A demanded accuracy and its outcome.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Demand {
    /// The smallest relative error that was demanded.
    #[serde(deserialize_with = "number")]
    pub accuracy: f64,
    /// The demand as it was written: one accuracy, or one for each quantity that is named.
    #[serde(default)]
    pub demanded: String,
    /// Whether every stated error that is asked for is within the demand.
    pub reached: bool,
    /// The reason why the demand was not reached.
    #[serde(default)]
    pub reason: Option<String>,
    /// Quantities that are asked for and whose error was never estimated: nothing is known about
    /// them, so the demand is not reached.
    #[serde(default)]
    pub unknown: Vec<String>,
    /// The stated relative error of the quantity that is farthest beyond its demand, or nearest to
    /// it.
    #[serde(deserialize_with = "number")]
    pub stated: f64,
    /// Name of the quantity of [`Demand::stated`].
    #[serde(default)]
    pub worst: Option<String>,
    /// The choices made, with reasons.
    pub choices: Vec<String>,
    /// Floating point operations of the factorisations and solves of all trials, including their
    /// estimates.
    #[serde(default, deserialize_with = "number")]
    pub work: f64,
}

/// The method by which a discretisation error was estimated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EstimateMethod {
    /// Runs of the scene on other meshes of the same family, on coarser ones if the run is fine
    /// enough: the error follows from how the values change (L. Eca, M. Hoekstra 2014,
    /// doi:10.1016/j.jcp.2014.01.006).
    CoarserMeshes,
    /// The energy norm of the recovered stress error: a rough figure, for large meshes from files.
    EnergyNorm,
    /// No estimate was made.
    #[default]
    None,
}

/// Another mesh of the same family.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Companion {
    /// Element size of this mesh over that of the run.
    #[serde(deserialize_with = "number")]
    pub ratio: f64,
    /// Number of freedoms on this mesh.
    pub freedoms: usize,
    /// Seconds that the run on this mesh took.
    #[serde(deserialize_with = "number")]
    pub seconds: f64,
}

/// Parts of a state whose figures have errors of their own. Each entry holds a text within the
/// paths of the figures, a text at the end of the paths, and the figures in words.
const PARTS: [(&str, &str, &str); 10] = [
    (".residual_depth_by_body.", "", "dents of bodies"),
    (".patches.", ".force", "forces of patches"),
    (".patches.", ".max_pressure", "their pressures"),
    (".patches.", ".semi_axes.1", "their larger half axes"),
    (".patches.", ".semi_axes.2", "their smaller ones"),
    (".history.", ".approach", "approaches of contacts"),
    (".history.", ".area", "areas of contacts"),
    (".history.", "force", "forces on sets"),
    (".history.", "displacement", "displacements of sets"),
    (".contact_", ".force", "forces of contacts"),
];

/// Relative errors of values at places of the scene's reference values, whose paths begin with
/// `reference.`.
const AT_PLACES: [(&str, &str, &str); 3] = [
    ("", ".pressure", "pressures at places"),
    ("", ".displacement", "displacements at places"),
    ("", "", "stresses at places"),
];

impl QuantityError {
    /// Describes the quantity in words if it belongs to a part of a state: to a body, a contact, a
    /// patch, a set that the history follows, or a place.
    pub fn of_part(&self) -> Option<&'static str> {
        // Components end with their axis.
        let end = self.quantity.trim_end_matches(['x', 'y', 'z']);
        let end = end.trim_end_matches('_');
        let mut parts = match end.starts_with("reference.") {
            true => AT_PLACES.iter(),
            false => PARTS.iter(),
        };
        let found = parts.find(|(part, key, _)| end.contains(part) && end.ends_with(key));
        found.map(|(_, _, words)| *words)
    }
}

/// A reported quantity with its estimated errors, all absolute, not negative and in the unit of the
/// quantity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct QuantityError {
    /// Path of the quantity in `summary.json`; states are given by name: `states.NAME.KEY`. A
    /// figure of a part of a state has the path `states.NAME.residual_depth_by_body.BODY`,
    /// `states.NAME.contact_1.force`, `states.NAME.patches.1.KEY` (patches counted from 1 in the
    /// order of the summary), or `states.NAME.history.COLUMN` for a column that the scene adds to
    /// the history. A value at a place of the scene's reference values has the path
    /// `reference.1.states.NAME.stress_xx` (places counted from 1).
    pub quantity: String,
    /// The reported value.
    #[serde(deserialize_with = "number")]
    pub value: f64,
    /// The stated error: the sum of the errors of discretisation, path and algebra.
    pub error: Option<f64>,
    /// The stated error over the largest size that the quantity has in the run.
    pub relative_error: Option<f64>,
    /// Estimated discretisation error, factor of safety included; for half widths with the error of
    /// reading them from the pressures.
    pub discretisation: Option<f64>,
    /// Estimated error of the path: increments, plastic iteration and event tolerance.
    pub path: Option<f64>,
    /// Estimated error of the algebra: backward error, equilibrium, complementarity, and at first
    /// yield the part of the largest stress that `gamma` leaves undetermined.
    #[serde(deserialize_with = "number")]
    pub algebraic: f64,
    /// Order of convergence in the element size that three or more meshes show, whether or not it
    /// is trusted.
    pub order: Option<f64>,
    /// The value to which the meshes extrapolate, if they show an order of convergence that is
    /// trusted.
    #[serde(default)]
    pub extrapolated: Option<f64>,
}
