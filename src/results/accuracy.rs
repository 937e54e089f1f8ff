//! How wrong the figures of a run may be, and what became of a demanded accuracy.

use super::number;
use serde::{Deserialize, Serialize};

/// How wrong the figures of a run may be.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Accuracy {
    /// How the discretisation error was estimated.
    pub method: EstimateMethod,
    /// The other meshes that were run for it, finest first.
    pub companions: Vec<Companion>,
    /// A row per reported quantity.
    pub quantities: Vec<QuantityError>,
    /// What was demanded, chosen and reached, where the scene demands an accuracy.
    pub demand: Option<Demand>,
    /// Seconds that the estimate took.
    #[serde(deserialize_with = "number")]
    pub seconds: f64,
    /// Floating point operations of the factorisations and solves of the runs that were made for
    /// it.
    #[serde(default, deserialize_with = "number")]
    pub work: f64,
    /// What the estimate could not do, and why.
    pub notes: Vec<String>,
}

/// A demanded accuracy and what became of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Demand {
    /// The smallest relative error that was demanded.
    #[serde(deserialize_with = "number")]
    pub accuracy: f64,
    /// The demand as it was written: one accuracy, or one for each quantity that is named.
    #[serde(default)]
    pub demanded: String,
    /// Whether every stated error that is asked for is within it.
    pub reached: bool,
    /// Why it was not reached.
    #[serde(default)]
    pub reason: Option<String>,
    /// Quantities that are asked for and whose error was never estimated: nothing can be said of
    /// them, so that the demand is not reached.
    #[serde(default)]
    pub unknown: Vec<String>,
    /// The stated relative error of the quantity that is farthest beyond its demand, or nearest to
    /// it.
    #[serde(deserialize_with = "number")]
    pub stated: f64,
    /// Name of that quantity.
    #[serde(default)]
    pub worst: Option<String>,
    /// What was chosen, and why.
    pub choices: Vec<String>,
    /// Floating point operations of the factorisations and solves of all trials, their estimates
    /// included.
    #[serde(default, deserialize_with = "number")]
    pub work: f64,
}

/// How a discretisation error was estimated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EstimateMethod {
    /// Runs of the scene on other meshes of the same family, coarser ones where the run is fine
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
    /// Seconds that its run took.
    #[serde(deserialize_with = "number")]
    pub seconds: f64,
}

/// A reported quantity with its estimated errors, all absolute, in its own unit, and not negative.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct QuantityError {
    /// Path of the quantity in `summary.json`; states by name: `states.NAME.KEY`.
    pub quantity: String,
    /// The reported value.
    #[serde(deserialize_with = "number")]
    pub value: f64,
    /// The stated error: those of discretisation, path and algebra together.
    pub error: Option<f64>,
    /// The stated error over the largest size that the quantity has in the run.
    pub relative_error: Option<f64>,
    /// Estimated discretisation error, factor of safety included; of half widths with that of
    /// reading them off the pressures.
    pub discretisation: Option<f64>,
    /// Estimated error of the path: increments, plastic iteration and event tolerance.
    pub path: Option<f64>,
    /// Estimated error of the algebra: backward error, equilibrium, complementarity, and at first
    /// yield what `gamma` leaves of the largest stress.
    #[serde(deserialize_with = "number")]
    pub algebraic: f64,
    /// Order of convergence in the element size that three meshes or more show, believed or not.
    pub order: Option<f64>,
    /// The value that the meshes extrapolate to, where they show an order of convergence that is
    /// believed.
    #[serde(default)]
    pub extrapolated: Option<f64>,
}
