//! Compressed arrays of other programs, checked.

use crate::error::{Error, Result};
use crate::linalg::SymmetricCsc;

/// Which entries of a symmetric matrix are given.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Triangle {
    /// Both triangles; the upper one is read.
    #[default]
    Both,
    /// Row <= column.
    Upper,
    /// Row >= column.
    Lower,
}

/// A symmetric `n x n` matrix from its entries compressed by column: `n + 1` begins of the columns in `rows` and `values`.
/// Repeated entries are added; rows need not be sorted.
///
/// ```
/// use brinell::constrained::{ConstrainedStructure, Triangle, rows_from_csr, stiffness_from_csc};
/// use brinell::linalg::Backend;
///
/// # fn main() -> brinell::Result<()> {
/// // Two unit springs in a row, the first tied to the ground; a wall at distance 1 before the second end.
/// let k = stiffness_from_csc(2, &[0, 1, 3], &[0, 0, 1], &[2.0, -1.0, 1.0], Triangle::Upper)?;
/// let wall = rows_from_csr(2, &[0, 1], &[1], &[1.0])?;
/// let mut structure = ConstrainedStructure::new(Backend::default(), &k, &wall, &[1.0])?;
/// structure.start(&[0.0, 1.0])?;
/// let event = structure.step(2.0)?;
/// assert!((event.t - 0.5).abs() < 1e-15, "the wall is reached under half the load");
/// structure.step(2.0)?;
/// assert!((structure.forces()[0] - 1.5).abs() < 1e-14);
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// Lengths that do not fit, begins that fall, a row that is not in `0..n`, an entry outside of the triangle or not finite: by its
/// place and value.
pub fn stiffness_from_csc(
    n: usize,
    starts: &[i64],
    rows: &[i64],
    values: &[f64],
    triangle: Triangle,
) -> Result<SymmetricCsc> {
    check_starts(starts, n, rows.len(), values.len(), "column")?;
    let mut triplets = sprs::TriMatI::<f64, i64>::with_capacity((n, n), rows.len());
    for column in 0..n {
        for k in starts[column] as usize..starts[column + 1] as usize {
            let row = index(rows[k], n, "a row of the matrix,")?;
            let value = values[k];
            if !value.is_finite() {
                return Err(Error::input(format!(
                    "the matrix at row {row}, column {column} is {value}"
                )));
            }
            match (triangle, row <= column) {
                (Triangle::Both | Triangle::Upper, true) => {
                    triplets.add_triplet(row, column, value)
                }
                (Triangle::Both, false) => {}
                (Triangle::Lower, _) if row >= column => triplets.add_triplet(column, row, value),
                (Triangle::Upper | Triangle::Lower, _) => {
                    return Err(Error::input(format!(
                        "the matrix has an entry at row {row}, column {column}, which is not in its {} triangle",
                        if triangle == Triangle::Upper {
                            "upper"
                        } else {
                            "lower"
                        }
                    )));
                }
            }
        }
    }
    Ok(triplets.to_csc())
}

/// Contact rows on `n` freedoms from their coefficients compressed by row: begins of the rows in `freedoms` and `coefficients`, one
/// more than there are rows.
///
/// # Errors
/// Lengths that do not fit, begins that fall, a freedom that is not in `0..n`.
pub fn rows_from_csr(
    n: usize,
    starts: &[i64],
    freedoms: &[i64],
    coefficients: &[f64],
) -> Result<Vec<Vec<(usize, f64)>>> {
    let n_rows = starts.len().saturating_sub(1);
    check_starts(starts, n_rows, freedoms.len(), coefficients.len(), "row")?;
    starts
        .windows(2)
        .map(|ends| {
            (ends[0] as usize..ends[1] as usize)
                .map(|k| {
                    let freedom = index(freedoms[k], n, "a freedom of a contact row,")?;
                    Ok((freedom, coefficients[k]))
                })
                .collect()
        })
        .collect()
}

/// Begins that rise from 0 to the number of entries.
fn check_starts(starts: &[i64], n: usize, indices: usize, values: usize, what: &str) -> Result<()> {
    let rising = starts.first() == Some(&0) && starts.windows(2).all(|p| p[0] <= p[1]);
    let end = starts.last().and_then(|e| usize::try_from(*e).ok());
    if starts.len() != n + 1 || !rising || end != Some(indices) || indices != values {
        return Err(Error::input(format!(
            "the begins of {n} {what}s must be {} numbers that begin with 0, do not fall and end with the number of entries: {} were \
             given, {}from {:?} to {:?}, for {indices} indices and {values} values",
            n + 1,
            starts.len(),
            if rising { "" } else { "not rising " },
            starts.first(),
            starts.last()
        )));
    }
    Ok(())
}

fn index(value: i64, below: usize, what: &str) -> Result<usize> {
    usize::try_from(value)
        .ok()
        .filter(|v| *v < below)
        .ok_or_else(|| Error::input(format!("{what} {value} is not in 0..{below}")))
}

/// Rows and gaps that fit each other and the freedoms.
pub(super) fn check(n: usize, rows: &[Vec<(usize, f64)>], gaps: &[f64]) -> Result<()> {
    if rows.len() != gaps.len() {
        return Err(Error::input(format!(
            "{} contact rows have {} gaps: one each is needed",
            rows.len(),
            gaps.len()
        )));
    }
    for (i, row) in rows.iter().enumerate() {
        if let Some((freedom, _)) = row.iter().find(|(freedom, _)| *freedom >= n) {
            return Err(Error::input(format!(
                "contact row {i} names freedom {freedom} of a matrix with {n}"
            )));
        }
        if row.iter().any(|(_, c)| !c.is_finite()) || !gaps[i].is_finite() {
            return Err(Error::input(format!(
                "contact row {i} has a coefficient or a gap that is not finite"
            )));
        }
        if row.iter().all(|(_, c)| *c == 0.0) {
            return Err(Error::input(format!("contact row {i} is zero")));
        }
    }
    Ok(())
}
