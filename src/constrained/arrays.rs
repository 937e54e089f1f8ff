//! Compressed arrays from other programs, checked and converted.

use crate::error::{Error, Result};
use crate::index::Index;
use crate::linalg::SymmetricCsc;
use std::ops::Range;

/// Triangle of a symmetric matrix whose entries are given.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Triangle {
    /// Entries of both triangles; only the upper triangle is read.
    #[default]
    Both,
    /// Entries of the upper triangle: row <= column.
    Upper,
    /// Entries of the lower triangle: row >= column.
    Lower,
}

/// Builds a symmetric `n x n` matrix from entries that are compressed by column. `starts` holds
/// `n + 1` positions in `rows` and `values` at which the columns start. Repeated entries are added;
/// rows need not be sorted.
///
/// ```
/// use brinell::constrained::{ConstrainedStructure, Triangle, rows_from_csr, stiffness_from_csc};
/// use brinell::linalg::Backend;
///
/// # fn main() -> brinell::Result<()> {
/// // Two unit springs in a row, the first tied to the ground; a wall at distance 1 before the
/// // second end.
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
/// The arrays may have indices of any width and are not copied. Only the result is allocated: the
/// upper triangle with 64-bit indices, 16 bytes for each entry, in the form that the factorisation
/// takes.
///
/// # Errors
/// Lengths that do not fit, starts that decrease, a row that is not in `0..n`, an entry that is
/// outside the triangle or not finite; the message names place and value.
pub fn stiffness_from_csc<S: Index, I: Index>(
    n: usize,
    starts: &[S],
    rows: &[I],
    values: &[f64],
    triangle: Triangle,
) -> Result<SymmetricCsc> {
    check_starts(starts, n, rows.len(), values.len(), "column")?;
    // Starts of the columns of the upper triangle, shifted by one; the fill below advances them.
    let mut columns = vec![0i64; n + 1];
    for column in 0..n {
        for k in range(starts, column) {
            let row = index(rows[k], n, "a row of the matrix,")?;
            if !values[k].is_finite() {
                return Err(Error::input(format!(
                    "the matrix at row {row}, column {column} is {}",
                    values[k]
                )));
            }
            if let Some([_, column]) = in_upper(triangle, row, column)? {
                columns[column + 1] += 1;
            }
        }
    }
    for column in 0..n {
        columns[column + 1] += columns[column];
    }
    let entries = columns[n] as usize;
    let (mut kept_rows, mut kept) = (vec![0i64; entries], vec![0.0; entries]);
    for column in 0..n {
        for k in range(starts, column) {
            let row = index(rows[k], n, "a row of the matrix,")?;
            if let Some([row, column]) = in_upper(triangle, row, column)? {
                let at = columns[column] as usize;
                (kept_rows[at], kept[at]) = (row as i64, values[k]);
                columns[column] += 1;
            }
        }
    }
    // The fill has advanced each start to the start of the next column.
    columns.rotate_right(1);
    columns[0] = 0;
    sort_and_add(&mut columns, &mut kept_rows, &mut kept);
    Ok(SymmetricCsc::new_csc((n, n), columns, kept_rows, kept))
}

/// Returns row and column of an entry in the upper triangle; `None` if the entry is not read.
///
/// # Errors
/// An entry outside the given triangle.
fn in_upper(triangle: Triangle, row: usize, column: usize) -> Result<Option<[usize; 2]>> {
    let name = match triangle {
        Triangle::Both | Triangle::Upper if row <= column => return Ok(Some([row, column])),
        Triangle::Both => return Ok(None),
        Triangle::Lower if row >= column => return Ok(Some([column, row])),
        Triangle::Lower => "lower",
        Triangle::Upper => "upper",
    };
    Err(Error::input(format!(
        "the matrix has an entry at row {row}, column {column}, which is not in its {name} triangle"
    )))
}

/// Sorts the rows of each unsorted column and adds repeated entries, in the order in which they
/// were given.
fn sort_and_add(columns: &mut [i64], rows: &mut Vec<i64>, values: &mut Vec<f64>) {
    let mut end = 0;
    let mut begin = 0;
    for column in 1..columns.len() {
        let own = begin..columns[column] as usize;
        begin = own.end;
        if !rows[own.clone()].is_sorted() {
            let mut entries: Vec<(i64, f64)> = own.clone().map(|k| (rows[k], values[k])).collect();
            entries.sort_by_key(|entry| entry.0);
            for (k, entry) in own.clone().zip(entries) {
                (rows[k], values[k]) = entry;
            }
        }
        let first = end;
        for k in own {
            if end > first && rows[end - 1] == rows[k] {
                values[end - 1] += values[k];
            } else {
                (rows[end], values[end]) = (rows[k], values[k]);
                end += 1;
            }
        }
        columns[column] = end as i64;
    }
    rows.truncate(end);
    values.truncate(end);
}

/// Builds contact rows on `n` freedoms from coefficients that are compressed by row. `starts` holds
/// the positions in `freedoms` and `coefficients` at which the rows start, and the end of the last
/// row.
///
/// # Errors
/// Lengths that do not fit, starts that decrease, a freedom that is not in `0..n`.
pub fn rows_from_csr<S: Index, I: Index>(
    n: usize,
    starts: &[S],
    freedoms: &[I],
    coefficients: &[f64],
) -> Result<Vec<Vec<(usize, f64)>>> {
    let n_rows = starts.len().saturating_sub(1);
    check_starts(starts, n_rows, freedoms.len(), coefficients.len(), "row")?;
    (0..n_rows)
        .map(|row| {
            range(starts, row)
                .map(|k| {
                    let freedom = index(freedoms[k], n, "a freedom of a contact row,")?;
                    Ok((freedom, coefficients[k]))
                })
                .collect()
        })
        .collect()
}

/// Range of the entries of a column (or row); the starts have been checked.
fn range<I: Index>(starts: &[I], column: usize) -> Range<usize> {
    let place = |at: usize| starts[at].try_into().unwrap_or(0);
    place(column)..place(column + 1)
}

/// Checks that starts rise from 0 to the number of entries.
fn check_starts<I: Index>(
    starts: &[I],
    n: usize,
    indices: usize,
    values: usize,
    what: &str,
) -> Result<()> {
    let place = |begin: &I| (*begin).try_into().ok();
    let rising = starts.first().and_then(place) == Some(0)
        && starts.windows(2).all(|p| place(&p[0]) <= place(&p[1]))
        && starts.iter().all(|begin| place(begin).is_some());
    let end = starts.last().and_then(place);
    if starts.len().checked_sub(1) != Some(n)
        || !rising
        || end != Some(indices)
        || indices != values
    {
        let say = |begin: Option<&I>| begin.map_or("none".to_string(), I::to_string);
        return Err(Error::input(format!(
            "the starts of {n} {what}s must be one number more, begin with 0, never decrease \
             and end with the number of entries: {} were given, {}from {} to {}, for {indices} \
             indices and {values} values",
            starts.len(),
            if rising { "" } else { "decreasing " },
            say(starts.first()),
            say(starts.last())
        )));
    }
    Ok(())
}

fn index(value: impl Index, below: usize, what: &str) -> Result<usize> {
    (value.below(below)).ok_or_else(|| Error::input(format!("{what} {value} is not in 0..{below}")))
}

/// Checks that rows and gaps fit each other and the freedoms.
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
