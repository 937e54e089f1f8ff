//! Rows as columns: dictionaries of numpy arrays, which `pandas.DataFrame` takes as they are.

use brinell::results::{Fields, HistoryRow, PairState, State, Status};
use numpy::{Element, PyArray1, PyArrayMethods, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Puts a column of each named field of the rows into a table.
macro_rules! columns {
    ($py:expr, $table:expr, $rows:expr, $type:ty, $($name:ident),+) => {
        $($table.set_item(
            stringify!($name),
            PyArray1::from_vec($py, $rows.iter().map(|row| row.$name as $type).collect()),
        )?;)+
    };
}

/// A row per accepted increment.
pub fn history<'py>(py: Python<'py>, rows: &[HistoryRow]) -> PyResult<Bound<'py, PyDict>> {
    let table = PyDict::new(py);
    columns!(py, table, rows, i64, increment);
    columns!(
        py,
        table,
        rows,
        f64,
        alpha,
        load,
        max_pressure,
        half_width,
        contact_force
    );
    columns!(py, table, rows, i64, closed_pairs, plastic_points);
    columns!(py, table, rows, f64, max_equivalent_plastic_strain);
    columns!(py, table, rows, i64, iterations, trailing_solves);
    columns!(py, table, rows, f64, residual);
    let events: Vec<&str> = rows.iter().map(|row| row.event.as_str()).collect();
    table.set_item("event", events)?;
    Ok(table)
}

/// A row per contact pair.
pub fn pairs<'py>(py: Python<'py>, rows: &[PairState]) -> PyResult<Bound<'py, PyDict>> {
    let table = PyDict::new(py);
    columns!(py, table, rows, i64, pair, contact);
    let coordinate = |k: usize| rows.iter().map(|row| row.position[k]).collect();
    table.set_item("x", PyArray1::<f64>::from_vec(py, coordinate(0)))?;
    table.set_item("y", PyArray1::<f64>::from_vec(py, coordinate(1)))?;
    columns!(py, table, rows, f64, gap, force, area, pressure);
    let closed = rows.iter().map(|row| row.status == Status::Closed);
    table.set_item("closed", PyArray1::from_vec(py, closed.collect()))?;
    Ok(table)
}

/// A row per state.
pub fn states<'py>(py: Python<'py>, rows: &[&State]) -> PyResult<Bound<'py, PyDict>> {
    let table = PyDict::new(py);
    let names: Vec<&str> = rows.iter().map(|row| row.name.as_str()).collect();
    table.set_item("name", names)?;
    columns!(
        py,
        table,
        rows,
        f64,
        alpha,
        load,
        contact_force,
        max_pressure,
        pole_pressure
    );
    columns!(py, table, rows, f64, half_width, residual_depth, approach);
    columns!(py, table, rows, i64, plastic_points);
    columns!(
        py,
        table,
        rows,
        f64,
        max_equivalent_plastic_strain,
        plastic_zone_size
    );
    let error = rows.iter().map(|row| row.energy_error.unwrap_or(f64::NAN));
    table.set_item("energy_error", PyArray1::from_vec(py, error.collect()))?;
    Ok(table)
}

/// An array that owns `values`, not to be written to: `width` columns, or a plain one.
pub fn kept<'py, T: Element>(
    py: Python<'py>,
    values: Vec<T>,
    width: Option<usize>,
) -> PyResult<Bound<'py, PyAny>> {
    let n = values.len();
    let array = PyArray1::from_vec(py, values);
    let array = match width {
        Some(width) => array.reshape([n / width.max(1), width])?.into_any(),
        None => array.into_any(),
    };
    array.getattr("flags")?.setattr("writeable", false)?;
    Ok(array)
}

/// Fields, moved into arrays.
pub fn fields<'py>(py: Python<'py>, fields: Fields) -> PyResult<Bound<'py, PyDict>> {
    let table = PyDict::new(py);
    table.set_item("displacement", kept(py, fields.displacement, Some(2))?)?;
    table.set_item("stress", kept(py, fields.stress, Some(4))?)?;
    table.set_item("von_mises", kept(py, fields.von_mises, None)?)?;
    table.set_item("plastic_strain", kept(py, fields.plastic_strain, None)?)?;
    table.set_item("yielded", kept(py, fields.yielded, None)?)?;
    table.set_item("error", kept(py, fields.error, None)?)?;
    Ok(table)
}

/// Copies fields back, to be written to files.
pub fn fields_of(table: &Bound<'_, PyDict>) -> PyResult<Fields> {
    fn values<T: Element + Clone>(table: &Bound<'_, PyDict>, name: &str) -> PyResult<Vec<T>> {
        let array = table.as_any().get_item(name)?;
        let array = array.extract::<PyReadonlyArrayDyn<'_, T>>()?;
        Ok(array.as_array().iter().cloned().collect())
    }
    Ok(Fields {
        displacement: values(table, "displacement")?,
        stress: values(table, "stress")?,
        von_mises: values(table, "von_mises")?,
        plastic_strain: values(table, "plastic_strain")?,
        yielded: values(table, "yielded")?,
        error: values(table, "error")?,
    })
}
