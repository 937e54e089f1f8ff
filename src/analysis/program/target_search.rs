//! The search for the load factor at which the quantity of a target has its value.

use super::awaited::Awaited;
use super::position::TargetSearch;
use super::run::{DOUBLINGS, Run};
use crate::analysis::increments::step::{MONITOR_ACCURACY, Monitor};
use crate::analysis::structure::solver::Solver;
use crate::error::{Error, ErrorKind, Result};
use crate::number::{exact, percent};
use crate::scene::{Direction, DisplacementTarget};
use std::rc::Rc;

impl<'m> Run<'m, '_> {
    /// Function that vanishes at the current target. It is of order 1 when measured against
    /// `scale`, so that the accuracy of the search does not depend on units.
    ///
    /// # Errors
    /// A target that cannot be measured.
    pub(super) fn monitor_of(&self, scale: f64) -> Result<Box<Monitor<'m>>> {
        let (target, label) = self.target();
        if let Some(multiple) = target.half_width {
            let at_yield = self.position.first_yield.point;
            let at_yield = at_yield.map(|y| y.half_width).filter(|b| *b > 0.0);
            let goal = at_yield
                .map(|at_yield| multiple * at_yield)
                .ok_or_else(|| {
                    Error::analysis(format!(
                        "target `{label}`: the contact half width at yield is not known"
                    ))
                })?;
            return Ok(Box::new(move |solver: &mut Solver| {
                Ok(solver.contact_figures().half_width / goal - 1.0)
            }));
        }
        if let Some(awaited) = Awaited::of(self.model(), target)? {
            return Ok(awaited.monitor(Rc::clone(&self.unloads_outside)));
        }
        let Some(goal) = &target.displacement else {
            return Err(Error::internal("a target that is not searched for"));
        };
        let DisplacementTarget { on, value, .. } = goal;
        let (value, direction) = (*value, usize::from(goal.direction == Direction::Y));
        let nodes =
            self.model().mesh.set_nodes(on).ok_or_else(|| {
                Error::input(format!("target `{label}`: the mesh has no set `{on}`"))
            })?;
        Ok(Box::new(move |solver: &mut Solver| {
            let u = solver.reading().displacements()?.total;
            let (freedoms, factors) = (&solver.structure.model.freedoms, &solver.at.factors);
            let along = |&n: &usize| freedoms.displacement(n, &u, factors)[direction];
            let mean = nodes.iter().map(along).sum::<f64>() / nodes.len() as f64;
            Ok((mean - value) / scale)
        }))
    }

    /// Value of a monitored quantity at a slightly larger load factor, if nothing yields on the
    /// way.
    pub(super) fn a_little_ahead(&mut self, monitor: &Monitor) -> Result<f64> {
        let before = self.solver.state();
        let alpha = before.at.alpha;
        let nearby = alpha + 1e-3 * alpha.abs().max(1.0);
        let point = self.solver.structure.point(nearby);
        let initial = before.equilibrium.initial.clone();
        self.solver.now = self.solver.respond(&point, initial);
        self.solver.at = point;
        let value = monitor(&mut self.solver);
        self.solver.restore(&before);
        value
    }

    /// Begins a search: from here on, the load factor moves up (doubling) or down to zero until the
    /// monitored quantity, which is `off` now, vanishes.
    pub(super) fn search(&mut self, monitor: Box<Monitor<'m>>, off: f64, upward: bool, scale: f64) {
        self.monitor = Some(monitor);
        self.position.search = Some(TargetSearch {
            end: self.solver.at.alpha,
            rounds: 0,
            upward,
            scale,
            at_first: off.abs(),
        });
    }

    /// Begins the way to the next load factor of a search.
    pub(super) fn widen_search(&mut self) -> Result<()> {
        let Some(mut search) = self.position.search else {
            return Ok(());
        };
        let begun = 0.5 * self.position.first_yield.alpha.unwrap_or(1.0);
        let next = match (search.upward, search.end > 0.0) {
            _ if search.rounds == DOUBLINGS => None,
            (true, _) => Some(2.0 * search.end.max(begun)),
            (false, true) => Some(0.0),
            (false, false) => None,
        };
        let Some(next) = next else {
            return Err(self.never_reached());
        };
        search.end = next;
        search.rounds += 1;
        self.position.search = Some(search);
        self.position.stops = self.stops(next);
        Ok(())
    }

    /// Ends the search, because the monitored quantity has vanished.
    pub(super) fn end_search(&mut self) {
        self.position.search = None;
        self.position.stops.clear();
    }

    /// Begins the search for a half width or a figure: with growing load, or with falling load if
    /// the present value is too large.
    pub(super) fn search_figure(&mut self) -> Result<()> {
        let (target, label) = self.target();
        let monitor = self.monitor_of(1.0)?;
        let off = monitor(&mut self.solver)?;
        let stays = target.figures().find(|(figure, _)| figure.stays());
        let Some((figure, value)) = stays.filter(|_| off > 0.0) else {
            self.search(monitor, off, off < 0.0, 1.0);
            return Ok(());
        };
        if off <= self.model().scene.program.gamma {
            return Ok(());
        }
        Err(Error::analysis(format!(
            "target `{label}`: the {} is {:.6e} at load factor {:.6} already, beyond {}, and no \
             load takes it back",
            figure.key(),
            (1.0 + off) * value,
            self.solver.at.alpha,
            exact(value),
        )))
    }

    /// A warning if the figure of the target that was reached is off because it jumps there:
    /// figures of a state are not always continuous.
    pub(super) fn passed_in_a_jump(&mut self) -> Result<Option<String>> {
        let (target, label) = self.target();
        let Some(monitor) = self.monitor.as_ref().filter(|_| target.finds_load()) else {
            return Ok(None);
        };
        let off = monitor(&mut self.solver)?;
        let tolerance = self.model().scene.program.gamma.max(MONITOR_ACCURACY);
        Ok((off.abs() > tolerance).then(|| {
            format!(
                "target `{label}` is passed in a jump at load factor {:.6}: what it asks for is \
                 off by {} there",
                self.solver.at.alpha,
                percent(off)
            )
        }))
    }

    /// Describes the quantity of the current target, its present value and its target value.
    fn how_far(&mut self) -> Result<String> {
        let target = self.target().0;
        let awaited = Awaited::of(self.model(), target)?;
        let (what, here, wanted) = match (awaited, &target.displacement) {
            (Some(awaited), _) => {
                let here = awaited.here(&mut self.solver)?;
                (awaited.key().to_string(), here, awaited.value)
            }
            (None, Some(goal)) => {
                let off = self.monitor_of(1.0)?(&mut self.solver)?;
                let what = format!("the displacement of {}", goal.on);
                (what, goal.value + off, goal.value)
            }
            (None, None) => {
                let off = self.monitor_of(1.0)?(&mut self.solver)?;
                let width = self.solver.contact_figures().half_width;
                ("half_width".to_string(), width, width / (1.0 + off))
            }
        };
        Ok(format!("{what} is {here:.6e} there, not {wanted:.6e}"))
    }

    fn never_reached(&mut self) -> Error {
        let (label, alpha) = (self.target().1, self.solver.at.alpha);
        match self.how_far() {
            Ok(how_far) => Error::analysis(format!(
                "target `{label}` was never reached: the load factor went to {alpha:.6}, and \
                 {how_far}"
            )),
            Err(error) => error,
        }
    }

    /// The error that ended the way to a target that is searched for, with the values reached.
    pub(super) fn not_reached(&mut self, error: Error) -> Error {
        let ends = matches!(
            error.kind(),
            ErrorKind::Collapse | ErrorKind::Outgrown | ErrorKind::Analysis
        );
        if self.position.search.is_none() || self.position.target >= self.labels.len() || !ends {
            return error;
        }
        let (label, alpha) = (self.target().1, self.solver.at.alpha);
        match self.how_far() {
            Ok(how_far) => error.within(format!(
                "target `{label}` was not reached (the last increment ended at load factor \
                 {alpha:.6}; {how_far})"
            )),
            Err(_) => error,
        }
    }
}
