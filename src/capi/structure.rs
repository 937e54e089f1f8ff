//! The lower level of the interface: a stiffness and contact rows that the caller gives.

use super::border::{
    SizePrefixed, exclusive, free, guarded, hand_out, shared, slice, slice_mut, take,
};
use super::options::{backend, brinell_options};
use super::results::lend;
use crate::constrained::{ConstrainedStructure, Triangle, rows_from_csr, stiffness_from_csc};
use crate::contact::Change;
use crate::error::{Error, Result};
use crate::linalg::SymmetricCsc;

/// A stiffness with contact rows, factored and condensed.
pub struct brinell_structure {
    structure: ConstrainedStructure,
    /// Changes of the last event: row, and whether it closes.
    changes: Vec<(usize, bool)>,
}

/// Both triangles are given; the upper one is read.
pub const BRINELL_TRIANGLE_BOTH: i32 = 0;
/// The upper triangle (row <= column) is given.
pub const BRINELL_TRIANGLE_UPPER: i32 = 1;
/// The lower triangle (row >= column) is given.
pub const BRINELL_TRIANGLE_LOWER: i32 = 2;

/// A sparse symmetric matrix, compressed by column; repeated entries are added.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct brinell_matrix {
    /// sizeof(brinell_matrix).
    pub size: usize,
    /// Number of rows and columns.
    pub n: usize,
    /// n + 1 starts of the columns in rows and values.
    pub column_starts: *const i64,
    /// Row of each entry, from 0.
    pub rows: *const i64,
    /// Value of each entry.
    pub values: *const f64,
    /// One of BRINELL_TRIANGLE_...
    pub triangle: i32,
}

// SAFETY: repr(C), begins with its size, numbers and pointers.
unsafe impl SizePrefixed for brinell_matrix {
    const NAME: &'static str = "brinell_matrix";
}

/// Contact rows B, compressed by row, and gaps delta: g = delta - B u >= 0.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct brinell_rows {
    /// sizeof(brinell_rows).
    pub size: usize,
    /// Number of rows.
    pub n_rows: usize,
    /// n_rows + 1 starts of the rows in freedoms and coefficients.
    pub row_starts: *const i64,
    /// Freedom of each coefficient, from 0.
    pub freedoms: *const i64,
    /// The coefficients.
    pub coefficients: *const f64,
    /// n_rows gaps without load; negative is interference.
    pub gaps: *const f64,
}

// SAFETY: repr(C), begins with its size, numbers and pointers.
unsafe impl SizePrefixed for brinell_rows {
    const NAME: &'static str = "brinell_rows";
}

/// Returns the number of entries that an array of starts implies; other errors in the array are
/// found later.
fn entries(starts: &[i64], what: &str) -> Result<usize> {
    let end = starts.last().and_then(|n| usize::try_from(*n).ok());
    end.ok_or_else(|| Error::input(format!("{what} must end with the number of entries")))
}

/// # Safety
/// The arrays are as long as the structure says.
unsafe fn read_matrix(matrix: &brinell_matrix) -> Result<SymmetricCsc> {
    let n = matrix.n;
    // SAFETY: as vouched for by the caller.
    let (starts, rows, values) = unsafe {
        let starts = slice(matrix.column_starts, n.saturating_add(1), "column_starts")?;
        let entries = entries(starts, "column_starts")?;
        (
            starts,
            slice(matrix.rows, entries, "rows")?,
            slice(matrix.values, entries, "values")?,
        )
    };
    let triangle = match matrix.triangle {
        BRINELL_TRIANGLE_BOTH => Triangle::Both,
        BRINELL_TRIANGLE_UPPER => Triangle::Upper,
        BRINELL_TRIANGLE_LOWER => Triangle::Lower,
        other => return Err(Error::input(format!("there is no triangle {other}"))),
    };
    stiffness_from_csc(n, starts, rows, values, triangle)
}

type ConstraintRows = (Vec<Vec<(usize, f64)>>, Vec<f64>);

/// # Safety
/// The arrays are as long as the structure says.
unsafe fn read_rows(rows: &brinell_rows, n: usize) -> Result<ConstraintRows> {
    if rows.n_rows == 0 {
        return Ok((Vec::new(), Vec::new()));
    }
    // SAFETY: as vouched for by the caller.
    let (starts, freedoms, coefficients, gaps) = unsafe {
        let starts = slice(rows.row_starts, rows.n_rows.saturating_add(1), "row_starts")?;
        let entries = entries(starts, "row_starts")?;
        (
            starts,
            slice(rows.freedoms, entries, "freedoms")?,
            slice(rows.coefficients, entries, "coefficients")?,
            slice(rows.gaps, rows.n_rows, "gaps")?,
        )
    };
    let list = rows_from_csr(n, starts, freedoms, coefficients)?;
    Ok((list, gaps.to_vec()))
}

/// Factors and condenses a stiffness with contact rows (NULL for none). The arrays are not needed
/// afterwards. The initial state is that without load.
///
/// # Safety
/// The structures are as long as their `size` says, and their arrays as long as their numbers say;
/// `out` may be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_structure_new(
    matrix: *const brinell_matrix,
    rows: *const brinell_rows,
    options: *const brinell_options,
    out: *mut *mut brinell_structure,
) -> i32 {
    let no_matrix = brinell_matrix {
        size: 0,
        n: 0,
        column_starts: std::ptr::null(),
        rows: std::ptr::null(),
        values: std::ptr::null(),
        triangle: BRINELL_TRIANGLE_BOTH,
    };
    let no_rows = brinell_rows {
        size: 0,
        n_rows: 0,
        row_starts: std::ptr::null(),
        freedoms: std::ptr::null(),
        coefficients: std::ptr::null(),
        gaps: std::ptr::null(),
    };
    guarded(|| {
        // SAFETY: the caller vouches for every pointer.
        unsafe {
            shared(matrix, "the matrix")?;
            let stiffness = read_matrix(&take(matrix, no_matrix)?)?;
            let (rows, gaps) = read_rows(&take(rows, no_rows)?, stiffness.cols())?;
            let structure =
                ConstrainedStructure::with_owned(backend(options)?, stiffness, &rows, &gaps)?;
            hand_out(
                out,
                brinell_structure {
                    structure,
                    changes: Vec::new(),
                },
            )
        }
    })
}

/// Frees a structure.
///
/// # Safety
/// `structure` is NULL or was handed out by this library and not freed before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_structure_free(structure: *mut brinell_structure) {
    // SAFETY: as vouched for by the caller.
    unsafe { free(structure) }
}

/// The contact freedoms: those that occur in rows, ascending. Valid as long as the structure.
///
/// # Safety
/// `structure` is a living handle; `data` and `n` may be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_structure_contact_freedoms(
    structure: *const brinell_structure,
    data: *mut *const usize,
    n: *mut usize,
) -> i32 {
    guarded(|| {
        // SAFETY: the caller vouches for every pointer.
        unsafe {
            lend(
                shared(structure, "the structure")?
                    .structure
                    .contact_freedoms(),
                data,
                n,
            )
        }
    })
}

/// The stiffness condensed on the contact freedoms, n x n, column by column. Valid as long as the
/// structure.
///
/// # Safety
/// `structure` is a living handle; `data` and `n` may be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_structure_condensed(
    structure: *const brinell_structure,
    data: *mut *const f64,
    n: *mut usize,
) -> i32 {
    guarded(|| {
        // SAFETY: the caller vouches for every pointer.
        unsafe {
            let matrix = shared(structure, "the structure")?
                .structure
                .condensed_stiffness();
            lend(matrix.as_slice(), data, n)?;
            *exclusive(n, "the place for its size")? = matrix.nrows();
        }
        Ok(())
    })
}

/// Calls `act` with `n` values; the changes of the last step are cleared.
///
/// # Safety
/// `structure` is a living handle, `values` has `n` values.
unsafe fn under(
    structure: *mut brinell_structure,
    values: *const f64,
    n: usize,
    what: &str,
    act: impl FnOnce(&mut ConstrainedStructure, &[f64]) -> Result<()>,
) -> i32 {
    guarded(|| {
        // SAFETY: the caller vouches for every pointer.
        let (s, values) = unsafe {
            (
                exclusive(structure, "the structure")?,
                slice(values, n, what)?,
            )
        };
        s.changes.clear();
        act(&mut s.structure, values)
    })
}

/// Solves contact under a load on all freedoms, which includes any plastic loads.
///
/// # Safety
/// `structure` is a living handle, `load` has `n` values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_structure_solve(
    structure: *mut brinell_structure,
    load: *const f64,
    n: usize,
) -> i32 {
    // SAFETY: as vouched for by the caller.
    unsafe { under(structure, load, n, "load", ConstrainedStructure::solve) }
}

/// Starts a piece of the load path: from the current state on the load is load + t rate, with t
/// from 0.
///
/// # Safety
/// `structure` is a living handle, `rate` has `n` values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_structure_start(
    structure: *mut brinell_structure,
    rate: *const f64,
    n: usize,
) -> i32 {
    // SAFETY: as vouched for by the caller.
    unsafe { under(structure, rate, n, "rate", ConstrainedStructure::start) }
}

/// Goes on to `end` or to the next change of contact, whichever comes first. `t` receives the
/// position, `n_changes` the number of rows that change there, 0 at the end.
///
/// # Safety
/// `structure` is a living handle; `t` and `n_changes` may be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_structure_step(
    structure: *mut brinell_structure,
    end: f64,
    t: *mut f64,
    n_changes: *mut usize,
) -> i32 {
    guarded(|| {
        // SAFETY: the caller vouches for every pointer.
        let (s, t, n_changes) = unsafe {
            (
                exclusive(structure, "the structure")?,
                exclusive(t, "the place for t")?,
                exclusive(n_changes, "the place for the number of changes")?,
            )
        };
        let event = s.structure.step(end)?;
        s.changes = event
            .changes
            .iter()
            .map(|change| match change {
                Change::Closes(row) => (*row, true),
                Change::Opens(row) => (*row, false),
            })
            .collect();
        *t = event.t;
        *n_changes = s.changes.len();
        Ok(())
    })
}

/// Change `index` of the last event: its row, and whether it closes (1) or opens (0).
///
/// # Safety
/// `structure` is a living handle; `row` and `closes` may be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_structure_change(
    structure: *const brinell_structure,
    index: usize,
    row: *mut usize,
    closes: *mut i32,
) -> i32 {
    guarded(|| {
        // SAFETY: the caller vouches for every pointer.
        unsafe {
            let changes = &shared(structure, "the structure")?.changes;
            let change = changes.get(index).ok_or_else(|| {
                Error::input(format!(
                    "there is no change {index}: the last event has {}",
                    changes.len()
                ))
            })?;
            *exclusive(row, "the place for the row")? = change.0;
            *exclusive(closes, "the place for the direction")? = i32::from(change.1);
        }
        Ok(())
    })
}

/// Gaps of the rows, >= 0. Valid until the state changes.
///
/// # Safety
/// `structure` is a living handle; `data` and `n` may be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_structure_gaps(
    structure: *const brinell_structure,
    data: *mut *const f64,
    n: *mut usize,
) -> i32 {
    guarded(|| {
        // SAFETY: the caller vouches for every pointer.
        unsafe {
            lend(
                shared(structure, "the structure")?.structure.gaps(),
                data,
                n,
            )
        }
    })
}

/// Forces of the rows, compressive positive. Valid until the state changes.
///
/// # Safety
/// `structure` is a living handle; `data` and `n` may be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_structure_forces(
    structure: *const brinell_structure,
    data: *mut *const f64,
    n: *mut usize,
) -> i32 {
    guarded(|| {
        // SAFETY: the caller vouches for every pointer.
        unsafe {
            lend(
                shared(structure, "the structure")?.structure.forces(),
                data,
                n,
            )
        }
    })
}

/// Statuses of the rows: 1 closed, 0 open.
///
/// # Safety
/// `structure` is a living handle; `closed` has room for `n` values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_structure_statuses(
    structure: *const brinell_structure,
    closed: *mut i32,
    n: usize,
) -> i32 {
    guarded(|| {
        // SAFETY: the caller vouches for every pointer.
        let (s, out) = unsafe {
            (
                shared(structure, "the structure")?,
                slice_mut(closed, n, "statuses")?,
            )
        };
        let open = s.structure.open();
        if open.len() != n {
            return Err(Error::input(format!(
                "{n} places were given for {} statuses",
                open.len()
            )));
        }
        for (out, open) in out.iter_mut().zip(open) {
            *out = i32::from(!open);
        }
        Ok(())
    })
}

/// Displacements of all freedoms. Costs one full solve. `backward_error` (NULL if not wanted)
/// receives the backward error of this solve.
///
/// # Safety
/// `structure` is a living handle; `u` has room for `n` values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_structure_displacements(
    structure: *const brinell_structure,
    u: *mut f64,
    n: usize,
    backward_error: *mut f64,
) -> i32 {
    guarded(|| {
        // SAFETY: the caller vouches for every pointer.
        let (s, u, error) = unsafe {
            (
                shared(structure, "the structure")?,
                slice_mut(u, n, "displacements")?,
                backward_error.as_mut(),
            )
        };
        let backward_error = s.structure.displacements(u)?;
        if let Some(error) = error {
            *error = backward_error;
        }
        Ok(())
    })
}
