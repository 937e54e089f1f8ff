//! Errors of brinell as exceptions.

use brinell::{Error, ErrorKind};
use pyo3::prelude::*;

/// The exception of an error (`brinell.Error` or one of its kinds), with what was computed before,
/// if anything was.
pub fn exception(py: Python<'_>, error: &Error, result: Option<Py<PyAny>>) -> PyErr {
    let kind = match error.kind() {
        ErrorKind::Input => "input",
        ErrorKind::Unsupported => "unsupported",
        ErrorKind::Io => "io",
        ErrorKind::Unheld => "unheld",
        ErrorKind::Analysis => "analysis",
        ErrorKind::Collapse => "collapse",
        ErrorKind::Inaccurate => "inaccurate",
        ErrorKind::Outgrown => "outgrown",
        ErrorKind::Stopped => "stopped",
        _ => "internal",
    };
    let mut text = error.to_string();
    for cause in error.causes() {
        text.push_str(&format!("\ncaused by: {cause}"));
    }
    made(py, kind, error.kind(), &text, result)
}

fn made(py: Python<'_>, kind: &str, of: ErrorKind, text: &str, result: Option<Py<PyAny>>) -> PyErr {
    let make = || -> PyResult<PyErr> {
        let make = py.import("brinell._errors")?.getattr("make")?;
        let value = make.call1((kind, of.exit_code(), text, result))?;
        Ok(PyErr::from_value(value))
    };
    make().unwrap_or_else(|failure| failure)
}

/// Takes the value, or raises the error.
pub trait Raise<T> {
    /// As Python sees it.
    fn raise(self, py: Python<'_>) -> PyResult<T>;
}

impl<T> Raise<T> for brinell::Result<T> {
    fn raise(self, py: Python<'_>) -> PyResult<T> {
        self.map_err(|error| exception(py, &error, None))
    }
}

/// The exception of a name that is not there.
pub fn missing(py: Python<'_>, message: &str) -> PyErr {
    made(py, "missing", ErrorKind::Input, message, None)
}

/// The exception of wrong input.
pub fn wrong(py: Python<'_>, message: String) -> PyErr {
    exception(py, &Error::input(message), None)
}
