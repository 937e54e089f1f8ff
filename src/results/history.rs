//! The history of a run, and the path between its rows.

use super::{Results, number};
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

impl Results {
    /// Returns the initial unloading stiffness: the slope of the load over the approach in the
    /// first increment after the largest load, during which contact does not change. `None` if the
    /// history does not follow the approach ([`crate::scene::Program::history`]) or the load does
    /// not decrease.
    pub fn unloading_stiffness(&self) -> Option<f64> {
        let mut columns = self.history_columns.iter();
        let approach = columns.position(|column| column == "approach")?;
        let rows = self.history.iter();
        let points: Option<Vec<[f64; 2]>> = rows
            .map(|row| Some([*row.measured.get(approach)?, row.load]))
            .collect();
        stiffness(&points?)
    }
}

/// Returns the slope of a curve of force over depth just after its largest force.
fn stiffness(points: &[[f64; 2]]) -> Option<f64> {
    let top = (0..points.len()).max_by(|&a, &b| points[a][1].total_cmp(&points[b][1]))?;
    let [from, to] = [points[top], *points.get(top + 1)?];
    let slope = (from[1] - to[1]) / (from[0] - to[0]);
    (slope.is_finite() && slope > 0.0).then_some(slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stiffness_is_that_of_the_first_increment_after_the_largest_force() {
        let there_and_back = [[0.0, 0.0], [1.0, 4.0], [2.0, 10.0], [1.9, 9.0], [1.5, 0.0]];
        let followed = |rows: &[[f64; 2]]| Results {
            history_columns: vec!["other".into(), "approach".into()],
            history: rows
                .iter()
                .map(|&[approach, load]| HistoryRow {
                    load,
                    measured: vec![7.0, approach],
                    ..HistoryRow::default()
                })
                .collect(),
            ..Results::default()
        };
        let mut results = followed(&there_and_back);
        assert!((results.unloading_stiffness().unwrap() - 10.0).abs() < 1e-12);
        results.history_columns.clear();
        assert_eq!(results.unloading_stiffness(), None);
        assert_eq!(followed(&there_and_back[..3]).unloading_stiffness(), None);
        assert_eq!(followed(&[]).unloading_stiffness(), None);
    }
}
