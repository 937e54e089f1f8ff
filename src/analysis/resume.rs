//! A run set up from its last checkpoint.

use super::aim::Aim;
use super::engine::Engine;
use super::keeper::{Keeper, RunRecord, SpreadRecord, Start, StartRecord};
use super::place::Place;
use super::program::Run;
use super::saved::Saved;
use super::zone_choice::Choice;
use super::zone_fit::Spread;
use crate::assembly::System;
use crate::checkpoint::Store;
use crate::error::{Error, Result};
use crate::linalg::Backend;
use crate::model::Model;
use crate::progress::Observer;
use crate::results::{HistoryRow, PathPoint, Results, State};
use std::time::Instant;

impl<'m, 'o> Run<'m, 'o> {
    /// The run that the last checkpoint is of.
    ///
    /// # Errors
    /// Those of [`Store::read`] and [`Engine::recall`].
    pub(super) fn resume(
        model: &'m Model,
        system: &'m System,
        backend: Backend,
        timings: &[(String, f64)],
        observer: &'o mut dyn Observer,
        store: Store,
        every: usize,
    ) -> Result<Self> {
        let record: RunRecord = store.read()?;
        observer.model(model.freedoms.n, model.pairs.len());
        observer.phase("factorisation");
        let begin = Instant::now();
        let (engine, same) = Engine::recall(model, system, backend, &record.engine)?;
        let mut results = Results {
            timings: timings.to_vec(),
            warnings: model.warnings.clone(),
            first_yield: record.first_yield,
            resumed: record.resumed + 1,
            ..Results::default()
        };
        for part in &record.states {
            let (states, rows, path): (Vec<State>, Vec<HistoryRow>, Vec<PathPoint>) =
                store.part_of(*part)?;
            results.states.extend(states);
            results.history.extend(rows);
            results.path.extend(path);
        }
        let rows_of_states = results.history.len();
        results.history.extend(record.history);
        results.path.extend(record.path);
        let (elements, guard) = record.engine.choice();
        let start = match record.start {
            Some((part, same_zone)) => {
                let kept: StartRecord = store.part_of(part)?;
                Some(Start {
                    saved: Saved::recall(&kept.saved, &engine, same_zone)?,
                    plastic: kept.plastic,
                    yield_alpha: kept.yield_alpha,
                    first_yield: kept.first_yield,
                    increments: kept.increments,
                })
            }
            None => None,
        };
        let spread = match record.spread {
            Some((part, highest, until)) => {
                let kept: SpreadRecord = store.part_of(part)?;
                let mut ratios = vec![0.0; model.mesh.n_elements()];
                for (e, ratio) in kept.elements.iter().zip(kept.ratios) {
                    if let Some(place) = ratios.get_mut(e) {
                        *place = ratio;
                    }
                }
                Some(Spread {
                    ratios,
                    highest,
                    until,
                })
            }
            None => None,
        };
        if !same {
            results.warnings.push(
                "resumed with a factorisation that differs in its last digits (another BLAS or number of its threads): results agree \
                 with those of an uninterrupted run to round-off, not bit for bit"
                    .to_string(),
            );
        }
        for warning in &results.warnings {
            observer.warning(warning);
        }
        observer.phase(&format!(
            "going on after increment {}, load factor {:.6}",
            results.history.len(),
            engine.at.alpha
        ));
        let mut standing = record.standing;
        standing.seconds.condensation += begin.elapsed().as_secs_f64();
        let n_targets = model.scene.program.targets.len();
        if standing.done > n_targets || standing.done != results.states.len() {
            return Err(Error::input(
                "the checkpoint names more targets than there are: run the scene again from its beginning",
            ));
        }
        let mut keeper = Keeper::new(store, every);
        keeper.n_states = results.states.len();
        (keeper.n_rows, keeper.rows_of_states) = (rows_of_states, rows_of_states);
        keeper.states = record.states;
        keeper.spread = record.spread.map(|(part, ..)| part);
        keeper.start = record.start.map(|(part, _)| part);
        Ok(Run {
            recovery: None,
            choice: Choice { elements, guard },
            at_yield: None,
            ratios_before_yield: Vec::new(),
            spread,
            observer,
            standing,
            aim: Aim::Nothing,
            fraction: standing.done as f64 / n_targets.max(1) as f64,
            between: record.between,
            keeper: Some(keeper),
            start,
            place: Place {
                attempt: record.place.attempt,
                search: record.place.search,
                ..Place::default()
            },
            resumed: Some(record.place),
            results,
            engine,
        })
    }
}
