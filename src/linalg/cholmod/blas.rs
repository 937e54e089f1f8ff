//! BLAS in use, and its number of threads.
//!
//! CHOLMOD spends its time in BLAS: without an optimised BLAS it is several times slower.
//!
//! OpenBLAS takes a work buffer of up to 128 MB of address space for each thread, and repeats the
//! request endlessly if the system refuses. Therefore, if the address space is limited (`ulimit
//! -v`), only one caller at a time enters the BLAS ([`enter`]), and the first caller checks
//! beforehand that there is room for its buffer.

use crate::error::{Error, Result};
use crate::memory;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

/// Address space of the work buffer of one thread: the largest value among the builds of OpenBLAS
/// (32 << 22 bytes).
const BUFFER: f64 = (32u64 << 22) as f64;

/// Permission to call the BLAS: a lock if the address space is limited; `None` if all threads may
/// call the BLAS at the same time.
pub(super) type Entered = Option<MutexGuard<'static, bool>>;

/// Waits for the permission to call the BLAS.
///
/// # Errors
/// `Analysis` if the limits of the process leave no room for the work buffer.
pub(super) fn enter() -> Result<Entered> {
    static LIMITED: OnceLock<bool> = OnceLock::new();
    static HAS_BUFFER: Mutex<bool> = Mutex::new(false);
    if !cfg!(openblas) || !LIMITED.get_or_init(|| memory::limits().is_some()) {
        return Ok(None);
    }
    let mut has_buffer = HAS_BUFFER.lock().unwrap_or_else(PoisonError::into_inner);
    if !*has_buffer {
        let left = memory::limits().unwrap_or(f64::INFINITY);
        if left < BUFFER {
            return Err(Error::analysis(format!(
                "out of memory: the BLAS needs a work buffer of {:.0} MB and the limits of this \
                 process leave {:.0} MB: raise them (ulimit -v)",
                BUFFER / 1e6,
                (left / 1e6).floor()
            )));
        }
        if blas_threads_are_too_many() {
            set_blas_threads(1);
        }
        take_buffer();
        *has_buffer = true;
    }
    Ok(Some(has_buffer))
}

/// Whether the limits of the process leave too little for the work buffers of all BLAS threads, for
/// as much other data of the threads, and for the work itself.
pub fn blas_threads_are_too_many() -> bool {
    let threads = blas_threads().unwrap_or(1);
    let needed = 2.0 * BUFFER * (threads as f64 + 1.0);
    threads > 1 && memory::limits().is_some_and(|left| left < needed)
}

/// Makes OpenBLAS allocate its work buffer, which it keeps.
fn take_buffer() {
    #[cfg(openblas)]
    {
        let (one, mut entry, mut info) = (1, 1.0, 0);
        // SAFETY: a matrix of one row, whose only entry is read and written.
        unsafe { openblas::dpotrf_(c"L".as_ptr(), &one, &mut entry, &one, &mut info) };
    }
}

/// The configuration functions of OpenBLAS, from `ffi/openblas.h`.
#[cfg(openblas)]
#[allow(missing_docs)]
mod openblas {
    include!(concat!(env!("OUT_DIR"), "/openblas.rs"));
}

/// Name, build options, processor kernels and threads of the BLAS in use, for instance
/// `OpenBLAS 0.3.21 DYNAMIC_ARCH NO_AFFINITY Haswell MAX_THREADS=64 (kernels Haswell, 2 threads)`.
pub fn blas_name() -> String {
    // The name can only be read from OpenBLAS, and only if it was found at build time.
    let (Some(configuration), Some(kernels)) = (configuration(), kernels()) else {
        return String::from("system BLAS, not known to be OpenBLAS");
    };
    let threads = blas_threads().unwrap_or(1);
    let plural = if threads == 1 { "" } else { "s" };
    format!("{configuration} (kernels {kernels}, {threads} thread{plural})")
}

/// Version and build options of OpenBLAS; `None` for another BLAS.
fn configuration() -> Option<String> {
    #[cfg(openblas)]
    {
        // SAFETY: takes nothing, reads the library's configuration.
        text(unsafe { openblas::openblas_get_config() })
    }
    #[cfg(not(openblas))]
    None
}

/// Processor whose kernels OpenBLAS uses (`Haswell`); `None` for another BLAS.
pub fn kernels() -> Option<String> {
    #[cfg(openblas)]
    {
        // SAFETY: takes nothing, reads the library's configuration.
        text(unsafe { openblas::openblas_get_corename() })
    }
    #[cfg(not(openblas))]
    None
}

/// Whether this OpenBLAS contains kernels for several processors and chooses among them on loading.
pub(super) fn has_choice() -> bool {
    configuration().is_some_and(|options| options.contains("DYNAMIC_ARCH"))
}

/// Converts a text of OpenBLAS' configuration.
#[cfg(openblas)]
fn text(pointer: *mut std::ffi::c_char) -> Option<String> {
    if pointer.is_null() {
        return None;
    }
    // SAFETY: not null, and OpenBLAS returns pointers to static, terminated strings.
    let text = unsafe { std::ffi::CStr::from_ptr(pointer) };
    Some(text.to_string_lossy().trim().to_owned())
}

/// Number of threads that the BLAS uses; `None` if the BLAS is not OpenBLAS.
pub fn blas_threads() -> Option<usize> {
    #[cfg(openblas)]
    {
        // SAFETY: takes nothing, reads the library's configuration.
        let threads = unsafe { openblas::openblas_get_num_threads() };
        usize::try_from(threads).ok()
    }
    #[cfg(not(openblas))]
    None
}

/// Sets the number of BLAS threads for the whole process; returns false if this is not possible.
pub fn set_blas_threads(threads: usize) -> bool {
    #[cfg(openblas)]
    {
        let threads = threads.clamp(1, 1024) as std::ffi::c_int;
        // SAFETY: the function clamps to what the library was built for.
        unsafe { openblas::openblas_set_num_threads(threads) };
        true
    }
    #[cfg(not(openblas))]
    {
        let _ = threads;
        false
    }
}
