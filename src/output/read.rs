//! Reading a result directory: everything that its report shows, without running again.
//!
//! `summary.json` holds the figures, `history.csv` and `contact.csv` the rows, the `.vtu` files the
//! fields, and the model is made from the scene as it was run. Numbers that were not finite were
//! written as null (or an empty cell) and are read as NaN.

use super::contact::PairRow;
use super::names::{CONTACT_FILE, HISTORY_FILE, PATH_FILE, SUMMARY_FILE};
use super::rows::{rows, summary};
use super::{Labels, RunHeader};
use super::{history, record, vtu_read};
use crate::error::{Error, Result};
use crate::model::Model;
use crate::results::Results;
use std::path::Path;

/// A run read back from its directory.
#[derive(Debug, Clone)]
pub struct Recorded {
    /// The facts about the run that the output states in addition to its results.
    pub header: RunHeader,
    /// The model, built again from the scene (or the arrays) as it was run.
    pub model: Model,
    /// The results. The kind of an early end is not recorded.
    pub results: Results,
}

/// Reads a directory that [`super::write_with_report`] or [`super::write_without_report`] wrote.
///
/// ```
/// use brinell::output::{RunHeader, read, write_without_report};
/// # use brinell::{analysis::Analysis, linalg::Backend, model::Model};
/// # use brinell::{progress::Silent, scene::Scene};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let folder = tempfile::tempdir()?;
/// # let dir = folder.path().join("out");
/// # let scene = Scene::load("data/scenes/contact_patch.toml")?;
/// # let mut analysis = Analysis::new(Model::new(&scene)?, Backend::default())?;
/// # let results = analysis.run(&mut Silent)?;
/// # let bodies = analysis.model().mesh.bodies.clone();
/// # let header = RunHeader { bodies, ..RunHeader::default() };
/// write_without_report(&dir, &header, analysis.model(), &results)?;
/// let recorded = read(&dir)?;
/// assert_eq!(recorded.results.states[0].max_pressure, results.states[0].max_pressure);
/// assert_eq!(recorded.results.history, results.history);
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// [`crate::ErrorKind::Io`] if a file cannot be read; [`crate::ErrorKind::Input`] naming the file
/// if `dir` is not a result of brinell, was written without its scene, or is damaged, or if its
/// parts do not belong together.
pub fn read(dir: &Path) -> Result<Recorded> {
    let path = dir.join(SUMMARY_FILE);
    let summary = summary(&path)?;
    let (model_path, model) = record::read(dir)?;
    let bodies = &model.mesh.bodies;
    let header = RunHeader {
        scene_title: model.scene.title.clone(),
        labels: Labels::of(&model),
        ..summary.header(bodies)
    };
    let field_files = summary.field_files();
    let mut results = summary.results(bodies);
    let sizes = &results.sizes;
    for (what, recorded, made) in [
        ("nodes", sizes.nodes, model.mesh.n_nodes()),
        ("elements", sizes.elements, model.mesh.n_elements()),
        ("contact pairs", sizes.contact_pairs, model.pairs.len()),
    ] {
        if recorded != made {
            return Err(Error::input(format!(
                "{}: has {recorded} {what} where {} makes {made}: they do not belong together",
                path.display(),
                model_path.display()
            )));
        }
    }
    (results.history, results.history_columns) = history::read(&dir.join(HISTORY_FILE))?;
    let between = dir.join(PATH_FILE);
    if between.exists() {
        results.path = rows(&between)?;
    }
    read_pairs(&dir.join(CONTACT_FILE), &model, &mut results)?;
    for (state, file) in results.states.iter_mut().zip(field_files) {
        if let Some(name) = file {
            // Only a file of this directory is read, whatever the summary says.
            let name = Path::new(&name).file_name().unwrap_or_default();
            state.fields = Some(vtu_read::read(&dir.join(name), &model.mesh)?);
        }
    }
    Ok(Recorded {
        header,
        model,
        results,
    })
}

/// Reads the pairs of all states.
fn read_pairs(path: &Path, model: &Model, results: &mut Results) -> Result<()> {
    // Points on the axis that are not pairs are numbered after the pairs.
    let on_axis = model.contacts.iter().filter(|c| c.axis.is_some()).count();
    let n_points = model.pairs.len() + on_axis;
    let is_of = |number: usize, n: usize| (1..=n).contains(&number);
    for (index, row) in rows::<PairRow>(path)?.into_iter().enumerate() {
        let state = row.state.checked_sub(1);
        let state = state.and_then(|state| results.states.get_mut(state));
        match state {
            Some(state)
                if is_of(row.pair, n_points) && is_of(row.contact, model.contacts.len()) =>
            {
                state.pairs.push(row.pair_state());
            }
            _ => {
                return Err(Error::input(format!(
                    "{}: row {}: pair {} of contact {} in state {} does not belong to this model",
                    path.display(),
                    index + 1,
                    row.pair,
                    row.contact,
                    row.state
                )));
            }
        }
    }
    Ok(())
}
