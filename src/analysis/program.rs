//! The load program: first yield, then target after target.

use super::drive::{Arrival, IncrementReport, Monitor, Saved, Stepper, stopped};
use super::engine::{Engine, LoadPoint};
use super::recovery::Recovery;
use super::zone_choice::{self, Choice};
use super::zone_fit::Spread;
use super::{check, quality, reference};
use crate::assembly::System;
use crate::error::{Error, Result};
use crate::linalg::Backend;
use crate::model::Model;
use crate::progress::{Flow, Observer};
use crate::results::{HistoryRow, Quality, Results, Sizes, State};
use crate::scene::{Target, Unit};
use std::cell::{Cell, RefCell};
use std::time::Instant;

/// Doublings of the load in search of first yield or of a target.
pub(super) const DOUBLINGS: usize = 60;
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

pub(super) struct Run<'m, 'o> {
    pub(super) engine: Engine<'m>,
    /// Recovered stress over the zone at hand, once it was asked for.
    pub(super) recovery: Option<Recovery>,
    pub(super) choice: Choice,
    /// What the zone follows the load by.
    pub(super) spread: Option<Spread>,
    pub(super) observer: &'o mut dyn Observer,
    pub(super) results: Results,
    /// Whether the material has yielded, so that increments are elastoplastic.
    pub(super) plastic: bool,
    /// Load factor (program's unit) at first yield.
    pub(super) yield_alpha: Option<f64>,
    /// Load factors (program's unit) between which the virgin structure is known to stay elastic.
    pub(super) elastic_range: [f64; 2],
    /// Number of targets behind.
    pub(super) done: usize,
    /// What the way to the next target is measured by.
    pub(super) aim: Aim,
    /// Share of the load program that lies behind, as far as it was reported: it never falls.
    pub(super) fraction: f64,
    pub(super) seconds: Seconds,
}

/// What the way to a target is measured by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Aim {
    /// There is no target yet.
    Nothing,
    /// From one load factor to another.
    Factor { from: f64, to: f64 },
    /// A monitored quantity is to vanish; its size at the beginning, once it is known.
    Monitored { at_first: Option<f64> },
}

impl Aim {
    /// Share of the way that lies behind, at a load factor and a value of the monitored quantity.
    fn share(self, alpha: f64, monitored: f64) -> f64 {
        let share = match self {
            Aim::Factor { from, to } if from != to => (alpha - from) / (to - from),
            Aim::Factor { .. } => 1.0,
            Aim::Monitored {
                at_first: Some(first),
            } if first > 0.0 => 1.0 - monitored.abs() / first,
            _ => 0.0,
        };
        if share.is_finite() {
            share.clamp(0.0, 1.0)
        } else {
            0.0
        }
    }
}

/// Seconds by effect.
#[derive(Default)]
pub(super) struct Seconds {
    pub(super) contact: f64,
    pub(super) plasticity: f64,
    pub(super) states: f64,
    pub(super) condensation: f64,
    pub(super) yield_load: f64,
}

impl<'m, 'o> Run<'m, 'o> {
    pub(super) fn new(
        model: &'m Model,
        system: &'m System,
        backend: Backend,
        timings: &[(String, f64)],
        observer: &'o mut dyn Observer,
    ) -> Result<Self> {
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
            spread: None,
            observer,
            results,
            plastic: false,
            yield_alpha: None,
            elastic_range: [0.0; 2],
            done: 0,
            aim: Aim::Nothing,
            fraction: 0.0,
            seconds: Seconds {
                condensation: start.elapsed().as_secs_f64(),
                ..Seconds::default()
            },
        })
    }

    pub(super) fn model(&self) -> &'m Model {
        self.engine.model
    }

    pub(super) fn execute(&mut self, yield_only: bool) -> Result<()> {
        let program = &self.model().scene.program;
        self.preload()?;
        let required = yield_only
            || program.unit == Unit::Yield
            || program
                .targets
                .iter()
                .any(|t| t.first_yield || t.half_width.is_some());
        if !self.choice.elements.is_empty() && (required || self.largest_factor().is_some()) {
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
    pub(super) fn reach_with_right_zone(&mut self, target: &Target, label: &str) -> Result<State> {
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

    /// Drives to a load point, elastic before first yield, elastoplastic after, growing the zone where it must.
    pub(super) fn drive(
        &mut self,
        end: &LoadPoint,
        monitor: Option<&Monitor>,
        watch_yield: bool,
    ) -> Result<Arrival> {
        let model = self.model();
        let program = &model.scene.program;
        let taken = Cell::new(0);
        // The increments' observer is told how far the monitored quantity is, which costs a solve for some.
        let last = Cell::new(f64::NAN);
        let remembering = monitor.map(|monitor| {
            let last = &last;
            move |engine: &mut Engine| {
                last.set(monitor(engine));
                last.get()
            }
        });
        let monitor = remembering.as_ref().map(|m| m as &Monitor);
        let mut watched = monitor.map(|m| m(&mut self.engine));
        if let (Aim::Monitored { at_first }, Some(value)) = (&mut self.aim, watched) {
            at_first.get_or_insert(value.abs());
        }
        let (aim, done, n_targets) = (
            self.aim,
            self.done as f64,
            program.targets.len().max(1) as f64,
        );
        loop {
            let plastic = self.plastic && !self.choice.elements.is_empty();
            if plastic {
                self.follow_load()?;
            } else if watch_yield {
                self.recovery();
            }
            if let (Some(monitor), Some(was)) = (monitor, watched) {
                // Another zone puts the state in equilibrium anew, within the tolerance: that may be all that was missing.
                let is = monitor(&mut self.engine);
                if is != was && (is > 0.0) != (was > 0.0) {
                    return Ok(Arrival::Monitor);
                }
            }
            let start = Instant::now();
            let results = &mut self.results;
            let fraction = &mut self.fraction;
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
            let mut report = |engine: &mut Engine, increment: &IncrementReport| {
                let row = row(engine, increment, results.history.len() + 1);
                let share = aim.share(row.alpha, last.get());
                *fraction = fraction.max((done + share) / n_targets);
                let flow = observer.borrow_mut().increment(&row, *fraction);
                results.history.push(row);
                Ok(flow == Flow::Continue && !stop())
            };
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
            let arrival = arrival?;
            watched = monitor.map(|m| m(&mut self.engine));
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
        };
        results.counts = self.engine.counts;
        results.factor = self.engine.sub.cost();
        results.condition = self.engine.sub.condition();
        let tolerances = quality::tolerances(model);
        for state in &results.states {
            for (figure, value, most) in state.quality.misses(&tolerances) {
                let text = format!(
                    "state `{}` is inaccurate: {figure} {value:.1e}, allowed {most:.1e} (condition at least {:.0e})",
                    state.name, results.condition
                );
                self.observer.warning(&text);
                results.warnings.push(text.clone());
                results.inaccurate.push(text);
            }
        }
        results.quality = results
            .states
            .iter()
            .fold(Quality::default(), |w, s| Quality {
                backward_error: w.backward_error.max(s.quality.backward_error),
                equilibrium: w.equilibrium.max(s.quality.equilibrium),
                complementarity: w.complementarity.max(s.quality.complementarity),
                penetration: w.penetration.max(s.quality.penetration),
                adhesion: w.adhesion.max(s.quality.adhesion),
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

#[cfg(test)]
mod tests {
    use super::Aim;

    #[test]
    fn the_share_of_the_way_runs_from_0_to_1_and_is_a_number_whatever_comes() {
        let up = Aim::Factor { from: 1.0, to: 3.0 };
        assert_eq!(
            [1.0, 2.0, 3.0].map(|alpha| up.share(alpha, f64::NAN)),
            [0.0, 0.5, 1.0]
        );
        let down = Aim::Factor { from: 2.0, to: 0.0 };
        assert_eq!(down.share(0.5, 0.0), 0.75);
        let monitored = Aim::Monitored {
            at_first: Some(0.5),
        };
        assert_eq!(
            [0.5, -0.25, 0.0, 9.0].map(|m| monitored.share(1.0, m)),
            [0.0, 0.5, 1.0, 0.0]
        );
        for aim in [
            Aim::Nothing,
            Aim::Monitored { at_first: None },
            up,
            monitored,
        ] {
            let share = aim.share(f64::NAN, f64::NAN);
            assert!((0.0..=1.0).contains(&share), "{aim:?}: {share}");
        }
        assert_eq!(Aim::Factor { from: 1.0, to: 1.0 }.share(1.0, 0.0), 1.0);
    }
}
