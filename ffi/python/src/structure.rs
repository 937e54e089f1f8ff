//! The lower level: a stiffness and contact rows of the caller.

use crate::arrays::{backend, doubles, integers, values};
use crate::errors::{Raise, wrong};
use crate::tables::kept;
use brinell::constrained::{ConstrainedStructure, Triangle, rows_from_csr, stiffness_from_csc};
use brinell::contact::Change;
use brinell::panics::contained;
use numpy::{PyArray1, PyReadwriteArray1, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use std::sync::{Mutex, MutexGuard};

/// A sparse symmetric stiffness with contact rows, factored and condensed once:
///
///     K u = f - B' r,   g = gaps - B u >= 0,   r >= 0,   g . r = 0
///
/// stiffness: K as a scipy sparse matrix, or (data, indices, indptr) compressed by column.
/// rows: B as a scipy sparse matrix, (data, indices, indptr) compressed by row, or a dense array; None for none.
/// gaps: a value for each row; negative is interference.
/// triangle: which entries are given, "both", "upper" or "lower".
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

struct Compressed {
    data: Vec<f64>,
    indices: Vec<i64>,
    starts: Vec<i64>,
    /// Rows and columns where they are known.
    shape: Option<(usize, usize)>,
}

fn compressed(given: &Bound<'_, PyAny>, convert: &str, what: &str) -> PyResult<Compressed> {
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
    let data = doubles(&parts[0], what)?;
    Ok(Compressed {
        data: values(py, &data)?.to_vec(),
        indices: integers(&parts[1], what)?.0,
        starts: integers(&parts[2], what)?.0,
        shape,
    })
}

/// Dense rows, compressed.
fn compress(given: &Bound<'_, PyAny>) -> PyResult<Compressed> {
    let array = doubles(given, "rows")?;
    let &[n_rows, n] = array.shape() else {
        return Err(wrong(given.py(), "rows: a matrix is needed".to_string()));
    };
    let mut out = Compressed {
        data: Vec::new(),
        indices: Vec::new(),
        starts: vec![0],
        shape: Some((n_rows, n)),
    };
    let values = values(given.py(), &array)?;
    for row in 0..n_rows {
        for (freedom, &value) in values[row * n..(row + 1) * n].iter().enumerate() {
            if value != 0.0 {
                out.data.push(value);
                out.indices.push(freedom as i64);
            }
        }
        out.starts.push(out.data.len() as i64);
    }
    Ok(out)
}

impl Structure {
    fn lock(&self) -> MutexGuard<'_, ConstrainedStructure> {
        // A state that a panic left behind is that of the last call that returned, or refused by the next.
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
        let k = compressed(stiffness, "tocsc", "stiffness")?;
        let n = k.shape.map_or(k.starts.len().saturating_sub(1), |s| s.1);
        if let Some((rows, columns)) = k.shape.filter(|s| s.0 != s.1) {
            return Err(wrong(
                py,
                format!("stiffness: {rows} x {columns} is not square"),
            ));
        }
        let b = match rows {
            None => Compressed {
                data: Vec::new(),
                indices: Vec::new(),
                starts: vec![0],
                shape: None,
            },
            Some(rows) if rows.cast::<PyTuple>().is_ok() || rows.hasattr("tocsr")? => {
                compressed(rows, "tocsr", "rows")?
            }
            Some(rows) => compress(rows)?,
        };
        if let Some((_, columns)) = b.shape.filter(|s| s.1 != n) {
            return Err(wrong(
                py,
                format!("rows: {columns} columns were given for {n} freedoms"),
            ));
        }
        let gaps = match gaps {
            None => Vec::new(),
            Some(gaps) => values(py, &doubles(gaps, "gaps")?)?.to_vec(),
        };
        let structure = py
            .detach(|| {
                contained(|| {
                    let stiffness =
                        stiffness_from_csc(n, &k.starts, &k.indices, &k.data, triangle)?;
                    let rows = rows_from_csr(n, &b.starts, &b.indices, &b.data)?;
                    ConstrainedStructure::new(backend, &stiffness, &rows, &gaps)
                })
            })
            .raise(py)?;
        let c = structure.condensed_stiffness();
        let freedoms = structure.contact_freedoms().iter().map(|f| *f as i64);
        let freedoms: Vec<i64> = freedoms.collect();
        Ok(Structure {
            condensed: kept(py, c.as_slice().to_vec(), Some(c.ncols()))?.unbind(),
            contact_freedoms: kept(py, freedoms, None)?.unbind(),
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

    /// The stiffness condensed on the contact freedoms, symmetric; one array for all calls, not to be written to.
    #[getter]
    fn condensed_stiffness(&self, py: Python<'_>) -> Py<PyAny> {
        self.condensed.clone_ref(py)
    }

    /// Solves contact under a load on all freedoms (plastic loads among them).
    fn solve(&self, load: &Bound<'_, PyAny>) -> PyResult<()> {
        self.under(load, "load", ConstrainedStructure::solve)
    }

    /// Starts a piece of the load path: from the state at hand the load goes on as load + t rate, t from 0.
    fn start(&self, rate: &Bound<'_, PyAny>) -> PyResult<()> {
        self.under(rate, "rate", ConstrainedStructure::start)
    }

    /// Goes on to `end` or to the next change of contact: t, and a list of (row, closes); empty at the end.
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

    /// Gaps of the rows, >= 0, in the state at hand.
    #[getter]
    fn gaps<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.lock().gaps())
    }

    /// Forces of the rows, compressive positive, in the state at hand.
    #[getter]
    fn forces<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.lock().forces())
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
