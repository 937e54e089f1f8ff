//! A result directory read back: what its report shows, without running again.
//!
//! `summary.json` holds the figures, `history.csv` and `contact.csv` the rows, the `.vtu` files the
//! fields, and the scene as it was run makes the model. Numbers that were not finite were written
//! as null (or an empty cell) and come back as NaN.

use super::rows::{self, Rows};
use super::{CONTACT_FILE, HISTORY_FILE, PATH_FILE, RunHeader, SUMMARY_FILE, record, vtu_read};
use crate::error::{Error, Result};
use crate::linalg::Prediction;
use crate::model::Model;
use crate::results::{
    ContactPatch, Effect, HistoryRow, PairState, PathPoint, Quality, ReferenceRow, Results, Sizes,
    State, Status, YieldPoint,
};
use crate::space::Vector;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::path::Path;

/// Names of orders that a factor may have.
const ORDERINGS: [&str; 3] = ["dense", "CAMD", "nested dissection + CAMD"];

/// A run read back from its directory.
#[derive(Debug, Clone)]
pub struct Recorded {
    /// What the output says about the run beside its results.
    pub header: RunHeader,
    /// The model, built again from the scene (or the arrays) as it was run.
    pub model: Model,
    /// The results. [`Results::incomplete_kind`] is not recorded.
    pub results: Results,
}

/// Reads a directory that [`super::write_with_report`] or [`super::write_without_report`] wrote.
///
/// ```
/// use brinell::output::{RunHeader, read, write_without_report};
/// # use brinell::{analysis::Analysis, linalg::Backend, model::Model, progress::Silent, scene::Scene};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let folder = tempfile::tempdir()?;
/// # let dir = folder.path().join("out");
/// # let scene = Scene::load("data/scenes/contact_patch.toml")?;
/// # let mut analysis = Analysis::new(Model::new(&scene)?, Backend::default())?;
/// # let results = analysis.run(&mut Silent)?;
/// # let header = RunHeader { bodies: analysis.model().mesh.bodies.clone(), ..RunHeader::default() };
/// write_without_report(&dir, &header, analysis.model(), &results)?;
/// let recorded = read(&dir)?;
/// assert_eq!(recorded.results.states[0].max_pressure, results.states[0].max_pressure);
/// assert_eq!(recorded.results.history, results.history);
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// [`crate::ErrorKind::Io`] where a file cannot be read; [`crate::ErrorKind::Input`] naming the
/// file where `dir` is no result of brinell, was written without its scene, is damaged, or where
/// its parts do not belong together.
pub fn read(dir: &Path) -> Result<Recorded> {
    let path = dir.join(SUMMARY_FILE);
    let summary = Summary {
        root: rows::summary(&path)?,
        path: &path,
    };
    let (model_path, model) = record::read(dir)?;
    let header = summary.header(&model);
    let mut results = summary.results(&header)?;
    for (what, recorded, made) in [
        ("nodes", results.sizes.nodes, model.mesh.n_nodes()),
        ("elements", results.sizes.elements, model.mesh.n_elements()),
        (
            "contact pairs",
            results.sizes.contact_pairs,
            model.pairs.len(),
        ),
    ] {
        if recorded != made {
            return Err(Error::input(format!(
                "{}: has {recorded} {what} where {} makes {made}: they do not belong together",
                path.display(),
                model_path.display()
            )));
        }
    }
    results.history = history(&Rows::read(&dir.join(HISTORY_FILE))?)?;
    let between = dir.join(PATH_FILE);
    if between.exists() {
        results.path = path_points(&Rows::read(&between)?)?;
    }
    for (state, pairs) in pairs(&Rows::read(&dir.join(CONTACT_FILE))?, &model)? {
        let state = results.states.get_mut(state).ok_or_else(|| {
            Error::input(format!(
                "{}: a row of state {}, which the summary does not have",
                dir.join(CONTACT_FILE).display(),
                state + 1
            ))
        })?;
        state.pairs.push(pairs);
    }
    for (state, entry) in results.states.iter_mut().zip(summary.list("states")) {
        if let Some(name) = entry["fields"].as_str() {
            // A file of this directory, whatever the summary says.
            let name = Path::new(name).file_name().unwrap_or_default();
            state.fields = Some(vtu_read::read(&dir.join(name), &model.mesh)?);
        }
    }
    Ok(Recorded {
        header,
        model,
        results,
    })
}

fn float(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

fn count(value: &Value) -> usize {
    value.as_u64().unwrap_or(0) as usize
}

fn text(value: &Value) -> String {
    value.as_str().unwrap_or_default().to_string()
}

fn texts(value: &Value) -> Vec<String> {
    value.as_array().into_iter().flatten().map(text).collect()
}

fn quality(value: &Value) -> Quality {
    Quality {
        backward_error: float(&value["backward_error"]),
        componentwise_error: value["componentwise_error"].as_f64(),
        round_off: value["round_off"].as_f64(),
        equilibrium: float(&value["equilibrium"]),
        complementarity: float(&value["complementarity"]),
        penetration: float(&value["penetration"]),
        adhesion: float(&value["adhesion"]),
    }
}

/// The parsed `summary.json`.
struct Summary<'a> {
    path: &'a Path,
    root: Value,
}

impl Summary<'_> {
    fn list(&self, key: &str) -> impl Iterator<Item = &Value> {
        self.root[key].as_array().into_iter().flatten()
    }

    /// Keys and values of an object.
    fn entries(&self, key: &str) -> impl Iterator<Item = (&String, &Value)> {
        self.root[key].as_object().into_iter().flatten()
    }

    /// A part whose type reads itself.
    fn part<Part: DeserializeOwned>(&self, key: &str) -> Result<Part> {
        serde_json::from_value(self.root[key].clone()).map_err(|cause| {
            Error::input(format!("{}: `{key}` is damaged", self.path.display())).because(cause)
        })
    }

    fn header(&self, model: &Model) -> RunHeader {
        RunHeader {
            scene_title: model.scene.title.clone(),
            scene_file: self.root["scene_file"].as_str().map(str::to_string),
            kind: text(&self.root["kind"]),
            solver: text(&self.root["solver"]),
            wall_seconds: float(&self.root["timings"]["total"]),
            bodies: model.mesh.bodies.clone(),
        }
    }

    /// All but the history, the pairs and the fields.
    fn results(&self, header: &RunHeader) -> Result<Results> {
        let root = &self.root;
        Ok(Results {
            sizes: Sizes {
                freedoms: count(&root["freedoms"]),
                nodes: count(&root["nodes"]),
                elements: count(&root["elements"]),
                contact_pairs: count(&root["contact_pairs"]),
                zone_freedoms: count(&root["zone_freedoms"]),
                zone_elements: count(&root["zone_elements"]),
                ..Sizes::default()
            },
            effects: self
                .entries("effects")
                .map(|(name, effect)| Effect {
                    name: name.clone(),
                    on: effect["on"] == true,
                    why: text(&effect["why"]),
                    seconds: float(&effect["seconds"]),
                    memory_bytes: effect["memory_bytes"].as_u64().unwrap_or(0),
                })
                .collect(),
            first_yield: root["yield"].is_object().then(|| YieldPoint {
                alpha: float(&root["yield"]["alpha"]),
                load: float(&root["yield"]["load"]),
                max_pressure: float(&root["yield"]["max_pressure"]),
                half_width: float(&root["yield"]["half_width"]),
                half_width_reading: Default::default(),
                location: vector(&root["yield"]["location"]),
                body: body(header, &root["yield"]["location"]["body"]),
            }),
            states: self.list("states").map(|s| state(header, s)).collect(),
            timings: self
                .entries("timings")
                .filter(|(phase, _)| *phase != "total")
                .map(|(phase, seconds)| (phase.clone(), float(seconds)))
                .collect(),
            counts: self.part("counts")?,
            quality: quality(&root["quality"]),
            condition: float(&root["condition"]),
            condition_estimate: root["condition_estimate"].as_f64(),
            inaccurate: texts(&root["inaccurate"]),
            factor: factor(&root["factor"]),
            reference: self.list("reference").map(reference).collect(),
            accuracy: self.part("accuracy")?,
            warnings: texts(&root["warnings"]),
            resumed: count(&root["resumed"]),
            incomplete: root["incomplete"].as_str().map(str::to_string),
            ..Results::default()
        })
    }
}

/// A point or direction; z = 0 where there is none.
fn vector(entry: &Value) -> Vector {
    let part = |key: &str| entry.get(key).map_or(0.0, float);
    [part("x"), part("y"), part("z")]
}

fn patch(entry: &Value) -> ContactPatch {
    ContactPatch {
        contact: count(&entry["contact"]).saturating_sub(1),
        force: float(&entry["force"]),
        area: float(&entry["area"]),
        max_pressure: float(&entry["max_pressure"]),
        mean_pressure: float(&entry["mean_pressure"]),
        semi_axes: [0, 1].map(|k| float(&entry["semi_axes"][k])),
        centroid: vector(&entry["centroid"]),
        direction: vector(&entry["direction"]),
    }
}

fn body(header: &RunHeader, name: &Value) -> usize {
    let named = |body: &String| name.as_str() == Some(body);
    header.bodies.iter().position(named).unwrap_or(0)
}

fn state(header: &RunHeader, entry: &Value) -> State {
    let arc = &entry["contact_arc"];
    State {
        name: text(&entry["name"]),
        alpha: float(&entry["alpha"]),
        load: float(&entry["load"]),
        contact_force: float(&entry["contact_force"]),
        max_pressure: float(&entry["max_pressure"]),
        patches: (entry["patches"].as_array().into_iter().flatten())
            .map(patch)
            .collect(),
        pole_pressure: float(&entry["pole_pressure"]),
        half_width: float(&entry["half_width"]),
        contact_arc: arc
            .is_object()
            .then(|| [float(&arc["from"]), float(&arc["to"])]),
        residual_depth: float(&entry["residual_depth"]),
        residual_depth_by_body: header
            .bodies
            .iter()
            .map(|body| float(&entry["residual_depth_by_body"][body.as_str()]))
            .collect(),
        rim_height: float(&entry["rim_height"]),
        plastic_points: count(&entry["plastic_points"]),
        plastic_points_by_body: header
            .bodies
            .iter()
            .map(|body| count(&entry["plastic_points_by_body"][body.as_str()]))
            .collect(),
        max_equivalent_plastic_strain: float(&entry["max_equivalent_plastic_strain"]),
        plastic_zone_size: float(&entry["plastic_zone_size"]),
        energy_error: entry["energy_error"].as_f64(),
        approach: float(&entry["approach"]),
        quality: quality(&entry["quality"]),
        ..State::default()
    }
}

fn reference(row: &Value) -> ReferenceRow {
    ReferenceRow {
        quantity: text(&row["quantity"]),
        reference: float(&row["reference"]),
        computed: float(&row["computed"]),
        ratio: float(&row["ratio"]),
        published_ratio: row["published_ratio"].as_f64(),
        source: text(&row["source"]),
    }
}

fn factor(value: &Value) -> Prediction {
    let name = value["ordering"].as_str().unwrap_or_default();
    let known = ORDERINGS.iter().find(|known| **known == name);
    Prediction {
        ordering: known.copied().unwrap_or("not known here"),
        factor_nonzeros: float(&value["factor_nonzeros"]),
        flops: float(&value["flops"]),
        trailing_nonzeros: float(&value["trailing_nonzeros"]),
        memory_bytes: float(&value["memory_bytes"]),
    }
}

/// The history.
fn history(rows: &Rows) -> Result<Vec<HistoryRow>> {
    (0..rows.len())
        .map(|row| {
            let number = |name: &str| rows.number(row, name);
            let count = |name: &str| rows.count(row, name);
            Ok(HistoryRow {
                increment: count("increment")?,
                alpha: number("alpha")?,
                load: number("load")?,
                max_pressure: number("max_pressure")?,
                half_width: number("half_width")?,
                contact_force: number("contact_force")?,
                closed_pairs: count("closed_pairs")?,
                plastic_points: count("plastic_points")?,
                max_equivalent_plastic_strain: number("max_equivalent_plastic_strain")?,
                iterations: count("iterations")?,
                trailing_solves: count("trailing_solves")?,
                residual: number("residual")?,
                event: rows.text(row, "event")?.to_string(),
            })
        })
        .collect()
}

/// The points of the path between the rows of the history.
fn path_points(rows: &Rows) -> Result<Vec<PathPoint>> {
    (0..rows.len())
        .map(|row| {
            Ok(PathPoint {
                increment: rows.count(row, "increment")?,
                alpha: rows.number(row, "alpha")?,
                load: rows.number(row, "load")?,
                max_pressure: rows.number(row, "max_pressure")?,
                half_width: rows.number(row, "half_width")?,
            })
        })
        .collect()
}

/// The pairs, each with the index of its state.
fn pairs(rows: &Rows, model: &Model) -> Result<Vec<(usize, PairState)>> {
    // Points on the axis that are no pairs are numbered after them.
    let on_axis = model.contacts.iter().filter(|c| c.axis.is_some()).count();
    let n_points = model.pairs.len() + on_axis;
    (0..rows.len())
        .map(|row| {
            let number = |name: &str| rows.number(row, name);
            let [pair, contact, state] = [
                rows.count(row, "pair")?,
                rows.count(row, "contact")?,
                rows.count(row, "state")?,
            ];
            let is_of = |number: usize, n: usize| (1..=n).contains(&number);
            if !is_of(pair, n_points) || !is_of(contact, model.contacts.len()) || state == 0 {
                return Err(Error::input(format!(
                    "{}: row {}: pair {pair} of contact {contact} in state {state} does not belong to this model",
                    rows.path().display(),
                    row + 1
                )));
            }
            let pair = PairState {
                pair: pair - 1,
                contact: contact - 1,
                position: [
                    number("x")?,
                    number("y")?,
                    if model.kind.is_solid() { number("z")? } else { 0.0 },
                ],
                gap: number("gap")?,
                force: number("force")?,
                area: number("area")?,
                pressure: number("pressure")?,
                status: match rows.text(row, "status")? {
                    "closed" => Status::Closed,
                    "open" => Status::Open,
                    other => {
                        return Err(rows.refused(row, "status", other, "neither open nor closed"));
                    }
                },
            };
            Ok((state - 1, pair))
        })
        .collect()
}
