//! The search for the load factor at which the quantity of a target has its value.

use super::awaited::Awaited;
use super::position::TargetSearch;
use crate::analysis::figures::measure::ContactFigures;
use crate::analysis::figures::reading::Reading;
use crate::analysis::increments::step::{MONITOR_ACCURACY, Monitor};
use crate::analysis::structure::solver::Solver;
use crate::error::{Error, Result};
use crate::model::{DisplacementGoal, Model, ProgramTarget, TargetCondition};
use crate::number::{exact, percent};
use std::cell::Cell;
use std::rc::Rc;

/// What the current target of a run asks for.
pub(super) struct Goal<'m> {
    pub(super) model: &'m Model,
    pub(super) target: &'m ProgramTarget,
    /// Contact half width at first yield, if it is known and not zero.
    pub(super) half_width_at_yield: Option<f64>,
    /// Whether the target was searched for with a zone outside of which unloading yields.
    pub(super) unloads_outside: Rc<Cell<bool>>,
}

impl<'m> Goal<'m> {
    /// Function that vanishes at the target. It is of order 1 when measured against `scale`, so
    /// that the accuracy of the search does not depend on units.
    ///
    /// # Errors
    /// A target that cannot be measured.
    pub(super) fn monitor(&self, scale: f64) -> Result<Box<Monitor<'m>>> {
        let model = self.model;
        Ok(match &self.target.condition {
            TargetCondition::HalfWidth(multiple) => {
                let goal = self.half_width_at_yield.map(|at_yield| multiple * at_yield);
                let goal = goal.ok_or_else(|| {
                    Error::analysis(format!(
                        "target `{}`: the contact half width at yield is not known",
                        self.target.label
                    ))
                })?;
                Box::new(move |solver: &mut Solver| {
                    Ok(ContactFigures::of(solver).half_width / goal - 1.0)
                })
            }
            TargetCondition::Figure(goal) => {
                Awaited { model, goal }.monitor(Rc::clone(&self.unloads_outside))
            }
            TargetCondition::Displacement(goal) => {
                Box::new(move |solver: &mut Solver| Ok(short_of(goal, solver)? / scale))
            }
            TargetCondition::FirstYield | TargetCondition::LoadFactor(_) => {
                return Err(Error::internal("a target that is not searched for"));
            }
        })
    }

    /// The search for the target, with the function that vanishes there. `None` if the target is
    /// reached.
    ///
    /// # Errors
    /// A target that cannot be measured, or that no load reaches.
    pub(super) fn search(
        &self,
        solver: &mut Solver,
    ) -> Result<Option<(Box<Monitor<'m>>, TargetSearch)>> {
        match &self.target.condition {
            TargetCondition::Displacement(goal) => self.search_displacement(goal, solver).map(Some),
            _ => self.search_figure(solver),
        }
    }

    fn search_displacement(
        &self,
        goal: &DisplacementGoal,
        solver: &mut Solver,
    ) -> Result<(Box<Monitor<'m>>, TargetSearch)> {
        let off = self.monitor(1.0)?(solver)?;
        let largest = goal.value.abs().max(off.abs());
        let scale = if largest > 0.0 { largest } else { 1.0 };
        let monitor = self.monitor(scale)?;
        let here = off / scale;
        let ahead = a_little_ahead(solver, &monitor)?;
        let upward = (ahead - here) * here <= 0.0;
        let search = TargetSearch::new(solver.at.alpha, here, upward, scale);
        Ok((monitor, search))
    }

    /// Begins the search for a half width or a figure: with growing load, or with falling load if
    /// the present value is too large.
    fn search_figure(
        &self,
        solver: &mut Solver,
    ) -> Result<Option<(Box<Monitor<'m>>, TargetSearch)>> {
        let monitor = self.monitor(1.0)?;
        let off = monitor(solver)?;
        let goal = match &self.target.condition {
            TargetCondition::Figure(goal) if goal.figure.stays() && off > 0.0 => goal,
            _ => {
                let search = TargetSearch::new(solver.at.alpha, off, off < 0.0, 1.0);
                return Ok(Some((monitor, search)));
            }
        };
        if off <= self.model.program.gamma {
            return Ok(None);
        }
        Err(Error::analysis(format!(
            "target `{}`: the {} is {:.6e} at load factor {:.6} already, beyond {}, and \
             unloading does not reduce it",
            self.target.label,
            goal.figure.key(),
            (1.0 + off) * goal.value,
            solver.at.alpha,
            exact(goal.value),
        )))
    }

    /// A warning if the figure of the target that was reached is off because it jumps there:
    /// figures of a state are not always continuous.
    pub(super) fn passed_in_a_jump(
        &self,
        monitor: Option<&Monitor>,
        solver: &mut Solver,
    ) -> Result<Option<String>> {
        let Some(monitor) = monitor.filter(|_| self.target.condition.finds_load()) else {
            return Ok(None);
        };
        let off = monitor(solver)?;
        let tolerance = self.model.program.gamma.max(MONITOR_ACCURACY);
        Ok((off.abs() > tolerance).then(|| {
            format!(
                "target `{}`: its quantity jumps past the value asked for at load factor {:.6}: it \
                 is off by {} there",
                self.target.label,
                solver.at.alpha,
                percent(off)
            )
        }))
    }

    /// Describes the quantity of the target, its present value and its target value.
    fn how_far(&self, solver: &mut Solver) -> Result<String> {
        let model = self.model;
        let (what, here, wanted) = match &self.target.condition {
            TargetCondition::Figure(goal) => {
                let here = Awaited { model, goal }.here(solver)?;
                (goal.figure.key().to_string(), here, goal.value)
            }
            TargetCondition::Displacement(goal) => {
                let off = short_of(goal, solver)?;
                let what = format!("the displacement of {}", goal.of.name);
                (what, goal.value + off, goal.value)
            }
            _ => {
                let off = self.monitor(1.0)?(solver)?;
                let width = ContactFigures::of(solver).half_width;
                ("half_width".to_string(), width, width / (1.0 + off))
            }
        };
        Ok(format!("{what} is {here:.6e} there, not {wanted:.6e}"))
    }

    /// The error of a search that has no further load factor to go to.
    pub(super) fn never_reached(&self, solver: &mut Solver) -> Error {
        let (label, alpha) = (&self.target.label, solver.at.alpha);
        match self.how_far(solver) {
            Ok(how_far) => Error::analysis(format!(
                "target `{label}` was never reached: the load factor went to {alpha:.6}, and \
                 {how_far}"
            )),
            Err(error) => error,
        }
    }

    /// The error that ended the way to the target, with the values reached.
    pub(super) fn not_reached(&self, error: Error, solver: &mut Solver) -> Error {
        let (label, alpha) = (&self.target.label, solver.at.alpha);
        match self.how_far(solver) {
            Ok(how_far) => error.within(format!(
                "target `{label}` was not reached (the last increment ended at load factor \
                 {alpha:.6}; {how_far})"
            )),
            Err(_) => error,
        }
    }
}

/// Mean displacement in the current state, less the value that a target prescribes for it.
fn short_of(goal: &DisplacementGoal, solver: &mut Solver) -> Result<f64> {
    let u = Reading::of(solver).displacements()?.total;
    let (freedoms, factors) = (&solver.structure.model.freedoms, &solver.at.factors);
    let nodes = &goal.of.nodes;
    let along = |&n: &usize| freedoms.displacement(n, &u, factors)[goal.axis];
    Ok(nodes.iter().map(along).sum::<f64>() / nodes.len() as f64 - goal.value)
}

/// Value of a monitored quantity at a slightly larger load factor, if nothing yields on the way.
fn a_little_ahead(solver: &mut Solver, monitor: &Monitor) -> Result<f64> {
    let before = solver.state();
    let alpha = before.at.alpha;
    let nearby = alpha + 1e-3 * alpha.abs().max(1.0);
    let point = solver.structure.point(nearby);
    let initial = before.equilibrium.initial.clone();
    solver.now = solver.respond(&point, initial);
    solver.at = point;
    let value = monitor(solver);
    solver.restore(&before);
    value
}
