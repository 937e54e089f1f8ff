//! The commands that compute: the only place at which the command line calls the analysis.

use super::common_arguments::CommonArguments;
use super::progress::Progress;
use super::restart::{self, RestartArguments};
use super::run_arguments::{CheckArguments, ProgramArguments, RunArguments};
use super::streams::{json, print};
use super::threads::start_threads;
use super::{interrupt, report};
use crate::accuracy::{self, Effort, Extent};
use crate::analysis::{self, Analysis, Check};
use crate::checkpoint::Checkpoints;
use crate::deck::{self, Deck, Options};
use crate::error::{Error, Result};
use crate::model::Model;
use crate::output::{self, Claim, RunHeader};
use crate::progress::Observer;
use crate::reference;
use crate::results::Results;
use crate::scene::Scene;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Runs the load program; returns the text to print and the results.
pub(super) fn run(program: &ProgramArguments, start: Instant) -> Result<(String, Results)> {
    let run = &program.run;
    let out = (run.out.clone()).unwrap_or_else(|| run.common.scene.with_extension("out"));
    let restart = Some(&program.restart);
    analyse(run, restart, Some(out), Extent::Program, start)
}

/// Does all steps of a run: scene, model, analysis, files, summary. If a run fails before it has
/// results of its own, the results of an earlier run are marked.
fn analyse(
    arguments: &RunArguments,
    restart: Option<&RestartArguments>,
    out: Option<PathBuf>,
    extent: Extent,
    start: Instant,
) -> Result<(String, Results)> {
    let common = &arguments.common;
    let demand = arguments.accuracy.as_ref();
    let without_demand =
        || Error::input("--budget is the time for an accuracy; demand one with --accuracy");
    let marked = |error: Error| {
        if out
            .as_deref()
            .is_some_and(|out| output::mark_stale(out, &error))
        {
            note_stale(arguments, out.as_deref(), start);
        }
        error
    };
    let mut scene = prepare(common, demand.map(|a| format!("accuracy={a}"))).map_err(marked)?;
    ask_for_results(&mut scene, arguments);
    if arguments.budget.is_some() && scene.accuracy.is_none() {
        return Err(marked(without_demand()));
    }
    // A directory that cannot be written is better discovered before an hour's run than after it.
    let claim = out.as_deref().map(Claim::new).transpose()?;
    let places = restart.zip(out.as_deref());
    compute(arguments, scene, places, claim, extent, start).map_err(marked)
}

/// Adds the requests for results in the formats of CalculiX that the command line asks for.
fn ask_for_results(scene: &mut Scene, arguments: &RunArguments) {
    let requests = &mut scene.requests;
    if arguments.frd.is_some() {
        requests.ask_for_usual(scene.program.targets.len());
    }
    requests.point_values |= arguments.frd.is_some() || arguments.dat.is_some();
}

/// Tells the user that the results in the directory are those of an earlier run.
fn note_stale(arguments: &RunArguments, out: Option<&Path>, start: Instant) {
    let out = out.unwrap_or(Path::new("")).display();
    let text =
        format!("the results in {out} are of an earlier run, and marked as such (stale.txt)");
    Progress::new(arguments.quiet, arguments.progress, start).note(&text);
}

/// Computes and writes the results; returns the text to print and the results.
fn compute(
    arguments: &RunArguments,
    scene: Scene,
    places: Option<(&RestartArguments, &Path)>,
    claim: Option<Claim>,
    extent: Extent,
    start: Instant,
) -> Result<(String, Results)> {
    let common = &arguments.common;
    let restart = places.and_then(|(restart, out)| Some((restart, restart.checkpoints(out)?)));
    if restart.is_some() && scene.accuracy.is_some() {
        return Err(restart::not_with_accuracy());
    }
    let json_since = arguments.progress_is_json().then_some(start);
    interrupt::listen(json_since, at_once(claim.as_ref()))?;
    let seconds = || start.elapsed().as_secs_f64();
    let mut progress = Progress::new(arguments.quiet, arguments.progress, start);
    let mut laps = Laps { last: start };
    let before = laps.next();
    let (scene, analysis, mut results) = match scene.accuracy {
        Some(_) => {
            let (backend, budget) = (common.solver.into(), arguments.budget);
            let mut found = accuracy::reach(&scene, backend, extent, budget, &mut progress)?;
            let timings = &mut found.results.timings;
            let of_last: f64 = timings.iter().map(|(_, seconds)| seconds).sum();
            timings.push(("other meshes".to_string(), laps.next() - of_last));
            (found.scene, found.analysis, found.results)
        }
        None => {
            let restart = restart.as_ref();
            let (analysis, results) =
                once(&scene, arguments, restart, extent, &mut progress, &mut laps)?;
            (scene, analysis, results)
        }
    };
    let model = analysis.model();
    results.timings.insert(0, ("scene".to_string(), before));
    let computed = seconds();
    let header = header(model, common, computed);
    let out = claim.as_ref().map(|claim| claim.dir().to_path_buf());
    if let Some(claim) = claim {
        progress.start("output");
        if arguments.no_report {
            claim.write_without_report(&header, model, &results)?;
        } else {
            claim.write_with_report(&header, model, &results)?;
        }
    }
    if let Some(path) = &arguments.dat {
        output::write_dat(path, model, &results)?;
    }
    if let Some(path) = &arguments.frd {
        output::write_frd(path, model, &results)?;
    }
    progress.finish();
    if let Some((_, out)) = places {
        restart::settle(out, &results)?;
    }
    let total = seconds();
    results
        .timings
        .push(("output".to_string(), total - computed));
    let text = if common.json {
        json(&output::summary(&header, &results))?
    } else {
        report::results(&scene, &header, &results, total, out.as_deref())
    };
    Ok((text, results))
}

/// A clock that is read once between two rows of the time table, so that the rows add up to the
/// whole.
struct Laps {
    last: Instant,
}

impl Laps {
    /// Returns the seconds since the clock was last read.
    fn next(&mut self) -> f64 {
        let now = Instant::now();
        let last = std::mem::replace(&mut self.last, now);
        now.duration_since(last).as_secs_f64()
    }
}

/// Returns the action before a second signal ends the program: the temporary directory is removed.
pub(super) fn at_once(claim: Option<&Claim>) -> impl Fn() + Send + Sync + 'static {
    let temporary = claim.and_then(Claim::temporary).map(Path::to_path_buf);
    move || {
        if let Some(temporary) = &temporary {
            let _ = std::fs::remove_dir_all(temporary);
        }
    }
}

/// Runs the scene with its own mesh and settings, and estimates the errors.
fn once(
    scene: &Scene,
    arguments: &RunArguments,
    restart: Option<&(&RestartArguments, Checkpoints)>,
    extent: Extent,
    progress: &mut Progress,
    laps: &mut Laps,
) -> Result<(Analysis, Results)> {
    let backend = arguments.common.solver.into();
    progress.scene(scene);
    progress.start("mesh and model");
    let model = Model::new(scene)?;
    let modelled = laps.next();
    progress.model(model.freedoms.n, model.pairs.len());
    progress.start("assembly");
    let mut analysis = Analysis::new(model, backend)?;
    let mut results = match (extent, restart) {
        (Extent::Program, None) => analysis.run(progress)?,
        (Extent::Program, Some((restart, checkpoints))) => {
            restart.run(&mut analysis, checkpoints, progress)?
        }
        (Extent::Yield, _) => analysis.yield_load(progress)?,
    };
    // The table has rows for the times of the run itself already.
    laps.next();
    reference::compare(analysis.model(), &mut results);
    results
        .timings
        .push(("references".to_string(), laps.next()));
    let effort = arguments.estimate.effort();
    if effort != Effort::None {
        let found = accuracy::estimate(scene, backend, &results, extent, effort, progress);
        results
            .timings
            .push(("error estimate".to_string(), laps.next()));
        results.accuracy = Some(found);
    }
    results
        .timings
        .insert(0, ("mesh and model".to_string(), modelled));
    Ok((analysis, results))
}

pub(super) fn header(model: &Model, common: &CommonArguments, wall_seconds: f64) -> RunHeader {
    RunHeader {
        scene_file: Some(common.scene.display().to_string()),
        ..RunHeader::new(model, common.solver.into(), wall_seconds)
    }
}

/// Computes the yield load only; returns the text to print and the results.
pub(super) fn yield_load(run: &RunArguments, start: Instant) -> Result<(String, Results)> {
    analyse(run, None, run.out.clone(), Extent::Yield, start)
}

/// Prints what a run would do and cost.
pub(super) fn check(arguments: &CheckArguments) -> Result<()> {
    let common = &arguments.common;
    if deck::is_deck(&common.scene) && !common.json {
        print(&super::deck::account(&Deck::read(&common.scene)?))?;
    }
    let scene = prepare(common, None)?;
    let model = Model::new(&scene)?;
    let mut check: Check = analysis::check(&model, common.solver.into())?;
    check.error_estimate = accuracy::planned(&scene, check.sizes.elements, Effort::default());
    print(&if common.json {
        json(&check)?
    } else {
        report::check(&scene, &check, arguments.effects)
    })?;
    match check.fits() {
        Some(false) => Err(Error::input(format!(
            "{}: use a coarser mesh, a smaller zone or a machine with more memory, or raise the \
             limit of this process (ulimit -v)",
            report::fit(&check)
        ))),
        _ => Ok(()),
    }
}

/// Reads the scene with all overrides applied; `last` is applied after the others.
pub(super) fn prepare(common: &CommonArguments, last: Option<String>) -> Result<Scene> {
    let overrides: Vec<String> = common.overrides.iter().cloned().chain(last).collect();
    let options = Options {
        small_strain: common.small_strain,
        ..Options::default()
    };
    let scene = deck::load_with(&common.scene, &overrides, options)?;
    start_threads(common.threads.map(usize::from))?;
    Ok(scene)
}
