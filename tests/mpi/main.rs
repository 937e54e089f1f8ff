//! Runs over several ranks on one machine: the results of CHOLMOD, and ends that all ranks share.

#[path = "../running/limit.rs"]
mod limit;

use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

const PROGRAM: &str = env!("CARGO_BIN_EXE_brinell");

fn has_mpirun() -> bool {
    let found = Command::new("mpirun").arg("--version").output().is_ok();
    if !found {
        println!("skipped: no mpirun on this machine");
    }
    found
}

fn scene(name: &str) -> String {
    format!("{}/data/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"))
}

/// The program on so many ranks, more than there may be processors.
fn on_ranks(ranks: usize, arguments: &[&str]) -> Command {
    let mut command = Command::new("mpirun");
    command
        .args(["--oversubscribe", "-n", &ranks.to_string(), PROGRAM])
        .args(arguments)
        .env("OMPI_ALLOW_RUN_AS_ROOT", "1")
        .env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1");
    command
}

fn run(ranks: usize, scene: &str, changes: &[&str], out: &Path) -> Value {
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

/// The largest difference of the figures of all states, each over the largest size that it has.
fn difference(found: &Value, expected: &Value) -> f64 {
    let [own, other] = [found, expected].map(|s| s["states"].as_array().unwrap());
    assert_eq!(own.len(), other.len());
    let figures = [
        "load",
        "max_pressure",
        "half_width",
        "residual_depth",
        "approach",
    ];
    let of = |figure: &str| {
        let value = |state: &Value| state[figure].as_f64().unwrap_or(0.0);
        let largest = other.iter().map(|s| value(s).abs()).fold(0.0, f64::max);
        let off = own
            .iter()
            .zip(other)
            .map(|(a, b)| (value(a) - value(b)).abs());
        off.fold(0.0, f64::max) / largest.max(f64::MIN_POSITIVE)
    };
    figures.into_iter().map(of).fold(0.0, f64::max)
}

/// The scenes of a folder of `data/scenes`.
fn names(folder: &str) -> Vec<String> {
    let path = format!("{}/data/scenes/{folder}", env!("CARGO_MANIFEST_DIR"));
    let files = std::fs::read_dir(path)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let scenes = files.filter(|path| path.extension().is_some_and(|end| end == "toml"));
    let mut names: Vec<String> = scenes
        .map(|path| format!("{folder}{}", path.file_stem().unwrap().to_str().unwrap()))
        .collect();
    names.sort();
    names
}

/// Every scene on two ranks, some on one and four. Of bodies that hardly anything holds, or whose
/// elements are slivers, displacements have the digits that their condition leaves; else the
/// plastic iteration ends at 1e-10 of the forces, from whichever side.
#[test]
fn results_are_those_of_cholmod_for_any_number_of_ranks() {
    if !has_mpirun() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let (mut n, mut close) = (0, 0);
    for name in names("").into_iter().chain(names("hard/")) {
        let path = scene(&name);
        let text = std::fs::read_to_string(&path).unwrap();
        let coarser: &[&str] = match text.contains("[mesh.curved_bodies]") {
            true => &["mesh.curved_bodies.resolution=4"],
            false => &[],
        };
        let expected = run(0, &path, coarser, &out);
        assert_eq!(expected["solver"], "cholmod");
        let is_ill = ["hard/nearly_floating", "hard/slivers"].contains(&name.as_str());
        let bound = if is_ill { 1e-6 } else { 1e-8 };
        let all = [
            "disc_in_plate",
            "ball_on_flat_3d",
            "hard/floating_body",
            "hard/to_and_fro",
        ];
        let ranks: &[usize] = if all.contains(&name.as_str()) {
            &[1, 2, 4]
        } else {
            &[2]
        };
        for &ranks in ranks {
            let found = run(ranks, &path, coarser, &out);
            assert_eq!(found["solver"], "mumps");
            let off = difference(&found, &expected);
            println!("{name} on {ranks}: {off:.1e}");
            assert!(off <= bound, "{name} on {ranks}: {off:e}");
            if ranks == 2 {
                n += 1;
                close += usize::from(off <= 1e-10);
            }
        }
    }
    println!("{close} of {n} scenes on two ranks within 1e-10");
    assert!(n > 40, "{n}");
}

fn ends(output: &Output, code: i32, words: &str) {
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(code), "{text}");
    assert_eq!(text.matches(words).count(), 1, "{text}");
}

/// An error is told once, and ends all ranks with its code.
#[test]
fn errors_end_all_ranks_with_one_message() {
    if !has_mpirun() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let out = out.to_str().unwrap();
    let patch = scene("contact_patch");
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

/// A rank that is killed ends the others within seconds.
#[test]
#[cfg(target_os = "linux")]
fn a_killed_rank_ends_the_run() {
    if !has_mpirun() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let ball = scene("ball_on_flat_3d");
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
