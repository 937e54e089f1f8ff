//! Checkpoints: files from which a run can continue after it was killed.
//!
//! ```text
//! DIR/checkpoint      the last accepted increment, and which parts belong to it
//!     part-NNNNNN     what does not change any more: states that were reached,
//!                     where the way to a target began
//!     lock            held by the run that writes here
//! ```
//!
//! `checkpoint` is written beside its final path, synchronised and renamed over its predecessor, so
//! that a complete one exists at every moment. Parts are written before the first checkpoint that
//! names them and deleted after the first that does not.
//!
//! A resumed run gives the results of an uninterrupted run, bit for bit, in the same build on the
//! same machine.
//! With CHOLMOD this needs the same BLAS with the same number of threads (the run says so if the
//! factor differs). Each file carries a hash of its content. The checkpoint also carries the
//! [`Identity`] of its run; it is refused, with the name of the first difference, if the run to be
//! resumed has another identity.

mod end_state;
mod file;
mod identity;
mod names;
mod store;

pub(crate) use end_state::{END_STATE_FILE, encode as encode_end_state, read as read_end_state};
pub use identity::Identity;
pub(crate) use store::{PartId, Store};

use crate::error::{Error, Result};
use std::path::{Path, PathBuf};

/// The directory in which a run leaves checkpoints, and their interval.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Checkpoints {
    dir: PathBuf,
    every: usize,
}

impl Checkpoints {
    /// Creates checkpoints in the directory `dir`, one at each accepted increment.
    pub fn new(dir: impl Into<PathBuf>) -> Self {
        Checkpoints {
            dir: dir.into(),
            every: 1,
        }
    }

    /// Sets the interval: one checkpoint at every `increments`-th accepted increment (0 counts as
    /// 1). The results do not depend on it.
    pub fn every(self, increments: usize) -> Self {
        Checkpoints {
            every: increments.max(1),
            ..self
        }
    }

    /// Returns the directory of the checkpoints.
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// Returns the number of accepted increments from one checkpoint to the next.
    pub(crate) fn interval(&self) -> usize {
        self.every
    }

    /// Whether there is a checkpoint from which a run can continue.
    pub fn exist(&self) -> bool {
        self.dir.join(names::CHECKPOINT).is_file()
    }

    /// Deletes the checkpoints, and the directory unless it holds something else.
    ///
    /// # Errors
    /// [`crate::ErrorKind::Io`] naming the file that could not be deleted.
    pub fn remove(&self) -> Result<()> {
        let failed = |path: &Path, cause| Error::io("delete", path, cause);
        // The checkpoint is deleted first, because the parts depend on it: a run that is killed in
        // between leaves no checkpoint rather than one without its parts.
        let first = self.dir.join(names::CHECKPOINT);
        match std::fs::remove_file(&first) {
            Err(cause) if cause.kind() != std::io::ErrorKind::NotFound => {
                return Err(failed(&first, cause));
            }
            _ => {}
        }
        let entries = match std::fs::read_dir(&self.dir) {
            Ok(entries) => entries,
            Err(cause) if cause.kind() == std::io::ErrorKind::NotFound => return Ok(()),
            Err(cause) => return Err(failed(&self.dir, cause)),
        };
        for entry in entries {
            let entry = entry.map_err(|cause| failed(&self.dir, cause))?;
            if names::is_ours(&entry.file_name()) {
                std::fs::remove_file(entry.path()).map_err(|cause| failed(&entry.path(), cause))?;
            }
        }
        // Fails if the user has put something there: then the directory stays.
        let _ = std::fs::remove_dir(&self.dir);
        Ok(())
    }
}
