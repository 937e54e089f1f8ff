//! Which BLAS does the work, and on how many threads.
//!
//! CHOLMOD spends its time in BLAS: without an optimised one it is several times slower.

/// The configuration functions of OpenBLAS, from `ffi/openblas.h`.
#[cfg(openblas)]
#[allow(missing_docs)]
mod openblas {
    include!(concat!(env!("OUT_DIR"), "/openblas.rs"));
}

/// Name, build options, processor kernels and threads of the BLAS in use, for instance
/// `OpenBLAS 0.3.21 DYNAMIC_ARCH NO_AFFINITY Haswell MAX_THREADS=64 (kernels Haswell, 2 threads)`.
#[cfg(openblas)]
pub fn blas_name() -> String {
    let text = |pointer: *mut std::ffi::c_char| {
        if pointer.is_null() {
            return String::from("unknown");
        }
        // SAFETY: not null, and OpenBLAS returns pointers to static, terminated strings.
        let text = unsafe { std::ffi::CStr::from_ptr(pointer) };
        text.to_string_lossy().trim().to_owned()
    };
    // SAFETY: both functions take nothing and only read the library's configuration.
    let (configuration, core) = unsafe {
        (
            openblas::openblas_get_config(),
            openblas::openblas_get_corename(),
        )
    };
    let threads = blas_threads().unwrap_or(1);
    format!(
        "{} (kernels {}, {threads} thread{})",
        text(configuration),
        text(core),
        if threads == 1 { "" } else { "s" }
    )
}

/// Without OpenBLAS at build time nothing can be asked: the system's BLAS has no name.
#[cfg(not(openblas))]
pub fn blas_name() -> String {
    String::from("system BLAS, not known to be OpenBLAS")
}

/// Threads that the BLAS uses; `None` where the BLAS cannot be asked.
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

/// Sets the threads that the BLAS uses, for the whole process; false where it cannot be set.
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
