//! Killed at any moment: `kill -9` leaves no time to tidy up.
#![cfg(unix)]

use crate::running::scene_file;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

fn start(out: &Path, more: &[&str]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_brinell"))
        .arg("run")
        .arg(scene_file("cylinder_on_half_plane"))
        .args(["-q", "--no-report", "--no-estimate", "--threads", "1"])
        .args(["--set", "mesh.cylinder_on_half_plane.resolution=12"])
        .arg("--out")
        .arg(out)
        .args(more)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// Everything in `summary.json` but what a clock or the operating system says, and how often the run went on.
fn summary(dir: &Path) -> serde_json::Value {
    let text = std::fs::read_to_string(dir.join("summary.json")).unwrap();
    let mut summary: serde_json::Value = serde_json::from_str(&text).unwrap();
    let object = summary.as_object_mut().unwrap();
    for key in ["timings", "peak_memory_bytes", "resumed"] {
        assert!(object.remove(key).is_some(), "{key}");
    }
    for effect in object["effects"].as_object_mut().unwrap().values_mut() {
        effect.as_object_mut().unwrap().remove("seconds");
    }
    summary
}

/// The same run again and again, killed at times of no pattern, until one of them comes to its end. A restart that loses a digit of the state, or a
/// checkpoint that is half written, changes the results or ends the run: passing means that every number of the summary and every byte of every
/// other file is that of the run that nobody disturbed.
#[test]
fn a_run_killed_again_and_again_has_the_results_of_one_that_was_not() {
    let folder = tempfile::tempdir().unwrap();
    let (plain, killed) = (folder.path().join("plain"), folder.path().join("killed"));
    let begin = Instant::now();
    let output = start(&plain, &[]).wait_with_output().unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let whole = begin.elapsed();

    let checkpoint = folder.path().join("killed.checkpoint/checkpoint");
    let mut random = 88_172_645_463_325_252u64;
    let mut kills = 0;
    let mut with_checkpoint = 0;
    let stderr = loop {
        let mut child = start(&killed, &["--checkpoint", "--resume"]);
        // From before the first increment to near the end; later runs are left more time, so that the test ends.
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        let share = 0.15 + 0.35 * (random % 1000) as f64 / 1000.0 + 0.1 * f64::from(kills / 8);
        let deadline = Instant::now() + whole.mul_f64(share);
        let ended = loop {
            if let Some(status) = child.try_wait().unwrap() {
                break Some(status);
            }
            if Instant::now() >= deadline {
                break None;
            }
            std::thread::sleep(Duration::from_millis(2));
        };
        match ended {
            Some(_) => {
                let output = child.wait_with_output().unwrap();
                let stderr = String::from_utf8(output.stderr).unwrap();
                assert!(output.status.success(), "{stderr}");
                break stderr;
            }
            None => {
                child.kill().unwrap();
                child.wait().unwrap();
                kills += 1;
                with_checkpoint += i32::from(checkpoint.is_file());
                assert!(kills < 100);
            }
        }
    };
    assert!(
        with_checkpoint >= 2,
        "{kills} kills, {with_checkpoint} of them beyond the first checkpoint"
    );
    assert!(!stderr.contains("last digits"), "{stderr}");

    assert_eq!(summary(&plain), summary(&killed));
    let mut compared = 0;
    for entry in std::fs::read_dir(&plain).unwrap() {
        let name = entry.unwrap().file_name();
        if name != "summary.json" {
            let read = |dir: &Path| std::fs::read(dir.join(&name)).unwrap();
            assert!(read(&plain) == read(&killed), "{name:?} differs");
            compared += 1;
        }
    }
    assert!(compared >= 5, "{compared} files");
    // Nothing is left but the results.
    let left: Vec<_> = std::fs::read_dir(folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    assert_eq!(left.len(), 2, "{left:?}");
}
