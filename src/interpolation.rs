//! Linear interpolation between the rows of a table.

/// Interpolates the second column at the value `at` of the first: linear between rows, constant
/// beyond them; 0 without rows.
pub(crate) fn interpolate(rows: &[[f64; 2]], at: f64) -> f64 {
    let next = rows.partition_point(|row| row[0] <= at);
    match (next.checked_sub(1).map(|i| rows[i]), rows.get(next)) {
        (Some(a), Some(b)) => a[1] + (b[1] - a[1]) * (at - a[0]) / (b[0] - a[0]),
        (Some(a), None) => a[1],
        (None, Some(b)) => b[1],
        (None, None) => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::interpolate;

    #[test]
    fn rows_are_joined_by_straight_lines() {
        let rows = [[1.0, 2.0], [3.0, 6.0], [4.0, 0.0]];
        for (at, value) in [(0.0, 2.0), (1.0, 2.0), (2.5, 5.0), (3.5, 3.0), (9.0, 0.0)] {
            assert_eq!(interpolate(&rows, at), value);
        }
        assert_eq!(interpolate(&[], 1.0), 0.0);
    }
}
