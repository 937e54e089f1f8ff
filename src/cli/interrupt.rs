//! Ctrl-C: the first asks the run to end after its increment, the second ends the program.

use crate::error::{Error, ErrorKind, Result};
use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};

static REQUESTED: AtomicBool = AtomicBool::new(false);

/// Has the user asked the run to end?
pub(super) fn requested() -> bool {
    REQUESTED.load(Ordering::Relaxed)
}

/// Starts listening.
///
/// # Errors
/// The system refuses the signal handler.
pub(super) fn listen() -> Result<()> {
    ctrlc::set_handler(|| {
        if REQUESTED.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(ErrorKind::Stopped.exit_code()));
        }
        let _ = writeln!(
            std::io::stderr(),
            "stopping after this increment; Ctrl-C again ends at once, without results"
        );
    })
    .map_err(|cause| Error::internal("cannot listen for Ctrl-C").because(cause))
}
