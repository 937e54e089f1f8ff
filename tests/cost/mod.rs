//! Speed that a test can hold: what a run does, counted, whatever machine it runs on. Most
//! models are too large for the dense backend.
#![cfg(any(feature = "cholmod", feature = "faer"))]

mod allocations;
mod counts;
mod effects;
mod many;
