//! Helpers for the border between Rust and C: statuses, messages, pointers, structures that contain
//! their size.

use crate::error::{Error, Result};
use crate::panics::contained;
use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char};

/// The call succeeded.
pub const BRINELL_OK: i32 = 0;
/// An argument, the scene or the mesh is wrong, or asks for an effect that brinell does not have.
pub const BRINELL_INPUT: i32 = 2;
/// A file could not be read or written.
pub const BRINELL_IO: i32 = 3;
/// The model is not held: a body can move freely.
pub const BRINELL_UNHELD: i32 = 4;
/// The analysis failed: a solve did not converge or a target was not reached.
pub const BRINELL_ANALYSIS: i32 = 5;
/// The load passed the limit load.
pub const BRINELL_COLLAPSE: i32 = 6;
/// The run is complete, but a state's quality misses its tolerance, an accuracy that the scene
/// demands was not reached, or the message names another reason not to trust the results.
pub const BRINELL_INACCURATE: i32 = 7;
/// Contact reached the end of the contact candidates, although the bodies extend beyond it.
pub const BRINELL_OUTGROWN: i32 = 8;
/// A fault of brinell itself.
pub const BRINELL_INTERNAL: i32 = 70;
/// The callback stopped the run.
pub const BRINELL_STOPPED: i32 = 130;

thread_local! {
    static LAST_ERROR: RefCell<CString> = RefCell::new(CString::default());
}

/// The message of the last failure in this thread, UTF-8; empty before the first one. Valid until
/// the next failure in this thread.
#[unsafe(no_mangle)]
pub extern "C" fn brinell_last_error() -> *const c_char {
    LAST_ERROR.with_borrow(|text| text.as_ptr())
}

/// The version of the library, such as "0.1.0". Static.
#[unsafe(no_mangle)]
pub extern "C" fn brinell_version() -> *const c_char {
    const VERSION: &CStr =
        match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
            Ok(text) => text,
            Err(_) => c"",
        };
    VERSION.as_ptr()
}

/// The version of this interface: raised where a program built against an older header would break.
#[unsafe(no_mangle)]
pub extern "C" fn brinell_abi_version() -> u32 {
    2
}

/// Runs `act` and turns a failure or a panic into a status with a message.
pub(super) fn guarded(act: impl FnOnce() -> Result<()>) -> i32 {
    match contained(act) {
        Ok(()) => BRINELL_OK,
        Err(error) => note(&error),
    }
}

/// Stores an error for [`brinell_last_error`] and returns its status.
pub(super) fn note(error: &Error) -> i32 {
    let mut text = error.to_string();
    for cause in error.causes() {
        text.push_str(&format!("\ncaused by: {cause}"));
    }
    let text = CString::new(text.replace('\0', " ")).unwrap_or_default();
    LAST_ERROR.set(text);
    i32::from(error.kind().exit_code())
}

/// Refuses NULL and lengths for which no memory could exist.
fn check<T>(is_null: bool, n: usize, what: &str) -> Result<()> {
    if is_null {
        return Err(Error::input(format!(
            "{what}: NULL was given for {n} values"
        )));
    }
    if n > isize::MAX as usize / size_of::<T>().max(1) {
        return Err(Error::input(format!(
            "{what}: {n} values exceed any memory"
        )));
    }
    Ok(())
}

/// Returns `n` values behind a pointer; NULL is allowed if `n` is 0.
///
/// # Safety
/// `data` is NULL or points to `n` values that live and do not change as long as the slice.
pub(super) unsafe fn slice<'a, T>(data: *const T, n: usize, what: &str) -> Result<&'a [T]> {
    if n == 0 {
        return Ok(&[]);
    }
    check::<T>(data.is_null(), n, what)?;
    // SAFETY: not NULL, of a possible length; the caller vouches for the rest.
    Ok(unsafe { std::slice::from_raw_parts(data, n) })
}

/// Returns `n` values to write to.
///
/// # Safety
/// `data` is NULL or points to `n` values that nobody else uses as long as the slice lives.
pub(super) unsafe fn slice_mut<'a, T>(data: *mut T, n: usize, what: &str) -> Result<&'a mut [T]> {
    if n == 0 {
        return Ok(&mut []);
    }
    check::<T>(data.is_null(), n, what)?;
    // SAFETY: not NULL, of a possible length; the caller vouches for the rest.
    Ok(unsafe { std::slice::from_raw_parts_mut(data, n) })
}

/// Returns a text as `str`.
///
/// # Safety
/// `text` is NULL or points to a text that ends with a zero byte and lives as long as the result.
pub(super) unsafe fn text<'a>(text: *const c_char, what: &str) -> Result<&'a str> {
    if text.is_null() {
        return Err(Error::input(format!("{what} is NULL")));
    }
    // SAFETY: not NULL; the caller vouches for the rest.
    let text = unsafe { CStr::from_ptr(text) };
    text.to_str()
        .map_err(|cause| Error::input(format!("{what} is not UTF-8")).because(cause))
}

/// Returns a reference to the value behind a pointer.
///
/// # Safety
/// `handle` is NULL or points to a living value that nobody changes as long as the reference lives.
pub(super) unsafe fn shared<'a, T>(handle: *const T, what: &str) -> Result<&'a T> {
    // SAFETY: as vouched for by the caller; NULL becomes None.
    unsafe { handle.as_ref() }.ok_or_else(|| Error::input(format!("{what} is NULL")))
}

/// Returns a mutable reference to the value behind a pointer.
///
/// # Safety
/// `handle` is NULL or points to a living value that nobody else uses as long as the reference
/// lives.
pub(super) unsafe fn exclusive<'a, T>(handle: *mut T, what: &str) -> Result<&'a mut T> {
    // SAFETY: as vouched for by the caller; NULL becomes None.
    unsafe { handle.as_mut() }.ok_or_else(|| Error::input(format!("{what} is NULL")))
}

/// Creates a handle and stores it at the place that the caller gives.
///
/// # Safety
/// `out` is NULL or may be written to.
pub(super) unsafe fn hand_out<T>(out: *mut *mut T, value: T) -> Result<()> {
    // SAFETY: as vouched for by the caller.
    *unsafe { exclusive(out, "the place for the result") }? = Box::into_raw(Box::new(value));
    Ok(())
}

/// Drops a handle; NULL is ignored.
///
/// # Safety
/// `handle` is NULL or came from [`hand_out`] and was not freed before.
pub(super) unsafe fn free<T>(handle: *mut T) {
    if !handle.is_null() {
        // SAFETY: made by Box::into_raw and given up by the caller. Dropping it must not unwind
        // into C.
        let _ = contained(|| {
            drop(unsafe { Box::from_raw(handle) });
            Ok(())
        });
    }
}

/// A structure that begins with its size as `usize`.
///
/// # Safety
/// An implementor is `repr(C)`, its first field is that size, and any bytes are a value of it.
pub(super) unsafe trait SizePrefixed: Copy {
    /// Name of the structure, for messages.
    const NAME: &'static str;
}

/// Largest number of bytes that a later version of a structure may have.
const MOST_BYTES: usize = 1 << 12;

fn known_bytes<T: SizePrefixed>(size: usize) -> Result<usize> {
    if !(size_of::<usize>()..=MOST_BYTES).contains(&size) {
        return Err(Error::input(format!(
            "{}: its first field says that it has {size} bytes; set it to sizeof",
            T::NAME
        )));
    }
    Ok(size.min(size_of::<T>()))
}

/// Copies a structure of the caller, which may be older than this library (shorter: the missing
/// part is taken from `default`) or newer (longer: the additional part is ignored). Returns
/// `default` for NULL.
///
/// # Safety
/// `from` is NULL or points to a structure as long as its first field says.
pub(super) unsafe fn take<T: SizePrefixed>(from: *const T, default: T) -> Result<T> {
    let mut value = default;
    if !from.is_null() {
        // SAFETY: every such structure begins with its size; only as many bytes as both sides know
        // are copied.
        unsafe {
            let bytes = known_bytes::<T>(from.cast::<usize>().read_unaligned())?;
            std::ptr::copy_nonoverlapping(from.cast::<u8>(), (&raw mut value).cast::<u8>(), bytes);
        }
    }
    Ok(value)
}

/// Fills a structure of the caller up to the size that the caller set; the size itself is not
/// changed.
///
/// # Safety
/// `to` is NULL or points to a structure as long as its first field says.
pub(super) unsafe fn give<T: SizePrefixed>(to: *mut T, value: &T) -> Result<()> {
    if to.is_null() {
        return Err(Error::input(format!("{} is NULL", T::NAME)));
    }
    // SAFETY: as in `take`; the size itself is skipped.
    unsafe {
        let bytes = known_bytes::<T>(to.cast::<usize>().read_unaligned())?;
        let head = size_of::<usize>();
        std::ptr::copy_nonoverlapping(
            std::ptr::from_ref(value).cast::<u8>().add(head),
            to.cast::<u8>().add(head),
            bytes - head,
        );
    }
    Ok(())
}
