//! Runs over several ranks on one machine: the results of CHOLMOD, and ends that all ranks share.

#[path = "../support/mod.rs"]
mod support;

use brinell::output::read;
use serde_json::Value;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};
use support::{limit, scene_path, scenes, tools};

const PROGRAM: &str = env!("CARGO_BIN_EXE_brinell");

/// The program on so many ranks, more than there may be processors.
fn on_ranks(ranks: usize, arguments: &[&str]) -> Command {
    let mut command = mpirun(ranks);
    command.arg(PROGRAM).args(arguments);
    command
}

fn mpirun(ranks: usize) -> Command {
    let mut command = Command::new("mpirun");
    command
        .args(["--oversubscribe", "-n", &ranks.to_string()])
        .env("OMPI_ALLOW_RUN_AS_ROOT", "1")
        .env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1");
    command
}

fn summary_on_ranks(ranks: usize, scene: &str, changes: &[&str], out: &Path) -> Value {
    let out = out.to_str().unwrap();
    let mut arguments = vec!["run", scene, "-q", "--json", "--no-estimate", "--no-report"];
    arguments.extend(["--out", out]);
    for change in changes {
        arguments.extend(["--set", change]);
    }
    let output = match ranks {
        0 => limit::output(Command::new(PROGRAM).args(&arguments)),
        _ => {
            arguments.extend(["--solver", "mumps"]);
            limit::output(&mut on_ranks(ranks, &arguments))
        }
    };
    let why = String::from_utf8_lossy(&output.stderr).into_owned();
    // Some scenes are there for their limit load.
    let ended = [Some(0), Some(6)].contains(&output.status.code());
    assert!(ended, "{scene} on {ranks}: {why}");
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Numbers of ranks on which scenes are run.
const RANKS: [usize; 3] = [1, 2, 4];

/// Scenes on the ranks that are chosen by their place in the list.
fn are_those_of_cholmod(scenes: &[String], chosen: impl Fn(usize, usize) -> bool) {
    if !tools::has("mpirun") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let mut counts = [(0, 0); RANKS.len()];
    for (i, name) in scenes.iter().enumerate() {
        let path = scene_path(name);
        let smaller = scenes::smaller(name);
        let expected = summary_on_ranks(0, &path, smaller, &out);
        assert_eq!(expected["solver"], "cholmod");
        let bound = scenes::agreement(name);
        for (r, ranks) in RANKS.into_iter().enumerate().filter(|(r, _)| chosen(i, *r)) {
            let found = summary_on_ranks(ranks, &path, smaller, &out);
            assert_eq!(found["solver"], "mumps");
            let off = scenes::difference(&found, &expected);
            println!("{name} on {ranks}: {off:.1e}");
            assert!(off <= bound, "{name} on {ranks}: {off:e}");
            counts[r].0 += 1;
            counts[r].1 += usize::from(off <= 1e-10);
        }
    }
    for (ranks, (n, close)) in RANKS.into_iter().zip(counts) {
        assert!(n > 5);
        println!("{n} scenes on {ranks} ranks, within 1e-10 of CHOLMOD: {close}");
    }
}

/// Every kind of model and every effect, each on one number of ranks. Scenes of hard contact are as
/// hard to one process: their ranks are for the long test.
#[test]
fn scenes_on_one_two_or_four_ranks_are_those_of_cholmod() {
    let mut scenes = scenes::all();
    scenes.retain(|name| !name.starts_with("hard/"));
    are_those_of_cholmod(&scenes, |i, r| i % RANKS.len() == r);
}

#[test]
#[ignore = "ten minutes: cargo test --features mumps --test mpi -- --ignored --nocapture"]
fn every_scene_on_one_two_and_four_ranks_is_that_of_cholmod() {
    are_those_of_cholmod(&scenes::all(), |_, _| true);
}

/// Fields on the whole mesh, which each rank evaluates and writes a part of, are those of one
/// process: elastic and plastic, in the plane and in space, with free strains.
#[test]
fn fields_in_pieces_are_those_of_one_process() {
    if !tools::has("mpirun") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let [one, several] = ["one", "several"].map(|name| folder.path().join(name));
    let mut yielded = false;
    for (name, changes) in [
        ("cylinder_on_half_plane", &[][..]),
        ("fit_by_heat", &[]),
        ("ball_on_flat_3d", &["mesh.curved_bodies.resolution=4"]),
    ] {
        summary_on_ranks(0, &scene_path(name), changes, &one);
        let summary = summary_on_ranks(3, &scene_path(name), changes, &several);
        let [whole, pieces] = [&one, &several].map(|dir| read(dir).unwrap().results.states);
        let (mut n, bound) = (0, scenes::agreement(name));
        for (i, (whole, pieces)) in whole.iter().zip(&pieces).enumerate() {
            let Some(whole) = &whole.fields else { continue };
            let file = summary["states"][i]["fields"].as_str().unwrap();
            assert!(file.ends_with(".pvtu"), "{file}");
            let pieces = pieces.fields.as_ref().unwrap();
            for (what, whole, pieces) in [
                ("displacement", &whole.displacement, &pieces.displacement),
                ("stress", &whole.stress, &pieces.stress),
                ("von Mises stress", &whole.von_mises, &pieces.von_mises),
                (
                    "plastic strain",
                    &whole.plastic_strain,
                    &pieces.plastic_strain,
                ),
                ("error", &whole.error, &pieces.error),
                ("nodal stress", &whole.nodal_stress, &pieces.nodal_stress),
                (
                    "pressure",
                    &whole.contact_pressure,
                    &pieces.contact_pressure,
                ),
                ("gap", &whole.gap, &pieces.gap),
            ] {
                // Gaps are not numbers where there is no pair.
                let numbers = || whole.iter().zip(pieces).filter(|(a, _)| !a.is_nan());
                assert!(pieces.iter().filter(|b| !b.is_nan()).count() == numbers().count());
                let size = numbers().fold(0.0f64, |m, (a, _)| m.max(a.abs()));
                let off = numbers().fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
                println!("{name}, state {i}: {what} {:.1e}", off / size);
                let is_close = |(a, b): (&f64, &f64)| (a - b).abs() <= bound * size;
                assert!(numbers().all(is_close), "{name}, state {i}: {what}");
            }
            assert_eq!(pieces.yielded, whole.yielded);
            yielded |= whole.yielded.contains(&1);
            n += 1;
        }
        assert!(n > 0, "{name}");
    }
    assert!(yielded);
}

fn ends(output: &Output, code: i32, words: &str) {
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(code), "{text}");
    assert_eq!(text.matches(words).count(), 1, "{text}");
}

/// An error is told once, and ends all ranks with its code.
#[test]
fn errors_end_all_ranks_with_one_message() {
    if !tools::has("mpirun") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let out = out.to_str().unwrap();
    let patch = scene_path("contact_patch");
    let each = limit::output(&mut on_ranks(3, &["run", &patch, "--out", out]));
    ends(&each, 2, "3 processes were started");
    assert!(!Path::new(out).exists());
    let absent = limit::output(&mut on_ranks(
        2,
        &["run", "absent.toml", "--solver", "mumps"],
    ));
    ends(&absent, 3, "absent.toml");
    let wrong = [
        "run",
        &patch,
        "--solver",
        "mumps",
        "--set",
        "program.steps=-1",
    ];
    ends(
        &limit::output(&mut on_ranks(2, &wrong)),
        2,
        "expected a whole number",
    );
}

/// The other ranks are asked to assemble, to factor and once for each load and state: how many
/// increments there are in between makes no difference.
#[test]
fn nobody_is_asked_between_load_steps() {
    if !tools::has("mpirun") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    for name in ["cylinder_on_half_plane", "ball_on_half_space"] {
        let [few, many] = [4, 40].map(|steps| {
            let steps = format!("program.steps={steps}");
            let summary = summary_on_ranks(
                3,
                &scene_path(name),
                &["program.stepping=steps", &steps],
                &out,
            );
            let history = std::fs::read_to_string(out.join("history.csv")).unwrap();
            (history.lines().count() - 1, summary)
        });
        let asked = |summary: &Value| summary["ranks"]["requests"].as_u64().unwrap();
        println!(
            "{name}: {} and {} increments, {} and {} requests of {} bytes in all",
            few.0,
            many.0,
            asked(&few.1),
            asked(&many.1),
            many.1["ranks"]["bytes"]
        );
        assert!(many.0 >= few.0 + 36, "{name}");
        // Another zone may be factored on the way.
        let factored = |summary: &Value| summary["counts"]["factorizations"].clone();
        assert_eq!(factored(&few.1), factored(&many.1), "{name}");
        let schema: Value = serde_json::from_str(brinell::output::SUMMARY_SCHEMA).unwrap();
        if let Err(error) = jsonschema::validate(&schema, &many.1) {
            panic!("{error}");
        }
        // A state whose residual is round-off may or may not be refined: two solves, one product.
        let states = few.1["states"].as_array().unwrap().len() as u64;
        assert!(
            asked(&few.1).abs_diff(asked(&many.1)) <= 3 * states,
            "{name}"
        );
    }
}

/// The scene of the ball in three dimensions, elastic.
fn elastic_ball(folder: &Path) -> String {
    let text = std::fs::read_to_string(scene_path("ball_on_flat_3d")).unwrap();
    let (model, _) = text.split_once("[program]").unwrap();
    let model = model.replace(
        "resolution = 6",
        "semi_axes = [0.11, 0.11]\nresolution = 12",
    );
    let model = model.replace(
        "material = \"steel\"",
        "material = \"steel\"\nplastic = false",
    );
    let path = folder.join("elastic.toml");
    std::fs::write(
        &path,
        model + "[program]\ntargets = [{ load_factor = 0.02 }]\n",
    )
    .unwrap();
    path.to_str().unwrap().to_string()
}

/// In kB: one process is refused, four run.
const ADDRESS_SPACE: usize = 1_500_000;

/// A solid model that is larger than the memory of one rank runs on four; what each needs was
/// predicted, and is a quarter. One rank alone without memory ends all, by its number.
#[test]
#[cfg(target_os = "linux")]
fn what_is_too_large_for_one_rank_runs_on_four() {
    if !tools::has("mpirun") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let path = elastic_ball(folder.path());
    let out = folder.path().join("out");
    let out = out.to_str().unwrap();
    let arguments = format!("run {path} --out {out} -q --json --no-estimate --no-report");
    let limited = |ranks: Option<usize>, limit: &str| {
        let solver = if ranks.is_some() {
            "--solver mumps"
        } else {
            ""
        };
        let line = format!("{limit}; exec {PROGRAM} {arguments} {solver}");
        let mut command = match ranks {
            Some(ranks) => {
                let mut command = mpirun(ranks);
                command.arg("bash");
                command
            }
            None => Command::new("bash"),
        };
        limit::output(command.args(["-c", &line]))
    };
    let small = format!("ulimit -v {ADDRESS_SPACE}");
    let alone = limited(None, &small);
    ends(&alone, 5, "out of memory: the factorisation");
    let four = limited(Some(4), &small);
    let why = String::from_utf8_lossy(&four.stderr).into_owned();
    assert!(four.status.success(), "{why}");
    let summary: Value = serde_json::from_slice(&four.stdout).unwrap();
    let list = |values: &Value| -> Vec<f64> {
        let values = values.as_array().unwrap().iter();
        values.map(|bytes| bytes.as_f64().unwrap()).collect()
    };
    let predicted = list(&summary["factor"]["memory_by_rank"]);
    let held = list(&summary["ranks"]["peak_memory_bytes"]);
    println!("predicted {predicted:?}, held {held:?}");
    for (predicted, held) in predicted.iter().zip(&held) {
        // Beside the factor stand the program itself and, on the first, mesh and states.
        assert!(*held < 1.3 * predicted && *held > 0.5 * predicted);
        assert!(*held < 0.5 * 1.45e9, "a quarter, and what stands beside it");
    }
    let of_third = format!("[ $OMPI_COMM_WORLD_RANK != 2 ] || ulimit -v {}", 700_000);
    ends(
        &limited(Some(4), &of_third),
        5,
        "out of memory: rank 2 of 4",
    );
}

/// More ranks than elements: some have nothing.
#[test]
fn ranks_without_an_element_do_no_harm() {
    if !tools::has("mpirun") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let changes = [
        "mesh.parts.0.block.elements=[1,1]",
        "mesh.parts.1.block.elements=[1,1]",
    ];
    let [alone, many] =
        [0, 5].map(|n| summary_on_ranks(n, &scene_path("contact_patch"), &changes, &out));
    assert_eq!(many["elements"], 2);
    assert!(scenes::difference(&many, &alone) <= 1e-10);
}

/// `mpirun` hands SIGUSR1 on: the run ends where it is, with its results. Killed outright, it goes
/// on from its checkpoint, on another number of ranks too.
#[test]
#[cfg(target_os = "linux")]
fn a_run_that_is_stopped_keeps_what_it_has() {
    if !tools::has("mpirun") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let path = scene_path("ball_on_flat_3d");
    let changes = ["mesh.curved_bodies.resolution=4"];
    let options = [
        "--solver",
        "mumps",
        "--no-estimate",
        "--no-report",
        "--set",
        changes[0],
    ];
    let start = |more: &[&str]| {
        let mut command = on_ranks(3, &["run", &path, "--out", out.to_str().unwrap()]);
        command.args(options).args(more);
        command.stdout(Stdio::null()).stderr(Stdio::piped());
        command.spawn().unwrap()
    };
    let until_increment = |running: &mut std::process::Child| {
        let mut events = BufReader::new(running.stderr.take().unwrap()).lines();
        let found = events.find(|line| line.as_ref().unwrap().contains("\"increment\""));
        assert!(found.is_some());
        // Nobody may be kept waiting for its messages to be read.
        std::thread::spawn(move || events.count());
    };
    let json = ["--progress", "json"];
    let mut running = start(&json);
    until_increment(&mut running);
    let parent = running.id().to_string();
    assert!(
        Command::new("kill")
            .args(["-USR1", &parent])
            .status()
            .unwrap()
            .success()
    );
    assert_eq!(limit::wait(&mut running).code(), Some(128 + 10));
    let summary = support::program::summary(&out);
    assert_eq!(summary["incomplete"], "stopped on request");

    let expected = summary_on_ranks(0, &path, &changes, &folder.path().join("other"));
    let mut running = start(&[&json[..], &["--checkpoint=1"]].concat());
    until_increment(&mut running);
    running.kill().unwrap();
    let _ = limit::wait(&mut running);
    // Ranks end with the one that started them.
    std::thread::sleep(Duration::from_secs(3));
    let mut resumed = on_ranks(2, &["run", &path, "--out", out.to_str().unwrap()]);
    resumed
        .args(options)
        .args(["-q", "--json", "--checkpoint=1", "--resume"]);
    let output = limit::output(&mut resumed);
    let why = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{why}");
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(found["resumed"].as_u64().unwrap() > 0);
    assert!(scenes::difference(&found, &expected) <= 1e-8);
}

/// A rank that is killed ends the others within seconds.
#[test]
#[cfg(target_os = "linux")]
fn a_killed_rank_ends_the_run() {
    if !tools::has("mpirun") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let ball = scene_path("ball_on_flat_3d");
    let arguments = [
        "run",
        &ball,
        "--solver",
        "mumps",
        "--out",
        out.to_str().unwrap(),
    ];
    let mut running = on_ranks(3, &arguments)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let parent = running.id().to_string();
    // The ranks are children of mpirun.
    let victim = (0..200).find_map(|_| {
        std::thread::sleep(Duration::from_millis(50));
        let listed = Command::new("pgrep").args(["-P", &parent]).output().ok()?;
        let text = String::from_utf8_lossy(&listed.stdout).into_owned();
        let ranks: Vec<&str> = text.lines().collect();
        (ranks.len() == 3).then(|| ranks[2].to_string())
    });
    let victim = victim.expect("three ranks");
    std::thread::sleep(Duration::from_millis(1500));
    let killed = Command::new("kill").args(["-9", &victim]).status().unwrap();
    assert!(killed.success());
    let start = Instant::now();
    let status = limit::wait(&mut running);
    assert!(!status.success());
    assert!(
        start.elapsed() < Duration::from_secs(30),
        "{:?}",
        start.elapsed()
    );
    assert!(!out.join("summary.json").exists());
}
