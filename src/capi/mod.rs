//! The C interface (feature `capi`). The header `ffi/include/brinell.h` is generated from this
//! module.
//!
//! Every function returns a status ([`BRINELL_OK`] or one of the numbers that the program returns
//! as its exit code) and leaves the reason in [`brinell_last_error`] of the calling thread. Handles
//! are opaque, owned by the caller and freed by their own function; NULL may be freed. Structures
//! that cross the border begin with their size, so that later versions may add to them. No panic
//! crosses the border and nothing is printed ([`crate::panics`]). There is no global state: handles
//! may be used in different threads at once, one handle by one thread at a time.
#![allow(non_camel_case_types)]

mod border;
mod conditions;
mod model;
mod options;
mod patches;
mod quantities;
mod results;
mod run;
mod scene;
mod structure;

pub use border::*;
pub use conditions::*;
pub use model::*;
pub use options::*;
pub use patches::*;
pub use quantities::*;
pub use results::*;
pub use run::*;
pub use scene::*;
pub use structure::*;

#[cfg(test)]
mod tests;
