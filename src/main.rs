//! The program `brinell`.

use std::alloc::{GlobalAlloc, Layout, System};
use std::io::Write;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

/// The allocator of the system. If memory runs out, the program reports how much was requested and
/// ends with an exit code of its own; without this allocator Rust would abort the program.
struct OrEnd;

#[global_allocator]
static ALLOCATOR: OrEnd = OrEnd;

// SAFETY: each call is handed on as it is to the system's allocator, which keeps the contract.
unsafe impl GlobalAlloc for OrEnd {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller's promise.
        there(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller's promise.
        there(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: the caller's promise.
        there(unsafe { System.realloc(block, layout, size) }, size)
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise.
        unsafe { System.dealloc(block, layout) }
    }
}

fn there(block: *mut u8, bytes: usize) -> *mut u8 {
    if block.is_null() {
        out_of_memory(bytes);
    }
    block
}

/// Ends the process at once, without cleaning up what other threads may be using.
#[cold]
fn out_of_memory(bytes: usize) -> ! {
    static ENDING: AtomicBool = AtomicBool::new(false);
    if !ENDING.swap(true, Ordering::SeqCst) {
        // The message is built on the stack, since there is no memory for anything else.
        let mut text = [0u8; 160];
        let mut rest = &mut text[..];
        let _ = writeln!(
            rest,
            "error: out of memory: {bytes} bytes were asked for: use a coarser mesh, or raise the \
             limit of this process (ulimit -v)"
        );
        let length = 160 - rest.len();
        let _ = std::io::stderr().write_all(&text[..length]);
    }
    _exit(i32::from(brinell::ErrorKind::Analysis.exit_code()))
}

// SAFETY: the function of the C library takes any number and does not return.
unsafe extern "C" {
    safe fn _exit(code: std::ffi::c_int) -> !;
}

fn main() -> ExitCode {
    brinell::cli::main()
}
