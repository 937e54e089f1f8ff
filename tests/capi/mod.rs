//! The C interface from the outside: header, installation, programs in C, C++, Rust and Python.

mod demand;
mod header;
mod install;
mod python;
