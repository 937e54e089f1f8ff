//! The result directory: what is in it, and that it appears whole or not at all.

mod arrays;
mod browser;
mod directory;
mod fields;
mod fixture;
#[path = "../running/interpreter.rs"]
mod interpreter;
#[path = "../running/limit.rs"]
mod limit;
mod python;
mod report;
mod summary;
mod svg;
mod tables;
mod vtu;
