//! The record of a structure under load in a checkpoint, and the structure set up again from it.

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

/// Record of a structure under load between two increments: its state, the data from which the next
/// increment is predicted, and as much of its history as later results depend on.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(in crate::analysis) struct SolverRecord {
    factored: Ascending,
    /// Guard elements, as indices in the zone's list of elements.
    guard: Ascending,
    /// Hash of the results of the factorisation, see [`fingerprint`].
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
    /// Elements of the zone, and whether each is in the guard.
    pub(in crate::analysis) fn choice(&self) -> (Vec<usize>, Vec<bool>) {
        let elements = self.state.elements.to_vec();
        let mut guard = vec![false; elements.len()];
        for place in self.guard.iter().filter(|&place| place < elements.len()) {
            guard[place] = true;
        }
        (elements, guard)
    }

    /// Records a structure. `guard` is the list that was given with the zone, `fingerprint` the
    /// result of [`fingerprint`].
    pub(in crate::analysis) fn of(solver: &Solver, guard: &[bool], fingerprint: u128) -> Self {
        SolverRecord {
            factored: Ascending::new(solver.structure.factored.iter().copied()),
            guard: Ascending::new((0..guard.len()).filter(|&place| guard[place])),
            fingerprint,
            state: solver.state(),
            pivots: solver.tableau.record().clone(),
            yielding: solver.zone.yielding(),
            predictor: solver.predictor.clone(),
            load_forces: solver.structure.loads.forces.clone(),
            unit: solver.structure.unit,
            condition: solver.structure.condition,
            cost: solver.cost,
            scales: solver.scales,
        }
    }

    /// Sets up the structure that was recorded. Also returns whether its factorisation equals the
    /// recorded one to the last bit.
    ///
    /// # Errors
    /// Errors of [`Solver::new`]; `Input` if the record does not fit the model.
    pub(in crate::analysis) fn recall<'m>(
        &self,
        model: &'m Model,
        system: &'m System,
        backend: Backend,
    ) -> Result<(Solver<'m>, bool)> {
        let (elements, guard) = self.choice();
        let n_elements = model.mesh.n_elements();
        let within = elements.iter().all(|&e| e < n_elements);
        if !within || !self.factored.within(n_elements) {
            return Err(unfit());
        }
        let factored = self.factored.to_vec();
        let mut solver = Solver::new(model, system, backend, &factored, elements, &guard)?;
        let same = fingerprint(&solver) == self.fingerprint;
        solver.structure.zone_number = self.state.zone;
        let n = model.pairs.len();
        let fits = knows(&solver, &self.state)
            && (self.predictor.pace.iter())
                .all(|pace| pace.initial.is_like(&self.state.equilibrium.initial))
            && solver.set_springs(&self.state.springs)
            && solver.tableau.replay(&self.pivots)
            && solver.tableau.open() == self.state.open
            && self.load_forces.len() == solver.structure.loads.forces.len()
            && self.load_forces.iter().all(|forces| forces.len() == n)
            && self.predictor.last_step.len() == model.loads.len() + 1
            && self.predictor.flow.fits(model.loads.len());
        if !fits {
            return Err(unfit());
        }
        solver.restore(&self.state);
        if !solver.zone.set_yielding(&self.yielding) {
            return Err(unfit());
        }
        solver.zone.set_factors(&self.state.at.factors);
        solver.predictor = self.predictor.clone();
        let structure = &mut solver.structure;
        structure.loads.forces.clone_from(&self.load_forces);
        structure.unit = self.unit;
        structure.condition = self.condition;
        solver.cost = self.cost;
        solver.scales = self.scales;
        Ok((solver, same))
    }
}

/// Whether a state may be a state of this structure, with the current zone or another.
pub(in crate::analysis) fn knows(solver: &Solver, state: &State) -> bool {
    let model = solver.structure.model;
    let n_zone = solver.structure.sub.zeros().zone.len();
    let n_points = solver.zone.n_points(&state.elements);
    state.fits(
        [model.pairs.len(), model.rows.n_contact()],
        model.loads.len(),
    ) && state.history.is_of(n_points)
        && state
            .elements
            .iter()
            .all(|&e| e < solver.structure.model.mesh.n_elements())
        && (state.zone != solver.structure.zone_number
            || (state.elements == solver.structure.elements
                && state.equilibrium.u.zone.len() == n_zone))
}

/// Hash of the results of the factorisation that depend on no zone: contact matrix and reduced
/// loads.
pub(in crate::analysis) fn fingerprint(solver: &Solver) -> u128 {
    let mut hash = Xxh3::new();
    let mut add = |values: &[f64]| {
        for value in values {
            hash.update(&value.to_bits().to_le_bytes());
        }
    };
    for block in solver.structure.sub.pair_matrix().blocks() {
        add(block.matrix.as_slice());
    }
    solver
        .structure
        .loads
        .reduced
        .iter()
        .for_each(|load| add(load));
    hash.digest128()
}

fn unfit() -> Error {
    Error::input(
        "the checkpoint does not fit this build's factorisation (another version of CHOLMOD or of \
         its orderings?): run the scene again from its beginning",
    )
}
