//! Results of a study for a quantity.

use serde::Serialize;

/// The reference value against which runs are measured.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StudyReference {
    /// The reference value.
    pub value: f64,
    /// Absolute uncertainty of the reference; 0 for a closed form.
    pub uncertainty: f64,
    /// The closed form's source, or how it was extrapolated.
    pub source: String,
    /// The value to which the model itself converges, extrapolated from the meshes; given if the
    /// reference is a closed form and differs from it by more than its uncertainty.
    pub limit: Option<f64>,
}

/// The cheapest setting with which an accuracy is reached.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Price {
    /// Relative accuracy.
    pub accuracy: f64,
    /// Index of the run with this setting; `None` if no run reaches the accuracy.
    pub run: Option<usize>,
}

/// A quantity over all runs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct QuantityStudy {
    /// Path of the quantity; `all` stands for the worst quantity that a demand on all includes.
    pub quantity: String,
    /// The reference; `None` for `all`.
    pub reference: Option<StudyReference>,
    /// Error of each run relative to the largest reference of its kind; `None` where the run failed
    /// or lacks the quantity.
    pub errors: Vec<Option<f64>>,
    /// Observed order of convergence in the element size, by series of meshes.
    pub orders: Vec<(String, f64)>,
    /// Runs to which no other run is superior in both time and accuracy, ordered by time.
    pub pareto: Vec<usize>,
    /// The cheapest setting for each accuracy.
    pub prices: Vec<Price>,
    /// Sentences: what accuracies cost, what limits them, and which looser settings would do.
    pub words: Vec<String>,
}
