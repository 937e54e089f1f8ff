//! Speed that a test can hold: what a run does, counted, whatever machine it runs on.

mod allocations;
#[cfg(feature = "cholmod")]
mod counts;
#[cfg(feature = "cholmod")]
mod many;
#[path = "../running/mod.rs"]
mod running;
