//! Three dimensions: elements, contact and plasticity of solids.

mod covered;
mod extruded;
mod generated;
mod held;
mod hertz;
mod integration;
mod nodal_forces;
mod once;
mod patch;
mod patches;
mod punch;
#[cfg(feature = "report")]
mod report;
#[cfg(feature = "report")]
mod swept;
mod thick;
