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
