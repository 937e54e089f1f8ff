//! Writing of result directories.

use super::atomic::Staging;
use super::names::{
    COLLECTION_FILE, CONTACT_FILE, HISTORY_FILE, PATH_FILE, REPORT_FILE, STALE_FILE, SUMMARY_FILE,
    is_figure,
};
use super::{RunHeader, contact, fields, frd, history, record, summary};
use crate::checkpoint::{END_STATE_FILE, encode_end_state};
use crate::error::Result;
use crate::mesh::Mesh;
use crate::model::Model;
use crate::results::Results;
use std::ffi::OsStr;
use std::io::Write;
use std::path::Path;

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
pub(super) fn finish(
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

/// Writes the results like [`write()`], and the scene as it was run: [`crate::output::read()`] can
/// read such a directory back, and its report can be made later.
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

pub(super) fn finish_without_report(
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
pub(super) fn is_result_file(name: &OsStr) -> bool {
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
            STALE_FILE,
            END_STATE_FILE,
            frd::FIELDS_FILE,
        ]
        .contains(&name)
            || fields::is_file(name)
            || is_figure(name)
    })
}
