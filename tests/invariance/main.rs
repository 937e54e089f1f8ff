//! What must not matter: units, sizes, numbering, order, threads, mirrors.

mod arrays;
mod dent;
mod loads;
mod mirrors;
mod numbering;
#[path = "../running/mod.rs"]
mod running;
mod threads;
mod units;
