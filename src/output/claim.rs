//! A result directory held for one run, from its start to the written results.

use super::RunHeader;
use super::atomic::{Staging, is_result, replace};
use super::names::STALE_FILE;
#[cfg(feature = "report")]
use super::reported::finish_with_report;
#[cfg(feature = "report")]
use super::study::finish_study;
use super::write::finish_without_report;
#[cfg(feature = "report")]
use crate::accuracy::Study;
use crate::error::{Error, Result};
use crate::model::Model;
use crate::results::Results;
use std::path::{Path, PathBuf};

/// A result directory held for a run: no other run can write to it meanwhile. Results of an earlier
/// run in the directory are marked (`stale.txt`) until the results of this run replace them, so
/// that they are not taken for those of this run if it fails or is killed.
pub struct Claim {
    dir: PathBuf,
    staging: Staging,
}

impl Claim {
    /// Holds `dir`. Anything that would make writing the results fail is found here, before a long
    /// run.
    ///
    /// # Errors
    /// `Input` if another run is writing to `dir`; otherwise the errors of [`super::write()`].
    pub fn new(dir: &Path) -> Result<Self> {
        let staging = Staging::new(dir)?;
        mark(
            staging.target(),
            "a later run to this directory has not ended yet, or was killed",
        );
        Ok(Claim {
            dir: dir.to_path_buf(),
            staging,
        })
    }

    /// Returns the directory as it was given.
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// Returns the temporary directory, which must be removed if the process ends without dropping
    /// this value.
    pub fn temporary(&self) -> Option<&Path> {
        self.staging.partial()
    }

    /// Writes the results as [`super::write_with_report`] does.
    ///
    /// # Errors
    /// Errors of [`super::write_with_report`].
    #[cfg(feature = "report")]
    pub fn write_with_report(
        self,
        header: &RunHeader,
        model: &Model,
        results: &Results,
    ) -> Result<()> {
        finish_with_report(self.staging, header, model, results)
    }

    /// Writes the results as [`super::write_without_report`] does.
    ///
    /// # Errors
    /// Errors of [`super::write_without_report`].
    pub fn write_without_report(
        self,
        header: &RunHeader,
        model: &Model,
        results: &Results,
    ) -> Result<()> {
        finish_without_report(self.staging, header, model, results)
    }

    /// Writes a study as [`super::write_study`] does.
    ///
    /// # Errors
    /// Errors of [`super::write_study`].
    #[cfg(feature = "report")]
    pub fn write_study(self, header: &RunHeader, study: &Study) -> Result<()> {
        finish_study(self.staging, header, study)
    }
}

/// Marks the results in `dir`, if there are any, as those of a run before the one that failed with
/// `error`. Returns whether there are any.
pub fn mark_stale(dir: &Path, error: &Error) -> bool {
    mark(
        dir,
        &format!(
            "a later run to this directory failed (exit code {}): {}",
            error.kind().exit_code(),
            error.in_full()
        ),
    )
}

/// Returns why the results in `dir` are not those of the last run; `None` if they are.
pub fn stale(dir: &Path) -> Option<String> {
    let path = dir.join(STALE_FILE);
    let there = path
        .exists()
        .then(|| crate::files::read_text("read", &path, Some(1 << 20)));
    there?.ok().map(|text| text.trim_end().to_string())
}

/// Marks the results in `dir`, if there are any. A write error is ignored, because `Staging::new`
/// has already checked that the directory can be written.
fn mark(dir: &Path, why: &str) -> bool {
    let there = is_result(dir);
    if there {
        let text = format!("These results are of an earlier run: {why}\n");
        let _ = replace(&dir.join(STALE_FILE), text.as_bytes());
    }
    there
}
