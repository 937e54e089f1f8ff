//! Reads whole files from outside after checking their kind and size.

use crate::error::{Error, Result};
use crate::memory;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Largest size of a scene in bytes, enough for some hundred thousand targets.
pub(crate) const LARGEST_SCENE: u64 = 64 << 20;

/// Reads the file at `path`; `what` is the action named in messages (`read the scene`).
///
/// # Errors
/// `Io` if the file cannot be read; `Input` if it is not a regular file (a device or a pipe may
/// have no end), or if it is larger than `largest` bytes or the memory that is available.
pub(crate) fn read(what: &str, path: &Path, largest: Option<u64>) -> Result<Vec<u8>> {
    let failed = |cause| Error::io(what, path, cause);
    let refused = |why: String| Error::input(format!("cannot {what} {}: {why}", path.display()));
    // Opening a pipe waits for its other end, so the kind is checked first.
    let kind = std::fs::metadata(path).map_err(failed)?.file_type();
    if !kind.is_file() {
        let kind = if kind.is_dir() {
            "a directory"
        } else {
            "no plain file but a device, a pipe or a socket"
        };
        return Err(refused(format!("it is {kind}; give a file")));
    }
    let file = File::open(path).map_err(failed)?;
    let size = file.metadata().map_err(failed)?.len();
    let most = largest_file(largest);
    let too_large = |size: u64| {
        refused(format!(
            "it has {size} bytes or more, at most {most} are taken: is it the right file?"
        ))
    };
    if size > most {
        return Err(too_large(size));
    }
    let mut bytes = Vec::with_capacity(usize::try_from(size).unwrap_or(0) + 1);
    // A limit for files that grow, or that report no size (/proc).
    file.take(most + 1)
        .read_to_end(&mut bytes)
        .map_err(failed)?;
    if bytes.len() as u64 > most {
        return Err(too_large(bytes.len() as u64));
    }
    Ok(bytes)
}

/// Largest size in bytes: the given bound, but at most the memory that is available.
fn largest_file(largest: Option<u64>) -> u64 {
    let available = memory::available().map_or(u64::MAX - 1, |free| free as u64);
    largest.map_or(available, |largest| largest.min(available))
}

/// Reads a file as [`read()`] does, as text.
///
/// # Errors
/// Errors of [`read()`]; `Input` if the file is not UTF-8.
pub(crate) fn read_text(what: &str, path: &Path, largest: Option<u64>) -> Result<String> {
    String::from_utf8(read(what, path, largest)?)
        .map_err(|_| Error::input(format!("{}: the file is not UTF-8 text", path.display())))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::ErrorKind;

    #[test]
    fn kinds_and_sizes_are_looked_at_first() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a file");
        std::fs::write(&path, "12345").unwrap();
        assert_eq!(read("read", &path, Some(5)).unwrap(), b"12345");
        let error = read("read", &path, Some(4)).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Input);
        assert!(
            error.message().contains("5 bytes or more, at most 4"),
            "{error}"
        );
        let error = read("read the scene", folder.path(), None).unwrap_err();
        assert!(error.message().contains("it is a directory"), "{error}");
        // A sparse file of 2^50 bytes takes no room on the disk, but would take all memory.
        let file = File::create(&path).unwrap();
        if file.set_len(1 << 50).is_ok() {
            let error = read("read the mesh", &path, None).unwrap_err();
            assert!(
                error.message().contains("1125899906842624 bytes"),
                "{error}"
            );
        }
        #[cfg(unix)]
        for device in ["/dev/zero", "/dev/null"] {
            let error = read("read", Path::new(device), None).unwrap_err();
            assert!(error.message().contains("no plain file"), "{error}");
        }
        let error = read("read", &folder.path().join("none"), None).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Io);
    }
}
