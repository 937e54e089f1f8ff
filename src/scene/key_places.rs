//! Places of the keys of a scene, kept for errors that are found after reading: names of sets, for
//! example, can be looked up only once there is a mesh.

use crate::error::Error;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

/// Places of the keys of a scene that was read from text; empty for a scene that was made in code.
#[derive(Clone, Default, PartialEq)]
pub struct KeyPlaces(Arc<BTreeMap<String, String>>);

impl KeyPlaces {
    pub(super) fn new(places: BTreeMap<String, String>) -> Self {
        KeyPlaces(Arc::new(places))
    }

    /// `FILE:LINE:COLUMN` or `--set KEY=VALUE` of a key path (`load.0.on`), or of the innermost
    /// enclosing table that has a place.
    pub fn of(&self, path: &str) -> Option<&str> {
        let mut path = path;
        loop {
            if let Some(place) = self.0.get(path) {
                return Some(place);
            }
            if path.is_empty() {
                return None;
            }
            path = path.rfind('.').map_or("", |dot| &path[..dot]);
        }
    }

    /// Replaces the places of the keys by `places`, for a scene text that was made from another
    /// source (a deck). Keys set by overrides keep their places. A key without an entry in `places`
    /// gets the place `file`.
    pub(super) fn elsewhere(&self, places: &BTreeMap<String, String>, file: &str) -> KeyPlaces {
        let there = KeyPlaces::new(places.clone());
        let place_of = |(key, place): (&String, &String)| {
            let place = match place.starts_with("--set ") {
                true => place,
                false => there.of(key).unwrap_or(file),
            };
            (key.clone(), place.to_string())
        };
        KeyPlaces::new(self.0.iter().map(place_of).collect())
    }

    /// Prefixes an error about a key with the key's place, if it is known.
    pub(crate) fn in_front(&self, path: &str, error: Error) -> Error {
        match self.of(path) {
            Some(place) => error.within(place),
            None => error,
        }
    }
}

/// Prints no places, because scenes that differ only in the places of their keys are equal.
impl fmt::Debug for KeyPlaces {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("KeyPlaces")
    }
}
