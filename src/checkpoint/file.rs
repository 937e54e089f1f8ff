//! A file that knows whether it is whole: a line that says what it is, the length and the hash of
//! what follows.

use crate::error::{Error, Result};
use crate::files;
use serde::{Serialize, de::DeserializeOwned};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use xxhash_rust::xxh3::xxh3_128;

/// Number of the layout: another one is refused.
const FORMAT: u32 = 6;
/// Length and hash.
const GUARD: usize = 8 + 16;

/// What a file of this build begins with.
fn first_line() -> String {
    format!(
        "brinell checkpoint, format {FORMAT}, version {}\n",
        env!("CARGO_PKG_VERSION")
    )
}

/// Writes `value` to `path` by way of `path` with the ending `.partial`, on disk before it gets its
/// name. Returns length and hash of its content.
pub(super) fn write(path: &Path, value: &impl Serialize) -> Result<(u64, u128)> {
    let content = postcard::to_stdvec(value)
        .map_err(|cause| Error::internal("a checkpoint cannot be encoded").because(cause))?;
    let (length, hash) = (content.len() as u64, xxh3_128(&content));
    let partial = path.with_extension("partial");
    let store = || -> std::io::Result<()> {
        let mut out = BufWriter::new(File::create(&partial)?);
        out.write_all(first_line().as_bytes())?;
        out.write_all(&length.to_le_bytes())?;
        out.write_all(&hash.to_le_bytes())?;
        out.write_all(&content)?;
        out.into_inner()?.sync_data()?;
        std::fs::rename(&partial, path)
    };
    store().map_err(|cause| {
        // What is there of it is of no use; that it stays is no second error.
        let _ = std::fs::remove_file(&partial);
        Error::io("write", path, cause)
    })?;
    Ok((length, hash))
}

/// Reads what [`write`] wrote; with it length and hash.
///
/// # Errors
/// `Input` where the file is none of brinell's, of another version, cut short or damaged; `Io`.
pub(super) fn read<T: DeserializeOwned>(path: &Path) -> Result<(T, u64, u128)> {
    let bytes = files::read("read", path, None)?;
    let refused = |why: String| Error::input(format!("{}: {why}", path.display()));
    let line = first_line();
    let Some(rest) = bytes.strip_prefix(line.as_bytes()) else {
        let end = bytes
            .iter()
            .take(100)
            .position(|&b| b == b'\n')
            .unwrap_or(0);
        let found = String::from_utf8_lossy(&bytes[..end]);
        return Err(refused(if found.starts_with("brinell checkpoint") {
            format!(
                "written by another version (`{found}`, this is `{}`): run the scene again from \
                 its beginning, or with that version",
                line.trim_end()
            )
        } else {
            "no checkpoint of brinell".to_string()
        }));
    };
    let damaged = |what: &str| {
        refused(format!(
            "the checkpoint is damaged ({what}): delete it and run the scene again from its \
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
