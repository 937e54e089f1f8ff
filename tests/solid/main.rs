//! Three dimensions: elements, contact and plasticity of solids.

mod extruded;
mod generated;
mod grid;
mod held;
mod hertz;
mod patch;
mod patches;
mod punch;
#[cfg(feature = "report")]
mod report;
#[cfg(feature = "report")]
#[path = "../output/svg.rs"]
mod svg;
mod swept;
mod thick;
