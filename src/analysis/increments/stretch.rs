//! Stretches of an elastoplastic drive on which nothing yields: unloading and reloading.
//!
//! These stretches are followed on the dense contact matrix, event by event. The path is the same
//! as that of elastoplastic increments in which nothing yields. Initial loads are constant, so the
//! first half of a trailing solve is linear in the load factor and done once for all events. Each
//! event costs the second half of a solve and one check of all points of the zone. This check
//! suffices: between two events strains are linear in the load factor, and von Mises' stress is a
//! convex function of the strains. If both ends lie within the yield surface, so does all between.

use super::elastic::ElasticPath;
use super::outgrown::accepted;
use super::step::{Arrival, IncrementReport, MONITOR_ACCURACY, Monitor, Step, crosses, describe};
use crate::analysis::structure::load_point::LoadPoint;
use crate::analysis::structure::solver::Solver;
use crate::contact::{Change, PathEnd};
use crate::error::Result;
use crate::substructure::Trailing;
use serde::{Deserialize, Serialize};

/// A stretch on which nothing has yielded so far, between two events.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ElasticStretch {
    path: ElasticPath,
    /// Pairs that changed at the last event.
    border: Vec<usize>,
    /// Statuses beyond the last event.
    open: Vec<bool>,
    /// Eliminated loads, which are computed from the path.
    #[serde(skip)]
    loads: Option<EliminatedPath>,
}

/// Eliminated loads along a path: the first half of the trailing solves.
#[derive(Debug, Clone)]
struct EliminatedPath {
    start: Trailing,
    /// Change of the eliminated loads over the whole piece.
    change: Trailing,
}

impl EliminatedPath {
    fn new(solver: &Solver, start: &LoadPoint, end: &LoadPoint) -> Self {
        let mut forces = vec![0.0; solver.now.gap.len()];
        let mut loads = solver.structure.external(start);
        let mut change = solver.structure.external(end);
        change.add(-1.0, &loads);
        loads.add(1.0, &solver.now.initial.load);
        solver.structure.sub.eliminate(&mut loads, &mut forces);
        solver.structure.sub.eliminate(&mut change, &mut forces);
        EliminatedPath {
            start: loads,
            change,
        }
    }

    fn at(&self, t: f64) -> Trailing {
        let mut loads = self.start.clone();
        loads.add(t, &self.change);
        loads
    }
}

impl ElasticStretch {
    /// Begins a stretch on the way to `end`; `None` if no contact force acts, or if the contact
    /// path cannot begin.
    pub fn begin(solver: &mut Solver, end: &LoadPoint) -> Option<Self> {
        if solver.now.force.iter().all(|r| *r == 0.0) {
            return None;
        }
        solver.refresh();
        let border = solver.border.clone();
        let open = solver.tableau.open().to_vec();
        let Ok(path) = ElasticPath::new(solver, end) else {
            set_statuses(solver, &open, border);
            return None;
        };
        let loads = EliminatedPath::new(solver, path.start(), end);
        solver.cost.count_half();
        solver.cost.count_half();
        Some(ElasticStretch {
            path,
            border,
            open,
            loads: Some(loads),
        })
    }

    /// Goes to the next event. If no step is returned, the material yields before it, and the last
    /// event is the current state. If no stretch is returned, this was the last event of the
    /// stretch.
    ///
    /// # Errors
    /// Errors of the monitor and of [`super::outgrown::accepted`].
    pub fn step(
        mut self,
        solver: &mut Solver,
        end: &LoadPoint,
        monitor: Option<&Monitor>,
        monitored: &mut Option<f64>,
    ) -> Result<(Option<Step>, Option<Self>)> {
        let (from, solves) = (solver.at.clone(), solver.cost.counts.trailing_solves);
        let (gap, force) = (solver.now.gap.clone(), solver.now.force.clone());
        let before = self.path.t();
        let outcome = self.path.advance(solver, 1.0);
        let Some(residual) = self.elastic_residual(solver, end) else {
            solver.assume_elastic();
            (solver.at, solver.now.gap, solver.now.force) = (from, gap, force);
            set_statuses(solver, &self.open, self.border);
            return Ok((None, None));
        };
        let mut report = IncrementReport {
            event: "target".to_string(),
            iterations: 1,
            trailing_solves: solver.cost.counts.trailing_solves - solves,
            residual,
        };
        if let (Some(monitor), Some(was)) = (monitor, *monitored) {
            let is = monitor(solver)?;
            *monitored = Some(is);
            if crosses(was, is) {
                let length = (self.path.t() - before).abs().max(f64::MIN_POSITIVE);
                let accuracy = MONITOR_ACCURACY * length;
                self.path
                    .land(solver, before, [was, is], accuracy, monitor)?;
                let step = accepted(solver, from.alpha, report, Some(Arrival::Monitor))?;
                return Ok((Some(step), None));
            }
        }
        let PathEnd::Event(changes) = outcome else {
            solver.at = end.clone();
            let step = accepted(solver, from.alpha, report, Some(Arrival::End))?;
            return Ok((Some(step), None));
        };
        report.event = describe(&changes);
        self.border = changes
            .iter()
            .map(|change| match *change {
                Change::Closes(k) | Change::Opens(k) => k,
            })
            .collect();
        self.open = solver.tableau.open().to_vec();
        if self.path.turn(solver).is_err() {
            // No rates were found beyond this event: elastoplastic increments find out why.
            set_statuses(solver, &self.open, self.border);
            let step = accepted(solver, from.alpha, report, None)?;
            return Ok((Some(step), None));
        }
        self.open = solver.tableau.open().to_vec();
        if self.path.t() == 0.0 {
            // A new piece began, with other loads.
            self.loads = None;
        }
        let step = accepted(solver, from.alpha, report, None)?;
        Ok((Some(step), Some(self)))
    }

    /// Updates the displacements to the current point of the path. Returns the out-of-balance force
    /// of the stresses divided by the force scale; `None` if a point yields.
    fn elastic_residual(&mut self, solver: &mut Solver, end: &LoadPoint) -> Option<f64> {
        let start = self.path.start();
        let loads = self
            .loads
            .get_or_insert_with(|| EliminatedPath::new(solver, start, end));
        let mut u = loads.at(self.path.t());
        let delta = solver.structure.delta(&solver.at);
        let (slip, _) = solver.structure.sub.split_slip(&delta, &solver.now.gap);
        solver.structure.sub.recover(&mut u, &slip);
        solver.cost.count_half();
        solver.zone.set_factors(&solver.at.factors);
        let mut balance = solver.structure.sub.zeros();
        let evaluation = solver.zone.evaluate(&u, &mut balance);
        solver.cost.counts.plastic_iterations += 1;
        if evaluation.yielding > 0 {
            return None;
        }
        solver.now.u = u;
        solver.fresh = true;
        solver.predictor.last_step = start.step_to(end);
        solver.update_scales();
        balance.add(-1.0, &solver.now.initial.load);
        Some(balance.largest() / solver.scales.force.max(f64::MIN_POSITIVE))
    }
}

/// Gives the pairs the statuses `open`, and updates the state accordingly.
fn set_statuses(solver: &mut Solver, open: &[bool], border: Vec<usize>) {
    for (k, &open) in open.iter().enumerate() {
        if solver.tableau.open()[k] != open {
            solver.tableau.flip(k);
        }
    }
    solver.border = border;
    solver.fresh = false;
    solver.refresh();
}
