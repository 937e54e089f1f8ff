//! Large pages for the numerical factor: its first touch then costs a page fault for every 2 MB,
//! not for every 4 KB.
//!
//! On a virtual machine a page fault may take 15 microseconds: more than half the time of a
//! factorisation of a plane model.

use std::ffi::c_void;

/// Alignment of the range for which large pages are requested. No large page is smaller, and a
/// piece left out at either end does no harm.
const ALIGNMENT: usize = 1 << 21;

/// Requests large pages for `bytes` of memory that was allocated but not touched yet. This is
/// advice only: a system without large pages goes on without them.
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

/// Does nothing on systems without such advice.
#[cfg(not(target_os = "linux"))]
pub(crate) fn prefer_large(_: *mut c_void, _: usize) {}
