//! Killed at any moment: `kill -9` leaves no time to tidy up.
#![cfg(unix)]

use crate::support::program::{program, stderr, summary};
use crate::support::tools::with_these_kernels;
use crate::support::{SMALL_BALL, limit, scene_file};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A scene and what is set in it.
type Case = (&'static str, &'static [&'static str]);

const CYLINDER: Case = (
    "cylinder_on_half_plane",
    &["mesh.cylinder_on_half_plane.resolution=12"],
);
/// Surfaces whose nodes do not face each other.
const ROLLER: Case = ("roller_on_plate", &[]);
const BALL: Case = ("ball_on_flat_3d", &SMALL_BALL);

fn start((scene, sets): Case, out: &Path, more: &[&str]) -> Child {
    with_these_kernels(&mut program())
        .arg("run")
        .arg(scene_file(scene))
        .args(["-q", "--no-report", "--no-estimate", "--threads", "1"])
        .args(sets.iter().flat_map(|set| ["--set", set]))
        .arg("--out")
        .arg(out)
        .args(more)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// Everything in `summary.json` but what a clock or the operating system says, and how often the
/// run went on.
fn lasting_summary(dir: &Path) -> serde_json::Value {
    let mut summary = summary(dir);
    let object = summary.as_object_mut().unwrap();
    for key in ["timings", "peak_memory_bytes", "resumed"] {
        assert!(object.remove(key).is_some(), "{key}");
    }
    for effect in object["effects"].as_object_mut().unwrap().values_mut() {
        effect.as_object_mut().unwrap().remove("seconds");
    }
    summary
}

/// The same run again and again, killed at times of no pattern, until one of them comes to its end.
/// A restart that loses a digit of the state, or a checkpoint that is half written, changes the
/// results or ends the run: passing means that every number of the summary and every byte of every
/// other file is that of the run that nobody disturbed.
fn killed_again_and_again(case: Case) {
    let folder = tempfile::tempdir().unwrap();
    let (plain, killed) = (folder.path().join("plain"), folder.path().join("killed"));
    let begin = Instant::now();
    let output = limit::finish(start(case, &plain, &[]));
    assert!(output.status.success(), "{}", stderr(&output));
    let whole = begin.elapsed();

    let checkpoint = folder.path().join("killed.checkpoint/checkpoint");
    let mut random = 88_172_645_463_325_252u64;
    let mut kills = 0;
    let mut with_checkpoint = 0;
    let mut rounds = 0;
    let stderr = loop {
        let mut child = start(case, &killed, &["--checkpoint", "--resume"]);
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        // Now at any time of the run, now soon after it has written a checkpoint (it may be writing
        // the next); in the end it is let be.
        let chance = (random % 1000) as f64 / 1000.0;
        let written = || {
            std::fs::metadata(&checkpoint)
                .and_then(|file| file.modified())
                .ok()
        };
        let before = written();
        let mut deadline = match kills {
            12.. => None,
            k if k % 2 == 0 => Some(Instant::now() + whole.mul_f64(0.6 * chance)),
            _ => None,
        };
        let started = Instant::now();
        let ended = loop {
            assert!(started.elapsed() < limit::PROCESS, "the run does not end");
            if let Some(status) = child.try_wait().unwrap() {
                break Some(status);
            }
            if deadline.is_none() && kills < 12 && written() != before {
                deadline = Some(Instant::now() + Duration::from_millis(30).mul_f64(chance));
            }
            if deadline.is_some_and(|deadline| Instant::now() >= deadline) {
                break None;
            }
            std::thread::sleep(Duration::from_millis(1));
        };
        match ended {
            Some(_) => {
                let output = child.wait_with_output().unwrap();
                let stderr = String::from_utf8(output.stderr).unwrap();
                assert!(output.status.success(), "{stderr}");
                rounds += 1;
                if with_checkpoint >= 2 || rounds == 5 {
                    break stderr;
                }
                // The machine was busier before: the run came to its end sooner than a kill. Again
                // from the begin.
                std::fs::remove_dir_all(&killed).unwrap();
                kills = 0;
            }
            None => {
                child.kill().unwrap();
                child.wait().unwrap();
                kills += 1;
                with_checkpoint += i32::from(checkpoint.is_file());
            }
        }
    };
    assert!(
        with_checkpoint >= 2,
        "{kills} kills, {with_checkpoint} of them beyond the first checkpoint"
    );
    assert!(!stderr.contains("last digits"), "{stderr}");

    same_results(&plain, &killed);
    // Nothing is left but the results, and hidden beside them what a kill amid their writing leaves
    // no time to delete.
    let left: Vec<_> = std::fs::read_dir(folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .filter(|name| !name.to_string_lossy().starts_with(".killed."))
        .collect();
    assert_eq!(left.len(), 2, "{left:?}");
}

#[test]
fn a_run_killed_again_and_again_has_the_results_of_one_that_was_not() {
    killed_again_and_again(CYLINDER);
}

#[test]
fn a_roller_that_does_not_match_killed_again_and_again_has_the_results_of_one_that_was_not() {
    killed_again_and_again(ROLLER);
}

#[test]
fn a_solid_killed_again_and_again_has_the_results_of_one_that_was_not() {
    killed_again_and_again(BALL);
}

/// Every number of the summary and every byte of every other file.
fn same_results(plain: &Path, other: &Path) {
    assert_eq!(lasting_summary(plain), lasting_summary(other));
    let mut compared = 0;
    for entry in std::fs::read_dir(plain).unwrap() {
        let name = entry.unwrap().file_name();
        if name != "summary.json" {
            let read = |dir: &Path| std::fs::read(dir.join(&name)).unwrap();
            assert!(read(plain) == read(other), "{name:?} differs");
            compared += 1;
        }
    }
    assert!(compared >= 5, "{compared} files");
}

/// Ctrl-C leaves results that are marked incomplete, and a checkpoint: the same line with
/// `--resume` finishes the job.
#[test]
fn a_run_stopped_by_the_user_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let (plain, stopped) = (folder.path().join("plain"), folder.path().join("stopped"));
    assert!(limit::wait(&mut start(CYLINDER, &plain, &[])).success());
    let checkpoint = folder.path().join("stopped.checkpoint/checkpoint");
    for attempt in 0.. {
        let mut child = start(CYLINDER, &stopped, &["--checkpoint=3"]);
        while !checkpoint.is_file() && child.try_wait().unwrap().is_none() {
            std::thread::sleep(Duration::from_millis(1));
        }
        let signal = ["-INT", &child.id().to_string()].map(str::to_owned);
        // It fails where the run has come to its end in the meantime.
        let _ = Command::new("kill").args(signal).status().unwrap();
        match limit::wait(&mut child).code() {
            Some(130) => break,
            Some(0) if attempt < 5 => std::fs::remove_dir_all(&stopped).unwrap(),
            code => panic!("{code:?}"),
        }
    }
    assert!(lasting_summary(&stopped)["incomplete"].is_string());
    assert!(checkpoint.is_file());
    assert!(limit::wait(&mut start(CYLINDER, &stopped, &["--resume"])).success());
    same_results(&plain, &stopped);
    assert!(!checkpoint.exists());
}

/// A demanded accuracy means runs on several meshes: there is no one state to go on from.
#[test]
fn a_demanded_accuracy_leaves_no_checkpoints() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    for option in ["--checkpoint", "--resume"] {
        let refused = start(CYLINDER, &out, &["--accuracy", "5%", option]);
        let output = limit::finish(refused);
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{stderr}");
        assert!(stderr.contains("accuracy"), "{stderr}");
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}
