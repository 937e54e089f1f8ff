//! Signals: the first asks the run to end at the last accepted increment, the second ends the
//! program.

use super::streams::json_line;
use crate::error::{Error, ErrorKind, Result};
use serde_json::json;
use std::io::Write;
use std::sync::atomic::{AtomicI32, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The signal that was received first, 0 before that.
static HEARD: AtomicI32 = AtomicI32::new(0);
/// Time within which a second signal counts as the same request: `timeout` and terminals send one
/// to the process and one to its group.
const SAME_WISH: Duration = Duration::from_millis(200);
/// The number of Ctrl-C, the same on all systems.
const SIGINT: i32 = 2;

/// Whether a signal asked the run to end.
pub(super) fn requested() -> bool {
    heard().is_some()
}

fn heard() -> Option<i32> {
    Some(HEARD.load(Ordering::Relaxed)).filter(|&signal| signal != 0)
}

/// Returns the exit code of a run that was stopped: 128 plus the number of the signal (130 after
/// Ctrl-C).
pub(super) fn exit_code() -> u8 {
    let code = heard().and_then(|signal| u8::try_from(128 + signal).ok());
    code.unwrap_or(ErrorKind::Stopped.exit_code())
}

/// Returns the name of what stopped the run: `Ctrl-C`, or the name of the signal.
pub(super) fn name() -> Option<&'static str> {
    match heard()? {
        SIGINT => Some("Ctrl-C"),
        #[cfg(unix)]
        signal => signal_hook::low_level::signal_name(signal),
        #[cfg(not(unix))]
        _ => None,
    }
}

/// The start time for reports as JSON (`None` for reports as text), and the action before a second
/// signal ends the program. The static below is `None` before anything listens.
type Wish = (Option<Instant>, Box<dyn Fn() + Send + Sync>);
static WISH: Mutex<Option<Wish>> = Mutex::new(None);

/// Starts listening; if something listens already, the new arguments replace the old ones. A signal
/// is reported on standard error: as a line of text, or, if `json` gives the time since which
/// progress is reported as JSON, as an event. `at_once` is called before a second signal ends the
/// program.
///
/// # Errors
/// The system refuses the signal handler.
pub(super) fn listen(
    json: Option<Instant>,
    at_once: impl Fn() + Send + Sync + 'static,
) -> Result<()> {
    let wish: Wish = (json, Box::new(at_once));
    let before = WISH
        .lock()
        .unwrap_or_else(PoisonError::into_inner)
        .replace(wish);
    if before.is_some() {
        return Ok(());
    }
    let first: Mutex<Option<Instant>> = Mutex::new(None);
    let hear = move |signal: i32| {
        let (Ok(mut first), Ok(wish)) = (first.lock(), WISH.lock()) else {
            return;
        };
        let Some((json, at_once)) = &*wish else {
            return;
        };
        match *first {
            Some(first) if first.elapsed() > SAME_WISH => {
                at_once();
                std::process::exit(i32::from(exit_code()));
            }
            Some(_) => {}
            None => {
                HEARD.store(signal, Ordering::Relaxed);
                *first = Some(Instant::now());
                tell(*json);
            }
        }
    };
    call_at_signals(hear)
        .map_err(|cause| Error::analysis("cannot listen for signals").because(cause))
}

fn tell(json: Option<Instant>) {
    let text = format!(
        "{}: stopping at the end of this increment; a second one ends at once, without results",
        name().unwrap_or("signal")
    );
    match json {
        Some(started) => json_line(started, "stopping", json!({ "message": text })),
        None => {
            let _ = writeln!(std::io::stderr(), "{text}");
        }
    }
}

/// Calls `hear` for signals that end a run. Queues of batch systems warn with SIGUSR1, which
/// `mpirun` passes on to all ranks.
#[cfg(unix)]
fn call_at_signals(hear: impl Fn(i32) + Send + Sync + 'static) -> std::io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGTERM, SIGUSR1};
    let ends = [SIGINT, SIGTERM, SIGHUP, SIGUSR1];
    let mut signals = signal_hook::iterator::Signals::new(ends)?;
    std::thread::Builder::new()
        .name("signals".to_string())
        .spawn(move || signals.forever().for_each(hear))
        .map(drop)
}

#[cfg(not(unix))]
fn call_at_signals(
    hear: impl Fn(i32) + Send + Sync + 'static,
) -> std::result::Result<(), ctrlc::Error> {
    ctrlc::set_handler(move || hear(SIGINT))
}

/// Makes a helping rank ignore signals: it ends with the first rank, which may still have to write
/// results.
#[cfg(feature = "mumps")]
pub(super) fn leave_to_first_rank() {
    // If this fails, the first rank still ends by itself.
    let _ = call_at_signals(|_| {});
}

/// Ignores SIGXFSZ: a file beyond the size limit (`ulimit -f`) then is a failed write, not the end
/// of the program.
pub(super) fn ignore_file_size_signal() {
    #[cfg(unix)]
    {
        let unread = std::sync::Arc::default();
        // If this fails, the default action of the system remains.
        let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, unread);
    }
}
