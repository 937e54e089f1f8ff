//! `summary.json`: the figures of a run, as one structure that writes and reads the file. Keys and
//! meanings are in [`super::SUMMARY_SCHEMA`]; the keys of a state are in the table [`QUANTITIES`].

use super::labels::{ContactExtent, Labels, UnitNames};
use super::{RunHeader, fields, named::NamedEntries};
use crate::error::ErrorKind;
use crate::memory;
use crate::results::{
    Accuracy, ContactPatch, Counts, Cycles, Effect, Field, Incomplete, Prediction, QUANTITIES,
    Quality, Quantity, Ranks, ReferenceRow, Results, Sizes, State, YieldPoint, number,
};
#[cfg(feature = "cli")]
use crate::space::Space;
use serde::{Deserialize, Serialize, Serializer, ser::SerializeMap};
use serde_json::{Map, Value};
use std::path::Path;

/// The content of `summary.json`. Numbers that are not finite become null.
///
/// `timings` are the phases of [`Results::timings`] (a phase that ran more than once is summed) and
/// `total`, the wall time of the run; `peak_memory_bytes` is the most memory that this process has
/// held so far, null if the system does not report it.
pub fn summary(header: &RunHeader, results: &Results) -> Value {
    // A summary consists of numbers and texts, and its keys are texts, so JSON can hold all of it.
    serde_json::to_value(Summary::new(header, results)).unwrap_or_default()
}

/// The content of `summary.json`. A key that is missing in the file of an older version has the
/// value of a run without that feature.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct Summary {
    pub brinell: Option<String>,
    pub scene: String,
    scene_file: Option<String>,
    kind: String,
    units: Option<UnitNames>,
    half_width_is: Option<ContactExtent>,
    solver: String,
    kernels: Option<String>,
    #[serde(flatten)]
    sizes: Sizes,
    effects: NamedEntries<EffectEntry>,
    timings: NamedEntries<Option<f64>>,
    peak_memory_bytes: Option<u64>,
    ranks: Option<Ranks>,
    counts: Counts,
    factor: Prediction,
    #[serde(deserialize_with = "number")]
    condition: f64,
    condition_estimate: Option<f64>,
    quality: Quality,
    inaccurate: Vec<String>,
    #[serde(rename = "yield")]
    first_yield: Option<YieldEntry>,
    states: Vec<StateEntry>,
    cycles: Option<Cycles>,
    reference: Vec<ReferenceRow>,
    accuracy: Option<Accuracy>,
    warnings: Vec<String>,
    resumed: usize,
    incomplete: Option<String>,
}

#[derive(Debug, Serialize, Deserialize)]
struct EffectEntry {
    on: bool,
    why: String,
    #[serde(deserialize_with = "number")]
    seconds: f64,
    memory_bytes: u64,
}

#[derive(Debug, Serialize, Deserialize)]
struct YieldEntry {
    #[serde(flatten)]
    figures: Map<String, Value>,
    location: Location,
}

#[derive(Debug, Default, Serialize, Deserialize)]
struct Location {
    #[serde(deserialize_with = "number")]
    x: f64,
    #[serde(deserialize_with = "number")]
    y: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    z: Option<f64>,
    body: String,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct StateEntry {
    name: String,
    contact_arc: Option<Arc>,
    residual_depth_by_body: NamedEntries<Option<f64>>,
    plastic_points_by_body: NamedEntries<usize>,
    quality: Quality,
    fields: Option<String>,
    /// Contact patches, of solids.
    patches: Option<Vec<ContactPatch>>,
    /// The quantities of the table [`QUANTITIES`], by key.
    #[serde(flatten)]
    figures: Map<String, Value>,
}

#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
struct Arc {
    #[serde(deserialize_with = "number")]
    from: f64,
    #[serde(deserialize_with = "number")]
    to: f64,
}

impl Serialize for StateEntry {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let mut map = to.serialize_map(None)?;
        map.serialize_entry("name", &self.name)?;
        for (key, figure) in &self.figures {
            map.serialize_entry(key, figure)?;
            // Entries that belong to a quantity follow it.
            match key.as_str() {
                "half_width" => map.serialize_entry("contact_arc", &self.contact_arc)?,
                "residual_depth" => {
                    map.serialize_entry("residual_depth_by_body", &self.residual_depth_by_body)?;
                }
                "plastic_points" => {
                    map.serialize_entry("plastic_points_by_body", &self.plastic_points_by_body)?;
                }
                _ => {}
            }
        }
        map.serialize_entry("quality", &self.quality)?;
        map.serialize_entry("fields", &self.fields)?;
        if let Some(patches) = &self.patches {
            map.serialize_entry("patches", patches)?;
        }
        map.end()
    }
}

/// Returns the quantities of the table [`QUANTITIES`] that a record has.
fn figures<R>(record: &R, field: impl Fn(&Quantity) -> Option<Field<R>>) -> Map<String, Value> {
    let entry = |quantity: &Quantity| {
        let value = (field(quantity)?.get)(record);
        let figure = match quantity.is_count {
            true => Value::from(value as u64),
            false => value.into(),
        };
        Some((quantity.key.to_string(), figure))
    };
    QUANTITIES.iter().filter_map(entry).collect()
}

/// Reads the quantities of a record back into it.
fn read_figures<R>(
    figures: &Map<String, Value>,
    record: &mut R,
    field: impl Fn(&Quantity) -> Option<Field<R>>,
) {
    for quantity in &QUANTITIES {
        if let (Some(field), Some(figure)) = (field(quantity), figures.get(quantity.key)) {
            (field.set)(record, figure.as_f64().unwrap_or(f64::NAN));
        }
    }
}

impl Summary {
    fn new(header: &RunHeader, results: &Results) -> Self {
        let states = results.states.iter().enumerate();
        let entry = |(index, state): (usize, &State)| {
            let file = || fields::file_name(index, results);
            StateEntry {
                fields: state.fields.as_ref().map(|_| file()),
                ..StateEntry::new(header, state)
            }
        };
        Summary {
            brinell: Some(env!("CARGO_PKG_VERSION").to_string()),
            scene: scene(header),
            scene_file: header.scene_file.clone(),
            kind: header.kind.clone(),
            units: header.labels.units(),
            half_width_is: Some(header.labels.extent()),
            solver: header.solver.clone(),
            kernels: header.kernels.clone(),
            sizes: results.sizes,
            effects: results.effects.iter().map(EffectEntry::new).collect(),
            timings: timings(&results.timings, header.wall_seconds),
            peak_memory_bytes: memory::peak(),
            ranks: results.ranks.clone(),
            counts: results.counts,
            factor: results.factor.clone(),
            condition: results.condition,
            condition_estimate: results.condition_estimate,
            quality: results.quality,
            inaccurate: results.inaccurate.clone(),
            first_yield: (results.first_yield.as_ref()).map(|point| YieldEntry::new(header, point)),
            states: states.map(entry).collect(),
            cycles: results.cycles.clone(),
            reference: results.reference.clone(),
            accuracy: results.accuracy.clone(),
            warnings: results.warnings.clone(),
            resumed: results.resumed,
            incomplete: (results.incomplete.as_ref()).map(|incomplete| incomplete.why.clone()),
        }
    }

    /// Returns the facts about the run that the output states in addition to its results, without
    /// the title of the scene.
    pub(super) fn header(&self, bodies: &[String]) -> RunHeader {
        let total = self.timings.get("total").copied().flatten();
        RunHeader {
            scene_title: String::new(),
            scene_file: self.scene_file.clone(),
            kind: self.kind.clone(),
            solver: self.solver.clone(),
            kernels: self.kernels.clone(),
            wall_seconds: total.unwrap_or(f64::NAN),
            bodies: bodies.to_vec(),
            labels: self.labels(),
        }
    }

    /// Returns the names and units of the numbers.
    pub(crate) fn labels(&self) -> Labels {
        Labels::recorded(&self.kind, self.units.clone(), self.half_width_is)
    }

    /// Returns the idealisation; an unknown one is taken for plane strain.
    #[cfg(feature = "cli")]
    pub(crate) fn space(&self) -> Space {
        let named = Space::ALL.into_iter().find(|s| s.name() == self.kind);
        named.unwrap_or(Space::PlaneStrain)
    }

    /// The names of the files with the fields of the states.
    pub(super) fn field_files(&self) -> Vec<Option<String>> {
        self.states.iter().map(|s| s.fields.clone()).collect()
    }

    /// Returns the results without the history, the pairs and the fields. The kind of an early end
    /// is not recorded.
    pub(crate) fn results(self, bodies: &[String]) -> Results {
        let phases = self.timings.0.into_iter();
        let phases = phases.filter(|(phase, _)| phase != "total");
        Results {
            sizes: self.sizes,
            effects: (self.effects.0.into_iter())
                .map(|(name, effect)| effect.effect(name))
                .collect(),
            first_yield: self.first_yield.map(|entry| entry.point(bodies)),
            states: self.states.into_iter().map(StateEntry::state).collect(),
            cycles: self.cycles,
            timings: phases
                .map(|(phase, seconds)| (phase, seconds.unwrap_or(f64::NAN)))
                .collect(),
            counts: self.counts,
            quality: self.quality,
            condition: self.condition,
            condition_estimate: self.condition_estimate,
            inaccurate: self.inaccurate,
            factor: self.factor,
            reference: self.reference,
            accuracy: self.accuracy,
            warnings: self.warnings,
            resumed: self.resumed,
            ranks: self.ranks,
            incomplete: self.incomplete.map(|why| Incomplete {
                kind: ErrorKind::Analysis,
                why,
            }),
            ..Results::default()
        }
    }
}

/// Returns the name of the scene for readers: its title, or the name of its file.
fn scene(header: &RunHeader) -> String {
    if !header.scene_title.is_empty() {
        return header.scene_title.clone();
    }
    let file = header.scene_file.as_deref().map(Path::new);
    let name = file
        .and_then(Path::file_name)
        .map(|name| name.to_string_lossy());
    name.map_or_else(|| "untitled".to_string(), |name| name.into_owned())
}

fn timings(phases: &[(String, f64)], total: f64) -> NamedEntries<Option<f64>> {
    let mut seconds: Vec<(&str, f64)> = Vec::new();
    for (phase, time) in phases.iter().filter(|(phase, _)| phase != "total") {
        match seconds.iter_mut().find(|(name, _)| name == phase) {
            Some((_, sum)) => *sum += time,
            None => seconds.push((phase, *time)),
        }
    }
    seconds.push(("total", total));
    let by_phase = seconds.into_iter();
    by_phase.map(|(k, v)| (k.to_owned(), Some(v))).collect()
}

impl EffectEntry {
    fn new(effect: &Effect) -> (String, Self) {
        let entry = EffectEntry {
            on: effect.on,
            why: effect.why.clone(),
            seconds: effect.seconds,
            memory_bytes: effect.memory_bytes,
        };
        (effect.name.clone(), entry)
    }

    fn effect(self, name: String) -> Effect {
        Effect {
            asked: self.on,
            name,
            on: self.on,
            why: self.why,
            seconds: self.seconds,
            memory_bytes: self.memory_bytes,
        }
    }
}

impl YieldEntry {
    fn new(header: &RunHeader, point: &YieldPoint) -> Self {
        let [x, y, z] = point.location;
        YieldEntry {
            figures: figures(point, |quantity| quantity.at_yield),
            location: Location {
                x,
                y,
                z: (header.dimension() == 3).then_some(z),
                body: header.body(point.body),
            },
        }
    }

    fn point(self, bodies: &[String]) -> YieldPoint {
        let Location { x, y, z, body } = self.location;
        let mut point = YieldPoint {
            location: [x, y, z.unwrap_or(0.0)],
            body: bodies.iter().position(|name| *name == body).unwrap_or(0),
            ..YieldPoint::default()
        };
        read_figures(&self.figures, &mut point, |quantity| quantity.at_yield);
        point
    }
}

impl StateEntry {
    fn new(header: &RunHeader, state: &State) -> Self {
        let depths = state.residual_depth_by_body.iter().copied();
        let points = state.plastic_points_by_body.iter().copied();
        StateEntry {
            name: state.name.clone(),
            contact_arc: state.contact_arc.map(|[from, to]| Arc { from, to }),
            residual_depth_by_body: by_body(header, depths.map(Some)),
            plastic_points_by_body: by_body(header, points),
            quality: state.quality,
            fields: None,
            patches: (header.dimension() == 3).then(|| state.patches.clone()),
            figures: figures(state, |quantity| Some(quantity.in_state)),
        }
    }

    fn state(self) -> State {
        let depths = self.residual_depth_by_body.0.into_iter();
        let points = self.plastic_points_by_body.0.into_iter();
        let mut state = State {
            name: self.name,
            contact_arc: self.contact_arc.map(|Arc { from, to }| [from, to]),
            residual_depth_by_body: depths.map(|(_, depth)| depth.unwrap_or(f64::NAN)).collect(),
            plastic_points_by_body: points.map(|(_, points)| points).collect(),
            patches: self.patches.unwrap_or_default(),
            quality: self.quality,
            ..State::default()
        };
        read_figures(&self.figures, &mut state, |quantity| {
            Some(quantity.in_state)
        });
        state
    }
}

/// Returns a figure of each body, by the name of the body.
fn by_body<T>(header: &RunHeader, figures: impl Iterator<Item = T>) -> NamedEntries<T> {
    let named = figures.enumerate();
    named.map(|(i, figure)| (header.body(i), figure)).collect()
}
