//! Speed that a test can hold: what a run does, counted, whatever machine it runs on.

mod allocations;
#[cfg(any(feature = "cholmod", feature = "faer"))]
mod counts;
#[cfg(any(feature = "cholmod", feature = "faer"))]
mod effects;
#[cfg(any(feature = "cholmod", feature = "faer"))]
mod many;
#[path = "../running/mod.rs"]
mod running;
