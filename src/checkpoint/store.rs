//! The directory of a run's checkpoints.

use super::names::{CHECKPOINT, LOCK, PART, number_of};
use super::{Checkpoints, Identity, file};
use crate::error::{Error, Result};
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use std::collections::BTreeSet;
use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};

/// The number of a part, with length and hash of its content.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct PartId {
    number: u32,
    length: u64,
    hash: u128,
}

/// The checkpoints of the current run. No other run can open them meanwhile.
#[derive(Debug)]
pub(crate) struct Store {
    dir: PathBuf,
    identity: Identity,
    /// Numbers of the parts in the directory.
    parts: BTreeSet<u32>,
    next: u32,
    /// Lock that the system releases when the run ends, however it ends.
    _lock: File,
}

impl Store {
    /// Opens the directory, which is created if it is absent. Its contents stay until the first
    /// [`Store::write`].
    ///
    /// # Errors
    /// `Input` if another run is writing to the directory, `Io` if it cannot be written.
    pub(crate) fn open(checkpoints: &Checkpoints, identity: Identity) -> Result<Self> {
        let dir = checkpoints.dir.clone();
        let failed = |path: &Path, cause| Error::io("write", path, cause);
        fs::create_dir_all(&dir).map_err(|cause| failed(&dir, cause))?;
        let path = dir.join(LOCK);
        let lock = File::create(&path).map_err(|cause| failed(&path, cause))?;
        match lock.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                return Err(Error::input(format!(
                    "{}: another run is writing checkpoints there: wait for its end, or choose \
                     another directory for the results (--out)",
                    dir.display()
                )));
            }
            Err(TryLockError::Error(cause)) => return Err(failed(&path, cause)),
        }
        let mut parts = BTreeSet::new();
        for entry in fs::read_dir(&dir).map_err(|cause| Error::io("read", &dir, cause))? {
            let entry = entry.map_err(|cause| Error::io("read", &dir, cause))?;
            parts.extend(number_of(&entry.file_name()));
        }
        Ok(Store {
            identity,
            next: parts.last().map_or(1, |last| last + 1),
            parts,
            _lock: lock,
            dir,
        })
    }

    /// Reads the checkpoint.
    ///
    /// # Errors
    /// `Input` if the checkpoint is damaged or of another run, with the difference; `Io` if it
    /// cannot be read.
    pub(crate) fn read<T: DeserializeOwned>(&self) -> Result<T> {
        let path = self.dir.join(CHECKPOINT);
        // The identity is read first: the content is decoded only if the identity matches.
        let ((identity, content), ..): ((Identity, Vec<u8>), u64, u128) = file::read(&path)?;
        if let Some(difference) = identity.difference(&self.identity) {
            return Err(Error::input(format!(
                "{}: the checkpoint is of another run: {difference}; undo the change, or run \
                 without --resume to begin anew",
                path.display()
            )));
        }
        decode(&path, &content)
    }

    /// Writes a part.
    ///
    /// # Errors
    /// `Io` if it cannot be written.
    pub(crate) fn add<T: Serialize>(&mut self, value: &T) -> Result<PartId> {
        let number = self.next;
        let (length, hash) = file::write(&self.part(number), value)?;
        self.next += 1;
        self.parts.insert(number);
        Ok(PartId {
            number,
            length,
            hash,
        })
    }

    /// Reads a part that the checkpoint names.
    ///
    /// # Errors
    /// `Input` if the part is damaged or not the one that is named, `Io` if it cannot be read.
    pub(crate) fn part_of<T: DeserializeOwned>(&self, id: PartId) -> Result<T> {
        let path = self.part(id.number);
        let (value, length, hash) = file::read(&path)?;
        if (length, hash) != (id.length, id.hash) {
            return Err(Error::input(format!(
                "{}: the checkpoint is damaged (this part belongs to another): delete it and run \
                 the scene again from its beginning",
                path.display()
            )));
        }
        Ok(value)
    }

    /// Writes the checkpoint and deletes parts that it does not use (`in_use`).
    ///
    /// # Errors
    /// `Io` if it cannot be written; the previous checkpoint then remains.
    pub(crate) fn write<T: Serialize>(&mut self, value: &T, in_use: &[PartId]) -> Result<()> {
        let path = self.dir.join(CHECKPOINT);
        let content = postcard::to_stdvec(value)
            .map_err(|cause| Error::internal("a checkpoint cannot be encoded").because(cause))?;
        file::write(&path, &(&self.identity, Bytes(&content)))?;
        let keep: BTreeSet<u32> = in_use.iter().map(|part| part.number).collect();
        let unused: Vec<u32> = self.parts.difference(&keep).copied().collect();
        for number in unused {
            let path = self.part(number);
            fs::remove_file(&path).map_err(|cause| Error::io("delete", &path, cause))?;
            self.parts.remove(&number);
        }
        Ok(())
    }

    fn part(&self, number: u32) -> PathBuf {
        self.dir.join(format!("{PART}{number:06}"))
    }
}

/// Bytes that are written as one block, not number by number.
struct Bytes<'b>(&'b [u8]);

impl Serialize for Bytes<'_> {
    fn serialize<S: serde::Serializer>(
        &self,
        serializer: S,
    ) -> std::result::Result<S::Ok, S::Error> {
        serializer.serialize_bytes(self.0)
    }
}

fn decode<T: DeserializeOwned>(path: &Path, content: &[u8]) -> Result<T> {
    postcard::from_bytes(content).map_err(|cause| {
        Error::input(format!(
            "{}: the checkpoint was written by another build of the same version: run the scene \
             again from its beginning",
            path.display()
        ))
        .because(cause)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    /// Parts of equal length are distinguished by their content.
    #[test]
    fn a_part_that_is_not_the_one_meant_is_refused() {
        let dir = tempfile::tempdir().unwrap();
        let identity: Identity = serde_json::from_value(json!({
            "scene": "", "mesh": 1, "values": 2, "backend": "", "start": 0,
        }))
        .unwrap();
        let mut store = Store::open(&Checkpoints::new(dir.path()), identity).unwrap();
        let [a, b] = [[1.0, 2.0], [2.0, 1.0]].map(|values| store.add(&values).unwrap());
        assert_eq!(a.length, b.length);
        assert_eq!(store.part_of::<[f64; 2]>(b).unwrap(), [2.0, 1.0]);
        let swapped = PartId {
            number: a.number,
            ..b
        };
        let refused = store.part_of::<[f64; 2]>(swapped).unwrap_err();
        assert!(
            refused.to_string().contains("belongs to another"),
            "{refused}"
        );
    }
}
