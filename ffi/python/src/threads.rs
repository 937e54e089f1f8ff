//! Runs on a number of threads.

use crate::errors::wrong;
use crate::observer::{LOOK, Signals};
use brinell::{Error, Result};
use pyo3::prelude::*;
use std::sync::mpsc::{RecvTimeoutError, sync_channel};

/// The argument `threads` as a number; `None` where the caller leaves it to brinell.
pub fn number(py: Python<'_>, threads: Option<i64>) -> PyResult<Option<usize>> {
    threads
        .map(|given| {
            let number = u16::try_from(given).ok().filter(|&number| number > 0);
            let bounds = || format!("threads is {given}; give a number from 1 to {}", u16::MAX);
            number.map(usize::from).ok_or_else(|| wrong(py, bounds()))
        })
        .transpose()
}

/// Does `work` on threads of their own, as many as said, else in the calling one with those that
/// there are. Only the calling thread may look for Ctrl-C: it does so while it waits.
///
/// # Errors
/// Those of `work`; threads that cannot be started.
pub fn on<T: Send>(
    threads: Option<usize>,
    signals: &Signals,
    work: impl FnOnce() -> Result<T> + Send,
) -> Result<T> {
    let Some(threads) = threads else {
        return work();
    };
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|cause| Error::input(format!("cannot start {threads} threads")).because(cause))?;
    let (done, wait) = sync_channel(1);
    std::thread::scope(|scope| {
        // The receiver outlives the thread: sending cannot fail.
        scope.spawn(|| done.send(pool.install(work)));
        loop {
            match wait.recv_timeout(LOOK) {
                Ok(result) => return result,
                Err(RecvTimeoutError::Timeout) => signals.look(),
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(Error::internal(
                        "the thread of the run ended without a result",
                    ));
                }
            }
        }
    })
}
