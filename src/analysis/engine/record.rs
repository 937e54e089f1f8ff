//! What a checkpoint holds of a structure under load, and the structure set up from it.

use super::Engine;
use crate::analysis::equilibrium::EliminatedLoad;
use crate::analysis::packed::Ascending;
use crate::analysis::state::State;
use crate::analysis::zone::Yielding;
use crate::assembly::System;
use crate::contact::TableauRecord;
use crate::error::{Error, Result};
use crate::linalg::Backend;
use crate::model::Model;
use crate::results::Counts;
use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::Xxh3;

/// A structure under load between two increments: its state, what the next increment is predicted
/// from, and how it came here as far as numbers depend on that.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(in crate::analysis) struct EngineRecord {
    factored: Ascending,
    /// Places among the elements of the zone of those that only watch.
    guard: Ascending,
    /// See [`Engine::fingerprint`].
    fingerprint: u128,
    state: State,
    pivots: TableauRecord,
    yielding: Yielding,
    last_step: Vec<f64>,
    pace: Option<EliminatedLoad>,
    load_forces: Vec<Vec<f64>>,
    unit: f64,
    counts: Counts,
    half: bool,
    force_scale: f64,
    condition: f64,
    displacement_scale: f64,
    deformation_scale: f64,
    round_off_floor: f64,
}

impl EngineRecord {
    /// Elements of the zone, and which of them only watch.
    pub(in crate::analysis) fn choice(&self) -> (Vec<usize>, Vec<bool>) {
        let elements = self.state.elements.to_vec();
        let mut guard = vec![false; elements.len()];
        for place in self.guard.iter().filter(|&place| place < elements.len()) {
            guard[place] = true;
        }
        (elements, guard)
    }
}

impl<'m> Engine<'m> {
    /// The record of this structure; `guard` as it was given with the zone, [`Engine::fingerprint`]
    /// as it was computed.
    pub(in crate::analysis) fn record(&self, guard: &[bool], fingerprint: u128) -> EngineRecord {
        EngineRecord {
            factored: Ascending::new(self.factored.iter().copied()),
            guard: Ascending::new((0..guard.len()).filter(|&place| guard[place])),
            fingerprint,
            state: self.state(),
            pivots: self.tableau.record().clone(),
            yielding: self.zone.yielding(),
            last_step: self.last_step.clone(),
            pace: self.pace.clone(),
            load_forces: self.load_forces.clone(),
            unit: self.unit,
            counts: self.counts,
            half: self.half,
            force_scale: self.force_scale,
            condition: self.condition,
            displacement_scale: self.displacement_scale,
            deformation_scale: self.deformation_scale,
            round_off_floor: self.round_off_floor,
        }
    }

    /// The structure that a record is of, and whether its factor is the same to the last bit.
    ///
    /// # Errors
    /// Those of [`Engine::new`]; `Input` where the record does not fit the model.
    pub(in crate::analysis) fn recall(
        model: &'m Model,
        system: &'m System,
        backend: Backend,
        record: &EngineRecord,
    ) -> Result<(Self, bool)> {
        let (elements, guard) = record.choice();
        let n_elements = model.mesh.n_elements();
        let within = elements.iter().all(|&e| e < n_elements);
        if !within || !record.factored.within(n_elements) {
            return Err(unfit());
        }
        let factored = record.factored.to_vec();
        let mut engine = Engine::new(model, system, backend, &factored, elements, &guard)?;
        let same = engine.fingerprint() == record.fingerprint;
        engine.zone_number = record.state.zone;
        let n = model.pairs.len();
        let fits = engine.knows(&record.state)
            && (record.pace.iter()).all(|pace| pace.is_like(&record.state.equilibrium.initial))
            && engine.tableau.replay(&record.pivots)
            && engine.tableau.open() == record.state.open
            && record.load_forces.len() == engine.load_forces.len()
            && record.load_forces.iter().all(|forces| forces.len() == n)
            && record.last_step.len() == model.loads.len() + 1;
        if !fits {
            return Err(unfit());
        }
        engine.restore(&record.state);
        if !engine.zone.set_yielding(&record.yielding) {
            return Err(unfit());
        }
        engine.zone.set_factors(&record.state.at.factors);
        engine.load_forces.clone_from(&record.load_forces);
        engine.last_step.clone_from(&record.last_step);
        engine.pace.clone_from(&record.pace);
        engine.unit = record.unit;
        engine.counts = record.counts;
        engine.half = record.half;
        engine.force_scale = record.force_scale;
        engine.condition = record.condition;
        engine.displacement_scale = record.displacement_scale;
        engine.deformation_scale = record.deformation_scale;
        engine.round_off_floor = record.round_off_floor;
        Ok((engine, same))
    }

    /// Whether a state may be one of this structure, with the zone at hand or another.
    pub(in crate::analysis) fn knows(&self, state: &State) -> bool {
        let n_zone = self.sub.zeros().zone.len();
        let n_points = self.zone.n_points(&state.elements);
        state.fits(self.model.pairs.len(), self.model.loads.len())
            && state.history.len() == n_points
            && state
                .elements
                .iter()
                .all(|&e| e < self.model.mesh.n_elements())
            && (state.zone != self.zone_number
                || (state.elements == self.elements && state.equilibrium.u.zone.len() == n_zone))
    }

    /// Hash of what the factorisation left of the model, whichever zone is chosen: contact matrix
    /// and reduced loads.
    pub(in crate::analysis) fn fingerprint(&self) -> u128 {
        let mut hash = Xxh3::new();
        let mut add = |values: &[f64]| {
            for value in values {
                hash.update(&value.to_bits().to_le_bytes());
            }
        };
        for block in self.tableau.matrix().blocks() {
            add(block.matrix.as_slice());
        }
        self.reduced_loads.iter().for_each(|load| add(load));
        hash.digest128()
    }
}

fn unfit() -> Error {
    Error::input(
        "the checkpoint does not fit this build's factorisation (another version of CHOLMOD or of its orderings?): \
         run the scene again from its beginning",
    )
}
