//! Switch that turns off CHOLMOD's own parallel loops.
//!
//! CHOLMOD 3 copies each supernode in loops of four OpenMP threads, however small the supernode and
//! however few the processors, in addition to the threads of the BLAS. On two cores these loops
//! take as long as the factorisation of a plane model itself (`cargo bench --bench history`). The
//! BLAS keeps its threads.

/// Functions of the OpenMP runtime, from `ffi/openmp.h`.
#[cfg(openmp)]
#[allow(missing_docs)]
mod runtime {
    include!(concat!(env!("OUT_DIR"), "/openmp.rs"));
}

/// Guard: while it lives, parallel regions entered by this thread run on this thread alone.
pub(super) struct Serial {
    #[cfg(openmp)]
    levels: std::ffi::c_int,
    /// The setting belongs to this thread and must be restored on it.
    _here: std::marker::PhantomData<*const ()>,
}

impl Serial {
    pub(super) fn new() -> Self {
        Serial {
            #[cfg(openmp)]
            // SAFETY: both functions read and write a setting of the calling thread alone.
            levels: unsafe {
                let levels = runtime::omp_get_max_active_levels();
                runtime::omp_set_max_active_levels(0);
                levels
            },
            _here: std::marker::PhantomData,
        }
    }
}

impl Drop for Serial {
    fn drop(&mut self) {
        #[cfg(openmp)]
        // SAFETY: as above; the value is the one that was found.
        unsafe {
            runtime::omp_set_max_active_levels(self.levels);
        }
    }
}
