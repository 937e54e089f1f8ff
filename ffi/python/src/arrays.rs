//! Arrays of the caller, and plain values.

use crate::errors::wrong;
use brinell::linalg::Backend;
use numpy::{PyReadonlyArrayDyn, PyUntypedArrayMethods};
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
pub fn values<'a>(py: Python<'_>, array: &'a PyReadonlyArrayDyn<'_, f64>) -> PyResult<&'a [f64]> {
    array
        .as_slice()
        .map_err(|cause| wrong(py, cause.to_string()))
}

/// `n x 2` doubles, row by row.
pub fn rows_of_two(given: &Bound<'_, PyAny>, what: &str) -> PyResult<Vec<[f64; 2]>> {
    let array = doubles(given, what)?;
    shape(given.py(), array.shape(), &[2], what)?;
    let values = values(given.py(), &array)?;
    Ok(values.chunks_exact(2).map(|r| [r[0], r[1]]).collect())
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

/// Whole numbers as they came, with the shape of their array.
pub fn integers(given: &Bound<'_, PyAny>, what: &str) -> PyResult<(Vec<i64>, Vec<usize>)> {
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
    let array = numpy.call_method1("ascontiguousarray", (array, "int64"))?;
    let array = array.extract::<PyReadonlyArrayDyn<'_, i64>>()?;
    let values = array.as_slice().map_err(|e| wrong(py, e.to_string()))?;
    Ok((values.to_vec(), array.shape().to_vec()))
}

/// Indices from 0, with the shape of their array.
pub fn indices(given: &Bound<'_, PyAny>, what: &str) -> PyResult<(Vec<usize>, Vec<usize>)> {
    let (values, shape) = integers(given, what)?;
    let checked = values.iter().enumerate().map(|(at, &value)| {
        usize::try_from(value).map_err(|_| {
            wrong(
                given.py(),
                format!("{what}: entry {at} is {value}; numbers count from 0"),
            )
        })
    });
    Ok((checked.collect::<PyResult<_>>()?, shape))
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
    match solver {
        None => Ok(Backend::default()),
        Some("cholmod") => Ok(Backend::Cholmod),
        Some("dense") => Ok(Backend::Dense),
        Some(other) => Err(wrong(
            py,
            format!("there is no solver {other:?}; give \"cholmod\" or \"dense\""),
        )),
    }
}
