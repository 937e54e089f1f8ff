//! Names of sets that the entries of a scene give, looked up in the mesh.

use crate::error::{Error, Result};
use crate::mesh::{Mesh, Surface};
use crate::scene::{Scene, closest};

/// An entry of a scene, for messages about it.
pub(super) struct Entry<'s> {
    scene: &'s Scene,
    /// Its key path, `load.0`.
    key: String,
    /// In words, `load 1`.
    what: String,
}

impl<'s> Entry<'s> {
    /// Entry `index` of one of the scene's lists.
    pub(super) fn of_list(scene: &'s Scene, list: &str, index: usize) -> Self {
        Entry {
            scene,
            key: format!("{list}.{index}"),
            what: format!("{list} {}", index + 1),
        }
    }

    /// The displacement that target `index` waits for.
    pub(super) fn of_target(scene: &'s Scene, index: usize) -> Self {
        Entry {
            scene,
            key: format!("program.targets.{index}.displacement"),
            what: format!("target {} displacement", index + 1),
        }
    }

    /// Set `index` that the history follows.
    pub(super) fn of_history(scene: &'s Scene, index: usize) -> Self {
        Entry {
            scene,
            key: format!("program.history.{index}"),
            what: format!("history {}", index + 1),
        }
    }

    /// The nodes of the set that it is the name of.
    pub(super) fn named(&self, mesh: &Mesh, name: &str) -> Result<Vec<usize>> {
        let nodes = self.found(mesh, &self.what, name);
        nodes.map_err(|error| self.refused(error))
    }

    /// Puts the entry's place in front of what is wrong with it.
    pub(super) fn refused(&self, error: Error) -> Error {
        self.scene.places.in_front(&self.key, error)
    }

    /// The entry and what it acts on, in words: load 1 on `block.top`.
    pub(super) fn on(&self, name: &str) -> String {
        format!("{} on `{name}`", self.what)
    }

    /// The nodes of the set that its key `on` names.
    pub(super) fn nodes(&self, mesh: &Mesh, name: &str) -> Result<Vec<usize>> {
        let nodes = self.found(mesh, &format!("{} on", self.what), name);
        nodes.map_err(|error| self.refused_at("on", error))
    }

    /// The nodes of a set, for messages about `what`.
    fn found(&self, mesh: &Mesh, what: &str, name: &str) -> Result<Vec<usize>> {
        match mesh.set_nodes(name) {
            Some(nodes) if !nodes.is_empty() => Ok(nodes),
            Some(_) => Err(Error::input(format!("{what} `{name}`: the set is empty"))),
            None => Err(unknown(what, name, &mesh.set_names())),
        }
    }

    /// The surface that one of its keys names.
    pub(super) fn surface<'m>(&self, mesh: &'m Mesh, key: &str, name: &str) -> Result<&'m Surface> {
        mesh.surfaces.get(name).ok_or_else(|| {
            let names: Vec<&str> = mesh.surfaces.keys().map(String::as_str).collect();
            let what = format!("{} surface", self.what);
            self.refused_at(key, unknown(&what, name, &names))
        })
    }

    fn refused_at(&self, key: &str, error: Error) -> Error {
        self.scene
            .places
            .in_front(&format!("{}.{key}", self.key), error)
    }
}

/// A name that the mesh does not have, with the one that may be meant.
fn unknown(what: &str, name: &str, known: &[&str]) -> Error {
    let meant = closest(name, known).map_or(".".to_string(), |k| format!(", did you mean `{k}`?"));
    Error::input(format!(
        "{what} `{name}`: the mesh has no such set{meant} It has: {}",
        known.join(", ")
    ))
}
