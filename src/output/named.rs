//! Named entries in a fixed order: a JSON object whose keys are in the order of the scene.

use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;
use std::marker::PhantomData;

/// Entries by name, in order.
#[derive(Debug)]
pub(super) struct NamedEntries<T>(pub Vec<(String, T)>);

impl<T> Default for NamedEntries<T> {
    fn default() -> Self {
        NamedEntries(Vec::new())
    }
}

impl<T> NamedEntries<T> {
    /// Returns the entry of a name.
    pub(super) fn get(&self, name: &str) -> Option<&T> {
        self.0.iter().find(|entry| entry.0 == name).map(|e| &e.1)
    }
}

impl<T> FromIterator<(String, T)> for NamedEntries<T> {
    fn from_iter<I: IntoIterator<Item = (String, T)>>(entries: I) -> Self {
        NamedEntries(entries.into_iter().collect())
    }
}

impl<T: Serialize> Serialize for NamedEntries<T> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.collect_map(self.0.iter().map(|(name, entry)| (name, entry)))
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for NamedEntries<T> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct Entries<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Entries<T> {
            type Value = NamedEntries<T>;

            fn expecting(&self, to: &mut fmt::Formatter) -> fmt::Result {
                to.write_str("an object")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<NamedEntries<T>, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(NamedEntries(entries))
            }
        }
        from.deserialize_map(Entries(PhantomData))
    }
}
