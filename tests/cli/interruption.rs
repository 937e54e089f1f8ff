//! Ctrl-C: what was computed is written and marked as incomplete.
#![cfg(unix)]

use super::{Folder, program};
use crate::support::limit;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A run of thousands of cheap increments.
fn long() -> Folder {
    Folder::with_changes(
        "thick_cylinder",
        &[
            ("elements = [16, 16]", "elements = [2, 2]"),
            (
                "[program]",
                "[program]\nstepping = \"steps\"\nsteps = 10000000",
            ),
            (
                "yield_stress = 240.0",
                "yield_stress = 240.0\nplastic_modulus = 2000.0",
            ),
        ],
    )
}

fn start(folder: &Folder, progress: &str) -> Child {
    let (scene, out) = (folder.scene(), folder.path("out"));
    program()
        .args([
            "run",
            scene.to_str().unwrap(),
            "--threads",
            "1",
            "--progress",
            progress,
            "--out",
            out.to_str().unwrap(),
        ])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

fn interrupt(child: &Child, signal: &str) {
    let status = Command::new("kill")
        .args([signal, &child.id().to_string()])
        .status()
        .unwrap();
    assert!(status.success());
}

/// Waits until the program has said `what` on standard error; what it says after that.
fn wait_for(child: &mut Child, what: &str) -> std::thread::JoinHandle<String> {
    use std::io::BufRead;
    let stderr = child.stderr.take().unwrap();
    let mut lines = std::io::BufReader::new(stderr).lines();
    assert!(
        lines.any(|line| line.unwrap().contains(what)),
        "{what:?} was never said"
    );
    // The rest is read so that the program does not stop at a full or closed pipe.
    std::thread::spawn(move || lines.map(|line| line.unwrap() + "\n").collect())
}

#[test]
fn the_first_signal_ends_the_run_with_results_that_are_marked_incomplete() {
    for (signal, code, name) in [
        ("-INT", 130, "Ctrl-C"),
        ("-TERM", 143, "SIGTERM"),
        ("-HUP", 129, "SIGHUP"),
    ] {
        let folder = long();
        let mut child = start(&folder, "plain");
        let rest = wait_for(&mut child, "load program");
        // The first increments (to first yield) need no more than this, on a loaded machine too.
        std::thread::sleep(Duration::from_millis(1500));
        interrupt(&child, signal);
        let status = limit::wait(&mut child);
        assert_eq!(status.code(), Some(code));
        let rest = rest.join().unwrap();
        let told = [
            format!("{name}: stopping at the end of this increment"),
            format!("stopped on request ({name})"),
        ];
        for told in told {
            assert!(rest.contains(&told), "no {told:?} in {rest}");
        }
        assert!(!rest.contains("by the user"), "{rest}");
        let summary = folder.summary();
        assert!(
            summary["incomplete"].as_str().unwrap().contains("stopped"),
            "{summary}"
        );
        let history = std::fs::read_to_string(folder.path("out/history.csv")).unwrap();
        assert!(history.lines().count() >= 2, "no increment: {history}");
        assert_eq!(folder.entries(), 2);
    }
}

#[test]
fn a_second_signal_ends_the_program_at_once_and_leaves_nothing() {
    // One huge increment: its factorisation and first iterations take far longer than the signals,
    // be it the sparse one or the dense one, which takes at most 6,000 freedoms.
    let elements = if cfg!(any(feature = "cholmod", feature = "faer")) {
        "elements = [160, 320]"
    } else {
        "elements = [28, 32]"
    };
    let folder = Folder::with_changes("thick_cylinder", &[("elements = [16, 16]", elements)]);
    let mut child = start(&folder, "plain");
    wait_for(&mut child, "mesh and model");
    interrupt(&child, "-INT");
    std::thread::sleep(Duration::from_millis(400));
    let begin = Instant::now();
    interrupt(&child, "-INT");
    let status = limit::wait(&mut child);
    assert_eq!(status.code(), Some(130));
    assert!(begin.elapsed() < Duration::from_secs(5));
    assert_eq!(folder.entries(), 1);
}

/// Standard error is JSON to the last line, also where the run is stopped.
#[test]
fn a_signal_is_an_event_where_progress_is_json() {
    use std::io::{BufRead, BufReader};
    let folder = long();
    let mut child = start(&folder, "json");
    let lines = BufReader::new(child.stderr.take().unwrap()).lines();
    let mut events = Vec::new();
    for line in lines {
        let line = line.unwrap();
        let event: serde_json::Value =
            serde_json::from_str(&line).unwrap_or_else(|e| panic!("{e}: {line}"));
        if event["event"] == "increment" && events.is_empty() {
            interrupt(&child, "-INT");
        }
        if event["event"] != "phase" {
            events.push(event);
        }
    }
    assert_eq!(limit::wait(&mut child).code(), Some(130));
    assert!(
        events.iter().any(|e| e["event"] == "stopping"),
        "{events:?}"
    );
    let last = events.last().unwrap();
    assert_eq!(
        (&last["event"], &last["exit_code"]),
        (&"error".into(), &130.into())
    );
}
