//! The C interface from the outside: header, installation, programs in C, C++ and Rust.

mod header;
mod install;
