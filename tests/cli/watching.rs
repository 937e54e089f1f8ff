//! Looking at a run: progress as JSON lines, results in the terminal.

use super::{brinell, scene_path, stderr, stdout, succeeds};
use serde_json::Value;

#[test]
fn progress_is_a_json_object_per_line() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let run = succeeds(&[
        "run",
        &scene_path("three_bodies"),
        "--progress",
        "json",
        "--out",
        out.to_str().unwrap(),
    ]);
    let text = String::from_utf8(run.stderr).unwrap();
    let events: Vec<Value> = text
        .lines()
        .map(|line| serde_json::from_str(line).unwrap_or_else(|e| panic!("{e}: {line}")))
        .collect();
    let of = |name: &str| -> Vec<&Value> { events.iter().filter(|e| e["event"] == name).collect() };
    let phases = of("phase");
    for name in [
        "mesh and model",
        "assembly",
        "factorisation",
        "load program",
        "output",
    ] {
        assert!(phases.iter().any(|e| e["name"] == name), "{name}: {text}");
    }
    for phase in &phases {
        let predicted = phase["predicted_seconds"].as_f64();
        assert!(predicted.is_some_and(|s| s > 0.0), "{phase}");
    }
    let increments = of("increment");
    let history = std::fs::read_to_string(out.join("history.csv")).unwrap();
    assert_eq!(increments.len(), history.lines().count() - 1);
    let mut last = [0.0, 0.0];
    for event in &increments {
        let now = ["seconds", "fraction"].map(|key| event[key].as_f64().unwrap());
        assert!(
            now[0] >= last[0] && now[1] >= last[1] && now[1] <= 1.0 + 1e-12,
            "{event}"
        );
        assert!(event["row"]["event"].is_string());
        assert!(event["seconds_left"].as_f64() >= Some(0.0), "{event}");
        last = now;
    }
    assert_eq!(last[1], 1.0, "the program was done to its end");
    // Not on a terminal: a line for each phase, with its time, and the time it will take where that
    // is worth telling.
    for other in [&["--progress", "plain"] as &[&str], &[]] {
        let run = succeeds(&[&["yield", &scene_path("thick_cylinder")], other].concat());
        let text = String::from_utf8(run.stderr).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines.len() >= 4, "{text}");
        for line in lines {
            assert!(line.starts_with('[') && line.contains(" s] "), "{text}");
        }
    }
    succeeds(&["yield", &scene_path("thick_cylinder"), "--progress", "bar"]);
}

#[test]
fn results_are_shown_in_the_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let out = out.to_str().unwrap();
    succeeds(&["run", "-q", &scene_path("three_bodies"), "--out", out]);
    let shown = succeeds(&["view", out, "--terminal", "--width", "60"]);
    let text = stdout(&shown);
    for word in [
        "Shim between two blocks",
        "First yield",
        "max pressure [MPa] against load [MPa]",
    ] {
        assert!(text.contains(word), "{word}:\n{text}");
    }
    // Tables and text as well as plots; three bodies have more columns than fit.
    let wide = text.lines().find(|line| line.chars().count() > 60);
    assert_eq!(wide, None, "{text}");
    let dots = text.lines().filter(|l| l.contains('│')).collect::<Vec<_>>();
    assert!(
        dots.len() >= 24 && dots.iter().all(|l| l.chars().count() <= 60),
        "{text}"
    );
    for more in [&[] as &[&str], &["--terminal"]] {
        let nothing = brinell(&[&["view", folder.path().to_str().unwrap()], more].concat());
        assert_eq!(nothing.status.code(), Some(3));
        assert!(stderr(&nothing).contains("summary.json"));
    }
}

#[test]
fn an_error_is_a_json_object_too() {
    let run = brinell(&["run", &scene_path("no_such_scene"), "--progress", "json"]);
    assert_eq!(run.status.code(), Some(3));
    let text = String::from_utf8(run.stderr).unwrap();
    let event: Value = serde_json::from_str(text.trim_end()).unwrap();
    assert_eq!(
        (&event["event"], &event["exit_code"]),
        (&"error".into(), &3.into())
    );
    assert!(event["message"].as_str().unwrap().contains("no_such_scene"));
}
