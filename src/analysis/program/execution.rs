//! The load program: preload, first yield, then target after target.
//!
//! The program is a sequence of steps over a [`super::position::Position`] and the state of the
//! structure. A step ends at the next accepted increment or at a target. A checkpoint holds the
//! position and the state between two steps.

use super::assembled::Analysis;
use super::first_yield::YieldSearch;
use super::position::{Purpose, Stage};
use super::run::Run;
use super::stopwatch::TimeRow;
use crate::analysis::choice::zone_choice;
use crate::analysis::choice::zone_fit::{Expected, ZoneFit};
use crate::analysis::figures::measure::{ContactFigures, total_load_size};
use crate::analysis::increments::drive::Drive;
use crate::analysis::increments::elastic::ElasticDrive;
use crate::analysis::increments::plastic::PlasticDrive;
use crate::analysis::increments::step::{Arrival, IncrementReport, Rules, Step, stopped};
use crate::analysis::structure::load_point::LoadPoint;
use crate::analysis::structure::solver::Solver;
use crate::analysis::structure::starting;
use crate::error::{Error, Result};
use crate::progress::{Flow, Observer};
use crate::results::{HistoryRow, Results, State};
use crate::scene::Stepping;
use std::ops::ControlFlow;
use std::time::Instant;

/// Result of a step of the program.
pub(super) enum ProgramEvent {
    /// An increment was accepted: the next row of the history.
    Increment(HistoryRow),
    /// A target was reached.
    Target(Box<State>),
}

impl<'m, 'o> Run<'m, 'o> {
    /// Sets up a run at its start.
    ///
    /// # Errors
    /// Errors of [`Solver::new`].
    pub(in crate::analysis) fn new(
        analysis: &'m Analysis,
        purpose: Purpose,
        expected: Option<Expected>,
        observer: &'o mut dyn Observer,
    ) -> Result<Self> {
        let model = &analysis.model;
        observer.model(model.freedoms.n, model.pairs.len());
        observer.phase("factorisation");
        let start = Instant::now();
        let (within, choice) = match &expected {
            Some(expected) => {
                let choice = zone_choice::predict(model, &expected.ratios);
                (choice.elements.clone(), choice)
            }
            None => {
                let within = zone_choice::first_guess(model).elements;
                (within, zone_choice::place_of_first_yield(model))
            }
        };
        let (system, elements) = (&analysis.system, choice.elements.clone());
        let solver = Solver::new(
            model,
            system,
            analysis.backend,
            &within,
            elements,
            &choice.guard,
        )?;
        let results = Results {
            timings: analysis.timings.clone(),
            warnings: model.warnings.clone(),
            bodies: model.mesh.bodies.clone(),
            ..Results::default()
        };
        for warning in &model.warnings {
            observer.warning(warning);
        }
        let mut run = Run::of(solver, ZoneFit::new(choice), results, observer);
        run.purpose = purpose;
        let seconds = &mut run.position.seconds;
        let found_since = expected.as_ref().map_or(start, |expected| expected.since);
        *seconds = seconds.running_since(found_since);
        seconds.hand_over((start - found_since).as_secs_f64(), TimeRow::Zone);
        run.zone.expected = expected.map(|expected| expected.ratios);
        run.follow_sets();
        run.begin()?;
        Ok(run)
    }

    /// Goes through the program, event by event, and writes a checkpoint whenever one is due.
    ///
    /// # Errors
    /// Errors of [`Run::next`]; [`stopped`] if the observer asks for that.
    pub(super) fn execute(&mut self) -> Result<()> {
        match self.position.stage {
            Stage::Preload { .. } if !self.position.stops.is_empty() => {
                self.observer.phase("preload");
            }
            Stage::Targets => self.observer.phase("load program"),
            _ => {}
        }
        self.position.seconds.switch(TimeRow::History);
        while let Some(event) = self.next()? {
            let increments = usize::from(matches!(event, ProgramEvent::Increment(_)));
            let goes_on = self.record(event);
            self.timed(TimeRow::Checkpoints, |run| {
                run.write_checkpoint(increments, !goes_on)
            });
            if !goes_on {
                return Err(stopped());
            }
        }
        Ok(())
    }

    /// Writes a checkpoint if one is due.
    fn write_checkpoint(&mut self, new_increments: usize, stopping: bool) {
        let Some(writer) = &mut self.checkpoints else {
            return;
        };
        if writer.is_due(new_increments, stopping) {
            let (start, reported) = (self.start.as_ref(), (&self.results, &self.path));
            let outcome = writer.write(&self.solver, &self.zone, &self.position, start, reported);
            let warning = writer.note(outcome);
            self.warn(warning);
        }
    }

    /// Goes to the next event; `None` at the end of the program.
    ///
    /// # Errors
    /// A load without equilibrium, an iteration that did not converge, a target that is out of
    /// reach.
    pub(super) fn next(&mut self) -> Result<Option<ProgramEvent>> {
        loop {
            if let Some(&stop) = self.position.stops.first() {
                let advanced = self.within_bound().and_then(|()| self.advance(stop));
                if let Some(row) = advanced.map_err(|error| self.not_reached(error))? {
                    return Ok(Some(ProgramEvent::Increment(row)));
                }
            } else if self.position.search.is_some() {
                self.widen_search()?;
            } else if self.start.is_some() {
                if let Some(state) = self.finish_target()? {
                    return Ok(Some(ProgramEvent::Target(Box::new(state))));
                }
            } else {
                match self.position.stage {
                    Stage::Preload { again } => self.prepare(again)?,
                    Stage::Targets if self.position.target < self.targets.end => {
                        self.begin_target()?;
                    }
                    Stage::Targets if self.targets.end < self.targets.n_of_program() => {
                        return Ok(None);
                    }
                    Stage::Targets => {
                        if !self.begin_cycle() {
                            return Ok(None);
                        }
                    }
                    Stage::YieldOnly => return Ok(None),
                }
            }
        }
    }

    /// Checks that another increment may be taken.
    ///
    /// # Errors
    /// `Analysis` if the run has taken `program.max_increments`, with a report on what it has
    /// reached.
    fn within_bound(&self) -> Result<()> {
        let program = &self.model().program;
        let taken = self.results.history.len();
        if taken < program.max_increments {
            return Ok(());
        }
        let shorter = match program.stepping {
            Stepping::Auto => format!("a larger program.path_error (now {:e})", program.path_error),
            Stepping::Events => "program.stepping = \"auto\" or \"steps\"".to_string(),
            Stepping::Steps => format!("fewer program.steps (now {})", program.steps),
        };
        Err(Error::analysis(format!(
            "the run has taken program.max_increments = {taken}: the last increment ended at load \
             factor {:.6}, {} of {} targets were reached{}. Raise program.max_increments, or ask \
             for fewer increments by {shorter}",
            self.solver.at.alpha,
            self.position.target,
            self.targets.n_of_program(),
            match self.position.cycles.n_done() {
                0 => String::new(),
                done => format!(" in cycle {}", done + 1),
            },
        )))
    }

    /// Records an event in the results; an increment is also passed to the observer. Returns
    /// whether the run continues.
    fn record(&mut self, event: ProgramEvent) -> bool {
        let row = match event {
            ProgramEvent::Increment(row) => row,
            ProgramEvent::Target(mut state) => {
                state.increments = self.results.history.len();
                self.results.states.push(*state);
                return true;
            }
        };
        let flow = self.observer.increment(&row, self.position.fraction);
        // Rows may have been taken back since the last increment.
        let (path, rows) = (&mut self.results.path, self.results.history.len());
        while path.last().is_some_and(|point| point.increment > rows) {
            path.pop();
        }
        path.extend(self.path.advance(&self.solver, &row));
        self.results.history.push(row);
        flow == Flow::Continue && !self.observer.stop_requested()
    }

    /// Takes the next step on the straight piece to a load factor. Returns the row of the
    /// increment, if there was one.
    fn advance(&mut self, stop: f64) -> Result<Option<HistoryRow>> {
        let end = self.solver.structure.point(stop);
        let plastic = self.increments_are_plastic();
        if plastic
            && self.position.drive.is_none()
            && self.timed(TimeRow::Zone, |run| run.follow_load())?
        {
            self.end_search();
            return Ok(None);
        }
        let effect = if plastic {
            TimeRow::Plasticity
        } else {
            TimeRow::Contact
        };
        let Step { increment, arrival } =
            self.timed(effect, |run| match run.position.drive.take() {
                Some(drive) => run.step(drive, &end),
                None => run.begin_drive(&end),
            })?;
        let mut row = increment.map(|report| self.row(&report));
        if let (Some(row), Some(gauges)) = (&mut row, &self.gauges) {
            row.measured = gauges.read(&mut self.solver)?;
        }
        if row.is_some() {
            let cycle = self.targets.n_of_program().max(1) as f64;
            let cycles = self.model().program.cycles as f64;
            let reached = self.position.target as f64 + self.share_behind(arrival);
            let behind = (self.position.cycles.n_done() as f64 + reached / cycle) / cycles;
            self.position.fraction = self.position.fraction.max(behind);
        }
        if let Some(arrival) = arrival {
            self.arrive(stop, arrival)?;
        }
        Ok(row)
    }

    /// Lets the zone follow the load. Returns whether the monitored quantity vanished by the change
    /// of the zone.
    fn follow_load(&mut self) -> Result<bool> {
        let until = &mut self.position.zone_until;
        match self.zone.for_load(&self.solver, until) {
            Some(choice) => self.change_zone(choice),
            None => Ok(false),
        }
    }

    /// Whether the material has yielded, and may yield in this run.
    fn increments_are_plastic(&self) -> bool {
        self.position.first_yield.is_behind && !self.zone.choice.elements.is_empty()
    }

    /// Begins the drive to the end of a straight piece. The drive is watched for first yield as
    /// soon as it leaves the range of load factors that the search for the yield load covered.
    fn begin_drive(&mut self, end: &LoadPoint) -> Result<Step> {
        let begun = if self.increments_are_plastic() {
            let (taken, monitor) = (self.position.taken, self.monitor.as_deref());
            PlasticDrive::begin(&mut self.solver, end, taken, monitor)?.map_continue(Drive::Plastic)
        } else {
            let first_yield = &self.position.first_yield;
            let known = self.position.stage == Stage::Targets
                && first_yield.excludes(self.solver.at.alpha, end.alpha);
            let watches_yield = !first_yield.is_behind && !known;
            let recovery = if watches_yield {
                self.zone
                    .recovery(&self.solver, self.position.first_yield.watched)
            } else {
                None
            };
            ElasticDrive::begin(&mut self.solver, end, recovery, self.monitor.as_deref())?
                .map_continue(|drive| Drive::Elastic(Box::new(drive)))
        };
        match begun {
            ControlFlow::Break(step) => Ok(step),
            ControlFlow::Continue(drive) => {
                self.position.drive = Some(drive);
                Ok(Step::default())
            }
        }
    }

    /// Takes the next step of a drive.
    fn step(&mut self, mut drive: Drive, end: &LoadPoint) -> Result<Step> {
        let model = self.solver.structure.model;
        let observer = &*self.observer;
        let rules = Rules {
            settings: &model.settings,
            program: &model.program,
            zone_until: match self.zone.spread {
                Some(_) => self.position.zone_until,
                None => f64::INFINITY,
            },
            stop: &|| observer.stop_requested(),
        };
        let recovery = match drive.watches_yield() {
            true => self
                .zone
                .recovery(&self.solver, self.position.first_yield.watched),
            false => None,
        };
        let monitor = self.monitor.as_deref();
        let step = drive.step(&mut self.solver, end, recovery, monitor, rules)?;
        self.position.drive = Some(drive);
        Ok(step)
    }

    /// Updates the position after the end of a drive to the load factor `stop`.
    fn arrive(&mut self, stop: f64, arrival: Arrival) -> Result<()> {
        let drive = self.position.drive.take();
        let taken = std::mem::take(&mut self.position.taken);
        match arrival {
            Arrival::End => {
                self.position.stops.remove(0);
                let first_yield = &mut self.position.first_yield;
                first_yield.is_behind |= first_yield.alpha == Some(stop);
            }
            Arrival::Monitor => self.end_search(),
            Arrival::Yield(peak) => {
                self.position.first_yield.record(&self.solver, peak);
                if self.position.stage == Stage::Targets {
                    let alpha = self.solver.at.alpha;
                    self.position.first_yield.alpha.get_or_insert(alpha);
                }
            }
            Arrival::ZoneTooSmall | Arrival::ZoneOutgrown => {
                self.position.taken = drive.map_or(taken, |drive| drive.taken());
                if arrival == Arrival::ZoneTooSmall {
                    let larger = zone_choice::grown(self.model(), &self.zone.choice);
                    if self.change_zone(larger)? {
                        self.end_search();
                    }
                }
            }
        }
        Ok(())
    }

    /// The history row of an accepted increment.
    fn row(&self, report: &IncrementReport) -> HistoryRow {
        let solver = &self.solver;
        let figures = ContactFigures::of(solver);
        let (plastic_points, strain) = solver.zone.extent();
        HistoryRow {
            increment: self.results.history.len() + 1,
            alpha: solver.at.alpha,
            load: total_load_size(solver),
            max_pressure: figures.max_pressure,
            half_width: figures.half_width,
            contact_force: figures.force * solver.structure.model.symmetry,
            closed_pairs: solver.closed_pairs(),
            plastic_points,
            max_equivalent_plastic_strain: strain,
            iterations: report.iterations,
            trailing_solves: report.trailing_solves,
            residual: report.residual,
            event: report.event.clone(),
            measured: Vec::new(),
        }
    }

    /// Puts the structure into the state in which the program begins: no loads, and the plastic
    /// strains that an earlier run left in the material.
    fn begin(&mut self) -> Result<()> {
        starting::begin(&mut self.solver)?;
        self.position.first_yield.is_behind |= self.model().start.is_some();
        self.begin_preload();
        Ok(())
    }

    /// Applies constant loads and interference before the load factor leaves zero.
    fn begin_preload(&mut self) {
        let end = self.solver.structure.point(0.0);
        let has_interference = self.model().pairs.iter().any(|p| p.interference != 0.0)
            && end.interference_share > 0.0;
        let loads = self.model().loads.iter();
        let mut factors = loads.zip(self.solver.at.factors.iter().zip(&end.factors));
        let is_loaded = factors.any(|(load, (here, there))| load.acts() && here != there);
        if !is_loaded && !has_interference {
            self.solver.at = end;
        } else {
            self.position.stops = vec![0.0];
        }
    }

    /// Finds first yield and the zone of the program after the preload. The preload is applied
    /// again if the material turns out to yield under it although this was not noticed.
    fn prepare(&mut self, again: bool) -> Result<()> {
        let required =
            self.purpose == Purpose::YieldLoad || self.model().program.needs_first_yield();
        if again && !self.position.first_yield.is_behind {
            return Err(Error::internal(
                "the material yields under the preload, and does not when that is applied anew",
            ));
        }
        if !self.zone.choice.elements.is_empty()
            && (required || self.targets.largest_factor().is_some())
        {
            self.observer.phase("yield load");
            let under_preload = self.timed(TimeRow::YieldLoad, |run| {
                YieldSearch { run, required }.find()
            })?;
            if under_preload {
                self.results.history.clear();
                self.position.stage = Stage::Preload { again: true };
                self.observer.phase("preload");
                return self.begin();
            }
        }
        if self.purpose != Purpose::Program {
            self.position.stage = Stage::YieldOnly;
            return match self.position.first_yield.point {
                None if self.purpose == Purpose::Zone => Ok(()),
                Some(_) => Ok(()),
                None if self.model().start.is_some() => Err(Error::analysis(
                    "no yield load: the material has yielded in the run that this one starts \
                     from",
                )),
                None => Err(Error::analysis(
                    "no yield load: no body that may yield (material with a yield stress, plastic \
                     not false) yields",
                )),
            };
        }
        // If nothing yields, the elastic path needs no zone.
        if let Some(at_yield) = self.position.first_yield.alpha {
            self.timed(TimeRow::Zone, |run| {
                let (zone, targets) = (&mut run.zone, &run.targets);
                let choice = zone.for_program(&mut run.solver, targets, at_yield)?;
                choice.map_or(Ok(()), |choice| run.set_zone(choice))
            })?;
        }
        self.observer.phase("load program");
        self.position.stage = Stage::Targets;
        Ok(())
    }
}
