//! The history of a run, and the path between its rows.

use super::number::number;
use serde::{Deserialize, Serialize};

/// A row of `history.csv`: one accepted increment.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct HistoryRow {
    /// Number of the increment, from 1.
    pub increment: usize,
    /// Load factor at the end of the increment, in the program's unit.
    #[serde(deserialize_with = "number")]
    pub alpha: f64,
    /// Total load at the end of the increment.
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
    /// Number of closed pairs.
    pub closed_pairs: usize,
    /// Number of Gauss points with plastic strain.
    pub plastic_points: usize,
    /// Largest equivalent plastic strain.
    #[serde(deserialize_with = "number")]
    pub max_equivalent_plastic_strain: f64,
    /// Number of plastic iterations in this increment.
    pub iterations: usize,
    /// Number of trailing solves in this increment.
    pub trailing_solves: usize,
    /// Relative out-of-balance force at the end of the increment.
    #[serde(deserialize_with = "number")]
    pub residual: f64,
    /// Event that ended the increment: `closes: pair 12`, `opens: pair 3`, `target: NAME`, `step`,
    /// `yield`.
    pub event: String,
    /// Values of the additional columns that the scene asks for
    /// ([`crate::scene::Program::history`]), in the order of [`super::Results::history_columns`].
    #[serde(default)]
    pub measured: Vec<f64>,
}

/// A row of `path.csv`: a point of the path between two rows of the history. Contact forces are
/// interpolated linearly between the rows, which is exact if nothing flows.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct PathPoint {
    /// Number of the increment to which the point belongs.
    pub increment: usize,
    /// Load factor, in the program's unit.
    #[serde(deserialize_with = "number")]
    pub alpha: f64,
    /// Total load at this point.
    #[serde(deserialize_with = "number")]
    pub load: f64,
    /// Maximum contact pressure.
    #[serde(deserialize_with = "number")]
    pub max_pressure: f64,
    /// Contact half width.
    #[serde(deserialize_with = "number")]
    pub half_width: f64,
}
