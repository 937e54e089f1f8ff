//! Progress of a run: the callback, and Ctrl-C.

use brinell::panics::outside;
use brinell::progress::{Flow, Observer};
use brinell::results::HistoryRow;
use pyo3::prelude::*;
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// Time between two looks at the signals: each needs the interpreter.
const LOOK: Duration = Duration::from_millis(50);

/// Calls back after each increment and stops where the callback returns something true, raises, or Ctrl-C was pressed.
pub struct Watcher {
    callback: Option<Py<PyAny>>,
    raised: Mutex<Option<PyErr>>,
    looked: Mutex<Instant>,
}

impl Watcher {
    pub fn new(callback: Option<Py<PyAny>>) -> Self {
        Watcher {
            callback,
            raised: Mutex::new(None),
            looked: Mutex::new(Instant::now()),
        }
    }

    /// What the callback or a signal raised.
    pub fn into_raised(self) -> Option<PyErr> {
        self.raised.into_inner().unwrap_or_else(|e| e.into_inner())
    }

    fn keep(&self, error: PyErr) {
        let mut raised = self.raised.lock().unwrap_or_else(|e| e.into_inner());
        raised.get_or_insert(error);
    }

    /// Whether the run must stop.
    fn asks(&self, act: impl FnOnce(Python<'_>) -> PyResult<bool>) -> bool {
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
        let stop = self.asks(|py| {
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
        self.asks(|_| Ok(false))
    }
}
