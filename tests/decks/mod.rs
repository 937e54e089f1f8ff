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
    run_with_model(&load_text(text).unwrap())
}

/// Reads the text of a deck, which includes no files, as `deck.inp`.
fn load_text(text: &str) -> Result<Scene> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("deck.inp");
    std::fs::write(&path, text).unwrap();
    deck::load(&path)
}
