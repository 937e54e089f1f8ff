//! Histories of the values of degrees of freedom, nodes and faces over all steps.
//!
//! A value given in a step is reached linearly from the one before over the time of the step, or
//! follows an amplitude. Where an amplitude jumps at the start of a step, the first increment goes
//! linearly to the value at its end, as in CalculiX. A value not given in a step stays, or goes
//! back to zero with `OP=NEW`. Several values for the same node or face in one step are added, but
//! values of supports replace each other. A displacement that is first given in a later step is
//! reached from where the node then is, and `OP=NEW` releases it: such a history has a span of
//! steps.

use super::Deck;
use super::bodies::unsupported;
use super::data::{Amplitude, Condition, ConditionKind, DeckStep, EntitySelection};
use super::facets::Face;
use super::series::Series;
use super::sets::What;
use super::source::LinePlace;
use crate::error::Result;
use crate::interpolation::interpolate;
use crate::scene::span::Span;
use std::collections::BTreeMap;

/// Relative difference, between the end of a step and the beginning of the next, above which a
/// value counts as jumping.
const JUMP: f64 = 1e-9;

/// A node and its degree of freedom counted from 0, or an element and its local facet.
pub(super) type Key = Face;

/// The history of one key.
#[derive(Debug, Clone)]
pub(super) struct KeyHistory {
    pub(super) series: Series,
    /// The line that gave the value last.
    pub(super) place: LinePlace,
    /// The steps over which a displacement is given.
    pub(super) span: Span,
    /// Whether the displacement stays where the node was at the beginning of the span.
    pub(super) stays: bool,
    /// Values with amplitudes over total time, which continue in later steps.
    runs_on: Vec<(f64, String)>,
}

impl KeyHistory {
    /// A history that follows from other values because of a line of the deck.
    pub(super) fn new(series: Series, place: LinePlace) -> Self {
        KeyHistory {
            series,
            place,
            span: Span::WHOLE,
            stays: false,
            runs_on: Vec::new(),
        }
    }
}

/// Displacements that are given, as histories by key.
pub(super) struct GivenDisplacements {
    /// Displacements given in all steps.
    pub(super) whole: Map,
    /// Displacements given from a later step on, or no longer given in one.
    pub(super) in_steps: Vec<(Key, KeyHistory)>,
}

/// Histories by key.
pub(super) type Map = BTreeMap<Key, KeyHistory>;

/// The time interval of a step.
struct Interval {
    start: f64,
    end: f64,
    /// End of the step's first increment.
    first: f64,
}

/// The values that a step gives for a key, with their amplitudes.
struct StepGiven<'d> {
    values: Vec<(f64, Option<&'d str>)>,
    /// Whether the value with which the step before ended stays.
    is_fixed: bool,
    place: LinePlace,
}

impl ConditionKind {
    fn keyword(self) -> &'static str {
        match self {
            ConditionKind::Boundary => "BOUNDARY",
            ConditionKind::Force => "CLOAD",
            ConditionKind::Pressure | ConditionKind::Volume => "DLOAD",
            ConditionKind::Temperature => "TEMPERATURE",
        }
    }
}

impl Deck {
    /// Times at which the steps end.
    pub(super) fn step_ends(&self) -> Vec<f64> {
        let mut time = 0.0;
        let steps = self.program.steps.iter();
        steps
            .map(|step| {
                time += step.period;
                time
            })
            .collect()
    }

    /// The histories of all given displacements.
    ///
    /// # Errors
    /// `Input` for undefined names and numbers, and for values that are too large.
    pub(super) fn displacements(&self) -> Result<GivenDisplacements> {
        let mut ended = Vec::new();
        let all = self.histories_of(ConditionKind::Boundary, &mut ended)?;
        let (whole, begun): (Map, Map) =
            (all.into_iter()).partition(|(_, entry)| entry.span.is_whole());
        ended.extend(begun);
        ended.sort_by_key(|(key, _)| *key);
        Ok(GivenDisplacements {
            whole,
            in_steps: ended,
        })
    }

    /// The histories of all keys of a kind of load.
    ///
    /// # Errors
    /// As for [`Deck::displacements`].
    pub(super) fn histories(&self, kind: ConditionKind) -> Result<Map> {
        self.histories_of(kind, &mut Vec::new())
    }

    /// The histories of all keys of one kind. Those of displacements that are released are added to
    /// `ended`.
    fn histories_of(&self, kind: ConditionKind, ended: &mut Vec<(Key, KeyHistory)>) -> Result<Map> {
        let mut map = Map::new();
        let initial = self.program.initial.iter();
        for condition in initial.filter(|condition| condition.kind == kind) {
            for key in self.keys(condition)? {
                let entry = KeyHistory::new(Series::starting(condition.value), condition.place);
                map.insert(key, entry);
            }
        }
        let mut start = 0.0;
        for (number, step) in self.program.steps.iter().enumerate() {
            let time = Interval {
                start,
                end: start + step.period,
                first: start + step.period / step.increments.max(1) as f64,
            };
            self.go_through(kind, (number, step), &time, &mut map, ended)?;
            start = time.end;
        }
        let all = || map.values().chain(ended.iter().map(|(_, entry)| entry));
        if let Some(entry) = all().find(|entry| !entry.series.is_finite()) {
            let message = "a value is too large, or a time";
            return Err(self.error(entry.place, kind.keyword(), message));
        }
        Ok(map)
    }

    fn go_through(
        &self,
        kind: ConditionKind,
        (number, step): (usize, &DeckStep),
        time: &Interval,
        map: &mut Map,
        ended: &mut Vec<(Key, KeyHistory)>,
    ) -> Result<()> {
        let mut given = self.given(kind, step)?;
        let is_renewed = step.renewed[kind as usize];
        if kind == ConditionKind::Boundary {
            // A node that stayed where it was begins a history when it gets a value.
            let ends = |key: &Key, entry: &KeyHistory| match given.get(key) {
                Some(given) => entry.stays && !given.is_fixed,
                None => is_renewed.is_some() && number > 0,
            };
            map.retain(|key, entry| {
                let stays = !ends(key, entry);
                if !stays {
                    entry.span.until = Some([time.start, time.first]);
                    ended.push((*key, entry.clone()));
                }
                stays
            });
        }
        for (key, entry) in map.iter_mut() {
            if let Some(given) = given.remove(key) {
                self.apply(kind, number, &given, time, entry)?;
                continue;
            }
            match (is_renewed, kind) {
                (Some(_), ConditionKind::Temperature) => {
                    entry.runs_on.clear();
                    entry.series.push(time.end, entry.series.at(0.0));
                }
                (Some(_), _) => {
                    entry.runs_on.clear();
                    entry.series.push(time.end, 0.0);
                }
                (None, _) => self.run_on(entry, time)?,
            }
        }
        for (key, given) in given {
            let mut entry = KeyHistory::new(Series::starting(0.0), given.place);
            if number > 0 && kind == ConditionKind::Boundary {
                entry.series = Series::default();
                entry.span.since = Some(time.start);
                entry.stays = given.is_fixed;
            } else if number > 0 {
                entry.series.push(time.start, 0.0);
            }
            self.apply(kind, number, &given, time, &mut entry)?;
            map.insert(key, entry);
        }
        Ok(())
    }

    /// The values that a step gives, key by key.
    fn given<'d>(
        &self,
        kind: ConditionKind,
        step: &'d DeckStep,
    ) -> Result<BTreeMap<Key, StepGiven<'d>>> {
        let mut out: BTreeMap<Key, StepGiven> = BTreeMap::new();
        for condition in step.conditions.iter().filter(|c| c.kind == kind) {
            let value = (condition.value, condition.amplitude.as_deref());
            for key in self.keys(condition)? {
                let given = out.entry(key).or_insert(StepGiven {
                    values: Vec::new(),
                    is_fixed: false,
                    place: condition.place,
                });
                if matches!(kind, ConditionKind::Boundary | ConditionKind::Temperature) {
                    given.values.clear();
                }
                given.values.push(value);
                given.is_fixed = condition.is_fixed;
                given.place = condition.place;
            }
        }
        Ok(out)
    }

    /// The keys to which a condition applies. The direction out of a plane model is not among them.
    ///
    /// # Errors
    /// `Input` for undefined names and numbers.
    pub(super) fn keys(&self, condition: &Condition) -> Result<Vec<Key>> {
        let at = (condition.place, condition.kind.keyword());
        let [first, last] = condition.range;
        if condition.kind == ConditionKind::Volume {
            let bodies = self.whole_bodies(&condition.on, at)?;
            return Ok(bodies.into_iter().map(|body| (body, first as u8)).collect());
        }
        if condition.kind != ConditionKind::Pressure {
            let dimension = self.dimension();
            let nodes = self.indices(What::Nodes, &condition.on, at)?;
            let freedoms = first - 1..last.min(dimension);
            let of_node = |&node: &u32| freedoms.clone().map(move |freedom| (node, freedom as u8));
            let mut keys: Vec<Key> = nodes.iter().flat_map(of_node).collect();
            keys.extend(self.rotations_among(&nodes, [first, last])?);
            if condition.kind == ConditionKind::Force && first > 3 && keys.is_empty() {
                let message = format!(
                    "degree of freedom {first}: moments act on the reference node of a *RIGID \
                     BODY or *COUPLING alone; press with forces along 1, 2 and 3"
                );
                return Err(self.error(at.0, at.1, message));
            }
            return Ok(keys);
        }
        match &condition.on {
            EntitySelection::Set(name) if first == 0 => {
                self.surface(name, (condition.place, "DSLOAD"))
            }
            on => {
                let elements = self.indices(What::Elements, on, at)?;
                let facet = |element: u32| self.facet(element, first, at);
                elements.into_iter().map(facet).collect()
            }
        }
    }

    /// The bodies of which a set of elements consists.
    ///
    /// # Errors
    /// `Unsupported` if the set contains only a part of a body.
    fn whole_bodies(&self, on: &EntitySelection, at: (LinePlace, &str)) -> Result<Vec<u32>> {
        let bodies = self.bodies()?;
        let mut counts = vec![[0usize; 2]; bodies.names.len()];
        for &body in &bodies.of_element {
            counts[body as usize][1] += 1;
        }
        for element in self.indices(What::Elements, on, at)? {
            counts[bodies.of_element[element as usize] as usize][0] += 1;
        }
        let mut whole = Vec::new();
        for (body, [given, all]) in counts.into_iter().enumerate() {
            if given == all {
                whole.push(body as u32);
            } else if given > 0 {
                let message = format!(
                    "it acts on {given} of the {all} elements of body {}: loads on volumes are \
                     those of whole bodies; give the part a section of its own",
                    bodies.names[body]
                );
                return Err(unsupported(self.error(at.0, at.1, message)));
            }
        }
        Ok(whole)
    }

    /// Dimension of the first element, and hence of the model.
    pub(super) fn dimension(&self) -> usize {
        let first = self.elements.types.first();
        first.map_or(3, |first| first.space.dimension())
    }

    /// Continues a history to the end of a step that gives values for its key.
    fn apply(
        &self,
        kind: ConditionKind,
        number: usize,
        given: &StepGiven,
        time: &Interval,
        entry: &mut KeyHistory,
    ) -> Result<()> {
        entry.place = given.place;
        entry.runs_on.clear();
        if given.is_fixed {
            entry.series.push(time.end, entry.series.last());
            return Ok(());
        }
        if given
            .values
            .iter()
            .all(|(_, amplitude)| amplitude.is_none())
        {
            let sum = given.values.iter().map(|(value, _)| value).sum();
            entry.series.push(time.end, sum);
            return Ok(());
        }
        let keyword = kind.keyword();
        let named = given.values.iter().map(|(value, name)| {
            let Some(name) = name else {
                let message = "values with and without an amplitude meet in one step; give all one";
                return Err(self.error(given.place, keyword, message));
            };
            let amplitude = self.program.amplitudes.get(name).ok_or_else(|| {
                let message = format!("there is no *AMPLITUDE {name}");
                self.error(given.place, keyword, message)
            })?;
            let size = match amplitude.is_absolute {
                true => 1.0,
                false => *value,
            };
            if amplitude.is_total {
                entry.runs_on.push((size, name.to_string()));
            }
            Ok((size, amplitude))
        });
        let laws: Vec<(f64, &Amplitude)> = named.collect::<Result<_>>()?;
        let start = value_at(&laws, time.start, time);
        let last = entry.series.last();
        if number == 0 {
            entry.series = Series::starting(start);
        }
        let jumps = (start - last).abs() > JUMP * start.abs().max(last.abs());
        // A jump at the start of the step is taken over the first increment; a node that comes from
        // wherever it is has no value there.
        let from = match number > 0 && (jumps || !entry.series.is_begun()) {
            true => time.first,
            false => time.start,
        };
        follow(&laws, time, from, &mut entry.series);
        Ok(())
    }

    /// Continues a history through a step that does not give values for its key.
    fn run_on(&self, entry: &mut KeyHistory, time: &Interval) -> Result<()> {
        let amplitude = |name: &str| self.program.amplitudes.get(name);
        let laws = entry.runs_on.iter();
        let laws: Vec<(f64, &Amplitude)> = laws
            .filter_map(|(value, name)| Some((*value, amplitude(name)?)))
            .collect();
        match laws.is_empty() {
            true => entry.series.push(time.end, entry.series.last()),
            false => follow(&laws, time, time.start, &mut entry.series),
        }
        Ok(())
    }
}

/// The sum of the given values times their amplitudes at a time.
fn value_at(laws: &[(f64, &Amplitude)], at: f64, time: &Interval) -> f64 {
    let of_law = |(value, amplitude): &(f64, &Amplitude)| {
        let own = match amplitude.is_total {
            true => at,
            false => at - time.start,
        };
        value * interpolate(&amplitude.rows, own)
    };
    laws.iter().map(of_law).sum()
}

/// Continues a history along amplitudes to the end of a step: linearly to the value at the time
/// `from`, and from there on as they go.
fn follow(laws: &[(f64, &Amplitude)], time: &Interval, from: f64, series: &mut Series) {
    let mut times = vec![time.end];
    times.extend((time.start < from).then_some(from));
    for (_, amplitude) in laws {
        let offset = if amplitude.is_total { 0.0 } else { time.start };
        let kinks = amplitude.rows.iter().map(|row| row[0] + offset);
        times.extend(kinks.filter(|t| from < *t && *t < time.end));
    }
    times.sort_by(f64::total_cmp);
    times.dedup();
    for at in times {
        series.push(at, value_at(laws, at, time));
    }
}
