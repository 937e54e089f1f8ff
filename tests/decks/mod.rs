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

use brinell::analysis::Analysis;
use brinell::deck::{self, Options};
use brinell::linalg::Backend;
use brinell::model::Model;
use brinell::progress::Silent;
use brinell::results::Results;
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/decks")
}

fn deck_path(name: &str) -> PathBuf {
    folder().join(format!("{name}.inp"))
}

/// Runs a deck or a scene.
fn run(path: &Path, overrides: &[&str]) -> (Model, Results) {
    let overrides: Vec<String> = overrides.iter().map(ToString::to_string).collect();
    let scene = deck::load_with(path, &overrides, Options::default()).unwrap();
    let model = Model::new(&scene).unwrap();
    let mut analysis = Analysis::new(model.clone(), Backend::default()).unwrap();
    let results = analysis.run(&mut Silent).unwrap();
    (model, results)
}
