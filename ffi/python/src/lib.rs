//! Python bindings of brinell: elastoplastic contact without friction.
//!
//! The module `brinell._brinell`; the package `brinell` beside it adds the exceptions. Arrays come
//! in as they lie in memory and leave as numpy's views of what the analysis computed. The
//! interpreter is free while the analysis works.

mod arrays;
mod errors;
mod kernels;
mod lent;
mod model;
mod observer;
mod run;
mod structure;
mod tables;
mod threads;

use pyo3::prelude::*;

#[pymodule]
mod _brinell {
    #[pymodule_export]
    use super::model::Model;
    #[pymodule_export]
    use super::run::{RunResult, State, check, main, new, run, yield_load};
    #[pymodule_export]
    use super::structure::Structure;
    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
