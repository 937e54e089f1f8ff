//! How far a run has come: what it knows beside its engine, its results and its place.

use serde::{Deserialize, Serialize};

/// How far a run has come. Checkpoints hold it as it is.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
pub(super) struct Standing {
    /// Whether the material has yielded, so that increments are elastoplastic.
    pub(super) plastic: bool,
    /// Load factor (program's unit) at first yield.
    pub(super) yield_alpha: Option<f64>,
    /// Load factors (program's unit) between which the virgin structure is known to stay elastic.
    pub(super) elastic_range: [f64; 2],
    /// Number of targets behind.
    pub(super) done: usize,
    pub(super) seconds: Seconds,
}

/// Seconds by effect.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
pub(super) struct Seconds {
    pub(super) contact: f64,
    pub(super) plasticity: f64,
    pub(super) states: f64,
    pub(super) stresses: f64,
    pub(super) condensation: f64,
    pub(super) yield_load: f64,
}

impl Seconds {
    /// Takes note of the time that a drive took.
    pub(super) fn add_drive(&mut self, plastic: bool, spent: f64) {
        match plastic {
            true => self.plasticity += spent,
            false => self.contact += spent,
        }
    }
}
