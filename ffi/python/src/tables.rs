//! Rows as columns: dictionaries of numpy's views, which `pandas.DataFrame` takes as they are.

use crate::lent::{Number, column, lent, read_only};
use brinell::results::{Fields, QUANTITIES, Results, Status};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// Puts a column of each named field of the rows into a table.
macro_rules! columns {
    ($py:expr, $table:expr, $results:expr, $rows:expr, $($name:ident),+ $(,)?) => {
        $($table.set_item(stringify!($name), column($py, $results, $rows, |row| &row.$name)?)?;)+
    };
}

/// A row per accepted increment.
#[rustfmt::skip] // one line for each kind of column
pub fn history<'py>(py: Python<'py>, results: &Arc<Results>) -> PyResult<Bound<'py, PyDict>> {
    let table = PyDict::new(py);
    columns!(py, table, results, |r: &Results| &r.history[..],
        increment, alpha, load, max_pressure, half_width, contact_force, closed_pairs, plastic_points,
        max_equivalent_plastic_strain, iterations, trailing_solves, residual);
    let events = results.history.iter().map(|row| row.event.as_str());
    table.set_item("event", events.collect::<Vec<&str>>())?;
    for (place, name) in results.history_columns.iter().enumerate() {
        let values = results.history.iter().map(|row| row.measured[place]);
        table.set_item(name, read_only(PyArray1::from_iter(py, values).into_any())?)?;
    }
    Ok(table)
}

/// A row per contact pair of a state.
#[rustfmt::skip]
pub fn pairs<'py>(
    py: Python<'py>,
    results: &Arc<Results>,
    state: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let table = PyDict::new(py);
    columns!(py, table, results, |r: &Results| &r.states[state].pairs[..], pair, contact);
    table.set_item("x", column(py, results, |r: &Results| &r.states[state].pairs[..], |row| &row.position[0])?)?;
    table.set_item("y", column(py, results, |r: &Results| &r.states[state].pairs[..], |row| &row.position[1])?)?;
    table.set_item("z", column(py, results, |r: &Results| &r.states[state].pairs[..], |row| &row.position[2])?)?;
    columns!(py, table, results, |r: &Results| &r.states[state].pairs[..], gap, force, area, pressure);
    let closed = results.states[state].pairs.iter().map(|row| row.status == Status::Closed);
    table.set_item("closed", PyArray1::from_iter(py, closed))?;
    Ok(table)
}

/// A row per state, with a column for each quantity. They are collected from the states.
pub fn states<'py>(py: Python<'py>, results: &Results) -> PyResult<Bound<'py, PyDict>> {
    let table = PyDict::new(py);
    let names = results.states.iter().map(|row| row.name.as_str());
    table.set_item("name", names.collect::<Vec<&str>>())?;
    for quantity in &QUANTITIES {
        let values = results.states.iter().map(quantity.in_state.get);
        let column = if quantity.is_count {
            PyArray1::from_iter(py, values.map(|count| count as isize)).into_any()
        } else {
            PyArray1::from_iter(py, values).into_any()
        };
        table.set_item(quantity.key, read_only(column)?)?;
    }
    Ok(table)
}

/// Fields of a state; `None` where it has none.
pub fn fields<'py>(
    py: Python<'py>,
    results: &Arc<Results>,
    state: usize,
) -> PyResult<Option<Bound<'py, PyDict>>> {
    let Some(own) = &results.states[state].fields else {
        return Ok(None);
    };
    // The mesh's dimension, and the components of a stress in it.
    let dimension = own.displacement.len() / results.sizes.nodes.max(1);
    let components = if dimension == 3 { 6 } else { 4 };
    let table = PyDict::new(py);
    let add = |name: &str, part: fn(&Fields) -> &[f64], width: Option<usize>| {
        table.set_item(name, field(py, results, state, part, width)?)
    };
    add("displacement", |f| &f.displacement, Some(dimension))?;
    add("stress", |f| &f.stress, Some(components))?;
    add("nodal_stress", |f| &f.nodal_stress, Some(components))?;
    add("von_mises", |f| &f.von_mises, None)?;
    // The names of the .vtu files; the shorter ones are earlier versions'.
    for name in ["equivalent_plastic_strain", "plastic_strain"] {
        add(name, |f| &f.plastic_strain, None)?;
    }
    for name in ["discretisation_error", "error"] {
        add(name, |f| &f.error, None)?;
    }
    add("contact_pressure", |f| &f.contact_pressure, None)?;
    add("gap", |f| &f.gap, None)?;
    let yielded = field(py, results, state, |f| &f.yielded[..], None)?;
    table.set_item("yielded", yielded)?;
    Ok(Some(table))
}

fn field<'py, T: Number>(
    py: Python<'py>,
    results: &Arc<Results>,
    state: usize,
    part: fn(&Fields) -> &[T],
    width: Option<usize>,
) -> PyResult<Bound<'py, PyAny>> {
    lent(
        py,
        results,
        |r| (r.states[state].fields.as_ref()).map_or(&[], part),
        width,
    )
}
