//! A committed state to go back to, and the way from one load point to another.

use super::engine::{Engine, LoadPoint};
use super::equilibrium::Equilibrium;
use crate::material::PlasticState;
use std::sync::Arc;

/// A committed state to go back to.
pub(super) struct Saved {
    pub(super) at: LoadPoint,
    pub(super) now: Equilibrium,
    pub(super) open: Vec<bool>,
    pub(super) border: Vec<usize>,
    pub(super) fresh: bool,
    /// Elements of the zone then, and their history.
    pub(super) elements: Arc<[usize]>,
    pub(super) history: Vec<PlasticState>,
}

impl Saved {
    pub(super) fn of(engine: &Engine) -> Self {
        Saved {
            at: engine.at.clone(),
            now: engine.now.clone(),
            open: engine.tableau.open().to_vec(),
            border: engine.border.clone(),
            fresh: engine.fresh,
            elements: Arc::clone(&engine.elements),
            history: engine.zone.history().to_vec(),
        }
    }

    pub(super) fn put_back(&self, engine: &mut Engine) {
        engine.at = self.at.clone();
        engine.border = self.border.clone();
        engine.pace = None;
        if Arc::ptr_eq(&self.elements, &engine.elements) {
            engine.zone.restore(&self.history);
            engine.now.copy_from(&self.now);
            engine.fresh = self.fresh;
        } else {
            engine.zone.restore_of(&self.elements, &self.history);
            engine.now.gap.copy_from_slice(&self.now.gap);
            engine.now.force.copy_from_slice(&self.now.force);
            let initial = engine.zone.initial_load(engine.sub.zeros());
            engine.now.initial = engine.eliminate(initial);
            engine.fresh = false;
        }
        // Closing first: a pair whose opening would free a motion can open once others are closed.
        for closing in [true, false] {
            for k in 0..self.open.len() {
                let open = engine.tableau.open()[k];
                if open != self.open[k] && open == closing {
                    engine.tableau.flip(k);
                }
            }
        }
    }
}

impl LoadPoint {
    /// Change of all factors and of the interference on the way to `end`.
    pub(super) fn step_to(&self, end: &LoadPoint) -> Vec<f64> {
        let mut step: Vec<f64> = end
            .factors
            .iter()
            .zip(&self.factors)
            .map(|(b, a)| b - a)
            .collect();
        step.push(end.interference - self.interference);
        step
    }

    /// Largest change of a factor on the way to `end`.
    pub(super) fn distance(&self, end: &LoadPoint) -> f64 {
        self.step_to(end).iter().fold(0.0, |m, d| m.max(d.abs()))
    }

    /// Share of the way from here to `end` at which `between` lies.
    pub(super) fn share_of(&self, between: &LoadPoint, end: &LoadPoint) -> f64 {
        if end.alpha != self.alpha {
            (between.alpha - self.alpha) / (end.alpha - self.alpha)
        } else {
            (between.interference - self.interference) / (end.interference - self.interference)
        }
    }
}
