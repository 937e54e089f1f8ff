//! The file that holds the state of the material at the end of a run, from which another run on the
//! same mesh may start.

use super::{file, identity};
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::results::EndState;
use std::path::Path;

/// Name of the end state's file in a result directory.
pub(crate) const END_STATE_FILE: &str = "end_state.bin";
/// Name of the kind of file in its first line.
const WHAT: &str = "end state";

/// Returns the content of the file.
///
/// # Errors
/// `Internal` if the state cannot be encoded.
pub(crate) fn encode(mesh: &Mesh, state: &EndState) -> Result<Vec<u8>> {
    let (bytes, ..) = file::encode(WHAT, &(identity::hash(mesh), state))?;
    Ok(bytes)
}

/// Reads the end state in the result directory `dir` of a run on the given mesh.
///
/// # Errors
/// `Input` if there is none, or if it is damaged, of another version or of another mesh; `Io` if it
/// cannot be read.
pub(crate) fn read(dir: &Path, mesh: &Mesh) -> Result<EndState> {
    let refused = |why: &str| Error::input(format!("{}: {why}", dir.display()));
    if !dir.is_dir() {
        return Err(refused(
            "there is no such directory; give the result directory of an earlier run",
        ));
    }
    let path = dir.join(END_STATE_FILE);
    if !path.exists() {
        return Err(refused(
            "it holds no end_state.bin: give the result directory of a run in which a body may \
             yield, made by this version",
        ));
    }
    let ((of_mesh, state), ..): ((u128, EndState), u64, u128) = file::read_as(WHAT, &path)?;
    if of_mesh != identity::hash(mesh) {
        return Err(refused(
            "its run was on another mesh: start from a run on the same one, node by node and \
             surface by surface (same mesh entry, same file; the generators make meshes for the \
             largest load of the program unless a contact_width is given)",
        ));
    }
    if !state.is_of(mesh.n_elements(), mesh.most_points()) {
        return Err(refused("its end state does not fit its mesh: run it again"));
    }
    Ok(state)
}
