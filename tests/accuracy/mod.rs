//! What a run says about its own errors, against closed forms and finer meshes.

mod claims;
pub mod demand;
mod estimate;
mod file_mesh;
mod indicator;
mod plastic_zone;
mod solid;
mod study;
