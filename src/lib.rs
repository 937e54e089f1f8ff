//! Elastoplastic contact without friction on one sparse factorisation.
//!
//! brinell presses elastic-plastic bodies together and unloads them: it computes where they touch,
//! how hard, where the material yields and what dent remains. It follows N. Endahl, *Finite Element
//! Analysis of Elastoplastic Contact Problems Without Friction*: the elastic stiffness is factored
//! once, everything but the contact freedoms and the zone that may yield is condensed, contact is a
//! small dense problem, and plastic strains enter as initial loads on the right-hand side.
//!
//! ```text
//!  scene ─▶ mesh ─▶ model ─▶ assembly ─▶ substructure ─▶ contact ─▶ analysis ─▶ results ─▶ output
//!  (what   (nodes,  (free-   (K, loads) (condense:      (pairs,   (yield load, (states,  (files)
//!   is      ele-     doms,               K → S_cc)       events)   increments)  history)
//!   asked)  ments,   pairs,
//!           sets)    loads)
//! ```
//!
//! A module imports only from modules declared above it; a test checks that.
//! `data/guide/theory.md`, "Equations of the paper", says which function implements each equation.
//!
//! # Use
//!
//! ```
//! use brinell::{analysis::Analysis, linalg::Backend, model::Model};
//! use brinell::{progress::Silent, scene::Scene};
//!
//! # fn main() -> brinell::Result<()> {
//! let scene = Scene::load("data/scenes/contact_patch.toml")?;
//! let results = Analysis::new(Model::new(&scene)?, Backend::default())?.run(&mut Silent)?;
//! // The contact transmits a uniform pressure unchanged.
//! assert!((results.states[0].max_pressure - 10.0).abs() < 1e-9);
//! # Ok(())
//! # }
//! ```
//!
//! | to | use |
//! |---|---|
//! | read or make a scene | [`scene::Scene`] |
//! | run on a mesh of one's own | [`mesh::gmsh`], [`model::Model::from_mesh`]; from arrays [`model::ModelBuilder`] |
//! | compute | [`analysis::Analysis`]: the whole program or the yield load |
//! | watch a run, or stop it | [`progress::Observer`] |
//! | read what came out | [`results::Results`]; as files [`output`] |
//! | list what is reported, or add to it | [`results::QUANTITIES`] |
//! | compare with what the scene names | [`reference::compare`] |
//! | solve contact on a stiffness of one's own | [`constrained::ConstrainedStructure`] |
//! | estimate the error of a number, or demand an accuracy | [`accuracy::estimate()`], [`accuracy::reach()`] |
//! | know whether a run met all requirements | [`results::Results::ending`] |
//! | compare with closed forms | [`analytical`] |
//!
//! The library never prints, never ends the process and holds no global state; everything that can
//! fail returns [`Error`], whose [`ErrorKind`] says what kind of failure it is and whose message
//! names file, key, node or body, the value, and what to do.
//!
//! # Features
//!
//! - `cholmod` (default): condense with CHOLMOD of SuiteSparse, which must be installed with its
//!   headers (and libclang, to read them). Its supernodal module is GPL-2.0-or-later, and so is any
//!   program that is linked with it.
//! - `faer`: condense with faer, in pure Rust, for models of any size without any system library
//!   (`default-features = false, features = ["faer"]`), MIT or Apache-2.0.
//! - `capi`: the C interface (`ffi/include/brinell.h`; `make install` builds the libraries with
//!   it).
//! - `cli` (default): the program. A library does not need it:
//!   `default-features = false, features = ["cholmod"]` leaves out clap, indicatif, maud and
//!   plotters.
//! - `mumps`: MUMPS over MPI for the freedoms outside the zone, CHOLMOD for the rest.
//! - `guide`: the guide as the module `guide` of the documentation.
//! - `report` (with `cli` and `capi`): `report.html` of a result folder, and the plots of a study.
//! - Without features (`default-features = false`) only the dense backend is available, which takes
//!   up to 6000 freedoms.
//!
//! # Stability
//!
//! Semantic versioning, as described in CONTRIBUTING.md under "Versions".
#![warn(missing_docs)]

// Blank lines keep the modules in the order of the data flow: rustfmt sorts adjacent lines.
mod text;

mod number;

mod root;

mod interpolation;

mod classes;

#[cfg(feature = "guide")]
#[doc = include_str!(concat!(env!("OUT_DIR"), "/guide_readme.md"))]
pub mod guide {
    include!(concat!(env!("OUT_DIR"), "/guide.rs"));
}

pub mod error;

pub(crate) mod memory;

mod files;

#[doc(hidden)]
pub mod panics;

mod index;

mod labels;

pub mod analytical;

pub mod space;

mod balls;

pub(crate) mod shape;

pub mod results;

pub mod scene;

pub mod deck;

pub mod mesh;

pub(crate) mod material;

pub mod element;

pub mod model;

pub mod linalg;

pub mod assembly;

pub mod contact;

pub mod substructure;

pub mod constrained;

pub mod progress;

pub mod checkpoint;

pub mod analysis;

pub mod reference;

pub mod accuracy;

pub mod output;

#[doc(hidden)]
pub mod selftest;

#[cfg(feature = "capi")]
pub mod capi;

#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod cli;

pub use error::{Error, ErrorKind, Result};
pub use index::Index;
