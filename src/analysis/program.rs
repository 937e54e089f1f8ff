//! The load program: first yield, then target after target.

use super::aim::Aim;
use super::between::Between;
use super::drive::{Arrival, Monitor, Stepper, stopped};
use super::engine::{Engine, LoadPoint};
use super::keeper::{Behind, Keeper, Kept, Recorder, Start};
use super::place::Place;
use super::recovery::Recovery;
use super::standing::{Seconds, Standing};
use super::zone_choice::{self, Choice};
use super::zone_fit::Spread;
use super::{check, quality, reference};
use crate::assembly::System;
use crate::error::{Error, Result};
use crate::linalg::Backend;
use crate::model::Model;
use crate::progress::Observer;
use crate::results::{Quality, Results, Sizes, State};
use crate::scene::{Target, Unit};
use std::cell::{Cell, RefCell};
use std::time::Instant;

/// Doublings of the load in search of first yield or of a target.
pub(super) const DOUBLINGS: usize = 60;
/// Lower bound of the condition from which it is estimated without being asked for: six digits of a
/// displacement may be left.
const DOUBTFUL: f64 = 1e10;
/// Choices of the zone that are tried in search of the place of first yield.
pub(super) const ZONE_ATTEMPTS: usize = 8;

pub(super) fn run(
    model: &Model,
    system: &System,
    backend: Backend,
    timings: &[(String, f64)],
    observer: &mut dyn Observer,
    yield_only: bool,
) -> Result<Results> {
    let run = Run::new(model, system, backend, timings, observer)?;
    complete(run, yield_only)
}

/// Runs to the end, or as far as it goes.
pub(super) fn complete(mut run: Run, yield_only: bool) -> Result<Results> {
    let outcome = run.execute(yield_only);
    let mut results = run.finish();
    match outcome {
        Ok(()) => {}
        Err(error) if results.states.is_empty() && results.history.is_empty() => return Err(error),
        Err(error) => {
            results.incomplete = Some(error.in_full());
            results.incomplete_kind = Some(error.kind());
        }
    }
    Ok(results)
}

pub(super) struct Run<'m, 'o> {
    pub(super) engine: Engine<'m>,
    /// Recovered stress over the zone at hand, once it was asked for.
    pub(super) recovery: Option<Recovery>,
    pub(super) choice: Choice,
    /// Quality at first yield, where that is all that is asked for.
    pub(super) at_yield: Option<Quality>,
    /// Elastic von Mises stress over yield stress of each element where first yield was last looked
    /// for; empty where the zone holds all that may yield.
    pub(super) ratios_before_yield: Vec<f64>,
    /// What the zone follows the load by.
    pub(super) spread: Option<Spread>,
    pub(super) observer: &'o mut dyn Observer,
    pub(super) results: Results,
    pub(super) standing: Standing,
    /// What the way to the next target is measured by.
    pub(super) aim: Aim,
    /// Share of the load program that lies behind, as far as it was reported: it never falls.
    pub(super) fraction: f64,
    /// The last row of the history, to see the path from there.
    pub(super) between: Between,
    /// Where the way to the target at hand began: to be gone again with a wider zone.
    pub(super) start: Option<Start>,
    /// Where the run is on its way.
    pub(super) place: Place,
    /// Where it was when it was killed, as far as that is still ahead.
    pub(super) resumed: Option<Place>,
    /// Writes checkpoints.
    pub(super) keeper: Option<Keeper>,
}

impl<'m, 'o> Run<'m, 'o> {
    pub(super) fn new(
        model: &'m Model,
        system: &'m System,
        backend: Backend,
        timings: &[(String, f64)],
        observer: &'o mut dyn Observer,
    ) -> Result<Self> {
        observer.model(model.freedoms.n, model.pairs.len());
        observer.phase("factorisation");
        let start = Instant::now();
        let within = zone_choice::first_guess(model).elements;
        let choice = zone_choice::place_of_first_yield(model);
        let engine = Engine::new(
            model,
            system,
            backend,
            &within,
            choice.elements.clone(),
            &choice.guard,
        )?;
        let mut results = Results {
            timings: timings.to_vec(),
            ..Results::default()
        };
        results.warnings.extend(model.warnings.iter().cloned());
        for warning in &model.warnings {
            observer.warning(warning);
        }
        Ok(Run {
            engine,
            recovery: None,
            choice,
            at_yield: None,
            ratios_before_yield: Vec::new(),
            spread: None,
            observer,
            results,
            standing: Standing {
                seconds: Seconds {
                    condensation: start.elapsed().as_secs_f64(),
                    ..Seconds::default()
                },
                ..Standing::default()
            },
            aim: Aim::Nothing,
            fraction: 0.0,
            between: Between::default(),
            start: None,
            place: Place::default(),
            resumed: None,
            keeper: None,
        })
    }

    pub(super) fn model(&self) -> &'m Model {
        self.engine.model
    }

    pub(super) fn execute(&mut self, yield_only: bool) -> Result<()> {
        if self.resumed.as_ref().is_none_or(|place| place.preload) {
            self.place.preload = true;
            self.preload()?;
            self.place = Place::default();
            self.resumed = None;
            if !self.prepare(yield_only)? {
                return Ok(());
            }
        }
        self.observer.phase("load program");
        let targets = &self.model().scene.program.targets;
        let labels = self.model().scene.program.labels();
        for index in self.standing.done..targets.len() {
            let state = self.reach_with_right_zone(&targets[index], &labels[index])?;
            self.standing.done = index + 1;
            self.results.states.push(state);
            self.keep_target();
        }
        Ok(())
    }

    /// First yield and the zone for the program; false where no more is wanted.
    fn prepare(&mut self, yield_only: bool) -> Result<bool> {
        let program = &self.model().scene.program;
        let required = yield_only
            || program.unit == Unit::Yield
            || program
                .targets
                .iter()
                .any(|t| t.first_yield || t.half_width.is_some());
        if !self.choice.elements.is_empty() && (required || self.largest_factor().is_some()) {
            self.observer.phase("yield load");
            let start = Instant::now();
            self.find_yield(required, yield_only)?;
            self.standing.seconds.yield_load = start.elapsed().as_secs_f64();
        }
        if yield_only {
            return match self.results.first_yield {
                Some(_) => Ok(false),
                None => Err(Error::analysis(
                    "no yield load: no body that may yield (material with a yield stress, plastic not false) yields",
                )),
            };
        }
        self.fit_zone()?;
        Ok(true)
    }

    /// Reaches a target and takes its state. The guard layer only sees what grows out of the zone:
    /// where the state shows stress beyond yield elsewhere, the zone is widened to there and the
    /// way to the target is gone again.
    pub(super) fn reach_with_right_zone(&mut self, target: &Target, label: &str) -> Result<State> {
        let begun = self.resumed.as_ref().map_or(0, |place| place.attempt);
        for attempt in begun..ZONE_ATTEMPTS {
            if self.start.is_none() {
                self.set_start();
            }
            self.place.attempt = attempt;
            self.reach(target, label)?;
            self.place = Place::default();
            self.resumed = None;
            let start = Instant::now();
            let state = self.engine.state(label, target.fields)?;
            self.standing.seconds.stresses += self.engine.stress_seconds;
            self.standing.seconds.states +=
                start.elapsed().as_secs_f64() - self.engine.stress_seconds;
            let missed = std::mem::take(&mut self.engine.beyond_yield_outside);
            let start = self.start.take();
            if missed.is_empty() {
                return Ok(state);
            }
            let start = start.ok_or_else(|| Error::internal("the way to a target has no begin"))?;
            start.saved.put_back(&mut self.engine);
            (self.standing.plastic, self.standing.yield_alpha) = (start.plastic, start.yield_alpha);
            self.results.first_yield = start.first_yield;
            self.results.history.truncate(start.increments);
            // What was searched for first yield did not hold all that yields: the way is watched
            // from its begin.
            self.standing.elastic_range = [0.0; 2];
            let wider = zone_choice::including(self.model(), &self.choice, &missed);
            self.set_zone(wider)?;
        }
        Err(Error::analysis(format!(
            "target `{label}`: the material keeps yielding outside the zone that was chosen"
        )))
    }

    /// Applies constant loads and interference, before the load factor leaves zero.
    pub(super) fn preload(&mut self) -> Result<()> {
        let start = self.engine.at.clone();
        let end = self.engine.point(0.0);
        let has_interference = self.model().pairs.iter().any(|p| p.interference != 0.0);
        if start.factors == end.factors && !has_interference {
            self.engine.at = end;
            return Ok(());
        }
        self.observer.phase("preload");
        let resumed = self.resumed.as_ref().and_then(|place| place.drive.as_ref());
        let watch_yield = resumed.is_none_or(|drive| drive.watch_yield);
        match self.drive(&end, None, watch_yield)? {
            Arrival::Yield(peak) => {
                self.record_yield(peak)?;
                self.drive(&end, None, false)?;
            }
            Arrival::Stopped => return Err(stopped()),
            _ => {}
        }
        Ok(())
    }

    /// The largest absolute load factor among the targets, if there is one.
    pub(super) fn largest_factor(&self) -> Option<f64> {
        self.model()
            .scene
            .program
            .targets
            .iter()
            .filter_map(|t| t.load_factor)
            .map(f64::abs)
            .reduce(f64::max)
    }

    /// Drives to a load point, elastic before first yield, elastoplastic after, growing the zone
    /// where it must.
    pub(super) fn drive(
        &mut self,
        end: &LoadPoint,
        monitor: Option<&Monitor>,
        watch_yield: bool,
    ) -> Result<Arrival> {
        let model = self.model();
        let program = &model.scene.program;
        let resumed = self.resumed.as_mut().and_then(|place| place.drive.take());
        let taken = Cell::new(resumed.as_ref().map_or(0, |drive| drive.taken));
        let mut leg = resumed.map(|drive| drive.leg);
        // The increments' observer is told how far the monitored quantity is, which costs a solve
        // for some.
        let last = Cell::new(f64::NAN);
        let remembering = monitor.map(|monitor| {
            let last = &last;
            move |engine: &mut Engine| {
                last.set(monitor(engine)?);
                Ok(last.get())
            }
        });
        let monitor = remembering.as_ref().map(|m| m as &Monitor);
        let mut watched = match leg {
            Some(_) => None,
            None => monitor.map(|m| m(&mut self.engine)).transpose()?,
        };
        if let (Aim::Monitored { at_first }, Some(value)) = (&mut self.aim, watched) {
            at_first.get_or_insert(value.abs());
        }
        let (aim, done, n_targets) = (
            self.aim,
            self.standing.done as f64,
            program.targets.len().max(1) as f64,
        );
        loop {
            let plastic = self.standing.plastic && !self.choice.elements.is_empty();
            if plastic && leg.is_none() {
                self.follow_load()?;
            } else if !plastic && watch_yield {
                self.recovery();
            }
            if let (Some(monitor), Some(was)) = (monitor, watched) {
                // Another zone puts the state in equilibrium anew, within the tolerance: that may
                // be all that was missing.
                let is = monitor(&mut self.engine)?;
                if is != was && (is > 0.0) != (was > 0.0) {
                    return Ok(Arrival::Monitor);
                }
            }
            let start = Instant::now();
            let observer = RefCell::new(&mut *self.observer);
            let stop = || observer.borrow().stop_requested();
            let stepper = Stepper {
                settings: &model.scene.analysis,
                stepping: program.stepping,
                steps: program.steps,
                taken: &taken,
                gamma: program.gamma,
                zone_until: self.spread.as_ref().map_or(f64::INFINITY, |s| s.until),
                stop: &stop,
            };
            let mut recorder = Recorder {
                results: &mut self.results,
                observer: &observer,
                progress: Behind {
                    fraction: &mut self.fraction,
                    aim,
                    monitored: &last,
                    done,
                    n_targets,
                },
                between: &mut self.between,
                keeper: self.keeper.as_mut(),
                kept: Kept {
                    standing: self.standing,
                    guard: &self.choice.guard,
                    spread: self.spread.as_ref(),
                    start: self.start.as_ref(),
                },
                place: &self.place,
                watch_yield,
                taken: &taken,
                since: start,
            };
            let arrival = if plastic {
                self.engine
                    .drive_plastic(end, stepper, monitor, leg.take(), &mut recorder)
            } else {
                let recovery = if watch_yield {
                    self.recovery.as_mut()
                } else {
                    None
                };
                self.engine
                    .drive_elastic(end, recovery, monitor, leg.take(), &mut recorder)
            };
            let spent = start.elapsed().as_secs_f64();
            self.standing.seconds.add_drive(plastic, spent);
            let arrival = arrival?;
            watched = monitor.map(|m| m(&mut self.engine)).transpose()?;
            match arrival {
                Arrival::ZoneTooSmall => {
                    let larger = zone_choice::grown(model, &self.choice);
                    self.set_zone(larger)?;
                }
                Arrival::ZoneOutgrown => {}
                other => return Ok(other),
            }
        }
    }

    pub(super) fn finish(mut self) -> Results {
        let model = self.engine.model;
        let mut results = std::mem::take(&mut self.results);
        results.sizes = Sizes {
            freedoms: model.freedoms.n,
            nodes: model.mesh.n_nodes(),
            elements: model.mesh.n_elements(),
            contact_pairs: model.pairs.len(),
            zone_freedoms: self.engine.sub.partition.zone.len(),
            zone_elements: self.choice.elements.len(),
            degree: model.mesh.degree(),
        };
        results.counts = self.engine.counts;
        let Standing {
            seconds,
            yield_alpha,
            ..
        } = self.standing;
        results.factor = self.engine.sub.cost();
        results.condition = self.engine.condition;
        let tolerances = quality::tolerances(model);
        let states = results.states.iter().map(|s| (s.name.as_str(), s.quality));
        let judged: Vec<(&str, Quality)> =
            states.chain(self.at_yield.map(|q| ("yield", q))).collect();
        // An elastic state is not iterated: its forces are off by what round-off leaves.
        let excused = judged.iter().filter_map(|(_, q)| q.excused(&tolerances));
        let floor = excused.fold(self.engine.round_off_floor, f64::max);
        if floor > 0.0 {
            let text = format!(
                "forces balance to their round-off, {:.1e} of the largest force, and not to analysis.tolerance = {:.1e}: displacements are \
                 large beside the strains of this mesh",
                floor, model.scene.analysis.tolerance
            );
            self.observer.warning(&text);
            results.warnings.push(text);
        }
        for (name, quality) in &judged {
            for (figure, value, most) in quality.misses(&tolerances) {
                let text = format!(
                    "state `{name}` is inaccurate: {figure} {value:.1e}, allowed {most:.1e} (condition at least {:.0e})",
                    results.condition
                );
                self.observer.warning(&text);
                results.warnings.push(text.clone());
                results.inaccurate.push(text);
            }
        }
        if model.scene.analysis.condition
            || !results.inaccurate.is_empty()
            || results.condition > DOUBTFUL
        {
            // A figure beside the results: a solve that fails leaves it out.
            let estimate = self
                .engine
                .sub
                .condition_estimate(model, self.engine.system);
            results.condition_estimate = estimate.ok();
        }
        let qualities = judged.iter().map(|(_, q)| q);
        results.quality = qualities.fold(Quality::default(), |w, q| w.worse(q));
        for (name, seconds) in [
            ("factorisation and condensation", seconds.condensation),
            ("yield load", seconds.yield_load),
            ("elastic increments", seconds.contact),
            ("elastoplastic increments", seconds.plasticity),
            ("states", seconds.states),
            ("stresses", seconds.stresses),
        ] {
            results.timings.push((name.to_string(), seconds));
        }
        results.effects = check::effects(model, yield_alpha.is_some());
        for effect in &mut results.effects {
            match effect.name.as_str() {
                "contact" => {
                    effect.seconds = seconds.contact + seconds.yield_load;
                    effect.memory_bytes = self.engine.sub.contact_bytes();
                }
                "plasticity" if effect.on => {
                    effect.seconds = seconds.plasticity;
                    effect.memory_bytes = self.engine.zone.bytes();
                }
                _ => {}
            }
        }
        results.reference = reference::rows(model, &results);
        results
    }
}
