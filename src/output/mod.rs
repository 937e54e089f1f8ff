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
mod history;
mod job;
pub(crate) mod labels;
mod named;
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

pub use claim::{Claim, mark_stale, stale};
pub use dat::{write_dat, write_prints};
pub use ending::ending;
pub use frd::write_frd;
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

use crate::checkpoint::{END_STATE_FILE, encode_end_state};
use crate::error::Result;
use crate::linalg::Backend;
use crate::mesh::Mesh;
use crate::model::Model;
use crate::results::Results;
use crate::space::Space;
use atomic::Staging;
use std::ffi::OsStr;
use std::io::Write;
use std::path::Path;

/// The JSON schema (draft 2020-12) that every `summary.json` of this version obeys.
pub const SUMMARY_SCHEMA: &str = include_str!("../../data/schema/summary.schema.json");

/// The file of the summary: its `brinell` key marks a directory as a result.
const SUMMARY_FILE: &str = "summary.json";
/// The file of a study: marks a directory like the summary.
const STUDY_FILE: &str = "accuracy.json";
const HISTORY_FILE: &str = "history.csv";
/// File of the points between increments, written if there are any.
const PATH_FILE: &str = "path.csv";
const CONTACT_FILE: &str = "contact.csv";
const COLLECTION_FILE: &str = "fields.pvd";
const REPORT_FILE: &str = "report.html";
/// Beginning of the file names of the report's figures.
const FIGURE_PREFIX: &str = "report_";
const FIGURE_SUFFIX: &str = ".svg";

/// Facts about a run that the output states in addition to its results.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RunHeader {
    /// Title of the scene.
    pub scene_title: String,
    /// The file that the scene was read from; `None` if it came from no file.
    pub scene_file: Option<String>,
    /// `plane_strain`, `plane_stress`, `axisymmetric` or `solid`, as in the scene.
    pub kind: String,
    /// The backend that factored the stiffness: `cholmod`, `faer` or `dense`.
    pub solver: String,
    /// The processor for which the kernels of the backend's BLAS are written (`Haswell`); `None`
    /// for a backend without such kernels.
    pub kernels: Option<String>,
    /// Wall time of the whole run in seconds.
    pub wall_seconds: f64,
    /// Body names, in the order of the mesh.
    pub bodies: Vec<String>,
    /// Names of the quantities and of their units.
    pub labels: Labels,
}

impl RunHeader {
    /// The header of a run of `model`.
    pub fn new(model: &Model, backend: Backend, wall_seconds: f64) -> Self {
        RunHeader {
            scene_title: model.scene.title.clone(),
            scene_file: (model.scene.file.as_ref()).map(|file| file.display().to_string()),
            kind: model.kind.name().to_string(),
            solver: backend.name().to_string(),
            kernels: backend.kernels(),
            wall_seconds,
            bodies: model.mesh.bodies.clone(),
            labels: Labels::of(model),
        }
    }

    /// Returns the number of coordinates.
    fn dimension(&self) -> usize {
        if self.kind == Space::Solid.name() {
            3
        } else {
            2
        }
    }

    /// Returns the name of a body by its index.
    fn body(&self, index: usize) -> String {
        match self.bodies.get(index) {
            Some(name) => name.clone(),
            None => format!("body {}", index + 1),
        }
    }
}

/// Writes the result directory `dir`: all of it or nothing.
///
/// An earlier result of brinell in `dir` is replaced; files in it that are not brinell's (a plot, a
/// ParaView state) are kept. Missing parent directories are created. `fields.pvd` is written if at
/// least one state has fields.
///
/// # Errors
/// [`crate::ErrorKind::Input`] if `dir` exists and is neither empty nor a result of brinell, or is
/// not a directory; [`crate::ErrorKind::Io`] naming the path if something cannot be written;
/// [`crate::ErrorKind::Internal`] if the fields of a state do not fit the mesh. After an error
/// `dir` is as it was and nothing is left beside it.
pub fn write(dir: &Path, header: &RunHeader, mesh: &Mesh, results: &Results) -> Result<()> {
    finish(Staging::new(dir)?, header, mesh, results, |_| Ok(()))
}

/// Writes tables and fields and the files that `more` adds, all or nothing.
fn finish(
    staging: Staging,
    header: &RunHeader,
    mesh: &Mesh,
    results: &Results,
    more: impl FnOnce(&Staging) -> Result<()>,
) -> Result<()> {
    write_tables_and_fields(&staging, header, mesh, results)?;
    more(&staging)?;
    staging.publish(is_result_file)
}

/// Writes the results like [`write()`], and the scene as it was run: [`read()`] can read such a
/// directory back, and its report can be made later.
///
/// # Errors
/// The errors of [`write()`].
pub fn write_without_report(
    dir: &Path,
    header: &RunHeader,
    model: &Model,
    results: &Results,
) -> Result<()> {
    finish_without_report(Staging::new(dir)?, header, model, results)
}

fn finish_without_report(
    staging: Staging,
    header: &RunHeader,
    model: &Model,
    results: &Results,
) -> Result<()> {
    finish(staging, header, &model.mesh, results, |staging| {
        record::write(staging, model)?;
        frd::write_fields(staging, model, results)
    })
}

/// Whether a file of this name is a figure of a report.
fn is_figure(name: &str) -> bool {
    name.starts_with(FIGURE_PREFIX) && name.ends_with(FIGURE_SUFFIX)
}

fn write_tables_and_fields(
    staging: &Staging,
    header: &RunHeader,
    mesh: &Mesh,
    results: &Results,
) -> Result<()> {
    staging.file(HISTORY_FILE, |out| history::write(out, results))?;
    if !results.path.is_empty() {
        staging.file(PATH_FILE, |out| history::write_path(out, results))?;
    }
    staging.file(CONTACT_FILE, |out| {
        contact::write(out, header.dimension(), &results.states)
    })?;
    fields::write(staging, header, mesh, results)?;
    if let Some(state) = &results.end_state {
        let bytes = encode_end_state(mesh, state)?;
        staging.file(END_STATE_FILE, |out| out.write_all(&bytes))?;
    }
    staging.file(SUMMARY_FILE, |out| {
        serde_json::to_writer_pretty(&mut *out, &summary(header, results))?;
        out.write_all(b"\n")
    })
}

/// Checks that [`write()`] will be able to write `dir`, so that a long run does not end with a
/// refusal. Leaves nothing behind.
///
/// # Errors
/// The errors of [`write()`], before anything is computed.
pub fn check_directory(dir: &Path) -> Result<()> {
    Staging::new(dir).map(drop)
}

/// Whether a file of this name in a result directory was written by brinell (and is removed when
/// the result is replaced).
fn is_result_file(name: &OsStr) -> bool {
    name.to_str().is_some_and(|name| {
        [
            SUMMARY_FILE,
            HISTORY_FILE,
            PATH_FILE,
            CONTACT_FILE,
            COLLECTION_FILE,
            REPORT_FILE,
            record::SCENE_FILE,
            record::MESH_FILE,
            record::MODEL_FILE,
            claim::STALE_FILE,
            END_STATE_FILE,
            frd::FIELDS_FILE,
        ]
        .contains(&name)
            || fields::is_file(name)
            || is_figure(name)
    })
}
