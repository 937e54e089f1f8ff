//! A result directory held for one run, from its start to the written results.

use super::atomic::{Staging, is_result, replace};
#[cfg(feature = "report")]
use super::reported::finish_with_report;
#[cfg(feature = "report")]
use super::study::finish_study;
use super::{RunHeader, finish_without_report};
#[cfg(feature = "report")]
use crate::accuracy::Study;
use crate::error::{Error, Result};
use crate::model::Model;
use crate::results::Results;
use std::path::{Path, PathBuf};

/// The file that marks results as not those of the last run.
pub(super) const STALE_FILE: &str = "stale.txt";

/// A result directory held for a run: no other run can write it meanwhile. Results of an earlier
/// run in it are marked (`stale.txt`) until those of this run replace them, so that they are not
/// taken for its own should it fail or be killed.
pub struct Claim {
    dir: PathBuf,
    staging: Staging,
}

impl Claim {
    /// Holds `dir`. What will fail when the results are written fails here, before an hour's run.
    ///
    /// # Errors
    /// `Input` where another run is writing to `dir`; otherwise as [`super::write()`].
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

    /// The directory, as it was given.
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// What must not stay where the process ends without dropping this: the directory in the
    /// making.
    pub fn temporary(&self) -> Option<&Path> {
        self.staging.partial()
    }

    /// As [`super::write_with_report`].
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

    /// As [`super::write_without_report`].
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

    /// As [`super::write_study`].
    ///
    /// # Errors
    /// Errors of [`super::write_study`].
    #[cfg(feature = "report")]
    pub fn write_study(self, header: &RunHeader, study: &Study) -> Result<()> {
        finish_study(self.staging, header, study)
    }
}

/// Marks the results in `dir`, if there are any, as those of an earlier run than one that failed
/// with `error`. Returns whether there are.
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

/// Why the results in `dir` are not those of the last run, where that is so.
pub fn stale(dir: &Path) -> Option<String> {
    let path = dir.join(STALE_FILE);
    let there = path
        .exists()
        .then(|| crate::files::read_text("read", &path, Some(1 << 20)));
    there?.ok().map(|text| text.trim_end().to_string())
}

/// A directory that cannot be written is none of this run's concern: it was found out before.
fn mark(dir: &Path, why: &str) -> bool {
    let there = is_result(dir);
    if there {
        let text = format!("These results are of an earlier run: {why}\n");
        let _ = replace(&dir.join(STALE_FILE), text.as_bytes());
    }
    there
}
