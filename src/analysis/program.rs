//! The load program: first yield, then target after target.

use super::drive::{Arrival, IncrementReport, Monitor, Saved, Stepper, stopped};
use super::engine::{Engine, Equilibrium, LoadPoint};
use super::recovery::{Peak, Recovery};
use super::zone_choice::{self, Choice};
use super::{check, reference};
use crate::assembly::System;
use crate::error::{Error, Result};
use crate::linalg::Backend;
use crate::model::Model;
use crate::progress::{Flow, Observer};
use crate::results::{HistoryRow, Quality, Results, Sizes, State, YieldPoint};
use crate::scene::{Direction, Target, Unit, YieldMethod};
use std::cell::RefCell;
use std::time::Instant;

/// Doublings of the load in search of first yield or of a target.
const DOUBLINGS: usize = 60;
/// Choices of the zone that are tried in search of the place of first yield.
const ZONE_ATTEMPTS: usize = 8;

pub(super) fn run(
    model: &Model,
    system: &System,
    backend: Backend,
    timings: &[(String, f64)],
    observer: &mut dyn Observer,
    yield_only: bool,
) -> Result<Results> {
    let mut run = Run::new(model, system, backend, timings, observer)?;
    let outcome = run.execute(yield_only);
    let mut results = run.finish();
    match outcome {
        Ok(()) => {}
        Err(error) if results.states.is_empty() && results.history.is_empty() => return Err(error),
        Err(error) => {
            results.incomplete = Some(error.message().to_string());
            results.incomplete_kind = Some(error.kind());
        }
    }
    Ok(results)
}

struct Run<'m, 'o> {
    engine: Engine<'m>,
    recovery: Option<Recovery>,
    choice: Choice,
    backend: Backend,
    observer: &'o mut dyn Observer,
    results: Results,
    /// Whether the material has yielded, so that increments are elastoplastic.
    plastic: bool,
    /// Load factor (program's unit) at first yield.
    yield_alpha: Option<f64>,
    /// Load factors (program's unit) between which the virgin structure is known to stay elastic.
    elastic_range: [f64; 2],
    /// Number of targets behind.
    done: usize,
    seconds: Seconds,
}

/// Seconds by effect.
#[derive(Default)]
struct Seconds {
    contact: f64,
    plasticity: f64,
    states: f64,
    condensation: f64,
    yield_load: f64,
}

impl<'m, 'o> Run<'m, 'o> {
    fn new(
        model: &'m Model,
        system: &'m System,
        backend: Backend,
        timings: &[(String, f64)],
        observer: &'o mut dyn Observer,
    ) -> Result<Self> {
        observer.phase("factorisation");
        let start = Instant::now();
        let choice = zone_choice::first_guess(model);
        let engine = Engine::new(
            model,
            system,
            backend,
            choice.elements.clone(),
            &choice.guard,
        )?;
        let recovery = (!choice.elements.is_empty())
            .then(|| Recovery::new(model, &choice.elements, &engine.places));
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
            recovery,
            choice,
            backend,
            observer,
            results,
            plastic: false,
            yield_alpha: None,
            elastic_range: [0.0; 2],
            done: 0,
            seconds: Seconds {
                condensation: start.elapsed().as_secs_f64(),
                ..Seconds::default()
            },
        })
    }

    fn model(&self) -> &'m Model {
        self.engine.model
    }

    fn execute(&mut self, yield_only: bool) -> Result<()> {
        let program = &self.model().scene.program;
        self.preload()?;
        let required = yield_only
            || program.unit == Unit::Yield
            || program
                .targets
                .iter()
                .any(|t| t.first_yield || t.half_width.is_some());
        if self.recovery.is_some() && (required || self.largest_factor().is_some()) {
            self.observer.phase("yield load");
            let start = Instant::now();
            self.find_yield(required)?;
            self.seconds.yield_load = start.elapsed().as_secs_f64();
        }
        if yield_only {
            return match self.results.first_yield {
                Some(_) => Ok(()),
                None => Err(Error::analysis(
                    "no yield load: no body that may yield (material with a yield stress, plastic not false) yields",
                )),
            };
        }
        self.fit_zone()?;
        self.observer.phase("load program");
        let targets = &self.model().scene.program.targets;
        let labels = self.model().scene.program.labels();
        for (index, target) in targets.iter().enumerate() {
            let state = self.reach_with_right_zone(target, &labels[index])?;
            self.done = index + 1;
            self.results.states.push(state);
        }
        Ok(())
    }

    /// Reaches a target and takes its state. The guard layer only sees what grows out of the zone: where the state shows
    /// stress beyond yield elsewhere, the zone is widened to there and the way to the target is gone again.
    fn reach_with_right_zone(&mut self, target: &Target, label: &str) -> Result<State> {
        for _ in 0..ZONE_ATTEMPTS {
            let saved = Saved::of(&self.engine);
            let (plastic, yield_alpha, first_yield) =
                (self.plastic, self.yield_alpha, self.results.first_yield);
            let increments = self.results.history.len();
            self.reach(target, label)?;
            let start = Instant::now();
            let state = self.engine.state(label, target.fields)?;
            self.seconds.states += start.elapsed().as_secs_f64();
            let missed = std::mem::take(&mut self.engine.beyond_yield_outside);
            if missed.is_empty() {
                return Ok(state);
            }
            saved.put_back(&mut self.engine);
            (self.plastic, self.yield_alpha, self.results.first_yield) =
                (plastic, yield_alpha, first_yield);
            self.results.history.truncate(increments);
            let wider = zone_choice::including(self.model(), &self.choice, &missed);
            self.rebuild(wider)?;
        }
        Err(Error::analysis(format!(
            "target `{label}`: the material keeps yielding outside the zone that was chosen"
        )))
    }

    /// Applies constant loads and interference, before the load factor leaves zero.
    fn preload(&mut self) -> Result<()> {
        let start = self.engine.at.clone();
        let end = self.engine.point(0.0);
        let has_interference = self.model().pairs.iter().any(|p| p.interference != 0.0);
        if start.factors == end.factors && !has_interference {
            self.engine.at = end;
            return Ok(());
        }
        self.observer.phase("preload");
        match self.drive(&end, None, true)? {
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
    fn largest_factor(&self) -> Option<f64> {
        self.model()
            .scene
            .program
            .targets
            .iter()
            .filter_map(|t| t.load_factor)
            .map(f64::abs)
            .reduce(f64::max)
    }

    /// Finds the yield load on the path of growing load factor and comes back to the start.
    fn find_yield(&mut self, required: bool) -> Result<()> {
        let unit_is_yield = self.model().scene.program.unit == Unit::Yield;
        if self.plastic {
            return if unit_is_yield {
                Err(Error::analysis(
                    "`unit = \"yield\"`: the preload alone makes the material yield, so there is no yield load to count in; use `unit = \"load\"`",
                ))
            } else {
                Ok(())
            };
        }
        let origin = (
            self.engine.at.clone(),
            self.engine.now.clone(),
            self.engine.tableau.open().to_vec(),
        );
        for _ in 0..ZONE_ATTEMPTS {
            let found = match self.model().scene.analysis.yield_load {
                YieldMethod::Exact => self.exact_yield(required)?,
                YieldMethod::Secant if required => {
                    let recovery = self
                        .recovery
                        .as_mut()
                        .ok_or_else(|| Error::internal("no recovery"))?;
                    Some(self.engine.secant_yield_load(recovery)?)
                }
                YieldMethod::Secant => None,
            };
            let missed = match &found {
                Some(_) => self.missed_outside()?,
                None => None,
            };
            if missed.is_none() {
                if let Some((alpha, peak)) = found {
                    self.record_yield(peak)?;
                    self.yield_alpha = Some(if unit_is_yield { 1.0 } else { alpha });
                    if unit_is_yield {
                        self.engine.unit = alpha;
                    }
                }
                self.elastic_range[1] = match (self.yield_alpha, self.largest_factor()) {
                    (Some(alpha), _) => alpha,
                    (None, Some(largest))
                        if self.model().scene.analysis.yield_load == YieldMethod::Exact =>
                    {
                        largest
                    }
                    _ => 0.0,
                };
            }
            self.come_back(&origin);
            match missed {
                None => return Ok(()),
                Some(choice) => self.rebuild(choice)?,
            }
        }
        Err(Error::analysis(
            "no yield load: the place of first yield keeps moving out of the zone that was searched",
        ))
    }

    /// Puts an elastic state back, also after the zone was chosen anew.
    fn come_back(&mut self, (at, now, open): &(LoadPoint, Equilibrium, Vec<bool>)) {
        let engine = &mut self.engine;
        engine.tableau.reset(open);
        engine.at = at.clone();
        engine.now.gap.clone_from(&now.gap);
        engine.now.force.clone_from(&now.force);
        engine.now.initial.fill(0.0);
        engine.border.clear();
        // Where nothing acts yet the displacements are zero; a body held by contact alone must not be moved to it.
        engine.fresh = now.u.largest() == 0.0;
        engine.now.u.fill(0.0);
        engine.refresh();
        self.plastic = false;
    }

    /// First yield along the path of growing load factor, up to the largest the program asks for unless yield is required.
    fn exact_yield(&mut self, required: bool) -> Result<Option<(f64, Peak)>> {
        let limit = if required {
            None
        } else {
            self.largest_factor()
        };
        let mut end = match limit {
            Some(largest) => largest,
            None => self.first_load_estimate()?,
        };
        for _ in 0..DOUBLINGS {
            for stop in self.stops(end) {
                let point = self.engine.point(stop);
                let mut quiet = |_: &mut Engine, _: &IncrementReport| Ok(true);
                if let Arrival::Yield(peak) =
                    self.engine
                        .drive_elastic(&point, self.recovery.as_mut(), None, &mut quiet)?
                {
                    return Ok(Some((self.engine.at.alpha, peak)));
                }
            }
            if limit.is_some() {
                return Ok(None);
            }
            end *= 2.0;
            if self.observer.stop_requested() {
                return Err(stopped());
            }
        }
        Err(Error::analysis(format!(
            "no yield load: the stress stays below yield up to load factor {end:.3e}; do the proportional loads press the bodies?"
        )))
    }

    /// A load factor of the size of the yield load: one contact solve at factor 1.
    fn first_load_estimate(&mut self) -> Result<f64> {
        let saved = (
            self.engine.at.clone(),
            self.engine.now.clone(),
            self.engine.tableau.open().to_vec(),
        );
        let point = self.engine.point(1.0);
        let estimate = match (self.engine.solve_contact_at(&point), self.recovery.as_mut()) {
            (Ok(()), Some(recovery)) => self.engine.peak(recovery).map(|p| p.ratio),
            _ => None,
        };
        self.engine.tableau.reset(&saved.2);
        (self.engine.at, self.engine.now, self.engine.fresh) = (saved.0, saved.1, true);
        // Stress grows at least like the cube root of the load (point contact): aim beyond, doubling goes on from there.
        Ok(estimate
            .filter(|r| r.is_finite() && *r > 0.0)
            .map_or(1.0, |r| 1.2 / r.min(r * r)))
    }

    fn record_yield(&mut self, peak: Peak) -> Result<()> {
        self.plastic = true;
        if self.results.first_yield.is_some() {
            return Ok(());
        }
        let figures = self.engine.contact_figures();
        self.results.first_yield = Some(YieldPoint {
            alpha: self.engine.at.alpha,
            load: self.engine.total_load_size(),
            max_pressure: figures.max_pressure,
            half_width: figures.half_width,
            location: peak.location,
            body: peak.body,
        });
        Ok(())
    }

    /// At first yield nothing outside the zone may be beyond yield: else the zone missed the place, and a better one is
    /// returned.
    fn missed_outside(&mut self) -> Result<Option<Choice>> {
        let u = self.engine.all_displacements()?;
        let ratios = zone_choice::stress_ratios(self.model(), &u, &self.engine.at.factors);
        let outside = (0..ratios.len())
            .filter(|e| self.choice.elements.binary_search(e).is_err())
            .map(|e| ratios[e])
            .fold(0.0, f64::max);
        Ok((outside > 1.0).then(|| zone_choice::predict(self.model(), &ratios)))
    }

    /// Chooses the zone for the program's extreme loads from the elastic stress there.
    fn fit_zone(&mut self) -> Result<()> {
        if self.recovery.is_none()
            || self.choice.guard.iter().all(|g| !g) && !self.choice.elements.is_empty()
        {
            return Ok(());
        }
        let Some(_) = self.yield_alpha else {
            // Nothing yields: the elastic path needs no zone at all.
            return Ok(());
        };
        let saved = (
            self.engine.at.clone(),
            self.engine.now.clone(),
            self.engine.tableau.open().to_vec(),
        );
        let mut ratios = vec![0.0f64; self.model().mesh.n_elements()];
        for alpha in self.extreme_factors() {
            let point = self.engine.point(alpha);
            if self.engine.solve_contact_at(&point).is_err() {
                continue;
            }
            let u = self.engine.all_displacements()?;
            for (r, new) in ratios.iter_mut().zip(zone_choice::stress_ratios(
                self.model(),
                &u,
                &self.engine.at.factors,
            )) {
                *r = r.max(new);
            }
        }
        self.engine.tableau.reset(&saved.2);
        (self.engine.at, self.engine.now, self.engine.fresh) = (saved.0, saved.1, true);
        let wanted = zone_choice::predict(self.model(), &ratios);
        // A smaller zone pays for its factorisation within a few increments; a missing part costs more.
        if !self.choice.covers(&wanted)
            || 5 * wanted.elements.len() < 3 * self.choice.elements.len()
        {
            self.rebuild(wanted)?;
        }
        Ok(())
    }

    /// Load factors between which the program moves; a target half width of m times that at yield stands for m^2.
    fn extreme_factors(&self) -> Vec<f64> {
        let at_yield = self.yield_alpha.unwrap_or(1.0);
        let mut all: Vec<f64> = Vec::new();
        for target in &self.model().scene.program.targets {
            all.extend(target.load_factor);
            all.extend(target.half_width.map(|m| m * m * at_yield));
        }
        let high = all.iter().copied().fold(at_yield, f64::max);
        let low = all.iter().copied().fold(0.0, f64::min);
        if low < 0.0 {
            vec![high, low]
        } else {
            vec![high]
        }
    }

    /// Factors the structure again with another zone; state and history are kept.
    fn rebuild(&mut self, choice: Choice) -> Result<()> {
        self.observer.phase("factorisation");
        let start = Instant::now();
        // The old factor goes before the new one comes: two at once would be the peak of memory.
        self.recovery = None;
        self.engine.sub.release()?;
        let old = &self.engine;
        let mut engine = Engine::new(
            self.model(),
            old.system,
            self.backend,
            choice.elements.clone(),
            &choice.guard,
        )?;
        engine.unit = old.unit;
        engine.force_scale = old.force_scale;
        let counts = engine.counts;
        engine.counts = old.counts;
        engine.counts.factorizations += counts.factorizations;
        engine.counts.full_solves += counts.full_solves;
        engine.counts.trailing_solves += counts.trailing_solves;
        engine.tableau.reset(old.tableau.open());
        engine.zone.take_over(&old.zone);
        engine.border = old.border.clone();
        engine.last_step = old.last_step.clone();
        engine.at = old.at.clone();
        let initial = engine.zone.initial_load(engine.sub.zeros());
        let at = engine.at.clone();
        engine.zone.set_factors(&at.factors);
        engine.now = engine.respond(&at, &initial);
        self.recovery = Some(Recovery::new(
            self.model(),
            &choice.elements,
            &engine.places,
        ));
        self.engine = engine;
        self.choice = choice;
        self.seconds.condensation += start.elapsed().as_secs_f64();
        Ok(())
    }

    /// Drives to a load point, elastic before first yield, elastoplastic after, growing the zone where it must.
    fn drive(
        &mut self,
        end: &LoadPoint,
        monitor: Option<&Monitor>,
        watch_yield: bool,
    ) -> Result<Arrival> {
        let model = self.model();
        let program = &model.scene.program;
        let fraction = self.done as f64 / program.targets.len().max(1) as f64;
        loop {
            let start = Instant::now();
            let results = &mut self.results;
            let observer = RefCell::new(&mut *self.observer);
            let stop = || observer.borrow().stop_requested();
            let stepper = Stepper {
                settings: &model.scene.analysis,
                stepping: program.stepping,
                steps: program.steps,
                gamma: program.gamma,
                stop: &stop,
            };
            let mut report = |engine: &mut Engine, increment: &IncrementReport| {
                let row = row(engine, increment, results.history.len() + 1);
                let flow = observer.borrow_mut().increment(&row, fraction);
                results.history.push(row);
                Ok(flow == Flow::Continue && !stop())
            };
            let plastic = self.plastic && !self.choice.elements.is_empty();
            let arrival = if plastic {
                self.engine
                    .drive_plastic(end, stepper, monitor, &mut report)
            } else {
                let recovery = if watch_yield {
                    self.recovery.as_mut()
                } else {
                    None
                };
                self.engine
                    .drive_elastic(end, recovery, monitor, &mut report)
            };
            let spent = start.elapsed().as_secs_f64();
            if plastic {
                self.seconds.plasticity += spent;
            } else {
                self.seconds.contact += spent;
            }
            match arrival? {
                Arrival::ZoneTooSmall => {
                    let larger = zone_choice::grown(model, &self.choice);
                    self.rebuild(larger)?;
                }
                other => return Ok(other),
            }
        }
    }

    /// Ends of the straight pieces from the current load factor to `alpha`: the kinks of the loads' histories in between.
    fn stops(&self, alpha: f64) -> Vec<f64> {
        let from = self.engine.at.alpha;
        let mut stops: Vec<f64> = self
            .model()
            .loads
            .iter()
            .flat_map(|l| l.kinks())
            .chain(self.yield_alpha.filter(|_| !self.plastic))
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

    /// Drives to a load factor along straight pieces between the kinks of the loads' histories. Wherever the path leaves what
    /// the search for the yield load went through, it is watched for first yield.
    fn drive_to_factor(&mut self, alpha: f64, monitor: Option<&Monitor>) -> Result<Arrival> {
        for stop in self.stops(alpha) {
            let end = self.engine.point(stop);
            loop {
                let [low, high] = self.elastic_range;
                let from = self.engine.at.alpha;
                let known = from.min(stop) >= low && from.max(stop) <= high;
                match self.drive(&end, monitor, !self.plastic && !known)? {
                    Arrival::End => break,
                    Arrival::Yield(peak) => {
                        self.record_yield(peak)?;
                        self.yield_alpha.get_or_insert(self.engine.at.alpha);
                    }
                    Arrival::Stopped => return Err(stopped()),
                    other => return Ok(other),
                }
            }
            if self.yield_alpha == Some(stop) {
                self.plastic = true;
            }
        }
        Ok(Arrival::End)
    }

    fn reach(&mut self, target: &Target, label: &str) -> Result<()> {
        if target.first_yield {
            let alpha = self.yield_alpha.ok_or_else(|| {
                Error::analysis(format!("target `{label}`: no yield load was found before the program's largest load factor"))
            })?;
            self.drive_to_factor(alpha, None)?;
            return Ok(());
        }
        if let Some(alpha) = target.load_factor {
            self.drive_to_factor(alpha, None)?;
            return Ok(());
        }
        if let Some(multiple) = target.half_width {
            let at_yield = self
                .results
                .first_yield
                .map(|y| y.half_width)
                .filter(|b| *b > 0.0)
                .ok_or_else(|| {
                    Error::analysis(format!(
                        "target `{label}`: the contact half width at yield is not known"
                    ))
                })?;
            let goal = multiple * at_yield;
            // Relative, so that the accuracy of the search does not depend on units.
            let monitor =
                move |engine: &mut Engine| engine.contact_figures().half_width / goal - 1.0;
            let upward = self.engine.contact_figures().half_width < goal;
            return self.search(&monitor, upward, label);
        }
        if let Some(goal) = &target.displacement {
            let nodes = self.model().mesh.set_nodes(&goal.on).ok_or_else(|| {
                Error::input(format!(
                    "target `{label}`: the mesh has no set `{}`",
                    goal.on
                ))
            })?;
            let direction = usize::from(goal.direction == Direction::Y);
            let value = goal.value;
            let distance = move |engine: &mut Engine| match engine.all_displacements() {
                Ok(u) => {
                    let sum: f64 = nodes
                        .iter()
                        .map(|&n| {
                            engine
                                .model
                                .freedoms
                                .displacement(n, &u, &engine.at.factors)[direction]
                        })
                        .sum();
                    sum / nodes.len() as f64 - value
                }
                Err(_) => f64::NAN,
            };
            let scale = value.abs().max(distance(&mut self.engine).abs());
            let monitor = move |engine: &mut Engine| {
                let off = distance(engine);
                if scale > 0.0 { off / scale } else { off }
            };
            let here = monitor(&mut self.engine);
            let ahead = {
                let alpha = self.engine.at.alpha;
                let probe = self.engine.point(alpha + 1e-3 * alpha.abs().max(1.0));
                let saved = (self.engine.at.clone(), self.engine.now.clone());
                let initial = self.engine.now.initial.clone();
                self.engine.now = self.engine.respond(&probe, &initial);
                self.engine.at = probe;
                let value = monitor(&mut self.engine);
                (self.engine.at, self.engine.now) = saved;
                value
            };
            let upward = (ahead - here) * here <= 0.0;
            return self.search(&monitor, upward, label);
        }
        Err(Error::input(format!("target `{label}` has no condition")))
    }

    /// Moves the load factor up (doubling) or down to zero until the monitored quantity vanishes.
    fn search(&mut self, monitor: &Monitor, upward: bool, label: &str) -> Result<()> {
        let mut end = self.engine.at.alpha;
        for _ in 0..DOUBLINGS {
            end = match (upward, end > 0.0) {
                (true, _) => 2.0 * end.max(0.5 * self.yield_alpha.unwrap_or(1.0)),
                (false, true) => 0.0,
                (false, false) => break,
            };
            match self.drive_to_factor(end, Some(monitor))? {
                Arrival::Monitor => return Ok(()),
                Arrival::End => {}
                _ => return Err(stopped()),
            }
        }
        let off = monitor(&mut self.engine);
        Err(Error::analysis(format!(
            "target `{label}` was never reached: the load factor went to {:.6} and the target quantity is still off by {off:.6e}",
            self.engine.at.alpha
        )))
    }

    fn finish(mut self) -> Results {
        let model = self.engine.model;
        let mut results = std::mem::take(&mut self.results);
        results.sizes = Sizes {
            freedoms: model.freedoms.n,
            nodes: model.mesh.n_nodes(),
            elements: model.mesh.n_elements(),
            contact_pairs: model.pairs.len(),
            zone_freedoms: self.engine.sub.partition.zone.len(),
            zone_elements: self.choice.elements.len(),
        };
        results.counts = self.engine.counts;
        results.factor = self.engine.sub.cost();
        results.quality = results
            .states
            .iter()
            .fold(Quality::default(), |w, s| Quality {
                backward_error: w.backward_error.max(s.quality.backward_error),
                equilibrium: w.equilibrium.max(s.quality.equilibrium),
                complementarity: w.complementarity.max(s.quality.complementarity),
                penetration: w.penetration.max(s.quality.penetration),
            });
        for (name, seconds) in [
            ("factorisation and condensation", self.seconds.condensation),
            ("yield load", self.seconds.yield_load),
            ("elastic increments", self.seconds.contact),
            ("elastoplastic increments", self.seconds.plasticity),
            ("states", self.seconds.states),
        ] {
            results.timings.push((name.to_string(), seconds));
        }
        results.effects = check::effects(model, self.yield_alpha.is_some());
        for effect in &mut results.effects {
            match effect.name.as_str() {
                "contact" => {
                    effect.seconds = self.seconds.contact + self.seconds.yield_load;
                    effect.memory_bytes = self.engine.sub.contact_bytes();
                }
                "plasticity" if effect.on => {
                    effect.seconds = self.seconds.plasticity;
                    effect.memory_bytes = self.engine.zone.bytes();
                }
                _ => {}
            }
        }
        results.reference = reference::rows(model, &results);
        results
    }
}

fn row(engine: &Engine, report: &IncrementReport, increment: usize) -> HistoryRow {
    let figures = engine.contact_figures();
    let (plastic_points, strain) = engine.zone.extent();
    HistoryRow {
        increment,
        alpha: engine.at.alpha,
        load: engine.total_load_size(),
        max_pressure: figures.max_pressure,
        half_width: figures.half_width,
        contact_force: figures.force * engine.model.symmetry,
        closed_pairs: engine.closed_pairs(),
        plastic_points,
        max_equivalent_plastic_strain: strain,
        iterations: report.iterations,
        trailing_solves: report.trailing_solves,
        residual: report.residual,
        event: report.event.clone(),
    }
}
