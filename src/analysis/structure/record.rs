//! What a checkpoint holds of a structure under load, and the structure set up from it.

use super::cost::Cost;
use super::solver::{Predictor, Scales, Solver};
use super::state::State;
use crate::analysis::zone::packed::Ascending;
use crate::analysis::zone::yielding::Yielding;
use crate::assembly::System;
use crate::contact::TableauRecord;
use crate::error::{Error, Result};
use crate::linalg::Backend;
use crate::model::Model;
use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::Xxh3;

/// A structure under load between two increments: its state, what the next increment is predicted
/// from, and how it came here as far as numbers depend on that.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(in crate::analysis) struct SolverRecord {
    factored: Ascending,
    /// Places among the elements of the zone of those that only watch.
    guard: Ascending,
    /// See [`Solver::fingerprint`].
    fingerprint: u128,
    state: State,
    pivots: TableauRecord,
    yielding: Yielding,
    predictor: Predictor,
    load_forces: Vec<Vec<f64>>,
    unit: f64,
    condition: f64,
    cost: Cost,
    scales: Scales,
}

impl SolverRecord {
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

impl<'m> Solver<'m> {
    /// The record of this structure; `guard` as it was given with the zone, [`Solver::fingerprint`]
    /// as it was computed.
    pub(in crate::analysis) fn record(&self, guard: &[bool], fingerprint: u128) -> SolverRecord {
        SolverRecord {
            factored: Ascending::new(self.structure.factored.iter().copied()),
            guard: Ascending::new((0..guard.len()).filter(|&place| guard[place])),
            fingerprint,
            state: self.state(),
            pivots: self.tableau.record().clone(),
            yielding: self.zone.yielding(),
            predictor: self.predictor.clone(),
            load_forces: self.structure.loads.forces.clone(),
            unit: self.structure.unit,
            condition: self.structure.condition,
            cost: self.cost,
            scales: self.scales,
        }
    }

    /// The structure that a record is of, and whether its factor is the same to the last bit.
    ///
    /// # Errors
    /// Those of [`Solver::new`]; `Input` where the record does not fit the model.
    pub(in crate::analysis) fn recall(
        model: &'m Model,
        system: &'m System,
        backend: Backend,
        record: &SolverRecord,
    ) -> Result<(Self, bool)> {
        let (elements, guard) = record.choice();
        let n_elements = model.mesh.n_elements();
        let within = elements.iter().all(|&e| e < n_elements);
        if !within || !record.factored.within(n_elements) {
            return Err(unfit());
        }
        let factored = record.factored.to_vec();
        let mut solver = Solver::new(model, system, backend, &factored, elements, &guard)?;
        let same = solver.fingerprint() == record.fingerprint;
        solver.structure.zone_number = record.state.zone;
        let n = model.pairs.len();
        let fits = solver.knows(&record.state)
            && (record.predictor.pace.iter())
                .all(|pace| pace.initial.is_like(&record.state.equilibrium.initial))
            && solver.set_springs(&record.state.springs)
            && solver.tableau.replay(&record.pivots)
            && solver.tableau.open() == record.state.open
            && record.load_forces.len() == solver.structure.loads.forces.len()
            && record.load_forces.iter().all(|forces| forces.len() == n)
            && record.predictor.last_step.len() == model.loads.len() + 1
            && record.predictor.flow.fits(model.loads.len());
        if !fits {
            return Err(unfit());
        }
        solver.restore(&record.state);
        if !solver.zone.set_yielding(&record.yielding) {
            return Err(unfit());
        }
        solver.zone.set_factors(&record.state.at.factors);
        solver.predictor = record.predictor.clone();
        let structure = &mut solver.structure;
        structure.loads.forces.clone_from(&record.load_forces);
        structure.unit = record.unit;
        structure.condition = record.condition;
        solver.cost = record.cost;
        solver.scales = record.scales;
        Ok((solver, same))
    }

    /// Whether a state may be one of this structure, with the zone at hand or another.
    pub(in crate::analysis) fn knows(&self, state: &State) -> bool {
        let model = self.structure.model;
        let n_zone = self.structure.sub.zeros().zone.len();
        let n_points = self.zone.n_points(&state.elements);
        state.fits(
            [model.pairs.len(), model.rows.n_contact()],
            model.loads.len(),
        ) && state.history.is_of(n_points)
            && state
                .elements
                .iter()
                .all(|&e| e < self.structure.model.mesh.n_elements())
            && (state.zone != self.structure.zone_number
                || (state.elements == self.structure.elements
                    && state.equilibrium.u.zone.len() == n_zone))
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
        for block in self.structure.sub.pair_matrix().blocks() {
            add(block.matrix.as_slice());
        }
        self.structure
            .loads
            .reduced
            .iter()
            .for_each(|load| add(load));
        hash.digest128()
    }
}

fn unfit() -> Error {
    Error::input(
        "the checkpoint does not fit this build's factorisation (another version of CHOLMOD or of \
         its orderings?): run the scene again from its beginning",
    )
}
