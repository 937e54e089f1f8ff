//! The lower level: a stiffness and contact rows of the caller.

use crate::arrays::{Integers, backend, doubles, each_width, integers, values};
use crate::errors::{Raise, wrong};
use crate::lent::{lent, read_only};
use brinell::constrained::{ConstrainedStructure, Triangle, rows_from_csr, stiffness_from_csc};
use brinell::contact::Change;
use brinell::linalg::SymmetricCsc;
use brinell::panics::contained;
use numpy::{PyArray1, PyReadonlyArrayDyn, PyReadwriteArray1, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use std::sync::{Mutex, MutexGuard};

/// A sparse symmetric stiffness with contact rows, factored and condensed once:
///
///     K u = f - B' r,   g = gaps - B u >= 0,   r >= 0,   g . r = 0
///
/// stiffness: K as a scipy sparse matrix, or (data, indices, indptr) compressed by column, read
/// where it lies; its upper triangle is kept. rows: B as a scipy sparse matrix, (data, indices,
/// indptr) compressed by row, or a dense array; None for none. gaps: a value for each row; negative
/// is interference. triangle: which entries are given, "both", "upper" or "lower".
#[pyclass(frozen, module = "brinell")]
pub struct Structure {
    inner: Mutex<ConstrainedStructure>,
    /// Of the last displacements.
    backward_error: Mutex<f64>,
    condensed: Py<PyAny>,
    contact_freedoms: Py<PyAny>,
    n: usize,
    n_rows: usize,
}

/// A sparse matrix where it lies.
struct Compressed<'py> {
    data: PyReadonlyArrayDyn<'py, f64>,
    indices: Integers<'py>,
    starts: Integers<'py>,
    /// Rows and columns where they are known.
    shape: Option<(usize, usize)>,
}

fn compressed<'py>(
    given: &Bound<'py, PyAny>,
    convert: &str,
    what: &str,
) -> PyResult<Compressed<'py>> {
    let py = given.py();
    let (parts, shape) = if let Ok(parts) = given.cast::<PyTuple>() {
        if parts.len() != 3 {
            return Err(wrong(
                py,
                format!(
                    "{what}: {} arrays were given; data, indices and indptr are needed",
                    parts.len()
                ),
            ));
        }
        let parts = [parts.get_item(0)?, parts.get_item(1)?, parts.get_item(2)?];
        (parts, None)
    } else if given.hasattr(convert)? {
        // scipy hands out the matrix itself where it is of this kind.
        let matrix = given.call_method0(convert)?;
        let part = |name: &str| matrix.getattr(name);
        let shape = part("shape")?.extract()?;
        (
            [part("data")?, part("indices")?, part("indptr")?],
            Some(shape),
        )
    } else {
        return Err(wrong(
            py,
            format!("{what}: give a scipy sparse matrix or (data, indices, indptr)"),
        ));
    };
    Ok(Compressed {
        data: doubles(&parts[0], what)?,
        indices: integers(&parts[1], what)?,
        starts: integers(&parts[2], what)?,
        shape,
    })
}

/// The upper triangle of a stiffness and its size.
fn stiffness(given: &Bound<'_, PyAny>, triangle: Triangle) -> PyResult<SymmetricCsc> {
    let py = given.py();
    let k = compressed(given, "tocsc", "stiffness")?;
    if let Some((rows, columns)) = k.shape.filter(|s| s.0 != s.1) {
        return Err(wrong(
            py,
            format!("stiffness: {rows} x {columns} is not square"),
        ));
    }
    let data = values(py, &k.data)?;
    each_width!(py, k.starts, |starts| each_width!(
        py,
        k.indices,
        |indices| {
            let n = starts.len().saturating_sub(1);
            let read = || stiffness_from_csc(n, starts, indices, data, triangle);
            py.detach(|| contained(read)).raise(py)
        }
    ))
}

/// Contact rows on `n` freedoms.
fn contact_rows(given: Option<&Bound<'_, PyAny>>, n: usize) -> PyResult<Vec<Vec<(usize, f64)>>> {
    let Some(given) = given else {
        return Ok(Vec::new());
    };
    let py = given.py();
    let fits = |columns: usize| match columns == n {
        true => Ok(()),
        false => Err(wrong(
            py,
            format!("rows: {columns} columns were given for {n} freedoms"),
        )),
    };
    if given.cast::<PyTuple>().is_ok() || given.hasattr("tocsr")? {
        let b = compressed(given, "tocsr", "rows")?;
        b.shape.map_or(Ok(()), |(_, columns)| fits(columns))?;
        let data = values(py, &b.data)?;
        return each_width!(py, b.starts, |starts| each_width!(
            py,
            b.indices,
            |indices| rows_from_csr(n, starts, indices, data).raise(py)
        ));
    }
    let array = doubles(given, "rows")?;
    let &[n_rows, columns] = array.shape() else {
        return Err(wrong(py, "rows: a matrix is needed".to_string()));
    };
    fits(columns)?;
    let dense = values(py, &array)?;
    let row = |row: usize| {
        let row = dense[row * columns..(row + 1) * columns].iter().copied();
        row.enumerate().filter(|(_, value)| *value != 0.0).collect()
    };
    Ok((0..n_rows).map(row).collect())
}

impl Structure {
    fn lock(&self) -> MutexGuard<'_, ConstrainedStructure> {
        // A state that a panic left behind is that of the last call that returned, or refused by
        // the next.
        self.inner.lock().unwrap_or_else(|e| e.into_inner())
    }

    /// Fills in the displacements, with the interpreter released.
    fn displace(&self, py: Python<'_>, u: &mut [f64]) -> PyResult<()> {
        let error = py
            .detach(|| contained(|| self.lock().displacements(u)))
            .raise(py)?;
        *(self.backward_error.lock()).unwrap_or_else(|e| e.into_inner()) = error;
        Ok(())
    }

    /// Hands a vector on, with the interpreter released.
    fn under(
        &self,
        given: &Bound<'_, PyAny>,
        what: &str,
        act: impl FnOnce(&mut ConstrainedStructure, &[f64]) -> brinell::Result<()> + Send,
    ) -> PyResult<()> {
        let py = given.py();
        let array = doubles(given, what)?;
        let vector = values(py, &array)?;
        py.detach(|| contained(|| act(&mut self.lock(), vector)))
            .raise(py)
    }
}

#[pymethods]
impl Structure {
    #[new]
    #[pyo3(signature = (stiffness, rows = None, gaps = None, *, triangle = "both", solver = None))]
    fn new(
        py: Python<'_>,
        stiffness: &Bound<'_, PyAny>,
        rows: Option<&Bound<'_, PyAny>>,
        gaps: Option<&Bound<'_, PyAny>>,
        triangle: &str,
        solver: Option<&str>,
    ) -> PyResult<Self> {
        let backend = backend(py, solver)?;
        let triangle = match triangle {
            "both" => Triangle::Both,
            "upper" => Triangle::Upper,
            "lower" => Triangle::Lower,
            other => {
                return Err(wrong(
                    py,
                    format!(
                        "there is no triangle {other:?}; give \"both\", \"upper\" or \"lower\""
                    ),
                ));
            }
        };
        let stiffness = self::stiffness(stiffness, triangle)?;
        let rows = contact_rows(rows, stiffness.cols())?;
        let gaps = gaps.map(|gaps| doubles(gaps, "gaps")).transpose()?;
        let gaps = gaps.as_ref().map_or(Ok(&[][..]), |gaps| values(py, gaps))?;
        let make = || ConstrainedStructure::with_owned(backend, stiffness, &rows, gaps);
        let structure = py.detach(|| contained(make)).raise(py)?;
        let condensed = structure.shared_condensed_stiffness();
        let n_contact = structure.contact_freedoms().len();
        let freedoms = structure.contact_freedoms().iter().map(|f| *f as i64);
        let freedoms = PyArray1::from_iter(py, freedoms).into_any();
        Ok(Structure {
            condensed: lent(py, &condensed, |c| c.as_slice(), Some(n_contact))?.unbind(),
            contact_freedoms: read_only(freedoms)?.unbind(),
            n: structure.n_freedoms(),
            n_rows: structure.n_rows(),
            inner: Mutex::new(structure),
            backward_error: Mutex::new(f64::NAN),
        })
    }

    /// Number of freedoms.
    #[getter]
    fn n_freedoms(&self) -> usize {
        self.n
    }

    /// Number of contact rows.
    #[getter]
    fn n_rows(&self) -> usize {
        self.n_rows
    }

    /// The contact freedoms: those that occur in rows, ascending.
    #[getter]
    fn contact_freedoms(&self, py: Python<'_>) -> Py<PyAny> {
        self.contact_freedoms.clone_ref(py)
    }

    /// The stiffness condensed on the contact freedoms, symmetric: a view of brinell's own, not to
    /// be written to.
    #[getter]
    fn condensed_stiffness(&self, py: Python<'_>) -> Py<PyAny> {
        self.condensed.clone_ref(py)
    }

    /// Solves contact under a load on all freedoms (plastic loads among them).
    fn solve(&self, load: &Bound<'_, PyAny>) -> PyResult<()> {
        self.under(load, "load", ConstrainedStructure::solve)
    }

    /// Starts a piece of the load path: from the state at hand the load goes on as load + t rate, t
    /// from 0.
    fn start(&self, rate: &Bound<'_, PyAny>) -> PyResult<()> {
        self.under(rate, "rate", ConstrainedStructure::start)
    }

    /// Goes on to `end` or to the next change of contact: t, and a list of (row, closes); empty at
    /// the end.
    fn step(&self, py: Python<'_>, end: f64) -> PyResult<(f64, Vec<(usize, bool)>)> {
        let event = py
            .detach(|| contained(|| self.lock().step(end)))
            .raise(py)?;
        let changes = event.changes.iter().map(|change| match change {
            Change::Closes(row) => (*row, true),
            Change::Opens(row) => (*row, false),
        });
        Ok((event.t, changes.collect()))
    }

    /// Gaps of the rows, >= 0, in the state at hand: a view of it that stays as it is when the
    /// state changes, not to be written to.
    #[getter]
    fn gaps<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let gaps = self.lock().shared_gaps();
        lent(py, &gaps, |gaps| &gaps[..], None)
    }

    /// Forces of the rows, compressive positive, in the state at hand: as `gaps`.
    #[getter]
    fn forces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let forces = self.lock().shared_forces();
        lent(py, &forces, |forces| &forces[..], None)
    }

    /// Which rows are closed.
    #[getter]
    fn closed<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<bool>> {
        let closed = self.lock().open().iter().map(|open| !open).collect();
        PyArray1::from_vec(py, closed)
    }

    /// Displacements of all freedoms, into `out` if given. Costs one full solve.
    #[pyo3(signature = (out = None))]
    fn displacements<'py>(
        &self,
        py: Python<'py>,
        out: Option<Bound<'py, PyArray1<f64>>>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let Some(out) = out else {
            let mut u = vec![0.0; self.n];
            self.displace(py, &mut u)?;
            return Ok(PyArray1::from_vec(py, u));
        };
        {
            let mut array: PyReadwriteArray1<'py, f64> = out
                .extract()
                .map_err(|cause| wrong(py, format!("out: {cause}")))?;
            let u = array
                .as_slice_mut()
                .map_err(|cause| wrong(py, format!("out: {cause}")))?;
            self.displace(py, u)?;
        }
        Ok(out)
    }

    /// |K u - f + B' r| / (|K| |u| + |f|) of the last displacements; not a number before them.
    #[getter]
    fn backward_error(&self) -> f64 {
        *(self.backward_error.lock()).unwrap_or_else(|e| e.into_inner())
    }

    fn __repr__(&self) -> String {
        format!(
            "<brinell.Structure: {} freedoms, {} contact rows>",
            self.n, self.n_rows
        )
    }
}
