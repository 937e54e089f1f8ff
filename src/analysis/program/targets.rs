//! Targets: from the current load factor to the next state that the program asks for.

use super::position::{FirstYield, Start, share_of_way};
use super::run::{Run, ZONE_ATTEMPTS};
use super::stopwatch::TimeRow;
use crate::analysis::check::seconds::gaps_are_alike;
use crate::analysis::choice::zone_choice;
use crate::analysis::figures::reading::Reading;
use crate::analysis::increments::step::Arrival;
use crate::analysis::stress::recovery::Watched;
use crate::error::{Error, ErrorKind, Result};
use crate::model::{Magnitude, Model, TargetCondition};
use crate::results;
use crate::scene::{Kind, Stepping, Unit};

impl Run<'_, '_> {
    /// Begins the way to the next target.
    pub(super) fn begin_target(&mut self) -> Result<()> {
        self.set_start();
        let goal = self.goal();
        if goal.target.condition == TargetCondition::FirstYield {
            let alpha = self.position.first_yield.alpha.ok_or_else(|| {
                Error::analysis(format!(
                    "target `{}`: no yield load was found before the program's largest load factor",
                    goal.target.label
                ))
            })?;
            self.position.stops = self.stops(alpha);
        } else if let Some(alpha) = goal.target.load_factor() {
            self.position.stops = self.stops(alpha);
        } else if let Some((monitor, search)) = goal.search(&mut self.solver)? {
            self.monitor = Some(monitor);
            self.position.search = Some(search);
        }
        Ok(())
    }

    /// Begins the way to the next load factor of a search.
    pub(super) fn widen_search(&mut self) -> Result<()> {
        let begun = 0.5 * self.position.first_yield.alpha.unwrap_or(1.0);
        let Some(search) = &mut self.position.search else {
            return Ok(());
        };
        if !search.widen(begun) {
            return Err(self.goal().never_reached(&mut self.solver));
        }
        let next = search.end;
        self.position.stops = self.stops(next);
        Ok(())
    }

    /// Ends the search, because the monitored quantity has vanished.
    pub(super) fn end_search(&mut self) {
        self.position.search = None;
        self.position.stops.clear();
    }

    /// The error that ended the way to a target, with the values reached if the target is searched
    /// for.
    pub(super) fn not_reached(&mut self, error: Error) -> Error {
        let ends = matches!(
            error.kind(),
            ErrorKind::Collapse | ErrorKind::Outgrown | ErrorKind::Analysis
        );
        let is_target = self.position.target < self.targets.n_of_program();
        if self.position.search.is_none() || !is_target || !ends {
            return error;
        }
        self.goal().not_reached(error, &mut self.solver)
    }

    /// Begins the next cycle after the last target of a cycle. Returns whether there is a next
    /// cycle.
    pub(super) fn begin_cycle(&mut self) -> bool {
        let (structure, zone) = (&self.solver.structure, &self.solver.zone);
        let program = &structure.model.program;
        let follows = self.position.cycles.begin_next(
            (program.cycles, program.steady),
            structure.model.start.as_ref(),
            &structure.elements,
            || zone.history(),
        );
        if follows {
            self.position.target = 0;
        }
        follows
    }

    /// Stores the state at the start of the way to a target.
    pub(super) fn set_start(&mut self) {
        self.start = Some(Start {
            state: self.solver.state(),
            first_yield: self.position.first_yield,
            rows: self.results.history.len(),
        });
        if let Some(checkpoints) = &mut self.checkpoints {
            checkpoints.forget_start();
        }
    }

    /// Takes the state at a target that was reached. The guard layer sees only yielding that grows
    /// out of the zone. If the state shows stress beyond yield elsewhere, the zone is widened to
    /// include it, and the way to the target is repeated. The way is also repeated, with a larger
    /// zone, if unloading yields outside the zone. It is repeated, too, if the state is elastic by
    /// the recovered stress and a Gauss point is beyond yield: from then on, the Gauss points are
    /// watched.
    pub(super) fn finish_target(&mut self) -> Result<Option<results::State>> {
        let goal = self.goal();
        let target = goal.target;
        let label = &target.label;
        let mut figures = self.timed(TimeRow::States, |run| {
            let figures = Reading::of(&mut run.solver).figures(label, target.fields)?;
            let seconds = &mut run.position.seconds;
            seconds.hand_over(figures.stress_seconds, TimeRow::Stresses);
            Ok::<_, Error>(figures)
        })?;
        if target.load_factor().is_some() {
            let state = &mut figures.state;
            [state.load_is_given, state.approach_is_given] = given_by_factor(self.model());
        }
        let passed = goal.passed_in_a_jump(self.monitor.as_deref(), &mut self.solver)?;
        self.monitor = None;
        let unloads_outside = std::mem::take(&mut self.unloads_outside).take();
        let missed = figures.beyond_yield_outside;
        let start = self.start.take();
        let first_yield = &self.position.first_yield;
        let watched = match !first_yield.is_behind && figures.beyond_yield_inside {
            true => Watched::GaussPoints,
            false => first_yield.watched,
        };
        if missed.is_empty() && watched == first_yield.watched && !unloads_outside {
            self.warn(passed);
            self.position.target += 1;
            self.position.attempt = 0;
            let (model, of) = (self.solver.structure.model, &mut self.position.deformation);
            of.take(&model.mesh, label, &figures.deformation);
            let is_last = self.position.cycles.is_last(model.program.cycles);
            return Ok(is_last.then_some(figures.state));
        }
        let start = start.ok_or_else(|| Error::internal("the way to a target has no start"))?;
        self.position.attempt += 1;
        self.solver.restore(&start.state);
        self.results.history.truncate(start.rows);
        // The zone searched for first yield did not hold all elements that yield: the way is
        // watched from its start.
        self.position.first_yield = FirstYield {
            elastic_range: [0.0; 2],
            watched,
            ..start.first_yield
        };
        if self.position.attempt == ZONE_ATTEMPTS {
            return Err(Error::analysis(format!(
                "target `{label}`: the material keeps yielding outside the zone that was chosen"
            )));
        }
        if unloads_outside {
            let larger = zone_choice::grown(self.model(), &self.zone.choice);
            self.set_zone(larger)?;
        } else if !missed.is_empty() {
            let wider = zone_choice::including(self.model(), &self.zone.choice, &missed);
            self.set_zone(wider)?;
        }
        Ok(None)
    }

    /// Ends of the straight pieces from the current load factor to `alpha`: the kinks of the loads'
    /// histories in between, the load factor at first yield if it lies ahead on the way, and
    /// `alpha`.
    pub(super) fn stops(&self, alpha: f64) -> Vec<f64> {
        let from = self.solver.at.alpha;
        let first_yield = &self.position.first_yield;
        let mut stops: Vec<f64> = self
            .model()
            .kinks()
            .chain(first_yield.alpha.filter(|_| !first_yield.is_behind))
            .filter(|k| (*k - from) * (alpha - *k) > 0.0)
            .collect();
        stops.sort_by(|a, b| a.total_cmp(b));
        if alpha < from {
            stops.reverse();
        }
        stops.dedup();
        stops.push(alpha);
        stops
    }

    /// Fraction, from 0 to 1, of the way to the current target that has been covered.
    pub(super) fn share_behind(&self, arrival: Option<Arrival>) -> f64 {
        let Some(start) = &self.start else {
            return 0.0;
        };
        if arrival == Some(Arrival::Monitor) {
            return 1.0;
        }
        let (drive, stops) = (&self.position.drive, &self.position.stops);
        match (&self.position.search, stops.last()) {
            (Some(search), _) => {
                let monitored = drive.as_ref().and_then(|drive| drive.monitored());
                search.share_behind(monitored.unwrap_or(f64::NAN))
            }
            (None, Some(&to)) => {
                let power = changes_by_load(self.model());
                share_of_way(self.solver.at.alpha, start.state.at.alpha, to, power)
            }
            (None, None) => 1.0,
        }
    }
}

/// Whether the reported load follows from the load factor alone, and whether the approach does:
/// without the yield load and without the response of the bodies.
fn given_by_factor(model: &Model) -> [bool; 2] {
    let is_known = model.program.unit != Unit::Yield;
    let leading = model.leading_load();
    let measures = leading.map(|leading| model.loads[leading].measures);
    let of_load = |of: Magnitude| match of {
        Magnitude::Displacement | Magnitude::Gap => false,
        Magnitude::Force
        | Magnitude::Stress
        | Magnitude::Temperature
        | Magnitude::Strain
        | Magnitude::Carried => true,
    };
    [
        is_known && measures.is_some_and(of_load),
        is_known && measures == Some(Magnitude::Displacement),
    ]
}

/// Power of the load over which increments are spread evenly. If increments end at changes of
/// contact and the contact grows pair by pair, it is the power with which the width of Hertz's
/// contact grows; in solids, where contacts are lines or patches, the power of a line.
fn changes_by_load(model: &Model) -> f64 {
    let mut contacts = model.contacts.iter().map(|c| &model.pairs[c.range.clone()]);
    let grows =
        model.program.stepping != Stepping::Steps && contacts.any(|pairs| !gaps_are_alike(pairs));
    match (grows, model.kind) {
        (false, _) => 1.0,
        (true, Kind::Axisymmetric) => 1.0 / 3.0,
        (true, _) => 0.5,
    }
}
