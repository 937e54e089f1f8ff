//! Histories of the values of degrees of freedom, nodes and faces over all steps.
//!
//! A value given in a step is reached linearly from the previous value over the time of the step,
//! or follows an amplitude. Where an amplitude jumps at the start of a step, the first increment
//! goes linearly to the value at the end of this increment, as in CalculiX. A value not given in a
//! step stays. With `OP=NEW`, a load that is not given goes back to zero, a temperature to its
//! initial value, and a displacement is released. Several values for the same node or face in one
//! step are added, but values of supports and temperatures replace each other. A displacement that
//! is first given in a later step starts from the position that the node then has. The history of a
//! displacement that begins in a later step or is released has a span of steps.

use super::Deck;
use super::data::{Amplitude, ConditionKind, DeckProgram, DeckStep};
use super::facets::Key;
use super::linear::FreedomCoefficients;
use super::series::Series;
use super::source::LinePlace;
use crate::error::Result;
use crate::interpolation::interpolate;
use crate::scene::span::Span;
use std::collections::BTreeMap;

/// Relative difference, between the end of a step and the beginning of the next, above which a
/// value counts as jumping.
const JUMP: f64 = 1e-9;

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

/// The sum of known displacements multiplied by coefficients.
pub(super) fn sum_of(terms: &FreedomCoefficients, known: &Map) -> Series {
    let mut sum = Series::starting(0.0);
    for (key, c) in terms {
        if let Some(entry) = known.get(key) {
            sum.add(&entry.series, *c);
        }
    }
    sum
}

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
    /// Whether the value stays as it was at the end of the step before.
    is_fixed: bool,
    place: LinePlace,
}

impl DeckProgram {
    /// Times at which the steps end.
    pub(super) fn step_ends(&self) -> Vec<f64> {
        let mut time = 0.0;
        let steps = self.steps.iter();
        steps
            .map(|step| {
                time += step.period;
                time
            })
            .collect()
    }
}

impl GivenDisplacements {
    /// The histories of all displacements that a deck gives.
    ///
    /// # Errors
    /// `Input` for undefined names and numbers, and for values that are too large.
    pub(super) fn of(deck: &Deck) -> Result<Self> {
        let mut ended = Vec::new();
        let all = histories_of(deck, ConditionKind::Boundary, &mut ended)?;
        let (whole, begun): (Map, Map) =
            (all.into_iter()).partition(|(_, entry)| entry.span.is_whole());
        ended.extend(begun);
        ended.sort_by_key(|(key, _)| *key);
        Ok(GivenDisplacements {
            whole,
            in_steps: ended,
        })
    }
}

/// The histories of all keys of a kind of load.
///
/// # Errors
/// Errors of [`GivenDisplacements::of`].
pub(super) fn histories(deck: &Deck, kind: ConditionKind) -> Result<Map> {
    histories_of(deck, kind, &mut Vec::new())
}

/// The histories of all keys of one kind. Histories of displacements that are released are added to
/// `ended`.
fn histories_of(
    deck: &Deck,
    kind: ConditionKind,
    ended: &mut Vec<(Key, KeyHistory)>,
) -> Result<Map> {
    let mut map = Map::new();
    let initial = deck.program.initial.iter();
    for condition in initial.filter(|condition| condition.kind == kind) {
        for key in condition.keys(deck)? {
            let entry = KeyHistory::new(Series::starting(condition.value), condition.place);
            map.insert(key, entry);
        }
    }
    let mut start = 0.0;
    for (number, step) in deck.program.steps.iter().enumerate() {
        let end = start + step.period;
        let first = start + step.period / step.increments.max(1) as f64;
        let step = HistoryStep {
            deck,
            kind,
            number,
            step,
            time: Interval { start, end, first },
        };
        step.go_through(&mut map, ended)?;
        start = end;
    }
    let all = || map.values().chain(ended.iter().map(|(_, entry)| entry));
    if let Some(entry) = all().find(|entry| !entry.series.is_finite()) {
        let message = "a value is too large, or a time";
        return Err(deck.error(entry.place, kind.keyword(), message));
    }
    Ok(map)
}

/// A step through which the histories of one kind are continued.
struct HistoryStep<'d> {
    deck: &'d Deck,
    kind: ConditionKind,
    number: usize,
    step: &'d DeckStep,
    time: Interval,
}

impl<'d> HistoryStep<'d> {
    fn go_through(&self, map: &mut Map, ended: &mut Vec<(Key, KeyHistory)>) -> Result<()> {
        let (kind, number, time) = (self.kind, self.number, &self.time);
        let mut given = self.given()?;
        let is_renewed = self.step.renewed[kind as usize];
        if kind == ConditionKind::Boundary {
            // A node that kept its position begins a new history when it gets a value.
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
                self.apply(&given, entry)?;
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
                (None, _) => self.run_on(entry),
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
            self.apply(&given, &mut entry)?;
            map.insert(key, entry);
        }
        Ok(())
    }

    /// The values that a step gives, key by key.
    fn given(&self) -> Result<BTreeMap<Key, StepGiven<'d>>> {
        let mut out: BTreeMap<Key, StepGiven> = BTreeMap::new();
        for condition in self.step.conditions.iter().filter(|c| c.kind == self.kind) {
            let value = (condition.value, condition.amplitude.as_deref());
            for key in condition.keys(self.deck)? {
                let given = out.entry(key).or_insert(StepGiven {
                    values: Vec::new(),
                    is_fixed: false,
                    place: condition.place,
                });
                if matches!(
                    self.kind,
                    ConditionKind::Boundary | ConditionKind::Temperature
                ) {
                    given.values.clear();
                }
                given.values.push(value);
                given.is_fixed = condition.is_fixed;
                given.place = condition.place;
            }
        }
        Ok(out)
    }

    /// Continues a history to the end of a step that gives values for its key.
    fn apply(&self, given: &StepGiven, entry: &mut KeyHistory) -> Result<()> {
        let (deck, time) = (self.deck, &self.time);
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
        let keyword = self.kind.keyword();
        let named = given.values.iter().map(|(value, name)| {
            let Some(name) = name else {
                let message = "some values of this step have an amplitude and others none: give \
                               all of them one";
                return Err(deck.error(given.place, keyword, message));
            };
            let amplitude = deck.program.amplitudes.get(name).ok_or_else(|| {
                let message = format!("there is no *AMPLITUDE {name}");
                deck.error(given.place, keyword, message)
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
        if self.number == 0 {
            entry.series = Series::starting(start);
        }
        let jumps = (start - last).abs() > JUMP * start.abs().max(last.abs());
        // A jump at the start of the step is taken over the first increment; a node that starts
        // from its current place has no value at the start.
        let from = match self.number > 0 && (jumps || !entry.series.is_begun()) {
            true => time.first,
            false => time.start,
        };
        follow(&laws, time, from, &mut entry.series);
        Ok(())
    }

    /// Continues a history through a step that does not give values for its key.
    fn run_on(&self, entry: &mut KeyHistory) {
        let time = &self.time;
        let amplitude = |name: &str| self.deck.program.amplitudes.get(name);
        let laws = entry.runs_on.iter();
        let laws: Vec<(f64, &Amplitude)> = laws
            .filter_map(|(value, name)| Some((*value, amplitude(name)?)))
            .collect();
        match laws.is_empty() {
            true => entry.series.push(time.end, entry.series.last()),
            false => follow(&laws, time, time.start, &mut entry.series),
        }
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
/// `from`, and then along the amplitudes themselves.
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
