//! The identity of a checkpoint: nothing that the results depend on may have changed.

use crate::error::{Error, Result};
use crate::files;
use crate::linalg::Backend;
use crate::mesh::Mesh;
use crate::results::EndState;
use crate::scene::{Field, Scene};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use xxhash_rust::xxh3::{Xxh3, xxh3_128};

/// Scene, mesh and backend of a run. The version of brinell is in the first line of each file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Identity {
    /// The scene with its overrides, as JSON.
    scene: String,
    /// Hash of the mesh: a scene may name a file, whose content may have changed.
    mesh: u128,
    /// Hash of the files with values at nodes that the scene names.
    values: u128,
    backend: String,
    /// Hash of the state from which the run starts, 0 if the material is virgin.
    start: u128,
}

impl Identity {
    /// Creates the identity of a run.
    ///
    /// # Errors
    /// `Internal` if the scene is not plain data.
    pub fn new(
        (scene, start): (&Scene, Option<&EndState>),
        mesh: &Mesh,
        backend: Backend,
    ) -> Result<Self> {
        let text = serde_json::to_string(scene)
            .map_err(|cause| Error::internal("the scene is not plain data").because(cause))?;
        Ok(Identity {
            scene: text,
            mesh: hash(mesh),
            values: hash_of_values(scene)?,
            backend: backend.name().to_string(),
            start: match start {
                Some(state) => hash_of_start(state)?,
                None => 0,
            },
        })
    }

    /// Returns `None` if a run with the identity `now` may continue from a checkpoint of `self`,
    /// else the difference.
    pub(super) fn difference(&self, now: &Identity) -> Option<String> {
        if self.scene != now.scene {
            let parse = |text: &str| serde_json::from_str::<Value>(text).unwrap_or_default();
            let (then, now) = (parse(&self.scene), parse(&now.scene));
            let found = first_difference("", &then, &now);
            return Some(found.map_or_else(
                || "the scene differs".to_string(),
                |(key, then, now)| format!("the scene's `{key}` was {then} and is {now}"),
            ));
        }
        if self.mesh != now.mesh {
            return Some("the mesh differs, the scene being the same: its file has changed".into());
        }
        if self.values != now.values {
            return Some("a file with temperatures has changed".into());
        }
        if self.start != now.start {
            let why = "the state in the directory of `start_from` has changed";
            return Some(why.into());
        }
        if self.backend != now.backend {
            return Some(format!(
                "the solver was `{}` and is `{}`",
                self.backend, now.backend
            ));
        }
        None
    }
}

/// Returns key path and both values of the first leaf that differs.
fn first_difference(path: &str, then: &Value, now: &Value) -> Option<(String, String, String)> {
    let below = |key: &str| match path {
        "" => key.to_string(),
        path => format!("{path}.{key}"),
    };
    match (then, now) {
        (Value::Object(a), Value::Object(b)) => {
            let keys = a.keys().chain(b.keys().filter(|key| !a.contains_key(*key)));
            keys.into_iter().find_map(|key| {
                let nothing = Value::Null;
                let side =
                    |map: &serde_json::Map<String, Value>| map.get(key).unwrap_or(&nothing).clone();
                first_difference(&below(key), &side(a), &side(b))
            })
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            let items = a.iter().zip(b).enumerate();
            items
                .into_iter()
                .find_map(|(i, (a, b))| first_difference(&below(&i.to_string()), a, b))
        }
        (Value::Array(a), Value::Array(b)) => Some((
            path.to_string(),
            format!("a list of {}", a.len()),
            format!("one of {}", b.len()),
        )),
        (a, b) if a == b => None,
        (a, b) => Some((path.to_string(), a.to_string(), b.to_string())),
    }
}

fn hash_of_start(state: &EndState) -> Result<u128> {
    let bytes = postcard::to_stdvec(state)
        .map_err(|cause| Error::internal("an end state cannot be encoded").because(cause))?;
    Ok(xxh3_128(&bytes))
}

/// Returns the hash of the files with values at nodes, one after the other; 0 if there are none.
fn hash_of_values(scene: &Scene) -> Result<u128> {
    let mut hash = Xxh3::new();
    let mut has_some = false;
    for field in scene.fields() {
        if let Field::Nodal(of) = field {
            hash.update(&files::read(
                "read the values of nodes",
                &scene.beside(&of.file),
                None,
            )?);
            has_some = true;
        }
    }
    Ok(if has_some { hash.digest128() } else { 0 })
}

/// Returns the hash of everything in the mesh that a result may depend on.
pub(super) fn hash(mesh: &Mesh) -> u128 {
    let mut hash = Xxh3::new();
    let mut number = |n: u64| hash.update(&n.to_le_bytes());
    number(mesh.dimension as u64);
    number(mesh.coordinates.len() as u64);
    mesh.coordinates.iter().for_each(|x| number(x.to_bits()));
    mesh.offsets.iter().for_each(|&at| number(at as u64));
    mesh.connectivity.iter().for_each(|&n| number(u64::from(n)));
    mesh.element_body.iter().for_each(|&b| number(u64::from(b)));
    mesh.shapes.iter().for_each(|&s| number(s as u64));
    mesh.integration.iter().for_each(|&i| number(i as u64));
    for (name, nodes) in &mesh.node_sets {
        name.bytes().for_each(|b| number(u64::from(b)));
        number(nodes.len() as u64);
        nodes.iter().for_each(|&n| number(n as u64));
    }
    for (name, surface) in &mesh.surfaces {
        name.bytes().for_each(|b| number(u64::from(b)));
        number(surface.facets.len() as u64);
        for facet in &surface.facets {
            number(facet.element as u64);
            number(facet.local as u64);
        }
        match &surface.curve {
            None => number(0),
            Some(curve) => {
                let (numbers, outward) = curve.numbers();
                curve.name().bytes().for_each(|b| number(u64::from(b)));
                numbers.iter().for_each(|x| number(x.to_bits()));
                number(u64::from(outward));
            }
        }
    }
    for body in &mesh.bodies {
        body.bytes().for_each(|b| number(u64::from(b)));
        number(body.len() as u64);
    }
    hash.digest128()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Curve, Facet, Surface};
    use serde_json::json;
    use std::collections::BTreeSet;

    /// One property is changed at a time: no two of these meshes have the same hash.
    #[test]
    fn everything_of_a_mesh_counts() {
        let circle = |center: [f64; 2], radius: f64, outward: bool| {
            Some(Curve::Circle {
                center,
                radius,
                outward,
            })
        };
        let surface = |element: usize, local: usize, curve: Option<Curve>| Surface {
            facets: vec![Facet { element, local }],
            curve,
        };
        let base = || {
            let mut mesh = Mesh {
                dimension: 2,
                coordinates: vec![0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0],
                bodies: vec!["a".into(), "b".into()],
                ..Mesh::default()
            };
            mesh.push_element(crate::shape::Shape::Quad4, 0, &[0, 1, 2, 3]);
            mesh.node_sets.insert("set".into(), vec![0, 2]);
            let curve = circle([0.0, 0.0], 1.0, true);
            mesh.surfaces.insert("side".into(), surface(0, 1, curve));
            mesh
        };
        let changes: [fn(&mut Mesh); 7] = [
            |_| {},
            |m| m.coordinates[3] = 1e-13,
            |m| m.connectivity.rotate_left(1),
            |m| m.element_body[0] = 1,
            |m| m.bodies[1] = "c".into(),
            |m| {
                m.node_sets
                    .insert("set".into(), vec![0, 3])
                    .map_or((), drop)
            },
            |m| {
                m.node_sets
                    .insert("other".into(), vec![0, 2])
                    .map_or((), drop)
            },
        ];
        let mut hashes: BTreeSet<u128> = BTreeSet::new();
        for change in changes {
            let mut mesh = base();
            change(&mut mesh);
            hashes.insert(hash(&mesh));
        }
        let surfaces = [
            surface(0, 2, circle([0.0, 0.0], 1.0, true)),
            surface(0, 1, circle([0.0, 0.5], 1.0, true)),
            surface(0, 1, circle([0.0, 0.0], 1.5, true)),
            surface(0, 1, circle([0.0, 0.0], 1.0, false)),
            surface(0, 1, Some(Curve::Line { normal: [0.0, 1.0] })),
            surface(0, 1, None),
        ];
        for changed in surfaces.clone() {
            let mut mesh = base();
            mesh.surfaces.insert("side".into(), changed);
            hashes.insert(hash(&mesh));
        }
        assert_eq!(hashes.len(), changes.len() + surfaces.len());
    }

    #[test]
    fn scene_mesh_and_solver_must_be_the_same() {
        let own = || Identity {
            scene: "{\"a\":1}".into(),
            mesh: 7,
            backend: "cholmod".into(),
            values: 0,
            start: 0,
        };
        assert_eq!(own().difference(&own()), None);
        let others = [
            (
                Identity {
                    scene: "{\"a\":2}".into(),
                    ..own()
                },
                "`a` was 1 and is 2",
            ),
            (Identity { mesh: 8, ..own() }, "the mesh differs"),
            (Identity { values: 8, ..own() }, "a file with temperatures"),
            (
                Identity {
                    backend: "dense".into(),
                    ..own()
                },
                "`cholmod` and is `dense`",
            ),
        ];
        for (other, fragment) in others {
            let why = own().difference(&other).unwrap();
            assert!(why.contains(fragment), "{why}");
        }
    }

    #[test]
    fn the_first_difference_is_named_by_its_key() {
        let then = json!({ "a": { "b": [1, { "c": 2.5 }] }, "d": "x" });
        let mut now = then.clone();
        assert_eq!(first_difference("", &then, &now), None);
        now["a"]["b"][1]["c"] = json!(2.6);
        let found = first_difference("", &then, &now).unwrap();
        assert_eq!(found, ("a.b.1.c".into(), "2.5".into(), "2.6".into()));
        now = json!({ "a": { "b": [1] }, "d": "x" });
        let (key, then_has, now_has) = first_difference("", &then, &now).unwrap();
        assert_eq!(key, "a.b");
        assert_eq!(
            (then_has.as_str(), now_has.as_str()),
            ("a list of 2", "one of 1")
        );
        now = then.clone();
        now["e"] = json!(true);
        let found = first_difference("", &then, &now).unwrap();
        assert_eq!(found, ("e".into(), "null".into(), "true".into()));
    }
}
