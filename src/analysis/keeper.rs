//! Checkpoints of a run: when they are written, and what is in them.
//!
//! Writing one changes nothing in the run, so that results do not depend on whether and how often
//! that is done.

use super::aim::Aim;
use super::between::Between;
use super::drive::IncrementReport;
use super::engine::Engine;
use super::packed::Ascending;
use super::place::{DrivePlace, Leg, Place, Watcher};
use super::program::Run;
use super::record::{EngineRecord, SavedRecord};
use super::saved::Saved;
use super::standing::Standing;
use super::zone_choice::PREDICTED;
use super::zone_fit::Spread;
use crate::checkpoint::{PartId, Store};
use crate::error::Result;
use crate::progress::{Flow, Observer};
use crate::results::{HistoryRow, PathPoint, Results, YieldPoint};
use serde::{Deserialize, Serialize};
use std::cell::{Cell, RefCell};
use std::sync::Arc;
use std::time::Instant;

/// Where the way to a target begins.
pub(super) struct Start {
    pub(super) saved: Saved,
    pub(super) plastic: bool,
    pub(super) yield_alpha: Option<f64>,
    pub(super) first_yield: Option<YieldPoint>,
    /// Increments behind.
    pub(super) increments: usize,
}

#[derive(Serialize, Deserialize)]
pub(super) struct StartRecord {
    pub(super) saved: SavedRecord,
    pub(super) plastic: bool,
    pub(super) yield_alpha: Option<f64>,
    pub(super) first_yield: Option<YieldPoint>,
    pub(super) increments: usize,
}

/// The elastic stress that the zone follows the load by: of the elements that it can matter for.
#[derive(Serialize, Deserialize)]
pub(super) struct SpreadRecord {
    pub(super) elements: Ascending,
    pub(super) ratios: Vec<f64>,
}

/// A run between two increments.
#[derive(Serialize, Deserialize)]
pub(super) struct RunRecord {
    pub(super) place: Place,
    pub(super) engine: EngineRecord,
    /// The part with the elastic stress, the largest load factor and the one up to which the zone
    /// was chosen.
    pub(super) spread: Option<(PartId, f64, f64)>,
    pub(super) standing: Standing,
    pub(super) first_yield: Option<YieldPoint>,
    pub(super) resumed: usize,
    /// States and the rows up to the last of them.
    pub(super) states: Vec<PartId>,
    /// The rows since.
    pub(super) history: Vec<HistoryRow>,
    /// The points between them, and the last row.
    pub(super) path: Vec<PathPoint>,
    pub(super) between: Between,
    /// Where the way to the target at hand began, and whether the zone was the one at hand.
    pub(super) start: Option<(PartId, bool)>,
}

/// What a checkpoint holds beside engine, results and place.
#[derive(Clone, Copy)]
pub(super) struct Kept<'r> {
    pub(super) standing: Standing,
    pub(super) guard: &'r [bool],
    pub(super) spread: Option<&'r Spread>,
    pub(super) start: Option<&'r Start>,
}

/// Writes checkpoints.
pub(super) struct Keeper {
    store: Store,
    every: usize,
    /// Increments since the last one.
    since: usize,
    /// The user has asked the run to stop: one more is due.
    stopping: bool,
    /// Parts with the states that have been written, and how many states and rows that are.
    pub(super) states: Vec<PartId>,
    pub(super) n_states: usize,
    pub(super) n_rows: usize,
    /// Rows up to the last state.
    pub(super) rows_of_states: usize,
    pub(super) spread: Option<PartId>,
    pub(super) start: Option<PartId>,
    /// Fingerprint of the factor, and after how many factorisations.
    fingerprint: Option<(usize, u128)>,
    failed: bool,
}

impl Keeper {
    pub(super) fn new(store: Store, every: usize) -> Self {
        Keeper {
            store,
            every,
            since: 0,
            stopping: false,
            states: Vec::new(),
            n_states: 0,
            n_rows: 0,
            rows_of_states: 0,
            spread: None,
            start: None,
            fingerprint: None,
            failed: false,
        }
    }

    fn is_due(&self) -> bool {
        self.since >= self.every || (self.stopping && self.since > 0)
    }

    fn write(
        &mut self,
        engine: &Engine,
        results: &Results,
        kept: Kept,
        place: Place,
        between: &Between,
    ) -> Result<()> {
        let path_of = |rows: std::ops::Range<usize>| -> Vec<PathPoint> {
            let points = results.path.iter();
            let points = points.filter(|point| rows.contains(&(point.increment - 1)));
            points.copied().collect()
        };
        if results.states.len() > self.n_states {
            let rows = self.n_rows..self.rows_of_states;
            let part = (
                &results.states[self.n_states..],
                &results.history[rows.clone()],
                path_of(rows),
            );
            self.states.push(self.store.add(&part)?);
            self.n_states = results.states.len();
            self.n_rows = self.rows_of_states;
        }
        let spread = match (kept.spread, self.spread) {
            (Some(spread), None) => {
                let hot = |e: &usize| spread.ratios[*e] >= PREDICTED;
                let elements: Vec<usize> = (0..spread.ratios.len()).filter(hot).collect();
                let part = self.store.add(&SpreadRecord {
                    ratios: elements.iter().map(|&e| spread.ratios[e]).collect(),
                    elements: Ascending::new(elements),
                })?;
                self.spread = Some(part);
                Some((part, spread.highest, spread.until))
            }
            (Some(spread), Some(part)) => Some((part, spread.highest, spread.until)),
            (None, _) => None,
        };
        let start = match (kept.start, self.start) {
            (Some(start), None) => Some((start, self.store.add(&start.record())?)),
            (Some(start), Some(part)) => Some((start, part)),
            (None, _) => None,
        };
        self.start = start.map(|(_, part)| part);
        let fingerprint = match self.fingerprint {
            Some((factorizations, hash)) if factorizations == engine.counts.factorizations => hash,
            _ => engine.fingerprint(),
        };
        self.fingerprint = Some((engine.counts.factorizations, fingerprint));
        let record = RunRecord {
            place,
            engine: engine.record(kept.guard, fingerprint),
            spread,
            standing: kept.standing,
            first_yield: results.first_yield,
            resumed: results.resumed,
            states: self.states.clone(),
            history: results.history[self.n_rows..].to_vec(),
            path: path_of(self.n_rows..results.history.len()),
            between: between.clone(),
            start: start.map(|(start, part)| (part, start.saved.is_of_zone(engine))),
        };
        let mut in_use = self.states.clone();
        in_use.extend(self.spread);
        in_use.extend(self.start);
        self.store.write(&record, &in_use)?;
        self.since = 0;
        Ok(())
    }
}

impl Start {
    fn record(&self) -> StartRecord {
        StartRecord {
            saved: self.saved.record(),
            plastic: self.plastic,
            yield_alpha: self.yield_alpha,
            first_yield: self.first_yield,
            increments: self.increments,
        }
    }
}

/// How much of the load program lies behind.
pub(super) struct Behind<'r> {
    /// As it was reported last: it never falls.
    pub(super) fraction: &'r mut f64,
    pub(super) aim: Aim,
    /// The monitored quantity.
    pub(super) monitored: &'r Cell<f64>,
    pub(super) done: f64,
    pub(super) n_targets: f64,
}

impl Behind<'_> {
    fn fraction(&mut self, alpha: f64) -> f64 {
        let share = self.aim.share(alpha, self.monitored.get());
        *self.fraction = self.fraction.max((self.done + share) / self.n_targets);
        *self.fraction
    }
}

/// Makes a row of each increment, and a checkpoint where one is due.
pub(super) struct Recorder<'r, 'o> {
    pub(super) results: &'r mut Results,
    pub(super) observer: &'r RefCell<&'r mut (dyn Observer + 'o)>,
    pub(super) progress: Behind<'r>,
    pub(super) between: &'r mut Between,
    pub(super) keeper: Option<&'r mut Keeper>,
    pub(super) kept: Kept<'r>,
    pub(super) place: &'r Place,
    pub(super) watch_yield: bool,
    pub(super) taken: &'r Cell<usize>,
    /// When the drive began.
    pub(super) since: Instant,
}

impl Watcher for Recorder<'_, '_> {
    fn increment(&mut self, engine: &mut Engine, report: &IncrementReport) -> Result<bool> {
        let row = row(engine, report, self.results.history.len() + 1);
        let mut observer = self.observer.borrow_mut();
        let flow = observer.increment(&row, self.progress.fraction(row.alpha));
        // Rows may have been taken back since.
        let (path, rows) = (&mut self.results.path, self.results.history.len());
        while path.last().is_some_and(|point| point.increment > rows) {
            path.pop();
        }
        path.extend(self.between.advance(engine, &row));
        self.results.history.push(row);
        let goes_on = flow == Flow::Continue && !observer.stop_requested();
        if let Some(keeper) = &mut self.keeper {
            keeper.since += 1;
            keeper.stopping = !goes_on;
        }
        Ok(goes_on)
    }

    fn resumable(&mut self, engine: &Engine, leg: &dyn Fn() -> Leg) -> Result<()> {
        let Some(keeper) = self.keeper.as_mut().filter(|keeper| keeper.is_due()) else {
            return Ok(());
        };
        let place = Place {
            drive: Some(DrivePlace {
                watch_yield: self.watch_yield,
                taken: self.taken.get(),
                leg: leg(),
            }),
            ..self.place.clone()
        };
        let drive = place.drive.as_ref();
        let plastic = drive.is_some_and(|drive| matches!(drive.leg, Leg::Plastic(_)));
        let mut kept = self.kept;
        let spent = self.since.elapsed().as_secs_f64();
        kept.standing.seconds.add_drive(plastic, spent);
        let outcome = keeper.write(engine, self.results, kept, place, self.between);
        note_failure(
            keeper,
            outcome,
            &mut **self.observer.borrow_mut(),
            self.results,
        );
        Ok(())
    }
}

/// A run does not end because a checkpoint cannot be written: its results are worth more. It says
/// so, once.
fn note_failure(
    keeper: &mut Keeper,
    outcome: Result<()>,
    observer: &mut dyn Observer,
    results: &mut Results,
) {
    match outcome {
        Ok(()) => keeper.failed = false,
        Err(error) if !keeper.failed => {
            keeper.failed = true;
            let text = format!("no checkpoint: {}; the run goes on", error.in_full());
            observer.warning(&text);
            results.warnings.push(text);
        }
        Err(_) => {}
    }
}

impl Run<'_, '_> {
    /// This run, writing a checkpoint at every `every`-th increment.
    pub(super) fn keeping(self, store: Store, every: usize) -> Self {
        Run {
            keeper: Some(Keeper::new(store, every)),
            ..self
        }
    }

    /// Takes note of where the way to a target begins.
    pub(super) fn set_start(&mut self) {
        self.start = Some(Start {
            saved: Saved::of(&self.engine),
            plastic: self.standing.plastic,
            yield_alpha: self.standing.yield_alpha,
            first_yield: self.results.first_yield,
            increments: self.results.history.len(),
        });
        if let Some(keeper) = &mut self.keeper {
            keeper.start = None;
        }
    }

    /// A target was reached: its state is kept, at once where a checkpoint is due.
    pub(super) fn keep_target(&mut self) {
        let Some(keeper) = &mut self.keeper else {
            return;
        };
        keeper.rows_of_states = self.results.history.len();
        if !keeper.is_due() {
            return;
        }
        let kept = Kept {
            standing: self.standing,
            guard: &self.choice.guard,
            spread: self.spread.as_ref(),
            start: None,
        };
        let place = Place::default();
        let outcome = keeper.write(&self.engine, &self.results, kept, place, &self.between);
        note_failure(keeper, outcome, &mut *self.observer, &mut self.results);
    }
}

impl Saved {
    /// Whether the zone was the one that the engine has.
    fn is_of_zone(&self, engine: &Engine) -> bool {
        Arc::ptr_eq(&self.elements, &engine.elements)
    }
}

/// The row of an accepted increment.
fn row(engine: &Engine, report: &IncrementReport, increment: usize) -> HistoryRow {
    let figures = engine.contact_figures();
    let (plastic_points, strain) = engine.zone.extent();
    HistoryRow {
        increment,
        alpha: engine.at.alpha,
        load: engine.total_load_size(),
        max_pressure: figures.max_pressure,
        half_width: figures.half_width,
        contact_force: figures.force * engine.model.symmetry,
        closed_pairs: engine.closed_pairs(),
        plastic_points,
        max_equivalent_plastic_strain: strain,
        iterations: report.iterations,
        trailing_solves: report.trailing_solves,
        residual: report.residual,
        event: report.event.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::Analysis;
    use crate::linalg::Backend;
    use crate::model::Model;
    use crate::progress::Silent;
    use crate::scene::Scene;

    /// Where the way to a target starts goes through a checkpoint with all that a retry with a
    /// wider zone puts back.
    #[test]
    fn the_start_of_a_way_keeps_the_first_yield_that_was_known() {
        let path = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/data/scenes/hard/unload_reload.toml"
        );
        let model = Model::new(&Scene::load(path).unwrap()).unwrap();
        let analysis = Analysis::new(model, Backend::Dense).unwrap();
        let (model, system) = (analysis.model(), analysis.system());
        let mut observer = Silent;
        let mut run = Run::new(model, system, Backend::Dense, &[], &mut observer).unwrap();
        run.execute(false).unwrap();
        let first = run.results.first_yield;
        assert!(first.is_some() && run.standing.yield_alpha.is_some());
        run.set_start();
        let record = run.start.as_ref().unwrap().record();
        let bytes = postcard::to_stdvec(&record).unwrap();
        let record: StartRecord = postcard::from_bytes(&bytes).unwrap();
        assert_eq!(record.first_yield, first);
        assert_eq!(record.yield_alpha, run.standing.yield_alpha);
        assert_eq!(record.increments, run.results.history.len());
        assert!(record.plastic);
        let saved = Saved::recall(&record.saved, &run.engine, true).unwrap();
        assert_eq!(saved.at, run.engine.at);
        assert_eq!(saved.history, run.engine.zone.history());
    }
}
