//! Panics become errors at the interface to other languages: none unwinds into the caller or is
//! printed.
//!
//! A panic of brinell is a fault of brinell; its message and place belong in the error, not on the
//! screen of a program that uses brinell. The panic hook belongs to the process, though. The hook
//! that is set here, with the first call of [`contained`], suppresses only panics of threads that
//! are inside such a call, and of rayon's workers during such a call; all other panics are passed
//! on to the previous hook. A program in C or Python has its own copy of Rust's runtime, and
//! therefore a hook that nothing else uses.

use crate::error::{Error, Result};
use std::cell::{Cell, RefCell};
use std::panic::{self, AssertUnwindSafe, catch_unwind};
use std::sync::Once;
use std::sync::atomic::{AtomicUsize, Ordering};

thread_local! {
    /// Number of nested calls of [`contained`] in this thread.
    static DEPTH: Cell<usize> = const { Cell::new(0) };
    /// Source location of the last panic of this thread.
    static PLACE: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// Number of calls of [`contained`] in all threads.
static CALLS: AtomicUsize = AtomicUsize::new(0);
static HOOK: Once = Once::new();

/// Runs `act`; a panic becomes an error of kind [`crate::ErrorKind::Internal`], and nothing is
/// printed.
///
/// # Errors
/// Errors of `act`, and a panic of `act`.
pub fn contained<T>(act: impl FnOnce() -> Result<T>) -> Result<T> {
    // The hook cannot be changed while this thread unwinds; the next call will set it.
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

/// Runs code of the caller (a callback) from inside [`contained`]: its panics are not contained.
pub fn outside<T>(callback: impl FnOnce() -> T) -> T {
    let _back = Restore(DEPTH.replace(0));
    callback()
}

/// Guard that counts a call until it is dropped, even by unwinding.
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
        // If the value cannot be read, the thread is being torn down and is not inside a call.
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

    /// Panics inside calls, in this thread and in workers, and one outside of a call.
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
