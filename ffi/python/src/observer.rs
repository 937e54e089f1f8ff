//! Progress of a run: the callback, and Ctrl-C.

use brinell::panics::outside;
use brinell::progress::{Flow, Observer};
use brinell::results::HistoryRow;
use pyo3::prelude::*;
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::{Duration, Instant};

/// Time between two looks at the signals: each needs the interpreter.
pub const LOOK: Duration = Duration::from_millis(50);

/// Calls back after each increment and stops where the callback returns something true, raises, or
/// Ctrl-C was pressed.
pub struct Watcher {
    callback: Option<Py<PyAny>>,
    signals: Signals,
    looked: Mutex<Instant>,
}

impl Watcher {
    pub fn new(callback: Option<Py<PyAny>>) -> Self {
        Watcher {
            callback,
            signals: Signals::default(),
            looked: Mutex::new(Instant::now()),
        }
    }

    /// What the callback or a signal raised.
    pub fn into_raised(self) -> Option<PyErr> {
        self.signals.raised().take()
    }

    /// What stops the run, for the thread that waits for it.
    pub fn signals(&self) -> Signals {
        self.signals.clone()
    }
}

/// The exception that stops a run, if one was raised.
#[derive(Clone, Default)]
pub struct Signals(Arc<Mutex<Option<PyErr>>>);

impl Signals {
    /// Looks whether Ctrl-C was pressed; Python tells it to its main thread only.
    pub fn look(&self) {
        self.asks(|_| Ok(false));
    }

    fn raised(&self) -> MutexGuard<'_, Option<PyErr>> {
        self.0.lock().unwrap_or_else(|e| e.into_inner())
    }

    fn keep(&self, error: PyErr) {
        self.raised().get_or_insert(error);
    }

    /// Whether the run must stop.
    fn asks(&self, act: impl FnOnce(Python<'_>) -> PyResult<bool>) -> bool {
        if self.raised().is_some() {
            return true;
        }
        outside(|| {
            Python::attach(|py| {
                py.check_signals()
                    .and_then(|()| act(py))
                    .unwrap_or_else(|error| {
                        self.keep(error);
                        true
                    })
            })
        })
    }
}

impl Observer for Watcher {
    fn increment(&mut self, row: &HistoryRow, fraction: f64) -> Flow {
        let stop = self.signals.asks(|py| {
            let Some(callback) = &self.callback else {
                return Ok(false);
            };
            let increment = pythonize::pythonize(py, row)?;
            increment.set_item("fraction", fraction)?;
            callback.call1(py, (increment,))?.is_truthy(py)
        });
        if stop { Flow::Stop } else { Flow::Continue }
    }

    fn stop_requested(&self) -> bool {
        {
            let mut looked = self.looked.lock().unwrap_or_else(|e| e.into_inner());
            if looked.elapsed() < LOOK {
                return false;
            }
            *looked = Instant::now();
        }
        self.signals.asks(|_| Ok(false))
    }
}
