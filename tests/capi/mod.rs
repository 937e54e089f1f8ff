//! The C interface from the outside: header, installation, programs in C, C++, Rust and Python.

mod header;
mod install;
mod python;
