//! Checkpoints of `brinell run`: where they go, and going on from them.

use super::progress::Progress;
use crate::analysis::Analysis;
use crate::checkpoint::Checkpoints;
use crate::error::{Error, ErrorKind, Result};
use crate::progress::Observer;
use crate::results::Results;
use clap::Args;
use std::path::Path;

/// Whether a run leaves checkpoints, and goes on from one.
#[derive(Debug, Args)]
pub(super) struct RestartArguments {
    /// Write a checkpoint at every N-th accepted increment (default 1), so that a run that is
    /// killed can go on with --resume
    ///
    /// Goes to the directory of the results with the ending .checkpoint, and is deleted when the
    /// results are written. Results do not depend on it.
    #[arg(
        long,
        value_name = "N",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "1",
        value_parser = clap::value_parser!(u32).range(1..)
    )]
    pub checkpoint: Option<u32>,
    /// Go on from the last checkpoint; begin anew where there is none. Writes checkpoints like
    /// --checkpoint
    ///
    /// The results are those of a run that was never stopped. A checkpoint of another scene, mesh,
    /// solver or version is refused.
    #[arg(long)]
    pub resume: bool,
}

impl RestartArguments {
    /// Where checkpoints go, if the user wants any: beside the results `out`.
    pub fn checkpoints(&self, out: &Path) -> Option<Checkpoints> {
        let wanted = self.checkpoint.is_some() || self.resume;
        wanted.then(|| beside(out).every(self.checkpoint.unwrap_or(1) as usize))
    }

    /// Runs with checkpoints.
    ///
    /// # Errors
    /// Errors of [`Analysis::run_with_checkpoints`] and [`Analysis::resume`].
    pub fn run(
        &self,
        analysis: &mut Analysis,
        checkpoints: &Checkpoints,
        progress: &mut Progress,
    ) -> Result<Results> {
        let dir = checkpoints.dir().display();
        match (self.resume, checkpoints.exist()) {
            (true, true) => return analysis.resume(checkpoints, progress),
            (true, false) => progress.note(&format!("no checkpoint in {dir}: from the beginning")),
            (false, true) => progress.warning(&format!(
                "the checkpoint in {dir} will be replaced (--resume would go on from it)"
            )),
            (false, false) => {}
        }
        analysis.run_with_checkpoints(checkpoints, progress)
    }
}

/// Why a scene that demands an accuracy leaves no checkpoints.
pub(super) fn not_with_accuracy() -> Error {
    Error::input(
        "--checkpoint and --resume are of one run on one mesh, but `accuracy` asks for runs on \
         several: leave `accuracy` out, and give the mesh and tolerances (scene_as_run.toml of a \
         run with `accuracy` has those that it chose)",
    )
}

/// The checkpoints that belong to the results `out`.
fn beside(out: &Path) -> Checkpoints {
    // Without a slash at its end, after which they would lie within.
    let mut dir = out.components().as_path().as_os_str().to_os_string();
    dir.push(".checkpoint");
    Checkpoints::new(dir)
}

/// After the results are written to `out`: a run that came to its end needs its
/// checkpoints no more, nor those that an earlier run with the same results left when it was
/// killed.
pub(super) fn settle(out: &Path, results: &Results) -> Result<()> {
    match results.ending().kind() {
        Some(ErrorKind::Stopped) => Ok(()),
        _ => beside(out).remove(),
    }
}
