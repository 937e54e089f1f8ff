//! Resuming a run from its last checkpoint.
//!
//! A checkpoint is the position in the program with the state of the structure. Everything that
//! follows from the model (the factor, the condensed loads and matrices, the places of freedoms) is
//! computed again, by the same operations on the same numbers. Writing a checkpoint changes nothing
//! in the run, so results do not depend on whether, or how often, checkpoints are written.

use super::assembled::Analysis;
use super::checkpoints::{CheckpointWriter, RunRecord};
use super::position::{Position, Stage, Start};
use super::run::Run;
use crate::analysis::choice::zone_choice::Choice;
use crate::analysis::choice::zone_fit::{Expected, ZoneFit};
use crate::analysis::structure::record::knows;
use crate::analysis::structure::solver::Solver;
use crate::checkpoint::Store;
use crate::error::{Error, Result};
use crate::progress::Observer;
use crate::results::{HistoryRow, PathPoint, Results, State};
use std::time::Instant;

/// Sets up the run from its last checkpoint.
///
/// # Errors
/// Errors of [`Store::read`] and
/// [`SolverRecord::recall`](crate::analysis::structure::record::SolverRecord::recall).
pub(super) fn resume<'m, 'o>(
    analysis: &'m Analysis,
    observer: &'o mut dyn Observer,
    store: Store,
    every: usize,
    expect: fn(&Analysis, &mut dyn Observer) -> Option<Expected>,
) -> Result<Run<'m, 'o>> {
    let model = &analysis.model;
    let mut record: RunRecord = store.read()?;
    observer.model(model.freedoms.n, model.pairs.len());
    observer.phase("factorisation");
    let begin = Instant::now();
    let (system, backend) = (&analysis.system, analysis.backend);
    let (solver, same) = record.solver.recall(model, system, backend)?;
    let mut results = results_of(&mut record, &store)?;
    results.timings.clone_from(&analysis.timings);
    results.warnings.clone_from(&model.warnings);
    results.bodies.clone_from(&model.mesh.bodies);
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
    if !fits(&record.position, &results, start.as_ref(), &solver) {
        return Err(Error::input(
            "the checkpoint does not belong to the program's targets: run the scene again from \
             its beginning",
        ));
    }
    let mut run = Run::of(solver, zone, results, observer);
    run.path = record.sampler;
    run.position = record.position;
    run.follow_sets();
    run.position.seconds = run.position.seconds.running_since(begin);
    run.start = start;
    if let Some(search) = run.position.search {
        run.monitor = Some(run.goal().monitor(search.scale)?);
    }
    let mut writer = CheckpointWriter::new(store, every);
    writer.parts = record.parts;
    run.checkpoints = Some(writer);
    Ok(run)
}

/// Collects the states, rows and points of the path of a checkpoint.
fn results_of(record: &mut RunRecord, store: &Store) -> Result<Results> {
    let mut results = Results {
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
    results.history.append(&mut record.history);
    results.path.append(&mut record.path);
    Ok(results)
}

/// Whether a position, with the states before it and the start of its way, belongs to the program
/// of this structure.
fn fits(position: &Position, results: &Results, start: Option<&Start>, solver: &Solver) -> bool {
    let program = &solver.structure.model.program;
    let n_targets = program.targets.len();
    let is_last = position.cycles.is_last(program.cycles);
    position.target <= n_targets
        && results.states.len() == if is_last { position.target } else { 0 }
        && (position.target < n_targets || (start.is_none() && position.search.is_none()))
        && start.is_none_or(|start| knows(solver, &start.state))
}
