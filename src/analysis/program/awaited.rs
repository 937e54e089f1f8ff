//! Figures for which a target of the load program waits, read from a state on the way.

use super::unloading::Unloading;
use crate::analysis::figures::dent::Dent;
use crate::analysis::figures::measure::ContactFigures;
use crate::analysis::figures::reading::Reading;
use crate::analysis::increments::step::Monitor;
use crate::analysis::structure::solver::Solver;
use crate::error::Result;
use crate::model::{FigureGoal, Model};
use crate::scene::TargetFigure;
use std::cell::Cell;
use std::rc::Rc;

/// Fraction of the wanted dent by which the dent of the present plastic strains may differ before
/// unloading is computed. Yielding on unloading changes a dent by far less than this.
const NEAR: f64 = 0.25;

/// A figure that a target waits for.
#[derive(Clone)]
pub(super) struct Awaited<'m> {
    pub(super) model: &'m Model,
    /// The figure, with its value at the target.
    pub(super) goal: &'m FigureGoal,
}

impl<'m> Awaited<'m> {
    /// Value of the figure in the current state; for a dent, the dent of the present plastic
    /// strains. Costs half a full solve for the approach, half a trailing solve for a dent.
    ///
    /// # Errors
    /// Failure of the backend's solve.
    pub(super) fn here(&self, solver: &mut Solver) -> Result<f64> {
        let of_contact = |solver: &Solver| -> ContactFigures {
            match self.goal.contact {
                Some(contact) => ContactFigures::of_contact(solver, contact),
                None => ContactFigures::of(solver),
            }
        };
        Ok(match self.goal.figure {
            TargetFigure::ResidualDepth => {
                let dent = Dent::of(solver);
                self.goal.body.map_or(dent.depth, |body| dent.by_body[body])
            }
            TargetFigure::ContactForce => of_contact(solver).force * self.model.symmetry,
            TargetFigure::ContactArea => of_contact(solver).area,
            TargetFigure::MaxPressure => of_contact(solver).max_pressure,
            TargetFigure::Approach => {
                let mut reading = Reading::of(solver);
                let u = reading.displacements()?.total;
                reading.approach(&u)
            }
            TargetFigure::MaxEquivalentPlasticStrain => solver.zone.extent().1,
        })
    }

    /// Value of the figure in the current state in the sense of the target: for a dent near the
    /// target value, the dent that is left after the load factor has returned to zero. Sets
    /// `unloads_outside` if yielding on unloading leaves the zone.
    fn as_meant(&self, solver: &mut Solver, unloads_outside: &Cell<bool>) -> Result<f64> {
        let here = self.here(solver)?;
        let FigureGoal { figure, value, .. } = *self.goal;
        let is_near = (here - value).abs() <= NEAR * value;
        if figure != TargetFigure::ResidualDepth || !is_near {
            return Ok(here);
        }
        let unloading = Unloading::of(self.model);
        match unloading.look(solver, |solver| self.here(solver))? {
            Some(left) => Ok(left),
            None => {
                unloads_outside.set(true);
                Ok(here)
            }
        }
    }

    /// Function of order 1 that vanishes when the figure has its target value.
    pub(super) fn monitor(self, unloads_outside: Rc<Cell<bool>>) -> Box<Monitor<'m>> {
        Box::new(move |solver: &mut Solver| {
            Ok(self.as_meant(solver, &unloads_outside)? / self.goal.value - 1.0)
        })
    }
}
