//! The C library of this very build, for the programs that are tested against it: what `make
//! install` makes is the crate itself as another kind of library, which would be compiled anew.

pub use brinell::capi::*;
