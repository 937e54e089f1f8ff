//! The study: many settings of one scene, each run and measured, cheapest first.

use super::knobs::{Knob, Setting, settings};
use super::meter::{Forecast, Meter, Pace, forecast};
use super::quantity_study::QuantityStudy;
use super::record::StudyRun;
use super::runs::{Extent, Quiet, run};
use super::verdict::assess;
use crate::error::{ErrorKind, Result};
use crate::linalg::Backend;
use crate::progress::Observer;
use crate::results::ReferenceRow;
use crate::scene::Scene;
use serde::Serialize;
use std::time::{Duration, Instant};

/// Number of finished runs from which the remaining time is predicted: fewer show too little.
const TRUSTED: usize = 4;

/// What a study turns, on how many meshes and in what time.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The knobs to turn.
    pub knobs: Vec<Knob>,
    /// Meshes in a series.
    pub levels: usize,
    /// Seconds that the study may take, except for its cheapest run, which is always made. Runs
    /// that would not fit are left out, and a run that is under way at the end is given up.
    pub budget: Option<f64>,
}

impl Default for Plan {
    fn default() -> Self {
        Plan {
            knobs: Knob::ALL.to_vec(),
            levels: 6,
            budget: None,
        }
    }
}

/// A whole study: runs, quantities and what was left out.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Study {
    /// The runs, in the order in which they were made.
    pub runs: Vec<StudyRun>,
    /// The quantities: reference, errors, orders, prices of each.
    pub quantities: Vec<QuantityStudy>,
    /// What was left out, and why.
    pub left_out: Vec<String>,
    /// Seconds that the study took.
    pub seconds: f64,
    /// Whether the study was stopped before its end.
    pub stopped: bool,
}

/// Studies a scene. Runs that fail are kept with the reason. When the observer asks to stop, or the
/// budget is spent, the study is judged by what it has.
///
/// # Errors
/// Where the scene itself makes no model.
pub fn study(
    scene: &Scene,
    backend: Backend,
    plan: &Plan,
    observer: &mut dyn Observer,
) -> Result<Study> {
    let start = Instant::now();
    observer.phase("study: predicting the cost of each setting");
    forecast(scene, backend)?;
    let mut out = Study::default();
    let settings = settings(scene, backend, &plan.knobs, plan.levels);
    let queue = cheapest_first(settings, &mut out.left_out, observer);
    out.stopped = observer.stop_requested();
    let mut pace = Pace::default();
    let mut references: Vec<ReferenceRow> = Vec::new();
    for (i, (setting, cost)) in queue.iter().enumerate() {
        if out.stopped {
            break;
        }
        let name = format!("{}, {}", setting.series, setting.value);
        let expected = pace.seconds(cost.seconds);
        // The cheapest run is made whatever the budget: without it there would be no result at all.
        let budget = plan.budget.filter(|_| !out.runs.is_empty());
        if let Some(budget) = budget.filter(|b| start.elapsed().as_secs_f64() + expected > *b) {
            let why = format!("about {expected:.1} s, beyond the budget of {budget} s");
            out.left_out.push(format!("{name}: {why}"));
            continue;
        }
        let left = if out.runs.len() < TRUSTED {
            String::new()
        } else {
            let all = queue[i..]
                .iter()
                .map(|(_, cost)| pace.seconds(cost.seconds));
            format!(" (about {:.0} s left)", all.sum::<f64>())
        };
        let phase = format!("run {} of {}{left}: {name}", i + 1, queue.len());
        observer.phase_of(&phase, expected);
        let meter = Meter::start();
        let mut hurried = Hurried::new(observer, start, budget);
        let extent = Extent::Program;
        let found = run(
            &setting.scene,
            setting.backend,
            extent,
            &mut Quiet(&mut hurried),
        );
        let usage = meter.stop();
        let late = hurried.is_late();
        out.stopped = observer.stop_requested();
        if out.stopped {
            break;
        }
        if late && matches!(&found, Err(error) if error.kind() == ErrorKind::Stopped) {
            let why = "under way when the budget was spent";
            out.left_out.push(format!("{name}: {why}"));
            continue;
        }
        pace.learn(cost.seconds, usage.undisturbed_seconds());
        if let Ok(results) = &found
            && references.is_empty()
        {
            references.clone_from(&results.reference);
        }
        out.runs.push(StudyRun::of(setting, cost, usage, found));
    }
    out.quantities = assess(&out.runs, &references);
    out.seconds = start.elapsed().as_secs_f64();
    Ok(out)
}

/// The settings with their forecasts, ordered by time; settings without a model are left out.
fn cheapest_first(
    settings: Vec<Setting>,
    left_out: &mut Vec<String>,
    observer: &mut dyn Observer,
) -> Vec<(Setting, Forecast)> {
    let mut queue: Vec<(Setting, Forecast)> = Vec::new();
    for setting in settings {
        if observer.stop_requested() {
            break;
        }
        // Settings on the same mesh have the same forecast, and the symbolic factorisation of a
        // large mesh takes time.
        let is_alike = |(other, _): &&(Setting, Forecast)| {
            other.scene.mesh == setting.scene.mesh && other.backend == setting.backend
        };
        let known = queue
            .iter()
            .find(is_alike)
            .map(|(_, forecast)| forecast.clone());
        let found = known.map_or_else(|| forecast(&setting.scene, setting.backend), Ok);
        match found {
            Ok(forecast) => queue.push((setting, forecast)),
            Err(error) => left_out.push(format!("{}, {}: {error}", setting.series, setting.value)),
        }
    }
    queue.sort_by(|a, b| a.1.seconds.total_cmp(&b.1.seconds));
    queue
}

/// Observer that asks to stop if another observer does or if the time is over.
struct Hurried<'o> {
    observer: &'o mut dyn Observer,
    end: Option<Instant>,
}

impl<'o> Hurried<'o> {
    fn new(observer: &'o mut dyn Observer, start: Instant, seconds: Option<f64>) -> Self {
        // A time beyond the range of the clock counts as no limit.
        let end = seconds
            .and_then(|s| Duration::try_from_secs_f64(s).ok())
            .and_then(|s| start.checked_add(s));
        Hurried { observer, end }
    }

    fn is_late(&self) -> bool {
        self.end.is_some_and(|end| Instant::now() >= end)
    }
}

impl Observer for Hurried<'_> {
    fn stop_requested(&self) -> bool {
        self.observer.stop_requested() || self.is_late()
    }
}
