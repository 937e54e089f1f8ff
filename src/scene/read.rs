//! Reading of text into a [`Scene`], with errors that name file, line, column and key, and suggest
//! what was meant.

use super::document::{KeyPositions, SceneSource};
use super::spelling::closest;
use super::{Scene, complete, listed_materials, overrides, unsupported, validate};
use crate::error::{Error, ErrorKind, Result};
use crate::files;
use crate::text::short;
use serde::Deserialize;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::Path;
use toml::de::DeTable;

impl Scene {
    /// Reads and validates a scene file.
    ///
    /// # Errors
    /// [`ErrorKind::Io`] if the file cannot be read; [`ErrorKind::Input`] as
    /// `FILE:LINE:COLUMN: ...` for text that is not TOML, unknown or missing keys, wrong types,
    /// numbers that are not finite and values out of range; [`ErrorKind::Unsupported`] for an
    /// effect that brinell does not have.
    pub fn load(path: impl AsRef<Path>) -> Result<Scene> {
        Self::load_with(path, &[])
    }

    /// Reads a scene file with `overrides` applied to it, each `key.path=value`. A segment of the
    /// path is a key, the index of an array entry or the entry's name
    /// (`load.press.history=constant`). The value is TOML; anything else is taken as a string. A
    /// table is merged key by key with the table already there. Without a value
    /// (`materials.steel.yield_stress=`) the key is removed.
    ///
    /// ```
    /// use brinell::scene::Scene;
    ///
    /// # fn main() -> brinell::Result<()> {
    /// let overrides = ["materials.steel.yield_stress=400".to_string()];
    /// let scene = Scene::load_with("data/scenes/contact_patch.toml", &overrides)?;
    /// assert_eq!(scene.materials["steel"].yield_stress, Some(400.0));
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// As for [`Scene::load`]; an error in an override is reported as `--set KEY=VALUE: ...`.
    pub fn load_with(path: impl AsRef<Path>, overrides: &[String]) -> Result<Scene> {
        let path = path.as_ref();
        let text = files::read_text("read the scene", path, Some(files::LARGEST_SCENE))?;
        let name = path.display().to_string();
        let mut scene = parse(&SceneSource::new(&name, &text, overrides), None)?;
        scene.file = Some(path.to_path_buf());
        Ok(scene)
    }

    /// Reads and validates a scene from a string; `name` stands for the file in messages. Relative
    /// paths in the scene are relative to the working directory.
    ///
    /// ```
    /// use brinell::{ErrorKind, scene::Scene};
    ///
    /// let text = "kind = \"plane_strain\"\nmaterial = {}";
    /// let error = Scene::parse(text, "press.toml").unwrap_err();
    /// assert_eq!(error.kind(), ErrorKind::Input);
    /// let expected = "press.toml:2:1: unknown key `material`, did you mean `materials`?";
    /// assert!(error.to_string().starts_with(expected));
    /// ```
    ///
    /// # Errors
    /// As for [`Scene::load`].
    pub fn parse(text: &str, name: &str) -> Result<Scene> {
        Self::parse_with(text, name, &[])
    }

    /// Reads and validates a scene from a string like [`Scene::parse`], with `overrides` applied as
    /// by [`Scene::load_with`].
    ///
    /// # Errors
    /// As for [`Scene::load_with`].
    pub fn parse_with(text: &str, name: &str, overrides: &[String]) -> Result<Scene> {
        parse(&SceneSource::new(name, text, overrides), None)
    }

    /// Reads a scene from a text that was made from another source (a deck), like
    /// [`Scene::parse_with`]: `places` holds the places in that source of the scene's tables.
    ///
    /// # Errors
    /// As for [`Scene::parse_with`], with the places in the other source.
    pub(crate) fn parse_placed(
        text: &str,
        name: &str,
        overrides: &[String],
        places: &BTreeMap<String, String>,
    ) -> Result<Scene> {
        parse(&SceneSource::new(name, text, overrides), Some(places))
    }

    /// The scene as TOML: [`Scene::parse`] reads it back.
    ///
    /// # Errors
    /// [`ErrorKind::Internal`] if a value has no form in TOML, which cannot happen for a scene that
    /// was read or built from finite numbers.
    pub fn to_toml(&self) -> Result<String> {
        let text = toml::to_string(self).map_err(|cause| {
            Error::internal("the scene cannot be written as TOML").because(cause)
        })?;
        // Numbers are written with an exponent where that is shorter, unless this would change a
        // value.
        let short = short(&text);
        let said = |text: &str| text.parse::<toml::Table>().ok();
        if matches!(short, Cow::Owned(_)) && said(&short) == said(&text) {
            return Ok(short.into_owned());
        }
        Ok(text)
    }
}

fn parse(source: &SceneSource<'_>, made_from: Option<&BTreeMap<String, String>>) -> Result<Scene> {
    let mut root = DeTable::parse(source.text)
        .map_err(|error| source.syntax_error(&error))?
        .into_inner();
    let warnings = overrides::apply(source, &mut root)?;
    let (places, root) = KeyPositions::number(source, root)?;
    let mut scene = Scene::deserialize(toml::de::Deserializer::from(root.clone()))
        .map_err(|error| explain(&error, &places))?;
    scene.places = places.by_key();
    if let Some(places) = made_from {
        scene.places = scene.places.elsewhere(places, source.name);
    }
    scene.warnings = warnings;
    complete::check(&scene, root.get_ref(), &scene.places)?;
    listed_materials::fill_in(&mut scene)?;
    let problems = validate::all_problems(&scene);
    if !problems.is_empty() {
        let lines = problems.iter().map(|problem| {
            let place = scene.places.of(&problem.key).unwrap_or(source.name);
            format!("{place}: {problem}")
        });
        return Err(Error::input(lines.collect::<Vec<_>>().join("\n")));
    }
    let labels = scene.program.labels();
    for (target, label) in scene.program.targets.iter_mut().zip(labels) {
        target.name = Some(label);
    }
    Ok(scene)
}

/// Converts an error of serde into words for the user.
fn explain(error: &toml::de::Error, places: &KeyPositions) -> Error {
    let (place, path) = places.of_error(error);
    let message = error.message();
    let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    let (kind, text) = match (message, quoted.split_first()) {
        (m, Some((word, known))) if m.starts_with("unknown field") => {
            unknown_key(word, known, path)
        }
        (m, Some((word, known))) if m.starts_with("unknown variant") => {
            unknown_word(word, known, path)
        }
        (m, Some((word, _))) if m.starts_with("missing field") => (
            ErrorKind::Input,
            if path.is_empty() {
                format!("the key `{word}` is missing")
            } else {
                format!("{path}: the key `{word}` is missing")
            },
        ),
        (m, _) => (ErrorKind::Input, format!("{path}: {}", in_words(m))),
    };
    Error::new(kind, format!("{place}: {text}"))
}

fn unknown_key(word: &str, known: &[&str], path: &str) -> (ErrorKind, String) {
    if let Some(effect) = unsupported::effect(word) {
        return (
            ErrorKind::Unsupported,
            format!("{path}: brinell has no {effect}; take the key `{word}` out"),
        );
    }
    let table = path.rfind('.').map_or("", |dot| &path[..dot]);
    let here = if table.is_empty() {
        String::new()
    } else {
        format!(" ({table})")
    };
    let text = format!(
        "unknown key `{word}`{} Known keys here{here}: {}",
        closest(word, known).map_or(".".to_string(), |k| format!(", did you mean `{k}`?")),
        if known.is_empty() {
            "none".to_string()
        } else {
            known.join(", ")
        }
    );
    (ErrorKind::Input, text)
}

fn unknown_word(word: &str, known: &[&str], path: &str) -> (ErrorKind, String) {
    if let Some(effect) = unsupported::effect(word) {
        return (
            ErrorKind::Unsupported,
            format!("{path}: \"{word}\": brinell has no {effect}"),
        );
    }
    let text = format!(
        "{path}: unknown value \"{word}\"{} Possible values: {}",
        closest(word, known).map_or(".".to_string(), |k| format!(", did you mean \"{k}\"?")),
        known.join(", ")
    );
    (ErrorKind::Input, text)
}

/// Replaces serde's names of types by plain words.
fn in_words(message: &str) -> String {
    if message == "wanted string or table" {
        return "wrong type, expected a word in quotes".to_string();
    }
    let Some((found, expected)) = message.rsplit_once(", expected ") else {
        return message.to_string();
    };
    let mut found = found.to_string();
    for (serde, words) in [
        ("invalid type: floating point", "wrong type: number"),
        ("invalid type: sequence", "wrong type: array"),
        ("invalid type: map", "wrong type: table"),
        ("invalid type:", "wrong type:"),
        ("invalid value:", "wrong value:"),
        ("invalid length", "wrong number of values:"),
    ] {
        if let Some(rest) = found.strip_prefix(serde) {
            found = format!("{words}{rest}");
        }
    }
    // The most common slips in TOML: a list of one entry given as a table, or a vector given by its
    // components.
    if found == "wrong type: table" && expected == "a sequence" {
        return "a single table, expected a list: write the head of one of several tables with two \
                brackets, [[...]], values as [1.0, 2.0]"
            .to_string();
    }
    let expected = match expected {
        "f64" => "a number",
        "usize" => "a whole number, 0 or more",
        "path string" => "a path in quotes",
        "a sequence" => "an array",
        "a map" => "a table",
        _ if expected.starts_with("struct ") => "a table",
        _ => expected,
    };
    format!("{found}, expected {expected}")
}

#[cfg(test)]
mod tests;
