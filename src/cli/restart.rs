//! Checkpoints of `brinell run`: their directory, and continuing from them.

use super::progress::Progress;
use crate::analysis::Analysis;
use crate::checkpoint::Checkpoints;
use crate::error::{Error, ErrorKind, Result};
use crate::progress::Observer;
use crate::results::Results;
use clap::Args;
use std::path::Path;

/// Options for writing checkpoints and for continuing from one.
#[derive(Debug, Args)]
pub(super) struct RestartArguments {
    /// Write a checkpoint at every N-th accepted increment (default 1), so that a run that is
    /// killed can continue with --resume
    ///
    /// Written to the directory of the results with the ending .checkpoint, and deleted when the
    /// results are written. Checkpoints do not change the results.
    #[arg(
        long,
        value_name = "N",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "1",
        value_parser = clap::value_parser!(u32).range(1..)
    )]
    pub checkpoint: Option<u32>,
    /// Continue from the last checkpoint, or start anew if there is none. Writes checkpoints like
    /// --checkpoint
    ///
    /// The results are those of a run that was never stopped. A checkpoint of another scene, mesh,
    /// solver or version is refused.
    #[arg(long)]
    pub resume: bool,
}

impl RestartArguments {
    /// Returns the directory of the checkpoints, next to the results `out`, if the user wants any.
    pub fn checkpoints(&self, out: &Path) -> Option<Checkpoints> {
        let wanted = self.checkpoint.is_some() || self.resume;
        wanted.then(|| beside(out).every(self.checkpoint.unwrap_or(1) as usize))
    }

    /// Runs the analysis with checkpoints.
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

/// Returns the error for a scene that demands an accuracy, which leaves no checkpoints.
pub(super) fn not_with_accuracy() -> Error {
    Error::input(
        "--checkpoint and --resume need a single run on one mesh, but `accuracy` asks for \
         several: leave `accuracy` out, and give the mesh and tolerances (scene_as_run.toml of a \
         run with `accuracy` has those that it chose)",
    )
}

/// Returns the checkpoints that belong to the results `out`.
fn beside(out: &Path) -> Checkpoints {
    // The path is taken without a slash at its end, because with one the checkpoints would lie
    // inside it.
    let mut dir = out.components().as_path().as_os_str().to_os_string();
    dir.push(".checkpoint");
    Checkpoints::new(dir)
}

/// Removes the checkpoints after the results are written to `out`: a completed run no longer needs
/// its checkpoints, nor those that an earlier, killed run with the same results directory left.
pub(super) fn settle(out: &Path, results: &Results) -> Result<()> {
    match results.ending().kind() {
        Some(ErrorKind::Stopped) => Ok(()),
        _ => beside(out).remove(),
    }
}
