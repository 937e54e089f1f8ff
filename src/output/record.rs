//! The scene as it was run, so that a result directory says by itself where it comes from: everything that was put over the
//! scene file is in it, and the mesh where the scene does not make one.

use super::atomic::Staging;
use crate::error::Result;
use crate::mesh::{Mesh, gmsh};
use crate::model::Model;
use crate::scene::MeshSource;
use std::io::Write;

/// The scene.
pub(super) const SCENE_FILE: &str = "scene_as_run.toml";
/// Its mesh.
pub(super) const MESH_FILE: &str = "mesh_as_run.msh";

/// Writes both. A mesh whose names a Gmsh file cannot hold is left out with its scene: results go first.
///
/// # Errors
/// `Io` naming the file.
pub(super) fn write(staging: &Staging, model: &Model) -> Result<()> {
    let mut scene = model.scene.clone();
    let made = &scene.mesh;
    let generated = made.cylinder_on_half_plane.is_some()
        || made.disc_in_plate.is_some()
        || made.parts.is_some();
    if !generated {
        // A model from arrays may hold pairs and nodal forces that no scene can say.
        if made.file.is_none() || !has_plain_names(&model.mesh) {
            return Ok(());
        }
        staging.file(MESH_FILE, |out| gmsh::write(&model.mesh, out))?;
        scene.mesh = MeshSource {
            file: Some(MESH_FILE.into()),
            ..MeshSource::default()
        };
    }
    let head = format!(
        "# As it was run by brinell {}, everything that was put over the scene file included.\n\n",
        env!("CARGO_PKG_VERSION")
    );
    let text = scene.to_toml()?;
    staging.file(SCENE_FILE, |out| {
        out.write_all(head.as_bytes())?;
        out.write_all(text.as_bytes())
    })
}

fn has_plain_names(mesh: &Mesh) -> bool {
    mesh.bodies
        .iter()
        .chain(mesh.surfaces.keys())
        .chain(mesh.node_sets.keys())
        .all(|name| !name.contains(['"', '\n', '\r']))
}
