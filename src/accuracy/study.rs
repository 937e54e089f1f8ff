//! The study: many settings of one scene, each run and measured, cheapest first.

use super::knobs::{Knob, Setting, settings};
use super::meter::{Forecast, Meter, Pace, PhaseMeter, forecast};
use super::record::StudyRun;
use super::runs::{Extent, run};
use super::verdict::{QuantityStudy, judge};
use crate::error::{ErrorKind, Result};
use crate::linalg::Backend;
use crate::progress::{Flow, Observer};
use crate::results::{HistoryRow, ReferenceRow};
use crate::scene::{MeshSource, Scene};
use serde::Serialize;
use std::time::{Duration, Instant};

/// Runs after which the remaining time is told: fewer say little of the machine and the scene.
const TRUSTED: usize = 4;

/// What to study.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The knobs to turn.
    pub knobs: Vec<Knob>,
    /// Meshes in a series.
    pub levels: usize,
    /// Seconds that the study may take, but for its cheapest run, which is always made: runs that
    /// would not fit are left out, one that is under way at the end is given up.
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

/// A whole study.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Study {
    /// The runs, in the order in which they were made.
    pub runs: Vec<StudyRun>,
    /// Each quantity: reference, errors, orders, prices.
    pub quantities: Vec<QuantityStudy>,
    /// What was left out, and why.
    pub left_out: Vec<String>,
    /// Seconds that the study took.
    pub seconds: f64,
    /// Whether it was stopped before its end.
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
    let mut out = Study::default();
    observer.phase("study: predicting the cost of each setting");
    forecast(scene, backend)?;
    let mut queue: Vec<(Setting, Forecast)> = Vec::new();
    let mut known: Vec<(f64, (MeshSource, Backend), Forecast)> = Vec::new();
    let all = settings(scene, backend, &plan.knobs, plan.levels);
    for setting in all {
        if observer.stop_requested() {
            break;
        }
        // Settings on one mesh have one forecast; the symbolic factorisation of a large one takes
        // its time.
        let key = (setting.scene.mesh.clone(), setting.backend);
        let found = match known.iter().find(|k| k.0 == setting.ratio && k.1 == key) {
            Some(known) => Ok(known.2),
            None => forecast(&setting.scene, setting.backend),
        };
        match found {
            Ok(forecast) => {
                known.push((setting.ratio, key, forecast));
                queue.push((setting, forecast));
            }
            Err(error) => out
                .left_out
                .push(format!("{}, {}: {error}", setting.series, setting.value)),
        }
    }
    queue.sort_by(|a, b| a.1.seconds.total_cmp(&b.1.seconds));
    let mut pace = Pace::default();
    let mut references: Vec<ReferenceRow> = Vec::new();
    let n = queue.len();
    out.stopped = observer.stop_requested();
    for i in 0..n {
        let (setting, cost) = &queue[i];
        if observer.stop_requested() {
            out.stopped = true;
            break;
        }
        let expected = pace.seconds(cost.seconds);
        let spent = start.elapsed().as_secs_f64();
        if let Some(budget) = plan.budget
            && !out.runs.is_empty()
            && spent + expected > budget
        {
            out.left_out.push(format!(
                "{}, {}: about {expected:.1} s, beyond the budget of {budget} s",
                setting.series, setting.value
            ));
            continue;
        }
        let left: f64 = queue[i..]
            .iter()
            .map(|(_, c)| pace.seconds(c.seconds))
            .sum();
        let left = match out.runs.len() < TRUSTED {
            true => String::new(),
            false => format!(" (about {left:.0} s left)"),
        };
        let name = format!(
            "run {} of {n}{left}: {}, {}",
            i + 1,
            setting.series,
            setting.value
        );
        observer.phase_of(&name, expected);
        let meter = Meter::start();
        // The cheapest run is made whatever the budget: else there would be nothing to go by.
        let budget = plan.budget.filter(|_| !out.runs.is_empty());
        let mut hurried = Hurried::new(observer, start, budget);
        let mut phases = PhaseMeter::start("assembly", &mut hurried);
        let found = run(
            &setting.scene,
            setting.backend,
            Extent::Program,
            &mut phases,
        );
        let phases = phases.stop();
        let usage = meter.stop();
        let late = hurried.is_late();
        if observer.stop_requested() {
            out.stopped = true;
            break;
        }
        if late && matches!(&found, Err(error) if error.kind() == ErrorKind::Stopped) {
            out.left_out.push(format!(
                "{}, {}: under way when the budget was spent",
                setting.series, setting.value
            ));
            continue;
        }
        pace.learn(cost.seconds, usage.undisturbed_seconds());
        if let Ok(results) = &found
            && references.is_empty()
        {
            references.clone_from(&results.reference);
        }
        out.runs.push(StudyRun {
            phases,
            ..StudyRun::of(setting, cost, usage, found)
        });
    }
    out.quantities = judge(&out.runs, &references);
    out.seconds = start.elapsed().as_secs_f64();
    Ok(out)
}

/// Passes everything on, and asks to stop when it is late.
struct Hurried<'o> {
    observer: &'o mut dyn Observer,
    end: Option<Instant>,
}

impl<'o> Hurried<'o> {
    fn new(observer: &'o mut dyn Observer, start: Instant, seconds: Option<f64>) -> Self {
        // A time beyond what the clock knows is none.
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
    fn phase(&mut self, name: &str) {
        self.observer.phase(name);
    }

    fn phase_of(&mut self, name: &str, seconds: f64) {
        self.observer.phase_of(name, seconds);
    }

    fn model(&mut self, freedoms: usize, contact_pairs: usize) {
        self.observer.model(freedoms, contact_pairs);
    }

    fn increment(&mut self, row: &HistoryRow, fraction: f64) -> Flow {
        self.observer.increment(row, fraction)
    }

    fn warning(&mut self, message: &str) {
        self.observer.warning(message);
    }

    fn stop_requested(&self) -> bool {
        self.observer.stop_requested() || self.is_late()
    }
}
