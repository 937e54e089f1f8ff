//! The threads of the program.

use crate::error::{Error, Result};
use std::sync::atomic::{AtomicBool, Ordering};

/// Starts the threads (one per processor if no number is given), of which this thread is one: it
/// works on small pieces itself instead of waking another thread and waiting for it. Later calls
/// change nothing.
pub(super) fn start_threads(threads: Option<usize>) -> Result<()> {
    static STARTED: AtomicBool = AtomicBool::new(false);
    if STARTED.swap(true, Ordering::Relaxed) {
        return Ok(());
    }
    let start = |threads: usize| {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .use_current_thread()
            .build_global()
    };
    match threads {
        Some(threads) => start(threads).map_err(|cause| {
            Error::analysis(format!(
                "cannot start {threads} threads: ask for fewer (--threads)"
            ))
            .because(cause)
        }),
        // If the limits of the process allow no more threads, this thread does all the work.
        None => {
            let _ = start(0).or_else(|_| start(1));
            Ok(())
        }
    }
}
