//! The result directory: what is in it, and that it appears whole or not at all.

mod arrays;
mod browser;
mod directory;
mod fields;
mod fixture;
mod python;
mod report;
mod summary;
mod tables;
mod vtu;
