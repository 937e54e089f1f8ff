//! The history of a run, and the path between its rows.

use super::number;
use serde::{Deserialize, Serialize};

/// A row of `history.csv`: one accepted increment.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct HistoryRow {
    /// Number, from 1.
    pub increment: usize,
    /// Load factor at its end, in the program's unit.
    #[serde(deserialize_with = "number")]
    pub alpha: f64,
    /// Total load.
    #[serde(deserialize_with = "number")]
    pub load: f64,
    /// Maximum contact pressure.
    #[serde(deserialize_with = "number")]
    pub max_pressure: f64,
    /// Contact half width.
    #[serde(deserialize_with = "number")]
    pub half_width: f64,
    /// Sum of the contact forces.
    #[serde(deserialize_with = "number")]
    pub contact_force: f64,
    /// Closed pairs.
    pub closed_pairs: usize,
    /// Gauss points with plastic strain.
    pub plastic_points: usize,
    /// Largest equivalent plastic strain.
    #[serde(deserialize_with = "number")]
    pub max_equivalent_plastic_strain: f64,
    /// Plastic iterations of this increment.
    pub iterations: usize,
    /// Trailing solves of this increment.
    pub trailing_solves: usize,
    /// Relative out-of-balance force at its end.
    #[serde(deserialize_with = "number")]
    pub residual: f64,
    /// What ended it: `closes: pair 12`, `opens: pair 3`, `target: NAME`, `step`, `yield`.
    pub event: String,
    /// What the scene asks for besides ([`crate::scene::Program::history`]), in the order of
    /// [`super::Results::history_columns`].
    #[serde(default)]
    pub measured: Vec<f64>,
}

/// A row of `path.csv`: a point of the path between two rows of the history. Contact forces are
/// taken to change evenly from the one to the other, which they do where nothing flows.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct PathPoint {
    /// Number of the increment that it is on the way of.
    pub increment: usize,
    /// Load factor, in the program's unit.
    #[serde(deserialize_with = "number")]
    pub alpha: f64,
    /// Total load.
    #[serde(deserialize_with = "number")]
    pub load: f64,
    /// Maximum contact pressure.
    #[serde(deserialize_with = "number")]
    pub max_pressure: f64,
    /// Contact half width.
    #[serde(deserialize_with = "number")]
    pub half_width: f64,
}
