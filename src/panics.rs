//! Panics become errors where another language calls: none unwinds into it, and none is printed.
//!
//! A panic of brinell is a fault of brinell; its message and place belong into the error, not onto
//! the screen of a program that brinell is a part of. The panic hook belongs to the process,
//! though. The one that is set here, with the first call of [`contained`], keeps silent only about
//! panics of threads that are inside such a call, and of rayon's workers while there is one; all
//! others go on to the hook that was there before. A program in C or Python has a copy of Rust's
//! runtime, and so a hook, that no one else uses.

use crate::error::{Error, Result};
use std::cell::{Cell, RefCell};
use std::panic::{self, AssertUnwindSafe, catch_unwind};
use std::sync::Once;
use std::sync::atomic::{AtomicUsize, Ordering};

thread_local! {
    /// How many calls of [`contained`] this thread is inside of.
    static DEPTH: Cell<usize> = const { Cell::new(0) };
    /// Where the last panic of this thread was.
    static PLACE: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// Calls of [`contained`] in all threads.
static CALLS: AtomicUsize = AtomicUsize::new(0);
static HOOK: Once = Once::new();

/// Runs `act`; its panic becomes an error of kind [`crate::ErrorKind::Internal`] and nothing is
/// printed.
///
/// # Errors
/// Errors of `act`, and its panic.
pub fn contained<T>(act: impl FnOnce() -> Result<T>) -> Result<T> {
    // The hook cannot be changed while this thread unwinds; the next call will do it.
    if !std::thread::panicking() {
        HOOK.call_once(keep_silent_inside);
    }
    let _inside = Inside::enter();
    catch_unwind(AssertUnwindSafe(act)).unwrap_or_else(|payload| {
        let text = payload.downcast_ref::<String>().cloned();
        let text = text.or_else(|| payload.downcast_ref::<&str>().map(|t| t.to_string()));
        let place = PLACE.take().map_or(String::new(), |p| format!(" at {p}"));
        Err(Error::internal(format!(
            "panic{place}: {}",
            text.unwrap_or_default()
        )))
    })
}

/// Runs code of the caller (a callback) from inside [`contained`]: its panics are none of ours.
pub fn outside<T>(callback: impl FnOnce() -> T) -> T {
    let _back = Restore(DEPTH.replace(0));
    callback()
}

/// Counts a call until it is dropped, also by unwinding.
struct Inside;

impl Inside {
    fn enter() -> Self {
        DEPTH.set(DEPTH.get() + 1);
        CALLS.fetch_add(1, Ordering::SeqCst);
        Inside
    }
}

impl Drop for Inside {
    fn drop(&mut self) {
        DEPTH.set(DEPTH.get() - 1);
        CALLS.fetch_sub(1, Ordering::SeqCst);
    }
}

struct Restore(usize);

impl Drop for Restore {
    fn drop(&mut self) {
        DEPTH.set(self.0);
    }
}

fn keep_silent_inside() {
    let before = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        // Without a value the thread is being torn down, and inside no call.
        let inside = DEPTH.try_with(Cell::get).unwrap_or(0) > 0;
        let for_a_call =
            rayon::current_thread_index().is_some() && CALLS.load(Ordering::SeqCst) > 0;
        if inside {
            let place = info.location().map(ToString::to_string);
            let _ = PLACE.try_with(|p| p.replace(place));
        } else if !for_a_call {
            before(info);
        }
    }));
}

#[cfg(test)]
mod tests {
    use super::*;
    use rayon::prelude::*;
    use std::process::Command;

    /// Panics inside calls, in this thread and in workers, and one outside.
    #[test]
    #[ignore = "run by the test below, whose stderr is looked at"]
    fn panics_of_all_sorts() {
        let error = contained(|| -> Result<()> { panic!("in the thread {}", 1) }).unwrap_err();
        assert_eq!(error.kind(), crate::ErrorKind::Internal);
        assert!(error.message().contains("in the thread 1"), "{error}");
        assert!(error.message().contains("panics.rs:"), "{error}");
        let error = contained(|| -> Result<()> {
            (0..1000).into_par_iter().for_each(|i| {
                assert!(i != 700, "in a worker");
            });
            Ok(())
        })
        .unwrap_err();
        assert!(error.message().contains("in a worker"), "{error}");
        let caught = contained(|| {
            Ok(outside(|| {
                catch_unwind(|| panic!("in the caller's callback")).is_err()
            }))
        });
        assert!(caught.unwrap());
        assert!(contained(|| -> Result<()> { panic!("after a callback") }).is_err());
        assert!(catch_unwind(|| panic!("outside of any call")).is_err());
    }

    #[test]
    fn only_panics_outside_of_calls_are_printed() {
        let output = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "panics::tests::panics_of_all_sorts"])
            .args(["--ignored", "--nocapture", "--test-threads=1"])
            .output()
            .unwrap();
        let printed = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{printed}");
        for silent in ["in the thread", "in a worker", "after a callback"] {
            assert!(!printed.contains(silent), "{printed}");
        }
        for loud in ["in the caller's callback", "outside of any call"] {
            assert!(printed.contains(loud), "{printed}");
        }
    }
}
