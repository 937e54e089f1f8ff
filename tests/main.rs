//! All tests through the public interface, in one program: one folder a suite.
//!
//! `cargo test --test all cli::` runs one of them. Runs over several ranks (`tests/mpi`) and
//! damaged inputs (`tests/fuzz`, which measures the memory of its process) have programs of their
//! own.

mod accuracy;
mod backends;
mod capi;
mod cli;
mod cost;
mod decks;
mod drift;
mod invariance;
mod mortar;
mod output;
mod properties;
mod solid;
mod stability;
mod support;
mod verification;
