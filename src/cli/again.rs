//! Begins the program anew where OpenBLAS, which reads its settings as it is loaded, needs others
//! than it was given.

use std::os::unix::process::CommandExt;
use std::process::Command;

const THREADS: &str = "OPENBLAS_NUM_THREADS";
/// How long a thread of OpenBLAS spins after its work before it sleeps, as a power of two in cycles
/// of the processor. OpenBLAS' own 26 is some 20 ms: where other processes run, each of its short
/// calls keeps a processor from them, and from this one, for so long. `2^20` is a third of a
/// millisecond, some ten times what it takes to wake a thread.
const SPINNING: (&str, &str) = ("OPENBLAS_THREAD_TIMEOUT", "20");

/// Begins anew with the settings that the BLAS should have had; returns where it has them.
pub(super) fn start_with_better_settings() {
    let needed = [fewer_threads(), better_kernels()];
    let mut settings: Vec<_> = needed.into_iter().flatten().collect();
    let Ok(program) = std::env::current_exe() else {
        return;
    };
    if settings.is_empty() {
        return;
    }
    // Beginning anew for this alone would cost more than it saves short runs.
    if std::env::var_os(SPINNING.0).is_none() {
        settings.push(SPINNING);
    }
    let mut arguments = std::env::args_os();
    let mut again = Command::new(program);
    if let Some(name) = arguments.next() {
        again.arg0(name);
    }
    // Only returns where it fails; the run goes on as it is.
    let _ = again.args(arguments).envs(settings).exec();
}

/// One thread where limits of the process leave no room for the work buffers of more: these are
/// asked for without end.
fn fewer_threads() -> Option<(&'static str, &'static str)> {
    let is_set = std::env::var_os(THREADS).is_some_and(|threads| threads == "1");
    let are_too_many = !is_set && crate::linalg::cholmod::blas_threads_are_too_many();
    are_too_many.then_some((THREADS, "1"))
}

/// The kernels that the processor has, unless the user named some.
fn better_kernels() -> Option<(&'static str, &'static str)> {
    use crate::linalg::cholmod::{KERNEL_SETTING, better_kernels};
    better_kernels().map(|kernels| (KERNEL_SETTING, kernels))
}
