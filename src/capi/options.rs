//! Options for the computation.

use super::border::{SizePrefixed, take};
use crate::error::{Error, Result};
use crate::linalg::Backend;

/// The backend that the library was built for.
pub const BRINELL_BACKEND_DEFAULT: i32 = 0;
/// Sparse Cholesky of SuiteSparse.
pub const BRINELL_BACKEND_CHOLMOD: i32 = 1;
/// Dense, by the textbook: a reference for small models.
pub const BRINELL_BACKEND_DENSE: i32 = 2;
/// Sparse Cholesky in pure Rust (faer).
pub const BRINELL_BACKEND_FAER: i32 = 3;

/// Options of the computation. NULL stands for the defaults, which are all zeros.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct brinell_options {
    /// sizeof(brinell_options).
    pub size: usize,
    /// One of BRINELL_BACKEND_...
    pub backend: i32,
}

// SAFETY: repr(C), begins with its size, numbers only.
unsafe impl SizePrefixed for brinell_options {
    const NAME: &'static str = "brinell_options";
}

/// Returns the backend that options ask for.
///
/// # Safety
/// The conditions of [`take`].
pub(super) unsafe fn backend(options: *const brinell_options) -> Result<Backend> {
    let default = brinell_options {
        size: size_of::<brinell_options>(),
        backend: BRINELL_BACKEND_DEFAULT,
    };
    // SAFETY: as vouched for by the caller.
    match unsafe { take(options, default) }?.backend {
        BRINELL_BACKEND_DEFAULT => Ok(Backend::default()),
        BRINELL_BACKEND_CHOLMOD => Ok(Backend::Cholmod),
        BRINELL_BACKEND_DENSE => Ok(Backend::Dense),
        BRINELL_BACKEND_FAER => Ok(Backend::Faer),
        other => Err(Error::input(format!(
            "brinell_options: there is no backend {other}"
        ))),
    }
}
