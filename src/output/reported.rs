//! Result directories with their report.

use super::atomic::{self, Staging};
use super::names::{REPORT_FILE, is_figure};
use super::write::finish;
use super::{RunHeader, frd, read, record, report};
use crate::error::{Error, Result};
use crate::model::Model;
use crate::results::Results;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Writes the results like [`super::write_without_report`], with `report.html` and the figures of
/// the report as SVG files.
///
/// # Errors
/// The errors of [`super::write()`]; `Internal` if a figure cannot be drawn.
pub fn write_with_report(
    dir: &Path,
    header: &RunHeader,
    model: &Model,
    results: &Results,
) -> Result<()> {
    finish_with_report(Staging::new(dir)?, header, model, results)
}

pub(super) fn finish_with_report(
    staging: Staging,
    header: &RunHeader,
    model: &Model,
    results: &Results,
) -> Result<()> {
    finish(staging, header, &model.mesh, results, |staging| {
        record::write(staging, model)?;
        frd::write_fields(staging, model, results)?;
        for (name, text) in report::files(header, model, results)? {
            staging.file(&name, |out| out.write_all(text.as_bytes()))?;
        }
        Ok(())
    })
}

/// Writes the report of a result directory again: `report.html` and its figures, each file whole.
/// Figures of an earlier report that this one does not have are removed; nothing else is touched.
/// Returns the path of the page.
///
/// # Errors
/// Errors of [`read()`]; `Internal` if a figure cannot be drawn, `Io` naming the file that
/// cannot be written.
pub fn write_report(dir: &Path) -> Result<PathBuf> {
    let recorded = read(dir)?;
    let files = report::files(&recorded.header, &recorded.model, &recorded.results)?;
    let listing = std::fs::read_dir(dir).map_err(|cause| Error::io("list", dir, cause))?;
    for entry in listing.flatten() {
        let name = entry.file_name();
        let stale = name.to_str().is_some_and(|name| {
            is_figure(name) && files.iter().all(|(written, _)| written != name)
        });
        if stale {
            let path = entry.path();
            std::fs::remove_file(&path).map_err(|cause| Error::io("remove", &path, cause))?;
        }
    }
    for (name, text) in &files {
        atomic::replace(&dir.join(name), text.as_bytes())?;
    }
    Ok(dir.join(REPORT_FILE))
}
