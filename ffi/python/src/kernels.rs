//! Says once, in Python's log, that the BLAS computes with less than the processor has.

use pyo3::prelude::*;
use std::sync::Once;

/// A warning of the logger `brinell` where the kernels of the BLAS are slow; once in a process.
pub fn warn_of_slow(py: Python<'_>) {
    static SAID: Once = Once::new();
    SAID.call_once(|| {
        let Some(warning) = brinell::linalg::slow_kernels() else {
            return;
        };
        // A log that cannot be written to is no reason not to compute.
        let _ = py
            .import("logging")
            .and_then(|logging| logging.call_method1("getLogger", ("brinell",)))
            .and_then(|logger| logger.call_method1("warning", (warning,)));
    });
}
