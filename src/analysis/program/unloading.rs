//! Computes the state that unloading leaves: goes back to load factor zero, and restores the state.

use crate::analysis::increments::plastic::PlasticDrive;
use crate::analysis::increments::step::{Arrival, Rules};
use crate::analysis::structure::solver::Solver;
use crate::error::Result;
use crate::model::Model;
use std::ops::ControlFlow;

/// The way from a state back to load factor zero, as the load program would take it: elastically
/// from one change of contact to the next, in increments if the material yields on the way back.
pub(super) struct Unloading<'m> {
    model: &'m Model,
}

impl<'m> Unloading<'m> {
    pub(super) fn of(model: &'m Model) -> Self {
        Unloading { model }
    }

    /// Reads a quantity after the load factor has gone to zero, and restores the state. `None` if
    /// something outside the zone yields on the way.
    ///
    /// # Errors
    /// Errors of the increments on the way, and of `read`.
    pub(super) fn look<T>(
        &self,
        solver: &mut Solver,
        read: impl FnOnce(&mut Solver) -> Result<T>,
    ) -> Result<Option<T>> {
        let before = solver.state();
        let (predictor, scales) = (solver.predictor.clone(), solver.scales);
        let found = match self.go(solver) {
            Ok(true) => read(solver).map(Some),
            Ok(false) => Ok(None),
            Err(error) => Err(error.within("on the way back to load factor 0")),
        };
        solver.restore(&before);
        (solver.predictor, solver.scales) = (predictor, scales);
        solver.forget_tangent();
        found
    }

    /// Goes to load factor zero. Returns false if the zone is too small for that.
    fn go(&self, solver: &mut Solver) -> Result<bool> {
        let rules = Rules {
            settings: &self.model.settings,
            program: &self.model.program,
            zone_until: f64::INFINITY,
            stop: &|| false,
        };
        for stop in self.stops(solver.at.alpha) {
            let end = solver.structure.point(stop);
            let begun = PlasticDrive::begin(solver, &end, 0, None)?;
            let ControlFlow::Continue(mut drive) = begun else {
                continue;
            };
            loop {
                match drive.step(solver, &end, None, rules)?.arrival {
                    None => {}
                    Some(Arrival::ZoneTooSmall | Arrival::ZoneOutgrown) => return Ok(false),
                    Some(_) => break,
                }
            }
        }
        Ok(true)
    }

    /// Load factors at the ends of the straight pieces on the way from a load factor to zero.
    fn stops(&self, from: f64) -> Vec<f64> {
        let kinks = self.model.kinks();
        let mut stops: Vec<f64> = kinks.filter(|kink| kink * (from - kink) > 0.0).collect();
        stops.sort_by(|a, b| b.abs().total_cmp(&a.abs()));
        stops.dedup();
        stops.push(0.0);
        stops
    }
}
