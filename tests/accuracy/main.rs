//! What a run says about its own errors, against closed forms.

#[path = "../running/mod.rs"]
mod running;

mod claim;
mod consistent;
mod demand;
mod effectivity;
mod file_mesh;
mod indicator;
mod parts;
mod price;
mod study;
