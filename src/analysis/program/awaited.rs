//! Figures for which a target of the load program waits, read from a state on the way.

use super::unloading::Unloading;
use crate::analysis::figures::dent::Dent;
use crate::analysis::figures::measure::ContactFigures;
use crate::analysis::figures::reading::Reading;
use crate::analysis::increments::step::Monitor;
use crate::analysis::structure::solver::Solver;
use crate::error::{Error, Result};
use crate::model::Model;
use crate::scene::{Target, TargetFigure};
use std::cell::Cell;
use std::rc::Rc;

/// Fraction of the wanted dent by which the dent of the present plastic strains may differ before
/// unloading is computed. Yielding on unloading changes a dent by far less than this.
const NEAR: f64 = 0.25;

/// A figure that a target waits for.
#[derive(Clone)]
pub(super) struct Awaited<'m> {
    model: &'m Model,
    figure: TargetFigure,
    /// The value of the figure at the target.
    pub(super) value: f64,
    /// The body to which the figure belongs, if the target names one.
    body: Option<usize>,
    /// The contact to which the figure belongs, if the target names one.
    contact: Option<usize>,
}

impl<'m> Awaited<'m> {
    /// The figure for which a target waits; `None` if it waits for none.
    ///
    /// # Errors
    /// A body that the mesh does not have.
    pub(super) fn of(model: &'m Model, target: &Target) -> Result<Option<Self>> {
        let Some((figure, value)) = target.figures().next() else {
            return Ok(None);
        };
        let number_of = |name: &String| {
            let bodies = &model.mesh.bodies;
            let number = bodies.iter().position(|body| body == name);
            number.ok_or_else(|| Error::input(format!("the mesh has no body `{name}`")))
        };
        Ok(Some(Awaited {
            model,
            figure,
            value,
            body: target.body.as_ref().map(number_of).transpose()?,
            contact: target.contact.map(|number| number - 1),
        }))
    }

    /// Name of the awaited figure.
    pub(super) fn key(&self) -> &'static str {
        self.figure.key()
    }

    /// Value of the figure in the current state; for a dent, the dent of the present plastic
    /// strains. Costs half a full solve for the approach, half a trailing solve for a dent.
    ///
    /// # Errors
    /// Failure of the backend's solve.
    pub(super) fn here(&self, solver: &mut Solver) -> Result<f64> {
        let of_contact = |solver: &Solver| -> ContactFigures {
            match self.contact {
                Some(contact) => ContactFigures::of_contact(solver, contact),
                None => ContactFigures::of(solver),
            }
        };
        Ok(match self.figure {
            TargetFigure::ResidualDepth => {
                let dent = Dent::of(solver);
                self.body.map_or(dent.depth, |body| dent.by_body[body])
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
        let is_near = (here - self.value).abs() <= NEAR * self.value;
        if self.figure != TargetFigure::ResidualDepth || !is_near {
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
            Ok(self.as_meant(solver, &unloads_outside)? / self.value - 1.0)
        })
    }
}
