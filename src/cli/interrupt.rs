//! Ctrl-C: the first asks the run to end at the last accepted increment, the second ends the program.

use super::progress::json_line;
use crate::error::{Error, ErrorKind, Result};
use serde_json::json;
use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

static REQUESTED: AtomicBool = AtomicBool::new(false);
/// A second signal this soon is the same wish: `timeout` and terminals send one to the process and one to its group.
const SAME_WISH: Duration = Duration::from_millis(200);

const STOPPING: &str =
    "stopping at the end of this increment; Ctrl-C again ends at once, without results";

/// Has the user asked the run to end?
pub(super) fn requested() -> bool {
    REQUESTED.load(Ordering::Relaxed)
}

/// Starts listening. What is heard is told on standard error: as a line for a reader, or where progress goes there as JSON since `json` as an
/// event of its own.
///
/// # Errors
/// The system refuses the signal handler.
pub(super) fn listen(json: Option<Instant>) -> Result<()> {
    let mut first: Option<Instant> = None;
    ctrlc::set_handler(move || {
        REQUESTED.store(true, Ordering::Relaxed);
        match first {
            Some(first) if first.elapsed() > SAME_WISH => {
                std::process::exit(i32::from(ErrorKind::Stopped.exit_code()));
            }
            Some(_) => {}
            None => {
                first = Some(Instant::now());
                match json {
                    Some(started) => json_line(started, "stopping", json!({ "message": STOPPING })),
                    None => {
                        let _ = writeln!(std::io::stderr(), "{STOPPING}");
                    }
                }
            }
        }
    })
    .map_err(|cause| Error::internal("cannot listen for Ctrl-C").because(cause))
}
