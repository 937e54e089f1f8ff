//! Restarts the program with other settings of OpenBLAS if the present ones do not suit: OpenBLAS
//! reads its settings only when it is loaded.

use std::os::unix::process::CommandExt;
use std::process::Command;

const THREADS: &str = "OPENBLAS_NUM_THREADS";
/// Time that a thread of OpenBLAS spins after its work before it sleeps, as a power of two in
/// cycles of the processor. OpenBLAS' default of 26 is some 20 ms: if other processes run, each
/// short call of OpenBLAS keeps a processor from them, and from this process, for that long. `2^20`
/// is a third of a millisecond, some ten times the time that it takes to wake a thread.
const SPINNING: (&str, &str) = ("OPENBLAS_THREAD_TIMEOUT", "20");

/// Restarts the program with the settings that the BLAS needs; returns if they are set already.
pub(super) fn start_with_better_settings() {
    let needed = [fewer_threads(), better_kernels()];
    let mut settings: Vec<_> = needed.into_iter().flatten().collect();
    let Ok(program) = std::env::current_exe() else {
        return;
    };
    if settings.is_empty() {
        return;
    }
    // Restarting for this setting alone would cost more than it saves in short runs.
    if std::env::var_os(SPINNING.0).is_none() {
        settings.push(SPINNING);
    }
    let mut arguments = std::env::args_os();
    let mut again = Command::new(program);
    if let Some(name) = arguments.next() {
        again.arg0(name);
    }
    // Only returns if it fails; the run then continues as it is.
    let _ = again.args(arguments).envs(settings).exec();
}

/// Returns the setting for one thread if limits of the process leave no room for the work buffers
/// of several threads: OpenBLAS would request these buffers forever.
fn fewer_threads() -> Option<(&'static str, &'static str)> {
    let is_set = std::env::var_os(THREADS).is_some_and(|threads| threads == "1");
    let are_too_many = !is_set && crate::linalg::cholmod::blas_threads_are_too_many();
    are_too_many.then_some((THREADS, "1"))
}

/// Returns the setting for the kernels of this processor, unless the user chose kernels.
fn better_kernels() -> Option<(&'static str, &'static str)> {
    use crate::linalg::cholmod::{KERNEL_SETTING, better_kernels};
    better_kernels().map(|kernels| (KERNEL_SETTING, kernels))
}
