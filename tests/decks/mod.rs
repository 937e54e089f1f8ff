//! Decks of Abaqus and CalculiX: what CalculiX computes for them and what brinell does, what is
//! written again, what is refused.

mod assemblies;
mod calculix;
mod converted;
mod expansion;
mod frd;
mod local_axes;
mod messages;
mod parameters;
mod programs;
mod refusals;
mod sections;
mod sets;
mod sides;
mod table;
mod two_bars;
mod variants;

use crate::support::{root, run_with_model};
use brinell::Result;
use brinell::deck::{self, Options};
use brinell::model::Model;
use brinell::results::Results;
use brinell::scene::Scene;
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    root().join("tests/decks")
}

fn deck_path(name: &str) -> PathBuf {
    folder().join(format!("{name}.inp"))
}

/// Runs the file of a deck or a scene.
fn run_file(path: &Path, overrides: &[&str]) -> (Model, Results) {
    let overrides: Vec<String> = overrides.iter().map(ToString::to_string).collect();
    let scene = deck::load_with(path, &overrides, Options::default()).unwrap();
    run_with_model(&scene)
}

/// Runs the text of a deck.
fn run_text(text: &str) -> (Model, Results) {
    with_text(text, |scene| Ok(run_with_model(&scene))).unwrap()
}

/// Writes the text of a deck as `deck.inp`, which holds the mesh, and hands its scene on.
fn with_text<T>(text: &str, see: impl FnOnce(Scene) -> Result<T>) -> Result<T> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("deck.inp");
    std::fs::write(&path, text).unwrap();
    see(deck::load(&path)?)
}
