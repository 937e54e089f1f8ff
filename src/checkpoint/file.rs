//! A file that can tell whether it is complete: a line that names its kind, then the length and the
//! hash of its content, then the content.

use crate::error::{Error, Result};
use crate::files;
use serde::{Serialize, de::DeserializeOwned};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use xxhash_rust::xxh3::xxh3_128;

/// Number of the layout: a file with another number is refused.
const FORMAT: u32 = 9;
/// Number of bytes of length and hash.
const GUARD: usize = 8 + 16;

/// Name in the first line of the files from which a run may continue.
const CHECKPOINT: &str = "checkpoint";

/// Returns the first line of a file of this build.
fn first_line(what: &str) -> String {
    format!(
        "brinell {what}, format {FORMAT}, version {}\n",
        env!("CARGO_PKG_VERSION")
    )
}

/// Returns a whole file with `value` as its content, and the length and hash of the content. `what`
/// names the kind of file.
pub(super) fn encode(what: &str, value: &impl Serialize) -> Result<(Vec<u8>, u64, u128)> {
    let content = postcard::to_stdvec(value)
        .map_err(|cause| Error::internal(format!("a {what} cannot be encoded")).because(cause))?;
    let (length, hash) = (content.len() as u64, xxh3_128(&content));
    let mut bytes = first_line(what).into_bytes();
    bytes.extend(length.to_le_bytes());
    bytes.extend(hash.to_le_bytes());
    bytes.extend(content);
    Ok((bytes, length, hash))
}

/// Writes `value` to `path`, first to a file with the ending `.partial`, which is on disk before it
/// is renamed. Returns length and hash of the content.
pub(super) fn write(path: &Path, value: &impl Serialize) -> Result<(u64, u128)> {
    let (bytes, length, hash) = encode(CHECKPOINT, value)?;
    let partial = path.with_extension("partial");
    let store = || -> std::io::Result<()> {
        let mut out = BufWriter::new(File::create(&partial)?);
        out.write_all(&bytes)?;
        out.into_inner()?.sync_data()?;
        std::fs::rename(&partial, path)
    };
    store().map_err(|cause| {
        // The incomplete file is useless; a failure to remove it is not reported.
        let _ = std::fs::remove_file(&partial);
        Error::io("write", path, cause)
    })?;
    Ok((length, hash))
}

/// Reads a file that [`write`] wrote; also returns length and hash of the content.
///
/// # Errors
/// `Input` if the file is not one of brinell, or is of another version, cut short or damaged; `Io`
/// if it cannot be read.
pub(super) fn read<T: DeserializeOwned>(path: &Path) -> Result<(T, u64, u128)> {
    read_as(CHECKPOINT, path)
}

/// Reads a file like [`read`], with `what` as the name of its kind.
///
/// # Errors
/// The errors of [`read`].
pub(super) fn read_as<T: DeserializeOwned>(what: &str, path: &Path) -> Result<(T, u64, u128)> {
    let bytes = files::read("read", path, None)?;
    let refused = |why: String| Error::input(format!("{}: {why}", path.display()));
    let line = first_line(what);
    let Some(rest) = bytes.strip_prefix(line.as_bytes()) else {
        let end = bytes
            .iter()
            .take(100)
            .position(|&b| b == b'\n')
            .unwrap_or(0);
        let found = String::from_utf8_lossy(&bytes[..end]);
        return Err(refused(if found.starts_with(&format!("brinell {what}")) {
            format!(
                "written by another version (`{found}`, this is `{}`): run the scene again from \
                 its beginning, or with that version",
                line.trim_end()
            )
        } else {
            format!("no {what} of brinell")
        }));
    };
    let damaged = |how: &str| {
        refused(format!(
            "the {what} is damaged ({how}): delete it and run the scene again from its \
             beginning"
        ))
    };
    let Some((guard, content)) = rest.split_at_checked(GUARD) else {
        return Err(damaged("cut short"));
    };
    let length = guard[..8].try_into().map_or(0, u64::from_le_bytes);
    let hash = guard[8..].try_into().map_or(0, u128::from_le_bytes);
    if length != content.len() as u64 {
        return Err(damaged(&format!("{} bytes of {length}", content.len())));
    }
    if xxh3_128(content) != hash {
        return Err(damaged("its hash is another"));
    }
    let value = postcard::from_bytes(content)
        .map_err(|cause| damaged("written by another build of the same version").because(cause))?;
    Ok((value, length, hash))
}
