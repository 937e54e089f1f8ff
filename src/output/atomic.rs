//! A result directory that appears whole or not at all.
//!
//! ```text
//! DIR absent    .DIR.partial ──rename──▶ DIR
//! DIR a result  DIR ──rename──▶ .DIR.y.old/DIR,  .DIR.partial ──rename──▶ DIR,  delete .DIR.y.old
//! ```
//!
//! `.DIR.partial` is locked by the process that writes it. The system releases the lock when that
//! process ends, however it ends: an unlocked `.DIR.partial` was left by a process that was killed,
//! and is used again. Both temporaries are siblings of DIR, so a rename never crosses file systems.
//! Whatever fails, DIR stays as it was and the temporaries are removed. Between the two renames of
//! a replacement DIR is absent for an instant: a process killed at that moment leaves the old and
//! the new result, both whole, beside DIR.

use super::names::{STUDY_FILE, SUMMARY_FILE};
use crate::error::{Error, Result};
use crate::files;
use std::ffi::{OsStr, OsString};
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Size of a write buffer in bytes. A larger buffer (1 MiB) is not faster.
const BUFFER_BYTES: usize = 1 << 16;

/// Replaces a file as a whole: the content is written to a file beside it, which is then renamed.
///
/// # Errors
/// `Io` naming the file.
pub(super) fn replace(path: &Path, content: &[u8]) -> Result<()> {
    replace_with(path, |out| out.write_all(content))
}

/// Replaces a file like [`replace`], with the content that the function `write` produces.
///
/// # Errors
/// `Io` naming the file.
pub(super) fn replace_with(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>,
) -> Result<()> {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let written = || -> io::Result<()> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(".").suffix(".partial");
        // The permissions are those of any other file: the user's umask decides who may read it.
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            builder.permissions(fs::Permissions::from_mode(0o666));
        }
        let file = builder.tempfile_in(folder)?;
        let mut out = BufWriter::with_capacity(BUFFER_BYTES, file.as_file());
        write(&mut out)?;
        out.flush()?;
        drop(out);
        file.persist(path).map(drop).map_err(|e| e.error)
    };
    written().map_err(|cause| Error::io("write", path, cause))
}

/// A directory that is being written. Dropped without [`Staging::publish`] it leaves no trace.
pub(super) struct Staging {
    /// Final path of the directory: absolute, symbolic links resolved.
    target: PathBuf,
    /// The temporary directory; `None` once published.
    partial: Option<Partial>,
    /// Parents of the target that were created for it, outermost first.
    made_parents: Vec<PathBuf>,
}

impl Staging {
    /// Starts writing the directory `dir`.
    ///
    /// # Errors
    /// `Input` if `dir` is in use by something else or another run is writing it, `Io` if its
    /// parent cannot be written.
    pub(super) fn new(dir: &Path) -> Result<Self> {
        let target = resolve(dir)?;
        check_replaceable(&target)?;
        let mut staging = Staging {
            made_parents: Vec::new(),
            partial: None,
            target,
        };
        staging.make_parents()?;
        staging.partial = Some(Partial::claim(&staging.target)?);
        Ok(staging)
    }

    /// Writes the file `name` of the directory through a buffer.
    ///
    /// # Errors
    /// `Io` naming the file's final path.
    pub(super) fn file(
        &self,
        name: &str,
        write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
    ) -> Result<()> {
        let Some(partial) = &self.partial else {
            return Err(Error::internal(format!(
                "{name} was written after {} had been published",
                self.target.display()
            )));
        };
        File::create_new(partial.path.join(name))
            .and_then(|file| {
                let mut out = BufWriter::with_capacity(BUFFER_BYTES, file);
                write(&mut out)?;
                out.flush()
            })
            .map_err(|e| Error::io("write", &self.target.join(name), e))
    }

    /// Returns the final path of the directory.
    pub(super) fn target(&self) -> &Path {
        &self.target
    }

    /// Returns the path of the temporary directory; `None` once published.
    pub(super) fn partial(&self) -> Option<&Path> {
        self.partial.as_ref().map(|partial| partial.path.as_path())
    }

    /// Moves the directory to its final path. If it replaces a directory, the entries of the old
    /// one for which `is_ours` is false are moved into the new one.
    ///
    /// # Errors
    /// `Io`; the previous directory is then back at its path, unless the message says where it is.
    pub(super) fn publish(mut self, is_ours: impl Fn(&OsStr) -> bool) -> Result<()> {
        let Some(partial) = &self.partial else {
            return Ok(());
        };
        let failed = |e| Error::io("write", &self.target, e);
        if self.target.exists() {
            let retired = self.retired()?;
            let previous = retired.path().join(self.name());
            fs::rename(&self.target, &previous).map_err(failed)?;
            if let Err(e) = fs::rename(&partial.path, &self.target) {
                return Err(match fs::rename(&previous, &self.target) {
                    Ok(()) => failed(e),
                    Err(_) => {
                        let kept = retired.keep().join(self.name());
                        failed(e).within(format!("the previous result is now {}", kept.display()))
                    }
                });
            }
            if let Err(e) = move_entries(&previous, &self.target, |name| !is_ours(name)) {
                let kept = retired.keep().join(self.name());
                self.forget();
                return Err(Error::io("move your files from", &kept, e));
            }
            let path = retired.path().to_path_buf();
            retired
                .close()
                .map_err(|e| Error::io("delete the previous result", &path, e))?;
        } else {
            fs::rename(&partial.path, &self.target).map_err(failed)?;
        }
        self.forget();
        Ok(())
    }

    /// Drops the record of temporaries: after the rename there is nothing left to clean up.
    fn forget(&mut self) {
        self.partial = None;
        self.made_parents.clear();
    }

    fn name(&self) -> &OsStr {
        self.target.file_name().unwrap_or_default()
    }

    fn parent(&self) -> &Path {
        self.target.parent().unwrap_or(&self.target)
    }

    /// Creates a hidden directory beside the target that takes the previous directory.
    fn retired(&self) -> Result<TempDir> {
        let mut prefix = OsString::from(".");
        prefix.push(self.name());
        prefix.push(".");
        tempfile::Builder::new()
            .prefix(&prefix)
            .suffix(".old")
            .tempdir_in(self.parent())
            .map_err(|e| Error::io("write", &self.target, e))
    }

    /// Creates the missing parents of the target and remembers which ones.
    fn make_parents(&mut self) -> Result<()> {
        let missing: Vec<PathBuf> = self
            .parent()
            .ancestors()
            .take_while(|p| !p.exists())
            .map(Path::to_path_buf)
            .collect();
        for path in missing.into_iter().rev() {
            fs::create_dir(&path).map_err(|e| Error::io("write", &self.target, e))?;
            self.made_parents.push(path);
        }
        Ok(())
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        if let Some(partial) = self.partial.take() {
            // Removed while it is locked. A directory that cannot be removed is used again by the
            // next run.
            let _ = fs::remove_dir_all(&partial.path);
        }
        for path in self.made_parents.iter().rev() {
            // Fails if someone else has put something there meanwhile: then the directory has to
            // stay.
            let _ = fs::remove_dir(path);
        }
    }
}

/// The directory `.NAME.partial` beside a target, which only one process can own.
struct Partial {
    path: PathBuf,
    /// The lock on the directory; `None` if the system cannot lock a directory.
    _lock: Option<File>,
}

impl Partial {
    /// Creates the directory, or empties the one that a killed process left.
    fn claim(target: &Path) -> Result<Self> {
        let failed = |e| Error::io("write", target, e);
        let mut name = OsString::from(".");
        name.push(target.file_name().unwrap_or_default());
        name.push(".partial");
        let path = target.with_file_name(name);
        loop {
            match fs::create_dir(&path) {
                Err(e) if e.kind() != io::ErrorKind::AlreadyExists => return Err(failed(e)),
                _ => {}
            }
            // The owner may publish or remove the directory at any time: then it is created again.
            let Ok(there) = fs::symlink_metadata(&path) else {
                continue;
            };
            if !there.is_dir() {
                return Err(Error::input(format!(
                    "{} is in the way of the results: move it, or choose another directory",
                    path.display()
                )));
            }
            let Ok(open) = open(&path) else { continue };
            let lock = open.map(|open| lock(open, target)).transpose()?.flatten();
            if lock.as_ref().is_none_or(|lock| is_at(lock, &path)) {
                empty(&path).map_err(failed)?;
                return Ok(Partial { path, _lock: lock });
            }
        }
    }
}

/// Opens a directory to be locked, if the system can lock directories.
fn open(dir: &Path) -> io::Result<Option<File>> {
    if cfg!(unix) {
        File::open(dir).map(Some)
    } else {
        Ok(None)
    }
}

/// Locks a directory for this process; `None` on a file system without locks.
fn lock(open: File, target: &Path) -> Result<Option<File>> {
    match open.try_lock() {
        Ok(()) => Ok(Some(open)),
        Err(fs::TryLockError::WouldBlock) => Err(Error::input(format!(
            "another run is writing to {}: wait for its end, or choose another directory (--out)",
            target.display()
        ))),
        Err(fs::TryLockError::Error(_)) => Ok(None),
    }
}

/// Whether an open directory is the one at `path`.
#[cfg(unix)]
fn is_at(open: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let identity = |m: fs::Metadata| (m.dev(), m.ino());
    let there = fs::metadata(path).map(identity).ok();
    there.is_some() && open.metadata().map(identity).ok() == there
}

#[cfg(not(unix))]
fn is_at(_: &File, _: &Path) -> bool {
    true
}

/// Removes what is in a directory.
fn empty(dir: &Path) -> io::Result<()> {
    for entry in fs::read_dir(dir)? {
        let entry = entry?;
        if entry.file_type()?.is_dir() {
            fs::remove_dir_all(entry.path())?;
        } else {
            fs::remove_file(entry.path())?;
        }
    }
    Ok(())
}

/// The absolute path of `dir`; symbolic links are followed, so that what is replaced is the
/// directory and not the link.
fn resolve(dir: &Path) -> Result<PathBuf> {
    if dir.as_os_str().is_empty() {
        return Err(Error::input("the output directory has an empty name"));
    }
    let failed = |e| Error::io("write", dir, e);
    match fs::canonicalize(dir) {
        Ok(path) => Ok(path),
        Err(e) if e.kind() != io::ErrorKind::NotFound => Err(failed(e)),
        Err(_) if dir.is_symlink() => Err(Error::input(format!(
            "the output directory {} is a symbolic link to nothing: remove the link or choose \
             another directory",
            dir.display()
        ))),
        Err(_) => std::path::absolute(dir).map_err(failed),
    }
}

/// Refuses a target that holds something other than a result of brinell.
fn check_replaceable(target: &Path) -> Result<()> {
    if !target.exists() {
        return match target.file_name() {
            Some(_) => Ok(()),
            None => Err(Error::input(format!(
                "{} is no name for an output directory",
                target.display()
            ))),
        };
    }
    if !target.is_dir() {
        return Err(Error::input(format!(
            "the output directory {} is a file: choose another directory",
            target.display()
        )));
    }
    let is_empty = fs::read_dir(target)
        .map_err(|e| Error::io("read", target, e))?
        .next()
        .is_none();
    if is_empty || is_result(target) {
        return Ok(());
    }
    Err(Error::input(format!(
        "the output directory {} exists and holds something other than a result of brinell (it has \
         no {SUMMARY_FILE} with the key `brinell`): it is left untouched; choose another directory",
        target.display()
    )))
}

/// Whether a directory holds a summary or a study of brinell.
pub(super) fn is_result(dir: &Path) -> bool {
    [SUMMARY_FILE, STUDY_FILE].iter().any(|name| {
        files::read("read", &dir.join(name), None)
            .ok()
            .and_then(|text| serde_json::from_slice::<serde_json::Value>(&text).ok())
            .is_some_and(|summary| summary.get("brinell").is_some())
    })
}

/// Moves the entries of one directory whose names are `chosen` into another.
fn move_entries(from: &Path, to: &Path, chosen: impl Fn(&OsStr) -> bool) -> io::Result<()> {
    for entry in fs::read_dir(from)? {
        let name = entry?.file_name();
        if chosen(&name) {
            fs::rename(from.join(&name), to.join(&name))?;
        }
    }
    Ok(())
}
