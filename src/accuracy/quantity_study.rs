//! What a study says about a quantity.

use serde::Serialize;

/// What the runs are measured against.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StudyReference {
    /// The reference value.
    pub value: f64,
    /// Absolute uncertainty of the reference; 0 for a closed form.
    pub uncertainty: f64,
    /// The closed form's source, or how it was extrapolated.
    pub source: String,
    /// The value extrapolated from the meshes, where the reference is a closed form from which it
    /// differs by more than it is uncertain: what the model itself converges to.
    pub limit: Option<f64>,
}

/// The cheapest setting that reaches an accuracy.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Price {
    /// Relative accuracy.
    pub accuracy: f64,
    /// Index of the run; `None` where none reaches it.
    pub run: Option<usize>,
}

/// A quantity over all runs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct QuantityStudy {
    /// Path of the quantity; `all` stands for the worst of those that govern.
    pub quantity: String,
    /// The reference; `None` for `all`.
    pub reference: Option<StudyReference>,
    /// Error of each run relative to the largest reference of its kind; `None` where the run failed
    /// or lacks the quantity.
    pub errors: Vec<Option<f64>>,
    /// Observed order of convergence in the element size, by series of meshes.
    pub orders: Vec<(String, f64)>,
    /// Runs of which none is both faster and more accurate, by time.
    pub pareto: Vec<usize>,
    /// What accuracies cost.
    pub prices: Vec<Price>,
    /// The verdict in words, what limits, and which looser settings would do.
    pub words: Vec<String>,
}
