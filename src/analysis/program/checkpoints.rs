//! The contents of a checkpoint of a run, and how they are written: parts that do not change any
//! more go into files of their own.

use super::path::PathSampler;
use super::position::{Position, Start};
use crate::analysis::choice::zone_fit::ZoneFit;
use crate::analysis::structure::record::{self, SolverRecord};
use crate::analysis::structure::solver::Solver;
use crate::checkpoint::{PartId, Store};
use crate::error::Result;
use crate::results::{HistoryRow, PathPoint, Results};
use serde::{Deserialize, Serialize};

/// The record of a run between two steps.
#[derive(Serialize, Deserialize)]
pub(super) struct RunRecord {
    pub(super) position: Position,
    pub(super) solver: SolverRecord,
    pub(super) parts: Parts,
    /// Rows of the history since the last state, and (`path`) points of the path since then.
    pub(super) history: Vec<HistoryRow>,
    pub(super) path: Vec<PathPoint>,
    pub(super) sampler: PathSampler,
    pub(super) resumed: usize,
}

/// Parts of a checkpoint that do not change any more, each in a file of its own.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct Parts {
    /// States that were reached, with the rows and points of the path up to the last of these
    /// states.
    pub(super) states: Vec<PartId>,
    /// Number of states in these parts, and (`n_rows`) number of rows.
    n_states: usize,
    n_rows: usize,
    /// Predicted spread of yielding, by which the zone follows the load.
    pub(super) spread: Option<PartId>,
    /// State at the start of the way to the current target.
    pub(super) start: Option<PartId>,
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
    /// Number of increments from one checkpoint to the next, and (`since`) since the last one.
    every: usize,
    since: usize,
    pub(super) parts: Parts,
    /// Fingerprint of the factor, with the number of factorisations after which it was computed.
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

    /// Drops the stored start, because the way to the next target starts from another state.
    pub(super) fn forget_start(&mut self) {
        self.parts.start = None;
    }

    /// Whether a checkpoint is due: after the set number of increments, and once more if the run is
    /// `stopping`.
    pub(super) fn is_due(&mut self, new_increments: usize, stopping: bool) -> bool {
        self.since += new_increments;
        self.since >= self.every || (stopping && self.since > 0)
    }

    /// A warning if a checkpoint could not be written. A failure to write does not end the run,
    /// because the results matter more. Of several failures in succession, only the first is
    /// reported.
    pub(super) fn note(&mut self, outcome: Result<()>) -> Option<String> {
        let had_failed = std::mem::replace(&mut self.failed, outcome.is_err());
        let error = outcome.err().filter(|_| !had_failed)?;
        let error = error.in_full();
        Some(format!("no checkpoint: {error}; the run goes on"))
    }

    pub(super) fn write(
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
            // Rows of the present way to a target may still be taken back.
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
            _ => record::fingerprint(solver),
        };
        self.fingerprint = Some((factorizations, fingerprint));
        let record = RunRecord {
            position: position.clone(),
            solver: SolverRecord::of(solver, &zone.choice.guard, fingerprint),
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
