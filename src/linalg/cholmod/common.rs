//! `cholmod_common`: parameters, status and statistics of one factorisation.

use crate::error::{Error, ErrorKind, Result};
use std::mem::MaybeUninit;
use suitesparse_sys as sys;

/// CHOLMOD's parameter and status object. Each factor owns one, so factors share no state.
pub(super) struct Common {
    raw: Box<sys::cholmod_common>,
}

// SAFETY: the workspace behind the pointers belongs to this object alone, and CHOLMOD keeps no
// state per thread: what one thread started another may use.
unsafe impl Send for Common {}

/// Memory that must be available before METIS is called, as a multiple of the workspace that
/// CHOLMOD expects METIS to take.
const METIS_RESERVE: f64 = 2.0;

impl Common {
    /// Starts CHOLMOD: no output, one given ordering, left-looking LL'.
    pub(super) fn start() -> Result<Self> {
        super::kernels::warn_of_slow_kernels();
        let mut raw: MaybeUninit<sys::cholmod_common> = MaybeUninit::zeroed();
        // SAFETY: `cholmod_l_start` writes every field it reads later; all of them are integers,
        // floats, pointers or optional functions, for which zero is a valid value.
        let (started, raw) = unsafe { (sys::cholmod_l_start(raw.as_mut_ptr()), raw.assume_init()) };
        let mut raw = Box::new(raw);
        if started == 0 {
            return Err(Error::internal(format!(
                "CHOLMOD did not start (status {})",
                raw.status
            )));
        }
        // Failures are reported as errors of this crate, never as text on a stream.
        raw.print = 0;
        raw.error_handler = None;
        raw.try_catch = 1;
        raw.itype = sys::CHOLMOD_LONG as i32;
        raw.nmethods = 1;
        raw.current = 0;
        raw.method[0].ordering = sys::CHOLMOD_GIVEN as i32;
        // A postorder of the whole elimination tree would mix the groups of freedoms; `ordering`
        // computes one for each group.
        raw.postorder = 0;
        raw.supernodal = sys::CHOLMOD_AUTO as i32;
        raw.final_ll = 1;
        raw.quick_return_if_not_posdef = 1;
        raw.useGPU = 0;
        // METIS ends the process if memory runs out, so CHOLMOD checks beforehand whether there is
        // enough.
        raw.metis_memory = METIS_RESERVE;
        Ok(Common { raw })
    }

    /// Lets CHOLMOD choose and postorder its own ordering, as it does by default.
    pub(super) fn choose_ordering(&mut self) {
        self.raw.nmethods = 0;
        self.raw.postorder = 1;
    }

    /// Object to pass to CHOLMOD.
    pub(super) fn as_mut(&mut self) -> &mut sys::cholmod_common {
        &mut self.raw
    }

    /// Object from which statistics are read.
    pub(super) fn get(&self) -> &sys::cholmod_common {
        &self.raw
    }

    /// Returns the error of the last call, if any; `what` was being done on `n` freedoms.
    pub(super) fn check(&self, what: &str, n: usize) -> Result<()> {
        // Ten long integers a freedom: ordering, tree, counts.
        self.check_asking(what, n, 80.0 * n as f64)
    }

    /// Returns the error like [`Common::check`], for a call that needed about `bytes` bytes.
    pub(super) fn check_asking(&self, what: &str, n: usize, bytes: f64) -> Result<()> {
        let status = self.raw.status;
        if status >= sys::CHOLMOD_OK as i32 {
            return Ok(());
        }
        let used = self.raw.memory_inuse as f64 / 1e6;
        Err(match status {
            sys::CHOLMOD_OUT_OF_MEMORY => Error::new(
                ErrorKind::Analysis,
                format!(
                    "out of memory in the {what} of {n} freedoms: it asked for about {:.0} MB, \
                     with {used:.0} MB in use by CHOLMOD: use a coarser mesh, a smaller zone or a \
                     machine with more memory",
                    (bytes / 1e6).ceil()
                ),
            ),
            sys::CHOLMOD_TOO_LARGE => Error::new(
                ErrorKind::Analysis,
                format!(
                    "the {what} of {n} freedoms is too large for the integers of CHOLMOD or its \
                     BLAS: use a coarser mesh"
                ),
            ),
            sys::CHOLMOD_NOT_INSTALLED => Error::input(format!(
                "this CHOLMOD lacks the method for the {what} of {n} freedoms: install a complete \
                 SuiteSparse"
            )),
            _ => Error::internal(format!(
                "CHOLMOD failed in the {what} of {n} freedoms (status {status})"
            )),
        })
    }

    /// Frees the workspace; the next call that needs one allocates it again.
    pub(super) fn free_workspace(&mut self) {
        // SAFETY: `raw` was started and frees what it allocated.
        unsafe { sys::cholmod_l_free_work(&mut *self.raw) };
    }
}

impl Drop for Common {
    fn drop(&mut self) {
        // SAFETY: `raw` was started and is finished once.
        unsafe { sys::cholmod_l_finish(&mut *self.raw) };
    }
}

/// Version of the CHOLMOD library in use, for instance `3.0.14`.
pub fn cholmod_version() -> String {
    let mut version = [0; 3];
    // SAFETY: the function writes three integers.
    unsafe { sys::cholmod_l_version(version.as_mut_ptr()) };
    format!("{}.{}.{}", version[0], version[1], version[2])
}
