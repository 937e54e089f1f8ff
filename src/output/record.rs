//! The record of what was run, so that a result directory says by itself where it comes from. It
//! consists of the scene with all overrides applied, and of the mesh if the scene does not generate
//! one; for a model that was given in arrays it is the whole model.

use super::atomic::Staging;
use crate::error::{Error, Result};
use crate::files;
use crate::mesh::{Mesh, gmsh};
use crate::model::{Model, Recipe};
use crate::scene::{MeshSource, Scene};
use std::io::Write;
use std::path::{Path, PathBuf};

/// File of the scene in a result directory.
pub(super) const SCENE_FILE: &str = "scene_as_run.toml";
/// File of the scene's mesh in a result directory.
pub(super) const MESH_FILE: &str = "mesh_as_run.msh";
/// File of a model that no scene can make.
pub(super) const MODEL_FILE: &str = "model_as_run.json";

/// Writes the scene and its mesh, or the model.
///
/// # Errors
/// `Io` naming the file.
pub(super) fn write(staging: &Staging, model: &Model) -> Result<()> {
    let made = &model.scene.mesh;
    // A Gmsh file cannot hold every name.
    if !model.is_of_its_scene() || (made.file.is_some() && !has_plain_names(&model.mesh)) {
        return staging.file(MODEL_FILE, |out| {
            serde_json::to_writer(&mut *out, &Recipe::of(model))?;
            out.write_all(b"\n")
        });
    }
    let mut scene = model.scene.clone();
    if let Some(folder) = scene.start_folder() {
        scene.start_from = Some(std::path::absolute(&folder).unwrap_or(folder));
    }
    if made.file.is_some() {
        staging.file(MESH_FILE, |out| gmsh::write(&model.mesh, out))?;
        scene.mesh = MeshSource {
            file: Some(MESH_FILE.into()),
            formulation: made.formulation,
            ..MeshSource::default()
        };
    }
    let head = format!(
        "# The scene as brinell {} ran it, with all overrides.\n\n",
        env!("CARGO_PKG_VERSION")
    );
    let text = scene.to_toml()?;
    staging.file(SCENE_FILE, |out| {
        out.write_all(head.as_bytes())?;
        out.write_all(text.as_bytes())
    })
}

/// Rebuilds the model of a directory; returns it with the path of the file that describes it.
///
/// # Errors
/// `Input` if no such file exists or it is damaged, `Io` if it cannot be read.
pub(super) fn read(dir: &Path) -> Result<(PathBuf, Model)> {
    let scene = dir.join(SCENE_FILE);
    if scene.exists() {
        let model = Model::new(&Scene::load(&scene)?)?;
        return Ok((scene, model));
    }
    let path = dir.join(MODEL_FILE);
    if !path.exists() {
        return Err(Error::input(format!(
            "{}: the results were written without their scene ({SCENE_FILE} or {MODEL_FILE}), run \
             the scene again; `brinell view --terminal` shows what there is",
            dir.display()
        )));
    }
    let text = files::read("read the model", &path, None)?;
    let recipe: Recipe = serde_json::from_slice(&text).map_err(|cause| {
        Error::input(format!("{}: the model is damaged", path.display())).because(cause)
    })?;
    let model = recipe.make().map_err(|cause| {
        Error::input(format!("{}: the model is damaged", path.display())).because(cause)
    })?;
    Ok((path, model))
}

fn has_plain_names(mesh: &Mesh) -> bool {
    mesh.bodies
        .iter()
        .chain(mesh.surfaces.keys())
        .chain(mesh.node_sets.keys())
        .all(|name| !name.contains(['"', '\n', '\r']))
}
