//! The directory of the results while runs come and go: killed ones, failed ones, two at once.
#![cfg(unix)]

use super::{Folder, program};
use crate::support::limit;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

/// A quick scene, and one that takes long, in one folder.
fn folder() -> Folder {
    let folder = Folder::with_changes("contact_patch", &[]);
    let long = super::scene_path("thick_cylinder");
    let text = std::fs::read_to_string(long).unwrap();
    let text = text.replace("elements = [16, 16]", "elements = [2, 2]");
    let text = text.replace(
        "[program]",
        "[program]\nstepping = \"steps\"\nsteps = 10000000",
    );
    let hardening = "yield_stress = 240.0\nplastic_modulus = 2000.0";
    let text = text.replace("yield_stress = 240.0", hardening);
    std::fs::write(folder.path("long.toml"), text).unwrap();
    folder
}

/// Starts the long run to `out`, and waits until it has the directory.
fn start(folder: &Folder) -> Child {
    let child = program()
        .args(["run", "-q", "--threads", "1", "--out"])
        .args([folder.path("out"), folder.path("long.toml")])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let start = Instant::now();
    while !folder.path(".out.partial").exists() {
        assert!(start.elapsed() < Duration::from_secs(60));
        std::thread::sleep(Duration::from_millis(5));
    }
    // Locked as soon as it is there; on a loaded machine not in the same instant.
    std::thread::sleep(Duration::from_millis(500));
    child
}

fn names(folder: &Folder) -> Vec<String> {
    let entries = std::fs::read_dir(folder.folder.path()).unwrap();
    let mut names: Vec<String> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn a_second_run_to_the_same_directory_is_refused_while_the_first_goes_on() {
    let folder = folder();
    let mut first = start(&folder);
    let output = folder.brinell("run", &["-q"]);
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    assert!(stderr.contains("another run is writing to"), "{stderr}");
    assert!(stderr.contains("--out"), "{stderr}");
    first.kill().unwrap();
    limit::wait(&mut first);
    // What was killed left its directory; the next run to the same place takes it away.
    assert!(folder.path(".out.partial").exists());
    assert_eq!(folder.brinell("run", &["-q"]).status.code(), Some(0));
    assert_eq!(names(&folder), ["long.toml", "out", "scene.toml"]);
}

#[test]
fn results_of_an_earlier_run_are_marked_until_a_run_succeeds() {
    let folder = folder();
    let stale = folder.path("out/stale.txt");
    assert_eq!(folder.brinell("run", &["-q"]).status.code(), Some(0));
    assert!(!stale.exists());
    let before = std::fs::read(folder.path("out/summary.json")).unwrap();

    // Killed: marked since its start.
    let mut killed = start(&folder);
    killed.kill().unwrap();
    limit::wait(&mut killed);
    let text = std::fs::read_to_string(&stale).unwrap();
    assert!(text.contains("has not ended yet, or was killed"), "{text}");

    // Refused before it has begun, and failed while it computes.
    for (set, code) in [("symmetry=3", 2), ("load.0.pressure=-10.0", 4)] {
        let output = folder.brinell("run", &["-q", "--set", set, "--set", "support=[]"]);
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{stderr}");
        let text = std::fs::read_to_string(&stale).unwrap();
        assert!(
            text.contains(&format!("failed (exit code {code})")),
            "{text}"
        );
    }
    assert_eq!(
        std::fs::read(folder.path("out/summary.json")).unwrap(),
        before
    );
    let out = folder.path("out");
    let view = super::brinell(&["view", out.to_str().unwrap(), "--terminal"]);
    let stderr = String::from_utf8(view.stderr).unwrap();
    assert!(
        stderr.starts_with("warning: These results are of an earlier run"),
        "{stderr}"
    );

    assert_eq!(folder.brinell("run", &["-q"]).status.code(), Some(0));
    assert!(!stale.exists());
    assert_eq!(names(&folder), ["long.toml", "out", "scene.toml"]);
}
