//! Rigid motions as the contact freedoms see them.

use nalgebra::DVector;

/// A rigid motion restricted to the contact freedoms.
#[derive(Debug, Clone)]
pub(crate) struct Trace {
    /// Number of the part of the model that moves.
    pub part: usize,
    /// Displacement of each contact freedom.
    pub values: DVector<f64>,
    /// Amplitude of each rigid motion of the model that this trace represents.
    pub of_motion: DVector<f64>,
}
