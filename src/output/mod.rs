//! The files that a run leaves: one directory, written whole or not at all.
//!
//! ```text
//! DIR/summary.json          figures of the run and of each state (SUMMARY_SCHEMA)  (summary)
//!     history.csv           a row per accepted increment                           (history)
//!     path.csv              points of the path between increments                  (history)
//!     contact.csv           a row per state and contact pair                       (contact)
//!     fields.pvd            the states with fields, as a time series               (fields)
//!     state_01_NAME.vtu     mesh and fields of one state                           (fields, vtu)
//!     state_01_NAME.pvtu    of a run on several ranks, with a .vtu for each part
//!     fields.frd            of a deck that asks for it: values at nodes           (frd)
//!     end_state.bin         what is left in the material, for `start_from`          (checkpoint)
//!     report.html           the run to look at                                     (report)
//!     report_NAME.svg       its figures
//!     scene_as_run.toml     the scene with all that was put over it                (record)
//!     mesh_as_run.msh       its mesh, where the scene does not make it
//!     model_as_run.json     in place of both: a model that was handed over in arrays
//!     stale.txt             where a later run failed: results of an earlier one    (claim)
//! ```
//!
//! [`read()`] reads a directory back, [`write_report`] writes its report again.
//!
//! A study ([`write_study`]) leaves a directory of its own:
//!
//! ```text
//! DIR/accuracy.json      every run with time, memory, errors; references, orders, prices  (study)
//!     accuracy.csv       a row per run and quantity                             (study)
//!     QUANTITY.svg       error over time, both logarithmic                      (work_precision)
//! ```
//!
//! [`write()`] first writes a temporary directory beside DIR and then renames it into place
//! (`atomic`). Keys of `summary.json` and columns of the tables keep their names once published.

mod atomic;
mod claim;
#[cfg(feature = "report")]
pub(crate) mod columns;
mod contact;
mod dat;
pub(crate) mod ending;
mod fields;
mod frd;
mod header;
mod history;
mod job;
pub(crate) mod labels;
mod named;
mod names;
mod read;
mod record;
#[cfg(feature = "report")]
mod report;
#[cfg(feature = "report")]
mod reported;
pub(crate) mod rows;
mod slaves;
#[cfg(feature = "report")]
pub(crate) mod stated_errors;
#[cfg(feature = "report")]
mod study;
mod summary;
#[cfg(feature = "cli")]
pub(crate) mod sweep;
mod table;
mod vtu;
mod vtu_read;
#[cfg(feature = "report")]
mod work_precision;
mod write;

pub use claim::{Claim, mark_stale, stale};
pub use dat::{write_dat, write_prints};
pub use ending::ending;
pub use frd::write_frd;
pub use header::RunHeader;
pub use job::JobFiles;
pub use labels::Labels;
pub use read::{Recorded, read};
#[cfg(feature = "report")]
pub use reported::{write_report, write_with_report};
#[cfg(feature = "report")]
pub use study::{study_json, write_study};
pub use summary::summary;
#[cfg(feature = "report")]
pub use work_precision::plot;
pub use write::{check_directory, write, write_without_report};

/// The JSON schema (draft 2020-12) that every `summary.json` of this version obeys.
pub const SUMMARY_SCHEMA: &str = include_str!("../../data/schema/summary.schema.json");
