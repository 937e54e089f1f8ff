//! Arrays of the caller, and plain values.

use crate::errors::wrong;
use brinell::linalg::Backend;
use numpy::{Element, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};
use serde::de::DeserializeOwned;

/// A contiguous array of doubles: the caller's own where it is one.
pub fn doubles<'py>(
    values: &Bound<'py, PyAny>,
    what: &str,
) -> PyResult<PyReadonlyArrayDyn<'py, f64>> {
    let py = values.py();
    let array = py
        .import(intern!(py, "numpy"))?
        .call_method1("ascontiguousarray", (values, "float64"))
        .map_err(|cause| wrong(py, format!("{what}: no array of numbers: {cause}")))?;
    Ok(array.extract::<PyReadonlyArrayDyn<'py, f64>>()?)
}

/// The values of a contiguous array.
pub fn values<'a, T: Element>(
    py: Python<'_>,
    array: &'a PyReadonlyArrayDyn<'_, T>,
) -> PyResult<&'a [T]> {
    array
        .as_slice()
        .map_err(|cause| wrong(py, cause.to_string()))
}

/// Vectors of `dimension` components, row by row; in the plane z is 0.
pub fn vectors(given: &Bound<'_, PyAny>, dimension: usize, what: &str) -> PyResult<Vec<[f64; 3]>> {
    let array = doubles(given, what)?;
    shape(given.py(), array.shape(), &[dimension], what)?;
    let rows = values(given.py(), &array)?.chunks_exact(dimension);
    let in_space = |row: &[f64]| [0, 1, 2].map(|d| row.get(d).copied().unwrap_or(0.0));
    Ok(rows.map(in_space).collect())
}

/// Checks that an array is `n` times `rest`.
pub fn shape(py: Python<'_>, shape: &[usize], rest: &[usize], what: &str) -> PyResult<()> {
    if shape.len() == rest.len() + 1 && shape[1..] == *rest {
        return Ok(());
    }
    let rest: String = rest.iter().map(|n| format!(", {n}")).collect();
    Err(wrong(
        py,
        format!("{what}: an array of shape {shape:?} was given; (n{rest}) is needed"),
    ))
}

/// Whole numbers where they lie.
pub enum Integers<'py> {
    /// 32 bit, as sparse matrices mostly have them.
    Narrow(PyReadonlyArrayDyn<'py, i32>),
    /// 64 bit, numpy's own.
    Wide(PyReadonlyArrayDyn<'py, i64>),
}

impl Integers<'_> {
    /// Shape of the array.
    pub fn shape(&self) -> &[usize] {
        match self {
            Integers::Narrow(array) => array.shape(),
            Integers::Wide(array) => array.shape(),
        }
    }
}

/// Says what to do with a slice of whole numbers, of either width.
macro_rules! each_width {
    ($py:expr, $integers:expr, |$slice:ident| $act:expr) => {
        match &$integers {
            $crate::arrays::Integers::Narrow(array) => {
                let $slice = $crate::arrays::values($py, array)?;
                $act
            }
            $crate::arrays::Integers::Wide(array) => {
                let $slice = $crate::arrays::values($py, array)?;
                $act
            }
        }
    };
}
pub(crate) use each_width;

/// Whole numbers: the caller's own where they are contiguous and of 32 or 64 bit with a sign, else
/// converted.
pub fn integers<'py>(given: &Bound<'py, PyAny>, what: &str) -> PyResult<Integers<'py>> {
    let py = given.py();
    let numpy = py.import(intern!(py, "numpy"))?;
    let array = numpy.call_method1("asarray", (given,))?;
    let kind: String = array.getattr("dtype")?.getattr("kind")?.extract()?;
    let empty = array.getattr("size")?.extract::<usize>()? == 0;
    if !empty && kind != "i" && kind != "u" {
        let dtype = array.getattr("dtype")?;
        return Err(wrong(
            py,
            format!("{what}: an array of {dtype} was given; whole numbers are needed"),
        ));
    }
    let contiguous = numpy.call_method1("ascontiguousarray", (&array,))?;
    if let Ok(array) = contiguous.extract() {
        return Ok(Integers::Narrow(array));
    }
    let array = numpy.call_method1("ascontiguousarray", (array, "int64"))?;
    Ok(Integers::Wide(array.extract()?))
}

/// Keywords as one of brinell's own types: unknown keys and wrong types are errors.
pub fn keywords<T: DeserializeOwned>(values: &Bound<'_, PyDict>, what: &str) -> PyResult<T> {
    pythonize::depythonize(&plain(values.as_any())?)
        .map_err(|cause| wrong(values.py(), format!("{what}: {cause}")))
}

/// Lists and numbers in place of numpy's.
fn plain<'py>(value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let py = value.py();
    if let Ok(table) = value.cast::<PyDict>() {
        let out = PyDict::new(py);
        for (key, value) in table {
            // What is None is not given.
            if !value.is_none() {
                out.set_item(key, plain(&value)?)?;
            }
        }
        return Ok(out.into_any());
    }
    if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        let items = value.try_iter()?.map(|item| plain(&item?));
        return Ok(PyList::new(py, items.collect::<PyResult<Vec<_>>>()?)?.into_any());
    }
    if value.hasattr(intern!(py, "tolist"))? {
        return value.call_method0(intern!(py, "tolist"));
    }
    Ok(value.clone())
}

/// The backend of this name; `None` for the default.
pub fn backend(py: Python<'_>, solver: Option<&str>) -> PyResult<Backend> {
    let Some(name) = solver else {
        return Ok(Backend::default());
    };
    Backend::from_name(name).map_err(|error| wrong(py, error.message().to_string()))
}
