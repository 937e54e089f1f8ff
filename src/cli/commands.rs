//! The commands that compute: the one place where the command line calls the analysis.

use super::arguments::{Arguments, Command, CommonArguments, RunArguments};
use super::progress::Progress;
use super::restart::{self, RestartArguments};
use super::{completions, example, interrupt, new, print, report, schema, study, view};
use crate::accuracy::{self, Extent};
use crate::analysis::{self, Analysis, Check};
use crate::checkpoint::Checkpoints;
use crate::error::{Error, Result};
use crate::linalg::Backend;
use crate::model::Model;
use crate::output::{self, RunHeader};
use crate::progress::Observer;
use crate::results::Results;
use crate::scene::{Kind, Scene};
use std::path::PathBuf;
use std::time::Instant;

/// Does what the user asked for.
pub(super) fn execute(arguments: &Arguments, start: Instant) -> Result<()> {
    match &arguments.command {
        Command::Run(program) => {
            let run = &program.run;
            let out = (run.out.clone()).unwrap_or_else(|| run.common.scene.with_extension("out"));
            analyse(
                run,
                Some(&program.restart),
                Some(out),
                Extent::Program,
                start,
            )
        }
        Command::Yield(run) => analyse(run, None, run.out.clone(), Extent::Yield, start),
        Command::Check(check) => predict(&check.common),
        Command::Selftest(selftest) => super::selftest::execute(selftest),
        Command::Accuracy(arguments) => study::execute(arguments),
        Command::Example(example) => example::run(example),
        Command::New(new) => new::run(new),
        Command::Schema(schema) => schema::run(schema),
        Command::View(view) => view::run(view),
        Command::Completions(completions) => completions::run(completions),
        Command::Man => completions::man(),
    }
}

/// Scene, model, analysis, files, summary.
fn analyse(
    arguments: &RunArguments,
    restart: Option<&RestartArguments>,
    out: Option<PathBuf>,
    extent: Extent,
    start: Instant,
) -> Result<()> {
    let common = &arguments.common;
    let demand = arguments.accuracy.as_ref();
    let scene = prepare(common, demand.map(|a| format!("accuracy={a}")))?;
    if let Some(out) = &out {
        // A directory that cannot be written is better found before an hour's run than after it.
        output::check_directory(out)?;
    }
    let places = restart.zip(out.as_deref());
    let restart = places.and_then(|(restart, out)| Some((restart, restart.checkpoints(out)?)));
    if restart.is_some() && scene.accuracy.is_some() {
        return Err(restart::not_with_accuracy());
    }
    interrupt::listen(arguments.progress_is_json().then_some(start))?;
    let seconds = || start.elapsed().as_secs_f64();
    let mut progress = Progress::new(arguments.quiet, arguments.progress, start);
    let (scene, analysis, mut results) = match scene.accuracy {
        Some(_) => {
            let found = accuracy::reach(&scene, common.solver.into(), extent, &mut progress)?;
            (found.scene, found.analysis, found.results)
        }
        None => {
            let (analysis, results) =
                once(&scene, arguments, restart.as_ref(), extent, &mut progress)?;
            (scene, analysis, results)
        }
    };
    let model = analysis.model();
    let computed = seconds();
    let header = header(&scene, model, common, computed);
    if let Some(out) = &out {
        progress.start("output");
        if arguments.no_report {
            output::write_without_report(out, &header, model, &results)?;
        } else {
            output::write_with_report(out, &header, model, &results)?;
        }
        results
            .timings
            .push(("output".to_string(), seconds() - computed));
    }
    progress.finish();
    if let Some((_, checkpoints)) = &restart {
        restart::settle(checkpoints, &results)?;
    }
    let text = if common.json {
        json(&output::summary(&header, &results))?
    } else {
        report::results(&scene, &header.bodies, &results, seconds(), out.as_deref())
    };
    print(&text)?;
    output::ending(&results)
}

/// Runs the scene as it stands, and estimates the errors.
fn once(
    scene: &Scene,
    arguments: &RunArguments,
    restart: Option<&(&RestartArguments, Checkpoints)>,
    extent: Extent,
    progress: &mut Progress,
) -> Result<(Analysis, Results)> {
    let backend = arguments.common.solver.into();
    let start = Instant::now();
    progress.scene(scene);
    progress.start("mesh and model");
    let model = Model::new(scene)?;
    let modelled = start.elapsed().as_secs_f64();
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
    if !arguments.no_estimate {
        let found = accuracy::estimate(scene, backend, &results, extent, progress);
        results
            .timings
            .push(("error estimate".to_string(), found.seconds));
        results.accuracy = Some(found);
    }
    results
        .timings
        .insert(0, ("mesh and model".to_string(), modelled));
    Ok((analysis, results))
}

pub(super) fn header(
    scene: &Scene,
    model: &Model,
    common: &CommonArguments,
    wall_seconds: f64,
) -> RunHeader {
    let kind = match scene.kind {
        Kind::PlaneStrain => "plane_strain",
        Kind::PlaneStress => "plane_stress",
        Kind::Axisymmetric => "axisymmetric",
    };
    RunHeader {
        scene_title: scene.title.clone(),
        scene_file: Some(common.scene.display().to_string()),
        kind: kind.to_string(),
        solver: Backend::from(common.solver).name().to_string(),
        wall_seconds,
        bodies: model.mesh.bodies.clone(),
    }
}

/// What a run would do and cost.
fn predict(common: &CommonArguments) -> Result<()> {
    let scene = prepare(common, None)?;
    let model = Model::new(&scene)?;
    let check: Check = analysis::check(&model, common.solver.into())?;
    print(&if common.json {
        json(&check)?
    } else {
        report::check(&scene, &check)
    })
}

/// The scene with all that is put over it, `last` after the rest.
pub(super) fn prepare(common: &CommonArguments, last: Option<String>) -> Result<Scene> {
    let overrides: Vec<String> = common.overrides.iter().cloned().chain(last).collect();
    let scene = Scene::load_with(&common.scene, &overrides)?;
    start_threads(common.threads.map(usize::from))?;
    Ok(scene)
}

/// This thread becomes one of the `threads` (all processors if not said): it works on small pieces itself where it would otherwise
/// wake another one and wait.
fn start_threads(threads: Option<usize>) -> Result<()> {
    let started = rayon::ThreadPoolBuilder::new()
        .num_threads(threads.unwrap_or(0))
        .use_current_thread()
        .build_global();
    match (started, threads) {
        (Err(cause), Some(threads)) => {
            Err(Error::internal(format!("cannot start {threads} threads")).because(cause))
        }
        _ => Ok(()),
    }
}

pub(super) fn json(value: &impl serde::Serialize) -> Result<String> {
    serde_json::to_string_pretty(value)
        .map(|text| text + "\n")
        .map_err(|cause| Error::internal("the summary is not plain data").because(cause))
}
