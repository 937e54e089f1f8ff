//! Three dimensions: elements, contact and plasticity of solids.

mod grid;
mod hertz;
mod patch;
