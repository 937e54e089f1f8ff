//! Three dimensions: elements, contact and plasticity of solids.

mod extruded;
mod generated;
mod grid;
mod hertz;
mod patch;
#[cfg(feature = "report")]
mod report;
mod thick;
