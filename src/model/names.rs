//! Names of sets in the entries of a scene, looked up in the mesh.

use crate::error::{Error, Result};
use crate::mesh::{Mesh, Surface};
use crate::scene::{Scene, closest};

/// An entry of a scene, for messages about the entry.
pub(super) struct SceneEntry<'s> {
    scene: &'s Scene,
    /// Key path of the entry, such as `load.0`.
    key: String,
    /// Name of the entry in messages, such as `load 1`.
    what: String,
}

impl<'s> SceneEntry<'s> {
    /// Makes entry `index` of one of the scene's lists.
    pub(super) fn of_list(scene: &'s Scene, list: &str, index: usize) -> Self {
        SceneEntry {
            scene,
            key: format!("{list}.{index}"),
            what: format!("{list} {}", index + 1),
        }
    }

    /// Makes the entry of target `index`.
    pub(super) fn of_target(scene: &'s Scene, index: usize) -> Self {
        SceneEntry {
            scene,
            key: format!("program.targets.{index}"),
            what: format!("target {}", index + 1),
        }
    }

    /// Makes the entry of the displacement for which target `index` waits.
    pub(super) fn of_target_displacement(scene: &'s Scene, index: usize) -> Self {
        SceneEntry {
            scene,
            key: format!("program.targets.{index}.displacement"),
            what: format!("target {} displacement", index + 1),
        }
    }

    /// Makes the entry of set `index` that the history follows.
    pub(super) fn of_history(scene: &'s Scene, index: usize) -> Self {
        SceneEntry {
            scene,
            key: format!("program.history.{index}"),
            what: format!("history {}", index + 1),
        }
    }

    /// Finds the nodes of the set `name` for an entry that consists of this name alone.
    pub(super) fn named(&self, mesh: &Mesh, name: &str) -> Result<Vec<usize>> {
        let nodes = self.found(mesh, &self.what, name);
        nodes.map_err(|error| self.refused(error))
    }

    /// Prefixes an error with the place of the entry.
    pub(super) fn refused(&self, error: Error) -> Error {
        self.scene.places.in_front(&self.key, error)
    }

    /// The entry and the set on which it acts, in words: load 1 on `block.top`.
    pub(super) fn on(&self, name: &str) -> String {
        format!("{} on `{name}`", self.what)
    }

    /// Finds the nodes of the set that the entry's key `on` names.
    pub(super) fn nodes(&self, mesh: &Mesh, name: &str) -> Result<Vec<usize>> {
        let nodes = self.found(mesh, &format!("{} on", self.what), name);
        nodes.map_err(|error| self.refused_at("on", error))
    }

    /// Finds the nodes of a set, with `what` for messages.
    fn found(&self, mesh: &Mesh, what: &str, name: &str) -> Result<Vec<usize>> {
        match mesh.set_nodes(name) {
            Some(nodes) if !nodes.is_empty() => Ok(nodes),
            Some(_) => Err(Error::input(format!("{what} `{name}`: the set is empty"))),
            None => Err(unknown(what, name, mesh, &mesh.set_names())),
        }
    }

    /// Finds the surface that one of the entry's keys names.
    pub(super) fn surface<'m>(&self, mesh: &'m Mesh, key: &str, name: &str) -> Result<&'m Surface> {
        mesh.surfaces.get(name).ok_or_else(|| {
            let names: Vec<&str> = mesh.surfaces.keys().map(String::as_str).collect();
            let what = format!("{} surface", self.what);
            self.refused_at(key, unknown(&what, name, mesh, &names))
        })
    }

    fn refused_at(&self, key: &str, error: Error) -> Error {
        self.scene
            .places
            .in_front(&format!("{}.{key}", self.key), error)
    }
}

/// Error for a name that the mesh does not have, with the name that was probably meant.
fn unknown(what: &str, name: &str, mesh: &Mesh, known: &[&str]) -> Error {
    let has = known.join(", ");
    if let Some((_, set)) = mesh.body_and_set(name) {
        let why = match mesh.surfaces.contains_key(set) {
            true => format!(
                "the mesh has nothing of surface `{set}` on this body, it is on {}",
                mesh.bodies_of_set(set).join(", ")
            ),
            false if known.contains(&set) => format!(
                "the mesh has no node of set `{set}` on this body, they are on {}",
                mesh.bodies_of_set(set).join(", ")
            ),
            false => format!("`{set}` is a set of nodes, not a surface; it has the surfaces {has}"),
        };
        return Error::input(format!("{what} `{name}`: {why}"));
    }
    let is_meant = |body: &&String| name.starts_with(&format!("{body}."));
    let meant = mesh.bodies.iter().find(is_meant);
    let of_body = |body: &String| known.iter().map(|set| format!("{body}.{set}")).collect();
    let parts: Vec<String> = meant.map_or(Vec::new(), of_body);
    let names = known
        .iter()
        .copied()
        .chain(parts.iter().map(String::as_str));
    let names: Vec<&str> = names.collect();
    let meant = closest(name, &names).map_or(".".to_string(), |k| format!(", did you mean `{k}`?"));
    Error::input(format!(
        "{what} `{name}`: the mesh has no such set{meant} It has: {has}"
    ))
}
