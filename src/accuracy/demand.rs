//! `accuracy = "1 %"`: the scene on finer and finer meshes of its family until the stated errors
//! are within the demand.
//!
//! The sequence begins with elements [`COARSEST`] times as large as the scene's. Each mesh is
//! judged by the [`MESHES`] last meshes, itself included, as any run is judged by its companions
//! ([`super::estimate()`]); the earlier runs are not repeated. The order of convergence that the
//! meshes show decides how much finer the next mesh has to be. If a mesh as fine as the scene's own
//! leaves a contact unresolved, the sequence begins anew with meshes that are refined around this
//! contact ([`super::graded`]). The sequence ends when every quantity asked for is within its
//! demand, judged by meshes whose element sizes span a ratio of [`SPAN`]. Otherwise it ends with
//! the reason for not going on: a quantity that has no limit under refinement, memory, time, or a
//! failed run. The values reported are those of the last mesh that was run to its end.

use super::companions::{Level, member};
use super::effort::{Effort, work_of_finer};
use super::estimate::{Judged, assess};
use super::extrapolation::LEAST_ORDER;
use super::graded;
use super::meter::work;
use super::outcome::{Outcome, PATH};
use super::path::with_error_over;
use super::quantities::quantities;
use super::runs::{Extent, Runs, analyse};
use crate::analysis::Analysis;
use crate::error::{Error, ErrorKind, Result};
use crate::linalg::Backend;
use crate::mesh::generate::Family;
use crate::model::Model;
use crate::number::{duration, significant};
use crate::progress::Observer;
use crate::results::{Demand, Incomplete, Results};
use crate::scene::{AccuracyDemand, Scene};
use std::collections::BTreeMap;
use std::time::Instant;

/// Element size of the first mesh over that of the scene's mesh. The first mesh has a thirtieth of
/// the elements in the plane and takes almost no time.
const COARSEST: f64 = 6.0;
/// Least and largest ratio of the element sizes of neighbouring meshes, and (`STEP`) the ratio if
/// nothing is known. The runs of a plane sequence in steps of [`STEP`] together take 1.6 times the
/// last run, whose mesh is at most 1.4 times finer than needed.
const STEPS: [f64; 2] = [1.2, 1.5];
const STEP: f64 = 1.4;
/// Number of meshes by which the last one is judged, itself included: four or more show the
/// scatter.
const MESHES: usize = 5;
/// Least ratio of the element sizes that these meshes span before a demand counts as reached, since
/// near meshes agree by chance. Three in steps of [`STEP`] span 1.96, apart from rounding.
const SPAN: f64 = 1.9;
/// Most times that the increments are made finer: an error that more increments do not reduce has
/// another source.
const MORE_STEPS: usize = 3;
/// Most contacts around which meshes are refined.
const MOST_PLACES: usize = 4;
/// Ratio of element sizes over which the error of a quantity hardly falls before the quantity
/// counts as having no limit.
const WITHOUT_LIMIT: f64 = 3.0;

/// A run that was made to a demand.
pub struct Reached {
    /// The scene with the mesh and steps that were chosen.
    pub scene: Scene,
    /// The analysis, with the model and the mesh.
    pub analysis: Analysis,
    /// The results with their errors.
    pub results: Results,
}

/// Runs a scene to its demanded accuracy, or as near to it as `budget` seconds allow.
///
/// # Errors
/// `Input` if the scene demands no accuracy, if its mesh cannot be refined, or if it has none of
/// the quantities that the demand names; errors of the runs if no mesh can be run to its end. A
/// demand that was not reached is no error: [`Demand::reason`] gives the reason.
pub fn reach(
    scene: &Scene,
    backend: Backend,
    extent: Extent,
    budget: Option<f64>,
    observer: &mut dyn Observer,
) -> Result<Reached> {
    let Some(demand) = scene.accuracy.clone() else {
        return Err(Error::input("the scene demands no accuracy"));
    };
    let mut pursuit = Pursuit {
        demand,
        base: scene.clone(),
        backend,
        extent,
        budget: budget.unwrap_or(f64::INFINITY),
        places_left: MOST_PLACES,
        start: Instant::now(),
        runs: Runs::new(backend, extent),
        sequence: Vec::new(),
        choices: Vec::new(),
        slow: BTreeMap::new(),
        more_steps: 0,
        work: 0.0,
    };
    pursuit.run(observer)
}

/// The pursuit of a demand from mesh to mesh.
struct Pursuit {
    demand: AccuracyDemand,
    /// The scene, with the increments that were found to be needed for the error of the path.
    base: Scene,
    backend: Backend,
    extent: Extent,
    budget: f64,
    /// Number of further contacts around which meshes may be refined.
    places_left: usize,
    start: Instant,
    runs: Runs,
    /// Element size of each mesh so far, over that of the scene's mesh, and the seconds of its run.
    sequence: Vec<(f64, f64)>,
    choices: Vec<String>,
    /// Quantities beyond their demand, each with the element size and the stated error from which
    /// on its error hardly fell.
    slow: BTreeMap<String, (f64, f64)>,
    more_steps: usize,
    work: f64,
}

/// A mesh that was run, with its errors compared with the demand.
struct MeshRun {
    reached: Reached,
    outcome: Outcome,
}

/// The step that follows a mesh.
enum Next {
    Within,
    Finer(f64),
    Graded(Box<Scene>),
    ShorterPath(Box<Scene>, String),
    Never(String),
}

impl Pursuit {
    fn run(&mut self, observer: &mut dyn Observer) -> Result<Reached> {
        let mut last: Option<MeshRun> = None;
        let mut wanted = COARSEST;
        loop {
            let level = match self.next_level(wanted) {
                Ok(level) => level,
                Err(why) => return self.end(last, why),
            };
            if let (Some(why), true) = (self.beyond_budget(level.ratio), last.is_some()) {
                return self.end(last, why);
            }
            let (ratio, words) = (level.ratio, level.scene.mesh.words());
            let begun = Instant::now();
            let ran = self.run_on(level, observer);
            let why = match &ran {
                Ok(reached) => (reached.results.incomplete.as_ref()).map(|i| i.why.clone()),
                Err(error) => Some(error.to_string()),
            };
            if let Some(why) = why {
                let stopped = observer.stop_requested();
                let why = format!("{words}: {why}");
                return match (ran, last) {
                    (_, Some(last)) if stopped => self.stopped(last),
                    (_, Some(last)) => self.end(Some(last), why),
                    // A mesh may be too coarse to be run to its end.
                    _ if ratio > 1.0 && !stopped => {
                        self.choices.push(why);
                        (last, wanted) = (None, ratio / STEP);
                        continue;
                    }
                    (Ok(reached), None) => self.end(Some(MeshRun::unjudged(reached)), why),
                    (Err(error), None) => Err(error),
                };
            }
            let mesh = self.judged(ran?, ratio, begun.elapsed().as_secs_f64(), observer)?;
            let next = match self.graded(&mesh, ratio, observer) {
                Some(next) => next,
                None => self.after(&mesh.outcome, ratio, &mesh.reached.results),
            };
            if observer.stop_requested() {
                return self.stopped(mesh);
            }
            last = Some(mesh);
            wanted = match next {
                Next::Within => return self.end(last, String::new()),
                Next::Never(why) => return self.end(last, why),
                Next::Finer(by) => ratio / by,
                Next::Graded(base) => {
                    self.base = *base;
                    self.sequence.clear();
                    self.slow.clear();
                    COARSEST
                }
                Next::ShorterPath(base, words) => {
                    let why = "longer ones leave too much of the error";
                    self.choices.push(format!("{words}: {why}"));
                    self.base = *base;
                    self.sequence.pop();
                    ratio
                }
            };
        }
    }

    /// Runs the scene on a mesh.
    fn run_on(&self, level: Level, observer: &mut dyn Observer) -> Result<Reached> {
        let demand = String::from(self.demand.clone());
        let words = level.scene.mesh.words();
        observer.phase(&format!("accuracy {demand}: {words}"));
        let model = Model::new(&level.scene)?;
        let (analysis, results) = analyse(model, self.backend, self.extent, observer)?;
        Ok(Reached {
            scene: level.scene,
            analysis,
            results,
        })
    }

    /// Estimates the errors of a mesh from the meshes before it.
    fn judged(
        &mut self,
        mut reached: Reached,
        ratio: f64,
        seconds: f64,
        observer: &mut dyn Observer,
    ) -> Result<MeshRun> {
        let Reached { scene, results, .. } = &mut reached;
        self.work += work(results);
        self.runs.keep(scene, results, seconds);
        let levels = self.levels_before(ratio);
        self.sequence.push((ratio, seconds));
        let judged = Judged {
            scene,
            results,
            extent: self.extent,
            effort: Effort::Quick,
        };
        let found = assess(&judged, levels, &mut self.runs, observer);
        self.work += found.work;
        let outcome = Outcome::of(&self.demand, results, &found);
        if outcome.is_of_nothing {
            return Err(self.no_such_quantity(results));
        }
        let (words, seconds) = (scene.mesh.words(), duration(seconds));
        let stated = outcome.words();
        self.choices
            .push(format!("{words}: stated error {stated} in {seconds}"));
        results.accuracy = Some(found);
        Ok(MeshRun { reached, outcome })
    }

    /// Returns the member of the family that is nearest to the wanted size and finer than the last.
    fn next_level(&self, wanted: f64) -> std::result::Result<Level, String> {
        let is_new = |level: &Level| match self.sequence.last() {
            Some((last, _)) => last / level.ratio >= STEPS[0] - 1e-9,
            None => true,
        };
        let mut why = "the mesh of this scene has no finer members".to_string();
        let mut ratio = wanted;
        // The search ends at half the wanted size, or at half the scene's own if that is smaller.
        while ratio > 0.49 * wanted.min(1.0) {
            match member(&self.base, ratio) {
                Ok(level) if is_new(&level) => return Ok(level),
                Ok(_) => {}
                Err(error) => why = error,
            }
            ratio /= 1.1;
        }
        Err(format!("`accuracy`: the mesh cannot be refined: {why}"))
    }

    /// Returns the meshes before one of this element size, by which that mesh is judged.
    fn levels_before(&self, ratio: f64) -> Vec<Level> {
        let before = self.sequence.iter().rev().take(MESHES - 1);
        let levels = before.filter_map(|(other, _)| member(&self.base, *other).ok());
        levels
            .map(|level| Level {
                ratio: level.ratio / ratio,
                ..level
            })
            .collect()
    }

    /// Returns the reason why a mesh of this element size would take too long, if it would.
    fn beyond_budget(&self, ratio: f64) -> Option<String> {
        let (last, seconds) = self.sequence.last()?;
        let expected = seconds * work_of_finer(self.base.kind, last / ratio);
        let left = self.budget - self.start.elapsed().as_secs_f64();
        (expected > left).then(|| {
            format!(
                "the next mesh would take about {}, and {} of the budget are left",
                duration(expected),
                duration(left.max(0.0))
            )
        })
    }

    /// Refines the scene's mesh around a contact, if a mesh as fine as the scene's own leaves this
    /// contact unresolved and demanded figures are therefore unknown.
    fn graded(&mut self, mesh: &MeshRun, ratio: f64, observer: &mut dyn Observer) -> Option<Next> {
        if ratio > 1.0 || mesh.outcome.unknown.is_empty() || self.places_left == 0 {
            return None;
        }
        let run = (&mesh.reached.scene, &mesh.reached.results);
        let (start, budget) = (self.start, self.budget);
        let in_time = || start.elapsed().as_secs_f64() < budget;
        let asked = (self.backend, self.extent);
        let found = graded::resolving(run, asked, (in_time, &mut self.work), observer);
        // If smaller elements did not resolve a contact once, later meshes do not try again.
        self.places_left = found.as_ref().map_or(0, |_| self.places_left - 1);
        let found = found?;
        let [x, y, radius] = [found.at[0], found.at[1], found.radius].map(|c| significant(c, 3));
        self.choices.push(format!(
            "elements divided {} times within {radius} of ({x}, {y}): one or two pairs carried the \
             contact there",
            found.times
        ));
        Some(Next::Graded(Box::new(graded::with(&self.base, found))))
    }

    /// Decides on the step that follows a mesh.
    fn after(&mut self, outcome: &Outcome, ratio: f64, results: &Results) -> Next {
        let sizes = self
            .sequence
            .iter()
            .rev()
            .take(MESHES)
            .map(|(other, _)| *other);
        let span = sizes.fold(0.0, f64::max) / ratio;
        let is_judged = self.sequence.len() > 2 && span >= SPAN;
        if is_judged && outcome.is_within() {
            return Next::Within;
        }
        if let Some(path) = self.without_limit(outcome, ratio, is_judged) {
            return Next::Never(format!(
                "{path} has no limit under refinement, or converges too slowly for any mesh that \
                 can be afforded; name the quantities that you need, as in accuracy = \"load = 1 \
                 %\", or round the corner, spread the force that makes it"
            ));
        }
        if is_judged && outcome.algebra > 1.0 {
            return Next::Never(
                "the round-off of the algebra alone leaves more than that".to_string(),
            );
        }
        if is_judged && outcome.path > PATH[0].max(outcome.mesh) && self.more_steps < MORE_STEPS {
            self.more_steps += 1;
            let (base, words) = with_error_over(&self.base, results, outcome.path / PATH[1]);
            return Next::ShorterPath(Box::new(base), words);
        }
        let by = if is_judged { outcome.finer } else { STEP };
        Next::Finer(by.clamp(STEPS[0], STEPS[1]))
    }

    /// Returns a quantity without a limit: its meshes show no order of at least [`LEAST_ORDER`],
    /// and over a ratio of element sizes of [`WITHOUT_LIMIT`] its stated error fell more slowly
    /// than with that order.
    fn without_limit(&mut self, outcome: &Outcome, ratio: f64, is_judged: bool) -> Option<String> {
        let mut slow = BTreeMap::new();
        for missed in outcome.missed.iter().filter(|_| is_judged) {
            let is_slow = |(size, error): &&(f64, f64)| {
                let enough = error * (ratio / size).powf(LEAST_ORDER);
                missed.order < Some(LEAST_ORDER) && missed.relative > enough
            };
            let before = self.slow.get(&missed.path).filter(is_slow).copied();
            let since = before.unwrap_or((ratio, missed.relative));
            slow.insert(missed.path.clone(), since);
        }
        self.slow = slow;
        let mut all = self.slow.iter();
        let found = all.find(|(_, (size, _))| size / ratio >= WITHOUT_LIMIT);
        found.map(|(path, _)| path.clone())
    }

    fn no_such_quantity(&self, results: &Results) -> Error {
        let all = quantities(results).into_iter();
        let all: Vec<String> = (all.filter(|quantity| !quantity.is_of_part()))
            .map(|quantity| quantity.path)
            .collect();
        Error::input(format!(
            "`accuracy` demands nothing that this scene has ({}); its quantities are {}",
            String::from(self.demand.clone()),
            all.join(", ")
        ))
    }

    /// Ends with the last mesh that was run to its end, because the user asked to stop.
    fn stopped(&mut self, mut last: MeshRun) -> Result<Reached> {
        let why = "stopped on the way to the demanded accuracy";
        let results = &mut last.reached.results;
        results.incomplete = Some(Incomplete {
            kind: ErrorKind::Stopped,
            why: format!("{why}; the results are those of the last mesh"),
        });
        self.end(Some(last), why.to_string())
    }

    /// Ends with the last mesh. The demand was reached if the reason `why` is empty.
    fn end(&mut self, last: Option<MeshRun>, why: String) -> Result<Reached> {
        let Some(MeshRun {
            mut reached,
            outcome,
        }) = last
        else {
            return Err(Error::input(why));
        };
        let accuracy = reached.results.accuracy.get_or_insert_default();
        accuracy.demand = Some(Demand {
            accuracy: self.demand.tightest(),
            demanded: String::from(self.demand.clone()),
            reached: why.is_empty(),
            reason: (!why.is_empty()).then_some(why),
            unknown: outcome.unknown,
            stated: outcome.stated,
            worst: outcome.worst,
            choices: std::mem::take(&mut self.choices),
            work: self.work,
        });
        Ok(reached)
    }
}

impl MeshRun {
    /// Builds the record of a mesh whose run ended before its load program did: nothing is known of
    /// the errors.
    fn unjudged(reached: Reached) -> Self {
        let outcome = Outcome {
            stated: f64::NAN,
            ..Outcome::default()
        };
        MeshRun { reached, outcome }
    }
}
