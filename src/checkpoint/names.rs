//! Names of the files in a directory of checkpoints.

use std::ffi::OsStr;

/// The file on which the parts depend.
pub(super) const CHECKPOINT: &str = "checkpoint";

/// The file by which a run keeps others out.
pub(super) const LOCK: &str = "lock";

/// Beginning of the names of parts.
pub(super) const PART: &str = "part-";

/// Returns the number of the part in a file of this name.
pub(super) fn number_of(name: &OsStr) -> Option<u32> {
    name.to_str()?.strip_prefix(PART)?.parse().ok()
}

/// Whether a file of this name was written by this module.
pub(super) fn is_ours(name: &OsStr) -> bool {
    let partial = |name: &str| name.ends_with(".partial");
    let text = name.to_str().unwrap_or_default();
    [CHECKPOINT, LOCK].contains(&text)
        || number_of(name).is_some()
        || (partial(text) && (text.starts_with(PART) || text.starts_with(CHECKPOINT)))
}
