//! What must not matter: units, sizes, numbering, order, threads, mirrors.

mod arrays;
mod dent;
mod directions;
mod loads;
mod mirrors;
mod numbering;
mod threads;
mod units;
