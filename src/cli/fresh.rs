//! New files: all of them are written or none, and no existing file is touched.

use crate::error::{Error, ErrorKind, Result};
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::Path;

/// Writes files that must not exist yet.
///
/// # Errors
/// `Io` naming the file that exists already or cannot be written; then none of the files is left
/// behind.
pub(super) fn write(files: &[(&Path, &[u8])]) -> Result<()> {
    let mut begun = Vec::new();
    let outcome = files.iter().try_for_each(|(path, content)| {
        let mut file = File::create_new(path).map_err(|cause| failed(path, cause))?;
        begun.push(*path);
        file.write_all(content).map_err(|cause| failed(path, cause))
    });
    if outcome.is_err() {
        for path in begun {
            // The error to report is the failed write, not a failed removal.
            let _ = fs::remove_file(path);
        }
    }
    outcome
}

fn failed(path: &Path, cause: io::Error) -> Error {
    if cause.kind() != io::ErrorKind::AlreadyExists {
        return Error::io("write", path, cause);
    }
    let text = format!(
        "{} exists and is left as it is: choose another name",
        path.display()
    );
    Error::new(ErrorKind::Io, text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_or_none_are_written() {
        let folder = tempfile::tempdir().unwrap();
        let [a, b] = ["a", "b"].map(|name| folder.path().join(name));
        fs::write(&b, "mine").unwrap();
        let error = write(&[(&a, b"1"), (&b, b"2")]).unwrap_err();
        assert!(
            error.to_string().contains("b exists and is left"),
            "{error}"
        );
        assert!(!a.exists());
        assert_eq!(fs::read(&b).unwrap(), b"mine");
        fs::remove_file(&b).unwrap();
        write(&[(&a, b"1"), (&b, b"2")]).unwrap();
        assert_eq!([fs::read(&a).unwrap(), fs::read(&b).unwrap()], [b"1", b"2"]);
        // The same file is given twice.
        fs::remove_file(&a).unwrap();
        assert!(write(&[(&a, b"1"), (&a, b"2")]).is_err());
        assert!(!a.exists());
    }
}
