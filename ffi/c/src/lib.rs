//! brinell as a library for C (`ffi/include/brinell.h`), which `make install` installs.

pub use brinell::capi::*;
