//! Checkpoints of a run, and going on from them.
//!
//! A checkpoint is the position in the program with the state of the structure. What follows from
//! the model (the factor, the condensed loads and matrices, the places of freedoms) is computed
//! again: the same operations on the same numbers. Writing one changes nothing in the run, so that
//! results do not depend on whether and how often that is done.

use super::Analysis;
use super::path::PathSampler;
use super::position::{Position, Stage};
use super::program::Run;
use super::solver::{Solver, SolverRecord};
use super::targets::Start;
use super::zone_choice::Choice;
use super::zone_fit::{Expected, ZoneFit};
use crate::checkpoint::{PartId, Store};
use crate::error::{Error, Result};
use crate::progress::Observer;
use crate::results::{HistoryRow, PathPoint, Results, State};
use serde::{Deserialize, Serialize};
use std::time::Instant;

/// A run between two steps.
#[derive(Serialize, Deserialize)]
struct RunRecord {
    position: Position,
    solver: SolverRecord,
    parts: Parts,
    /// Rows and points of the path since the last state.
    history: Vec<HistoryRow>,
    path: Vec<PathPoint>,
    sampler: PathSampler,
    resumed: usize,
}

/// What does not change any more, in files of its own.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
struct Parts {
    /// States that were reached, with the rows and points of the path up to the last of them.
    states: Vec<PartId>,
    /// How many states and rows that are.
    n_states: usize,
    n_rows: usize,
    /// What the zone follows the load by.
    spread: Option<PartId>,
    /// Where the way to the target at hand starts.
    start: Option<PartId>,
}

impl Parts {
    fn all(&self) -> Vec<PartId> {
        let states = self.states.iter().copied();
        states.chain(self.spread).chain(self.start).collect()
    }
}

/// Writes the checkpoints of a run.
pub(super) struct CheckpointWriter {
    store: Store,
    /// Increments from one checkpoint to the next, and since the last.
    every: usize,
    since: usize,
    parts: Parts,
    /// Fingerprint of the factor, and after how many factorisations.
    fingerprint: Option<(usize, u128)>,
    failed: bool,
}

impl CheckpointWriter {
    pub(super) fn new(store: Store, every: usize) -> Self {
        CheckpointWriter {
            store,
            every,
            since: 0,
            parts: Parts::default(),
            fingerprint: None,
            failed: false,
        }
    }

    /// The way to the next target starts elsewhere.
    pub(super) fn forget_start(&mut self) {
        self.parts.start = None;
    }

    fn write(
        &mut self,
        solver: &Solver,
        zone: &ZoneFit,
        position: &Position,
        start: Option<&Start>,
        (results, sampler): (&Results, &PathSampler),
    ) -> Result<()> {
        let path_from = |first: usize, end: usize| -> Vec<PathPoint> {
            let points = results.path.iter().copied();
            let within = |point: &PathPoint| (first + 1..=end).contains(&point.increment);
            points.filter(within).collect()
        };
        let parts = &mut self.parts;
        let n_rows = results.history.len();
        if results.states.len() > parts.n_states {
            // Rows of the way at hand may be taken back.
            let end = start.map_or(n_rows, |start| start.rows);
            let states = &results.states[parts.n_states..];
            let rows = &results.history[parts.n_rows..end];
            let path = path_from(parts.n_rows, end);
            parts.states.push(self.store.add(&(states, rows, path))?);
            (parts.n_states, parts.n_rows) = (results.states.len(), end);
        }
        if let (Some(spread), None) = (&zone.spread, parts.spread) {
            parts.spread = Some(self.store.add(spread)?);
        }
        match (start, parts.start) {
            (Some(start), None) => parts.start = Some(self.store.add(start)?),
            (None, Some(_)) => parts.start = None,
            _ => {}
        }
        let factorizations = solver.cost.counts.factorizations;
        let fingerprint = match self.fingerprint {
            Some((known, fingerprint)) if known == factorizations => fingerprint,
            _ => solver.fingerprint(),
        };
        self.fingerprint = Some((factorizations, fingerprint));
        let record = RunRecord {
            position: position.clone(),
            solver: solver.record(&zone.choice.guard, fingerprint),
            parts: parts.clone(),
            history: results.history[parts.n_rows..].to_vec(),
            path: path_from(parts.n_rows, n_rows),
            sampler: sampler.clone(),
            resumed: results.resumed,
        };
        self.store.write(&record, &parts.all())?;
        self.since = 0;
        Ok(())
    }
}

impl<'m, 'o> Run<'m, 'o> {
    /// This run, writing a checkpoint at every `every`-th increment.
    pub(super) fn with_checkpoints(self, store: Store, every: usize) -> Self {
        Run {
            checkpoints: Some(CheckpointWriter::new(store, every)),
            ..self
        }
    }

    /// Writes a checkpoint where one is due after an increment: at every so many, and one more
    /// where the run is `stopping`. A run does not end because that fails, its results are worth
    /// more; it says so, once.
    pub(super) fn write_checkpoint(&mut self, new_increments: usize, stopping: bool) {
        let Some(writer) = &mut self.checkpoints else {
            return;
        };
        writer.since += new_increments;
        if writer.since < writer.every && !(stopping && writer.since > 0) {
            return;
        }
        let start = self.start.as_ref();
        let reported = (&self.results, &self.path);
        match writer.write(&self.solver, &self.zone, &self.position, start, reported) {
            Ok(()) => writer.failed = false,
            Err(error) if !writer.failed => {
                writer.failed = true;
                let text = format!("no checkpoint: {}; the run goes on", error.in_full());
                self.observer.warning(&text);
                self.results.warnings.push(text);
            }
            Err(_) => {}
        }
    }

    /// The run that the last checkpoint is of.
    ///
    /// # Errors
    /// Those of [`Store::read`] and [`Solver::recall`].
    pub(super) fn resume(
        analysis: &'m Analysis,
        observer: &'o mut dyn Observer,
        store: Store,
        every: usize,
        expect: fn(&Analysis, &mut dyn Observer) -> Option<Expected>,
    ) -> Result<Self> {
        let model = &analysis.model;
        let record: RunRecord = store.read()?;
        observer.model(model.freedoms.n, model.pairs.len());
        observer.phase("factorisation");
        let begin = Instant::now();
        let (system, backend) = (&analysis.system, analysis.backend);
        let (solver, same) = Solver::recall(model, system, backend, &record.solver)?;
        let mut results = Results {
            timings: analysis.timings.clone(),
            warnings: model.warnings.clone(),
            resumed: record.resumed + 1,
            ..Results::default()
        };
        for part in &record.parts.states {
            let (states, rows, path): (Vec<State>, Vec<HistoryRow>, Vec<PathPoint>) =
                store.part_of(*part)?;
            results.states.extend(states);
            results.history.extend(rows);
            results.path.extend(path);
        }
        results.history.extend(record.history);
        results.path.extend(record.path);
        if !same {
            results.warnings.push(
                "resumed with a factorisation that differs in its last digits (another BLAS or \
                 number of its threads or of ranks): results agree with those of an uninterrupted \
                 run to round-off, not bit for bit"
                    .to_string(),
            );
        }
        for warning in &results.warnings {
            observer.warning(warning);
        }
        observer.phase(&format!(
            "going on after increment {}, load factor {:.6}",
            results.history.len(),
            solver.at.alpha
        ));
        let (elements, guard) = record.solver.choice();
        let mut zone = ZoneFit::new(Choice { elements, guard });
        if let Some(part) = record.parts.spread {
            zone.spread = Some(store.part_of(part)?);
        }
        if let Stage::Preload { .. } = record.position.stage {
            zone.expected = expect(analysis, observer).map(|expected| expected.ratios);
        }
        let start: Option<Start> = match record.parts.start {
            Some(part) => Some(store.part_of(part)?),
            None => None,
        };
        let position = record.position;
        let n_targets = model.scene.program.targets.len();
        let is_last = position.cycles.is_last(model.scene.program.cycles);
        let fits = position.target <= n_targets
            && results.states.len() == if is_last { position.target } else { 0 }
            && (position.target < n_targets || (start.is_none() && position.search.is_none()))
            && start
                .as_ref()
                .is_none_or(|start| solver.knows(&start.state));
        if !fits {
            return Err(Error::input(
                "the checkpoint does not belong to the program's targets: run the scene again from \
                 its beginning",
            ));
        }
        let mut run = Run::of(solver, zone, results, observer);
        run.path = record.sampler;
        run.position = position;
        run.follow_sets()?;
        run.position.seconds = run.position.seconds.running_since(begin);
        run.start = start;
        if let Some(search) = run.position.search {
            run.monitor = Some(run.monitor_of(search.scale)?);
        }
        run.checkpoints = Some(CheckpointWriter {
            parts: record.parts,
            ..CheckpointWriter::new(store, every)
        });
        Ok(run)
    }
}
