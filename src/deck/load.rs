//! Reading of a scene from a file that may be a scene or a deck.

use super::{Deck, Options, words};
use crate::error::Result;
use crate::scene::Scene;
use std::path::Path;

/// Whether a file is a deck, judged by the extension `.inp`.
pub fn is_deck(path: &Path) -> bool {
    path.extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("inp"))
}

/// Reads and validates a scene file, or the scene that a deck describes.
///
/// # Errors
/// Errors of [`load_with`].
pub fn load(path: impl AsRef<Path>) -> Result<Scene> {
    load_with(path, &[], Options::default())
}

/// Reads a scene like [`load()`], with `overrides` applied to it, each `key.path=value`
/// ([`Scene::load_with`]). Remarks on how a deck was interpreted are among the scene's warnings.
///
/// # Errors
/// The errors of [`Scene::load_with`], [`Deck::read`] and [`Deck::convert`].
pub fn load_with(path: impl AsRef<Path>, overrides: &[String], options: Options) -> Result<Scene> {
    let path = path.as_ref();
    if !is_deck(path) {
        return Scene::load_with(path, overrides);
    }
    let conversion = Deck::read(path)?.convert(options)?;
    let mut scene = conversion.finish(&path.display().to_string(), overrides)?;
    scene.file = Some(path.to_path_buf());
    Ok(scene)
}

impl super::Conversion {
    /// The scene in the form in which it would be read from a file: validated, with overrides
    /// applied, and with the places of its data in the deck.
    ///
    /// # Errors
    /// The errors of [`Scene::parse_with`], at the lines of the deck.
    pub fn finish(&self, name: &str, overrides: &[String]) -> Result<Scene> {
        let text = self.scene.to_toml()?;
        let parsed = Scene::parse_placed(&text, name, overrides, &self.places);
        let mut scene = parsed.map_err(|error| error.reworded(words::reworded))?;
        scene.requests = self.scene.requests.clone();
        let taken = self.account.taken.iter().map(ToString::to_string);
        scene.warnings.splice(0..0, taken);
        Ok(scene)
    }
}
