//! Quantities by their keys, and numbers by their paths.

use super::border::{exclusive, guarded, shared, text};
use super::results::brinell_results;
use crate::error::Error;
use crate::results::{self, QUANTITIES, Quantity};
use std::ffi::{CString, c_char};
use std::sync::LazyLock;

/// Number of the quantities that a state has.
#[unsafe(no_mangle)]
pub extern "C" fn brinell_n_quantities() -> usize {
    QUANTITIES.len()
}

/// The key of quantity `index`, from 0, as in summary.json: "load", "half_width", "residual_depth"
/// and so on; NULL if there is no such quantity. Static.
#[unsafe(no_mangle)]
pub extern "C" fn brinell_quantity_key(index: usize) -> *const c_char {
    static KEYS: LazyLock<Vec<CString>> = LazyLock::new(|| {
        let key = |quantity: &Quantity| CString::new(quantity.key).unwrap_or_default();
        QUANTITIES.iter().map(key).collect()
    });
    KEYS.get(index).map_or(std::ptr::null(), |key| key.as_ptr())
}

/// A number of the results by its path in summary.json: "yield.KEY" at first yield, or
/// "states.NAME.KEY" of a state, where the number of the state, from 0, may stand for its name.
/// Counts are numbers too; a number that is not known is NaN. The status is BRINELL_INPUT if the
/// results have no such number.
///
/// # Safety
/// `results` is a living handle; `path` is a text that ends with a zero byte; `value` may be
/// written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_results_value(
    results: *const brinell_results,
    path: *const c_char,
    value: *mut f64,
) -> i32 {
    guarded(|| {
        // SAFETY: the caller vouches for every pointer.
        unsafe {
            let results = &shared(results, "the results")?.results;
            let path = text(path, "the path")?;
            let found = results::value(results, path).ok_or_else(|| {
                Error::input(format!(
                    "`{path}` is no number of these results: give yield.KEY or states.NAME.KEY"
                ))
            })?;
            *exclusive(value, "the place for the value")? = found;
        }
        Ok(())
    })
}
