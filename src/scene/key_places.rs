//! Where the keys of a scene stand, for what is found wrong with them later: names of sets can be
//! looked up only once there is a mesh.

use crate::error::Error;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

/// Places of the keys of a scene that was read, none of one that was made in code.
#[derive(Clone, Default, PartialEq)]
pub struct KeyPlaces(Arc<BTreeMap<String, String>>);

impl KeyPlaces {
    pub(super) fn new(places: BTreeMap<String, String>) -> Self {
        KeyPlaces(Arc::new(places))
    }

    /// `FILE:LINE:COLUMN` or `--set KEY=VALUE` of a key path (`load.0.on`), or of the innermost
    /// table around it that is there.
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

    /// Gives keys of a text that was made from something else their places there; overrides keep
    /// theirs. A key that has none there is `file`'s.
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

    /// Puts the place of a key, where it is known, in front of what is wrong with it.
    pub(crate) fn in_front(&self, path: &str, error: Error) -> Error {
        match self.of(path) {
            Some(place) => error.within(place),
            None => error,
        }
    }
}

/// Says nothing: scenes that differ in where their keys stand are the same.
impl fmt::Debug for KeyPlaces {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("KeyPlaces")
    }
}
