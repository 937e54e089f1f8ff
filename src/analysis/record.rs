//! What a checkpoint keeps of the structure under load, and the structure set up from it.
//!
//! What follows from the model (the factor, the condensed loads and matrices, the places of
//! freedoms) is computed again: the same operations on the same numbers. What depends on the way
//! here is kept: state, history, and the pivots that the tableau went through.

use super::engine::{Engine, LoadPoint};
use super::equilibrium::{EliminatedLoad, Equilibrium};
use super::packed::{Ascending, SparseHistory, SparseTrailing};
use super::saved::Saved;
use super::zone::ZoneRecord;
use crate::assembly::System;
use crate::contact::TableauRecord;
use crate::error::{Error, Result};
use crate::linalg::Backend;
use crate::material::PlasticState;
use crate::model::Model;
use crate::results::Counts;
use crate::substructure::Trailing;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use xxhash_rust::xxh3::Xxh3;

/// A load that was eliminated piece by piece: not what eliminating it at once gives, to the last
/// bit.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct EliminatedRecord {
    load: SparseTrailing,
    eliminated: SparseTrailing,
    forces: Vec<f64>,
}

impl EliminatedRecord {
    fn of(load: &EliminatedLoad) -> Self {
        EliminatedRecord {
            load: SparseTrailing::new(&load.load),
            eliminated: SparseTrailing::new(&load.eliminated),
            forces: load.forces.clone(),
        }
    }

    /// `zeros` has the size that it must have; `None` where it has another.
    fn unpack(&self, zeros: &Trailing, n_pairs: usize) -> Option<EliminatedLoad> {
        let mut out = EliminatedLoad::none(zeros, n_pairs);
        let fits = self.load.unpack(&mut out.load)
            && self.eliminated.unpack(&mut out.eliminated)
            && self.forces.len() == n_pairs;
        out.forces.clone_from(&self.forces);
        fits.then_some(out)
    }
}

/// An equilibrium.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct EquilibriumRecord {
    initial: EliminatedRecord,
    u: Trailing,
    gap: Vec<f64>,
    force: Vec<f64>,
}

impl EquilibriumRecord {
    fn of(now: &Equilibrium) -> Self {
        EquilibriumRecord {
            initial: EliminatedRecord::of(&now.initial),
            u: now.u.clone(),
            gap: now.gap.clone(),
            force: now.force.clone(),
        }
    }

    /// `zeros` has the size that it must have; `None` where it has another.
    fn unpack(&self, zeros: &Trailing, n_pairs: usize) -> Option<Equilibrium> {
        let initial = self.initial.unpack(zeros, n_pairs)?;
        let fits = self.u.zone.len() == zeros.zone.len()
            && self.u.contact.len() == zeros.contact.len()
            && self.gap.len() == n_pairs
            && self.force.len() == n_pairs;
        fits.then(|| Equilibrium {
            initial,
            u: self.u.clone(),
            gap: self.gap.clone(),
            force: self.force.clone(),
        })
    }
}

/// The structure under load between two increments.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct EngineRecord {
    factored: Ascending,
    elements: Ascending,
    /// Places among the elements of those that only watch.
    guard: Ascending,
    /// See [`Engine::fingerprint`].
    fingerprint: u128,
    tableau: TableauRecord,
    zone: ZoneRecord,
    load_forces: Vec<Vec<f64>>,
    unit: f64,
    counts: Counts,
    half: bool,
    force_scale: f64,
    condition: f64,
    displacement_scale: f64,
    deformation_scale: f64,
    round_off_floor: f64,
    at: LoadPoint,
    now: EquilibriumRecord,
    fresh: bool,
    border: Vec<usize>,
    last_step: Vec<f64>,
    pace: Option<EliminatedRecord>,
}

impl EngineRecord {
    /// Elements of the zone, and which of them only watch.
    pub(super) fn choice(&self) -> (Vec<usize>, Vec<bool>) {
        let elements = self.elements.to_vec();
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
    pub(super) fn record(&self, guard: &[bool], fingerprint: u128) -> EngineRecord {
        EngineRecord {
            factored: Ascending::new(self.factored.iter().copied()),
            elements: Ascending::new(self.elements.iter().copied()),
            guard: Ascending::new((0..guard.len()).filter(|&place| guard[place])),
            fingerprint,
            tableau: self.tableau.record().clone(),
            zone: self.zone.record(),
            load_forces: self.load_forces.clone(),
            unit: self.unit,
            counts: self.counts,
            half: self.half,
            force_scale: self.force_scale,
            condition: self.condition,
            displacement_scale: self.displacement_scale,
            deformation_scale: self.deformation_scale,
            round_off_floor: self.round_off_floor,
            at: self.at.clone(),
            now: EquilibriumRecord::of(&self.now),
            fresh: self.fresh,
            border: self.border.clone(),
            last_step: self.last_step.clone(),
            pace: self.pace.as_ref().map(EliminatedRecord::of),
        }
    }

    /// The structure that a record is of, and whether its factor is the same to the last bit.
    ///
    /// # Errors
    /// Those of [`Engine::new`]; `Input` where the record does not fit the model.
    pub(super) fn recall(
        model: &'m Model,
        system: &'m System,
        backend: Backend,
        record: &EngineRecord,
    ) -> Result<(Self, bool)> {
        let n_elements = model.mesh.n_elements();
        if !record.factored.within(n_elements) || !record.elements.within(n_elements) {
            return Err(unfit());
        }
        let (elements, guard) = record.choice();
        let factored = record.factored.to_vec();
        let mut engine = Engine::new(model, system, backend, &factored, elements, &guard)?;
        let same = engine.fingerprint() == record.fingerprint;
        let n = model.pairs.len();
        let zeros = engine.sub.zeros();
        engine.now = record.now.unpack(&zeros, n).ok_or_else(unfit)?;
        engine.pace = match &record.pace {
            Some(pace) => Some(pace.unpack(&zeros, n).ok_or_else(unfit)?),
            None => None,
        };
        let fits = engine.zone.recall(&record.zone)
            && engine.tableau.replay(&record.tableau)
            && record.load_forces.len() == engine.load_forces.len()
            && record.load_forces.iter().all(|forces| forces.len() == n)
            && record.at.factors.len() == model.loads.len()
            && record.last_step.len() == model.loads.len() + 1
            && record.border.iter().all(|&k| k < n);
        if !fits {
            return Err(unfit());
        }
        engine.zone.set_factors(&record.at.factors);
        engine.load_forces.clone_from(&record.load_forces);
        engine.unit = record.unit;
        engine.counts = record.counts;
        engine.half = record.half;
        engine.force_scale = record.force_scale;
        engine.condition = record.condition;
        engine.displacement_scale = record.displacement_scale;
        engine.deformation_scale = record.deformation_scale;
        engine.round_off_floor = record.round_off_floor;
        engine.at = record.at.clone();
        engine.fresh = record.fresh;
        engine.border.clone_from(&record.border);
        engine.last_step.clone_from(&record.last_step);
        Ok((engine, same))
    }

    /// Hash of what the factorisation left of the model, whichever zone is chosen: contact matrix
    /// and reduced loads.
    pub(super) fn fingerprint(&self) -> u128 {
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

/// A committed state to go back to.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct SavedRecord {
    at: LoadPoint,
    now: EquilibriumRecord,
    n_zone: usize,
    open: Vec<bool>,
    border: Vec<usize>,
    fresh: bool,
    elements: Ascending,
    points: usize,
    history: SparseHistory,
}

impl Saved {
    /// The record of this state.
    pub(super) fn record(&self) -> SavedRecord {
        SavedRecord {
            at: self.at.clone(),
            now: EquilibriumRecord::of(&self.now),
            n_zone: self.now.u.zone.len(),
            open: self.open.clone(),
            border: self.border.clone(),
            fresh: self.fresh,
            elements: Ascending::new(self.elements.iter().copied()),
            points: self.history.len(),
            history: SparseHistory::new(&self.history),
        }
    }

    /// The state that a record is of; `same_zone` where it is one of the engine's zone as it is.
    ///
    /// # Errors
    /// `Input` where the record does not fit.
    pub(super) fn recall(record: &SavedRecord, engine: &Engine, same_zone: bool) -> Result<Self> {
        let n = engine.model.pairs.len();
        let zeros = Trailing::zeros(record.n_zone, engine.now.u.contact.len());
        let elements: Arc<[usize]> = if same_zone {
            Arc::clone(&engine.elements)
        } else {
            record.elements.to_vec().into()
        };
        let mut history = vec![PlasticState::default(); record.points];
        let fits = record.history.unpack(&mut history) && record.open.len() == n;
        let now = record.now.unpack(&zeros, n).filter(|_| fits);
        Ok(Saved {
            at: record.at.clone(),
            now: now.ok_or_else(unfit)?,
            open: record.open.clone(),
            border: record.border.clone(),
            fresh: record.fresh,
            elements,
            history,
        })
    }
}

fn unfit() -> Error {
    Error::input(
        "the checkpoint does not fit this build's factorisation (another version of CHOLMOD or of its orderings?): \
         run the scene again from its beginning",
    )
}
