//! The sparse backends against the dense reference: the same condensed matrix, the same yield load,
//! the same histories.
//!
//! The dense backend does by textbook formulas what the sparse ones do with a constrained ordering
//! and partial solves. It shares no code with them below `Condensed`, so agreement to 1e-10 leaves
//! no room for a wrong block, sign or permutation.
#![cfg(any(feature = "cholmod", feature = "faer"))]

mod agreement;
mod parts;
mod random;
mod round;
mod scenes;
