//! The unloading stiffness, from the history of a run.

use super::Results;

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
    use crate::results::HistoryRow;

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
