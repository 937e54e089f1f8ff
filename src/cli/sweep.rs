//! `brinell sweep`: the same scene with other values of some keys, run in separate processes.

mod arguments;
mod cost;
mod demand;
mod points;
mod worker;

pub(super) use arguments::SweepArguments;
pub(super) use worker::Ended;

use super::interrupt;
use super::streams::{json, print};
use super::table::{ColumnAlignment, Table, page_width};
use crate::deck::{self, Options};
use crate::error::{Error, ErrorKind, Result};
use crate::files;
use crate::number::{number, seconds};
use crate::output::sweep::{Sweep, SweepOutcome, SweepPoint, folder};
use crate::scene::Field;
use clap::ValueEnum;
use points::{Points, Shard};
use std::collections::BTreeSet;
use std::io::Write;
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::time::Instant;
use worker::{Worker, ask_to_stop, lock};
use xxhash_rust::xxh3::xxh3_128;

/// Runs the points that are not finished yet, writes table and charts, and prints the table.
pub(super) fn execute(arguments: &SweepArguments) -> Result<()> {
    let common = &arguments.common;
    let dir = (arguments.out.clone()).unwrap_or_else(|| common.scene.with_extension("sweep"));
    let asked = Points::new(arguments.points.as_deref(), &arguments.vary, arguments.zip)?;
    let keys = asked.keys;
    // An error in any point is found before the first one runs.
    let points = asked.values.into_iter();
    let points: Result<Vec<SweepPoint>> = points.map(|v| point(arguments, &keys, v)).collect();
    let mut points = points?;
    tell_apart(&mut points);
    if let Some(shard) = arguments.shard {
        let mut own = (0..points.len()).map(|k| shard.has(k));
        points.retain(|_| own.next().unwrap_or(false));
    }
    let shard = arguments.shard.map(Shard::numbers);
    let mut sweep = Sweep::new(&dir, keys, points, shard)?;
    if arguments.check {
        return cost::predict(arguments, &sweep);
    }
    std::fs::create_dir_all(&dir).map_err(|cause| Error::io("make", &dir, cause))?;
    if shard.is_some() {
        // The record tells other shares that the directory belongs to a sweep.
        sweep.record(&dir)?;
    }
    let running: Arc<Mutex<Vec<u32>>> = Arc::default();
    let at_once = Arc::clone(&running);
    interrupt::listen(None, move || stop(&at_once))?;
    let work = SweepRuns {
        arguments,
        dir: &dir,
        order: demand::order(&sweep.points),
        running: &running,
        sweep: Mutex::new(&mut sweep),
        next: Mutex::new(0),
    };
    work.run()?;
    sweep.record(&dir)?;
    let outcome = sweep.outcome(&dir)?;
    let shown = match arguments.show.is_empty() {
        true => outcome.main_paths(),
        false => arguments.show.clone(),
    };
    // Table and charts need all points, which a share does not have.
    let written = match arguments.shard {
        None => outcome.write(&dir, &shown)?,
        Some(_) => vec!["a share; the same command without --shard gathers all".to_string()],
    };
    print(&match common.json {
        true => json(&outcome.json())?,
        false => format!(
            "{}\nSweep in {}: {}\n{}",
            table(&sweep, &outcome, &shown).render(page_width()),
            dir.display(),
            written.join(", "),
            shared(&sweep, &outcome)
        ),
    })?;
    ending(&sweep)
}

/// Returns a point that has not been run, with the text that represents everything its results
/// depend on.
fn point(arguments: &SweepArguments, keys: &[String], values: Vec<String>) -> Result<SweepPoint> {
    let common = &arguments.common;
    let options = Options {
        small_strain: common.small_strain,
        ..Options::default()
    };
    let scene = deck::load_with(&common.scene, &arguments.overrides(keys, &values), options)?;
    let mut text = serde_json::to_string(&scene)
        .map_err(|cause| Error::internal("the scene is not plain data").because(cause))?;
    for choice in [
        env!("CARGO_PKG_VERSION").to_string(),
        format!("{:?}", common.solver),
        format!("{:?}", arguments.accuracy),
        format!("{:?}", arguments.estimate.effort()),
    ] {
        text.push('\n');
        text.push_str(&choice);
    }
    let mut content = text.into_bytes();
    if let Some(file) = &scene.mesh.file {
        let folder = common.scene.parent().unwrap_or(Path::new(""));
        content.extend(files::read("read the mesh", &folder.join(file), None)?);
    }
    for field in scene.fields() {
        if let Field::Nodal(of) = field {
            let path = scene.beside(&of.file);
            content.extend(files::read("read the values of nodes", &path, None)?);
        }
    }
    Ok(SweepPoint {
        folder: folder(keys, &values),
        values,
        identity: format!("{:032x}", xxh3_128(&content)),
        demand: demand::of(&scene),
        ..SweepPoint::default()
    })
}

/// Appends the identity of a point to its folder if several folders would have the same name.
fn tell_apart(points: &mut [SweepPoint]) {
    let mut seen = BTreeSet::new();
    let twice: BTreeSet<String> = (points.iter())
        .filter(|point| !seen.insert(point.folder.clone()))
        .map(|point| point.folder.clone())
        .collect();
    for point in points
        .iter_mut()
        .filter(|point| twice.contains(&point.folder))
    {
        let identity: String = point.identity.chars().take(8).collect();
        point.folder = format!("{}-{identity}", point.folder);
    }
}

/// The runs of a sweep, several at a time.
struct SweepRuns<'w> {
    arguments: &'w SweepArguments,
    dir: &'w Path,
    /// Indices of the points in the order in which they are run.
    order: Vec<usize>,
    /// Numbers of the running processes.
    running: &'w Mutex<Vec<u32>>,
    sweep: Mutex<&'w mut Sweep>,
    next: Mutex<usize>,
}

impl SweepRuns<'_> {
    fn run(&self) -> Result<()> {
        let jobs = usize::from(self.arguments.jobs);
        std::thread::scope(|scope| {
            let workers: Vec<_> = (0..jobs).map(|_| scope.spawn(|| self.work())).collect();
            let ended = workers.into_iter().map(|worker| match worker.join() {
                Ok(ended) => ended,
                Err(_) => Err(Error::internal("a worker of the sweep panicked")),
            });
            ended.collect()
        })
    }

    /// Runs one point after the other until none is left or the user has asked to stop.
    fn work(&self) -> Result<()> {
        let mut worker = None;
        while let Some((index, point)) = self.take().filter(|_| !interrupt::requested()) {
            let start = Instant::now();
            let Ended { exit_code, message } = self.run_point(&mut worker, &point)?;
            let mut sweep = lock(&self.sweep);
            sweep.points[index].exit_code = exit_code;
            sweep.points[index].message = message.clone();
            sweep.record(self.dir)?;
            let how = match exit_code {
                Some(0) => format!("done in {}", seconds(start.elapsed().as_secs_f64())),
                _ => message,
            };
            let total = sweep.points.len();
            self.note(&format!(
                "point {} of {total}, {}: {how}",
                index + 1,
                point.folder
            ));
        }
        Ok(())
    }

    /// Returns the next point that is not finished.
    fn take(&self) -> Option<(usize, SweepPoint)> {
        let sweep = lock(&self.sweep);
        let mut next = lock(&self.next);
        while let Some(&index) = self.order.get(*next) {
            *next += 1;
            let point = &sweep.points[index];
            if !point.is_finished() {
                return Some((index, point.clone()));
            }
            self.note(&format!(
                "point {}, {}: finished before",
                index + 1,
                point.folder
            ));
        }
        None
    }

    fn note(&self, text: &str) {
        if !self.arguments.quiet {
            let _ = writeln!(std::io::stderr(), "{}", crate::text::shown_in_line(text));
        }
    }

    /// Runs a point in a worker, which is started if there is none.
    fn run_point(&self, worker: &mut Option<Worker>, point: &SweepPoint) -> Result<Ended> {
        if worker.is_none() {
            let new = Worker::start()?;
            lock(self.running).push(new.id());
            *worker = Some(new);
        }
        let Some(at_work) = worker else {
            return Err(Error::internal("no worker was started"));
        };
        let id = at_work.id();
        let (ended, is_there) = at_work.run(&self.words(point))?;
        if !is_there {
            lock(self.running).retain(|running| *running != id);
            *worker = None;
        }
        Ok(ended)
    }

    /// Returns the words of the command that runs a point.
    fn words(&self, point: &SweepPoint) -> Vec<String> {
        let SweepArguments { common, jobs, .. } = self.arguments;
        let processors = std::thread::available_parallelism().map_or(1, usize::from);
        let share = (processors / usize::from(*jobs)).max(1);
        let threads = common.threads.map_or(share, usize::from);
        let path = |path: &Path| path.to_string_lossy().into_owned();
        let mut words = vec![
            "brinell".to_string(),
            "run".to_string(),
            path(&common.scene),
            "--quiet".to_string(),
            "--json".to_string(),
            "--out".to_string(),
            path(&self.dir.join(&point.folder)),
            "--threads".to_string(),
            threads.to_string(),
        ];
        if let Some(solver) = common.solver.to_possible_value() {
            words.extend(["--solver".to_string(), solver.get_name().to_string()]);
        }
        let keys = &lock(&self.sweep).keys;
        for change in self.arguments.overrides(keys, &point.values) {
            words.extend(["--set".to_string(), change]);
        }
        if let Some(demand) = &self.arguments.accuracy {
            words.extend(["--accuracy".to_string(), demand.clone()]);
        }
        let effort = self.arguments.estimate.effort();
        words.extend(["--estimate".to_string(), effort.name().to_string()]);
        for (is_asked, flag) in [
            (self.arguments.no_report, "--no-report"),
            (common.small_strain, "--small-strain"),
        ] {
            words.extend(is_asked.then(|| flag.to_string()));
        }
        words
    }
}

/// Forwards a second signal to the running processes, so that it ends them at once, too.
fn stop(running: &Mutex<Vec<u32>>) {
    for id in lock(running).iter() {
        ask_to_stop(*id);
    }
}

fn table(sweep: &Sweep, outcome: &SweepOutcome<'_>, shown: &[String]) -> Table {
    let short = |key: &String| {
        let last = key.rsplit('.').next().unwrap_or(key);
        let is_alone = sweep
            .keys
            .iter()
            .filter(|k| k.rsplit('.').next() == Some(last))
            .count()
            == 1;
        if is_alone {
            last.to_string()
        } else {
            key.clone()
        }
    };
    let failed = |point: &SweepPoint| point.exit_code != Some(0);
    let mut columns: Vec<(ColumnAlignment, String)> = Vec::new();
    columns.extend(
        sweep
            .keys
            .iter()
            .map(|key| (ColumnAlignment::Number, short(key))),
    );
    columns.extend(
        shown
            .iter()
            .map(|path| (ColumnAlignment::Number, outcome.heading(path))),
    );
    let with_notes = sweep.points.iter().any(failed);
    columns.extend(with_notes.then(|| (ColumnAlignment::Text, "note".to_string())));
    let mut table = Table::new(&columns);
    for (index, point) in sweep.points.iter().enumerate() {
        let figures = shown.iter().map(|path| match outcome.figure(index, path) {
            Some(value) => number(value),
            None => "-".to_string(),
        });
        let note = match point.exit_code {
            None => "not run".to_string(),
            Some(0) => String::new(),
            Some(code) => format!("exit code {code}: {}", point.message),
        };
        table.row(point.values.iter().cloned().chain(figures).chain([note]));
    }
    table
}

/// Describes how many factorisations the points took, if several ran.
fn shared(sweep: &Sweep, outcome: &SweepOutcome<'_>) -> String {
    let of_points = (0..sweep.points.len()).filter_map(|point| outcome.factorizations(point));
    let of_points: Vec<usize> = of_points.collect();
    match of_points.len() {
        0 | 1 => String::new(),
        n => {
            let made: usize = of_points.iter().sum();
            format!("Factorisations of these {n} points: {made}.\n")
        }
    }
}

/// Returns the error with which the program ends, if any.
fn ending(sweep: &Sweep) -> Result<()> {
    let total = sweep.points.len();
    if interrupt::requested() {
        let finished = sweep
            .points
            .iter()
            .filter(|point| point.is_finished())
            .count();
        let text = format!(
            "the sweep was stopped, {finished} of {total} points are finished; the same command \
             goes on with the others"
        );
        return Err(Error::new(ErrorKind::Stopped, text));
    }
    let failed: Vec<&str> = (sweep.points.iter())
        .filter(|point| point.exit_code != Some(0))
        .map(|point| point.folder.as_str())
        .collect();
    match failed.is_empty() {
        true => Ok(()),
        false => Err(Error::analysis(format!(
            "{} of {total} points did not end well: {}",
            failed.len(),
            failed.join(", ")
        ))),
    }
}
