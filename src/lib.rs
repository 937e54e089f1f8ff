//! Elastoplastic contact without friction on one sparse factorisation.
//!
//! brinell presses elastic-plastic bodies together and lets them go again: where they touch, how
//! hard, where the material yields and what dent stays. It follows N. Endahl, *Finite Element
//! Analysis of Elastoplastic Contact Problems Without Friction*: the elastic stiffness is factored
//! once, everything but the contact freedoms and the zone that may yield is condensed, contact is a
//! small dense problem, plastic strains enter as initial loads on the right-hand side.
//!
//! ```text
//!  scene ─▶ mesh ─▶ model ─▶ assembly ─▶ substructure ─▶ contact ─▶ analysis ─▶ results ─▶ output
//!  (what    (nodes,  (freedoms, (K, loads)  (condense:       (pairs,    (yield load,  (states,  (files)
//!   is       elements, pairs,               K → S_cc)         events)    increments)   history)
//!   asked)   sets)     loads)
//! ```
//!
//! A module imports only from modules declared above it; a test holds that.
//!
//! # From a scene to results
//!
//! ```
//! use brinell::{analysis::Analysis, linalg::Backend, model::Model, progress::Silent, scene::Scene};
//!
//! # fn main() -> brinell::Result<()> {
//! // A shaft that is 0.05 too thick for its ring; Lame gives a pressure of 78.75.
//! let scene = Scene::parse(
//!     r#"
//!     kind = "plane_stress"
//!     mesh.parts = [
//!         { body = "shaft", disc = { radius = 50.0, elements = 16 } },
//!         { body = "ring", ring = { radius = [50.0, 100.0], elements = [16, 16] } },
//!     ]
//!     materials.steel = { youngs_modulus = 210e3, poissons_ratio = 0.3 }
//!     bodies = { shaft = { material = "steel" }, ring = { material = "steel" } }
//!     contact = [{ first = "shaft.outer", second = "ring.inner", interference = 0.05 }]
//!     support = [
//!         { on = "shaft.start", fix = ["y"] }, { on = "shaft.end", fix = ["x"] },
//!         { on = "ring.start", fix = ["y"] }, { on = "ring.end", fix = ["x"] },
//!     ]
//!     program.targets = [{ name = "fitted", load_factor = 0.0 }]
//!     "#,
//!     "shrink fit",
//! )?;
//! let results = Analysis::new(Model::new(&scene)?, Backend::default())?.run(&mut Silent)?;
//! assert!((results.states[0].max_pressure / 78.75 - 1.0).abs() < 0.01);
//! # Ok(())
//! # }
//! ```
//!
//! A model may also come from arrays ([`model::ModelBuilder`]); programs with elements of their own hand over a sparse stiffness and
//! contact rows ([`constrained::ConstrainedStructure`]). Other languages: `ffi/README.md`.
//!
//! # Features
//!
//! `cholmod` (default) condenses with SuiteSparse's CHOLMOD; without it (`default-features = false`) the crate is pure Rust and solves densely,
//! up to 6000 freedoms. `capi` adds the C interface.
//!
//! # Versions
//!
//! Semantic versioning: before 1.0 a minor version may break what a patch may not. It covers public items, scene keys, keys of `summary.json`,
//! columns of tables, exit codes and the C header (which has a version of its own, raised where programs must be compiled anew). The types of
//! [`scene`] and [`results`] may gain fields in any minor version: build them with `..Default::default()`. Digits at the level of round-off may
//! change with any version, and so may the texts of messages. A later Rust than 1.89 may be asked for by a minor version.
#![warn(missing_docs)]

// Blank lines keep the order of the data: rustfmt sorts neighbouring lines.
pub mod error;

pub mod panics;

pub mod analytical;

pub mod shape;

pub mod scene;

pub mod mesh;

pub mod material;

pub mod element;

pub mod model;

pub mod linalg;

pub mod assembly;

pub mod contact;

pub mod substructure;

pub mod constrained;

pub mod results;

pub mod progress;

pub mod analysis;

pub mod accuracy;

pub mod output;

pub mod selftest;

#[cfg(feature = "capi")]
pub mod capi;

pub mod cli;

pub use error::{Error, ErrorKind, Result};
