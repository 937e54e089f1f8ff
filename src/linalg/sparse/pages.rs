//! Large pages for the numerical factor: its first touch costs a fault for every 2 MB, not for
//! every 4 KB.
//!
//! On a virtual machine a fault may take 15 microseconds: more than half the time of a
//! factorisation of a plane model.

use std::ffi::c_void;

/// Size to which the system's advice is aligned: no page is smaller, and a piece left out at an end
/// costs nothing.
const ALIGNMENT: usize = 1 << 21;

/// Asks for large pages behind `bytes` of memory that was allocated and not touched yet. Advice
/// only: a system that has none goes on without.
#[cfg(target_os = "linux")]
pub(crate) fn prefer_large(start: *mut c_void, bytes: usize) {
    let skipped = start.align_offset(ALIGNMENT);
    let whole = bytes.saturating_sub(skipped) / ALIGNMENT * ALIGNMENT;
    if whole > 0 {
        let first = start.cast::<u8>().wrapping_add(skipped).cast();
        // SAFETY: the range lies within the allocation, whose contents the advice leaves alone.
        let _ = unsafe { rustix::mm::madvise(first, whole, rustix::mm::Advice::LinuxHugepage) };
    }
}

/// Asks for nothing where such advice is unknown.
#[cfg(not(target_os = "linux"))]
pub(crate) fn prefer_large(_: *mut c_void, _: usize) {}
