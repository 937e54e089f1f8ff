//! `brinell sweep` and `brinell materials`.

use super::{brinell, program, stderr, succeeds};
use serde_json::Value;
use std::path::Path;
use std::process::Output;

/// Two blocks of one element each: a run takes no time.
pub(super) fn patch(folder: &Path) -> String {
    let scene = folder.join("patch.toml");
    let text = include_str!("../../data/scenes/contact_patch.toml");
    std::fs::write(&scene, text).unwrap();
    scene.to_str().unwrap().to_string()
}

fn sweep(scene: &str, more: &[&str]) -> Output {
    let modulus = "materials.steel.youngs_modulus=100000.0,200000.0";
    brinell(&[&["sweep", scene, "--vary", modulus], more].concat())
}

/// The load that answers is what a sweep shows first, with a chart: twice as stiff it is twice as
/// large for the same approach.
#[test]
fn a_sweep_shows_the_loads_that_are_found() {
    let folder = tempfile::tempdir().unwrap();
    let scene = patch(folder.path());
    let target = "program.targets=[{ name = \"hit\", approach = 1e-4 }]";
    let output = sweep(&scene, &["--no-estimate", "--set", target, "--json"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    let load = |k: usize| {
        found["points"][k]["figures"]["states.hit.load"]
            .as_f64()
            .unwrap()
    };
    assert!((load(1) / load(0) - 2.0).abs() < 1e-7);
    let dir = folder.path().join("patch.sweep");
    assert!(dir.join("sweep_states_hit_load.svg").exists());
    let printed = sweep(&scene, &["--no-estimate", "--set", target]).stdout;
    let printed = String::from_utf8_lossy(&printed).into_owned();
    let first_figure = printed.lines().find(|line| line.contains("youngs_modulus"));
    assert!(
        first_figure.is_some_and(|line| line.contains("load")),
        "{printed}"
    );
    // Asked for alone, it is the one chart.
    let out = folder.path().join("one");
    let more = ["--show", "states.hit.load", "--out", out.to_str().unwrap()];
    let one = sweep(
        &scene,
        &[&["--no-estimate", "--set", target], &more[..]].concat(),
    );
    assert!(one.status.success(), "{}", stderr(&one));
    let names = std::fs::read_dir(out)
        .unwrap()
        .map(|entry| entry.unwrap().file_name());
    let charts: Vec<_> = names
        .filter(|name| name.to_str().unwrap().ends_with(".svg"))
        .collect();
    assert_eq!(charts, ["sweep_states_hit_load.svg"]);
}

#[test]
fn a_sweep_has_a_row_per_point_and_goes_on_where_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let scene = patch(folder.path());
    let ratio = "materials.steel.poissons_ratio=0.0,0.3";
    // What a point varies counts, whatever is set for all.
    let set = "materials.steel.youngs_modulus=1000.0";
    let common = ["--vary", ratio, "--jobs", "2", "--set", set];
    let run = |more: &[&str]| sweep(&scene, &[&common[..], more].concat());
    let first = run(&["--json"]);
    assert!(first.status.success(), "{}", stderr(&first));
    assert_eq!(
        stderr(&first).matches(": done in").count(),
        4,
        "{}",
        stderr(&first)
    );
    let found: Value = serde_json::from_slice(&first.stdout).unwrap();
    let points = found["points"].as_array().unwrap();
    assert_eq!(points.len(), 4);
    // Twice as stiff moves half as far.
    let approach = |k: usize| {
        let figures = points[k]["figures"].as_object().unwrap();
        let path = figures
            .keys()
            .find(|path| path.ends_with(".approach"))
            .unwrap();
        figures[path].as_f64().unwrap()
    };
    assert!((approach(0) / approach(2) - 2.0).abs() < 1e-9);

    let dir = folder.path().join("patch.sweep");
    // Figures of states are those of the run.
    let of_point = dir.join("youngs_modulus_100000.0-poissons_ratio_0.0/summary.json");
    let summary = std::fs::read_to_string(of_point).unwrap();
    let summary: Value = serde_json::from_str(&summary).unwrap();
    let state = &summary["states"][0];
    let name = state["name"].as_str().unwrap();
    let figures = points[0]["figures"].as_object().unwrap();
    let of_state = |path: &str| Some(path.strip_prefix(&format!("states.{name}."))?.to_string());
    let mut compared = 0;
    for (path, value) in figures {
        if let Some(key) = of_state(path) {
            assert_eq!(value.as_f64(), state[&key].as_f64(), "{path}");
            compared += 1;
        }
    }
    assert!(
        compared > 5 && state["closed_pairs"].as_u64() > Some(0),
        "{figures:?}"
    );

    let table = std::fs::read_to_string(dir.join("sweep.csv")).unwrap();
    assert_eq!(table.lines().count(), 5, "{table}");
    let head = "materials.steel.youngs_modulus,materials.steel.poissons_ratio,exit_code,message,";
    assert!(table.starts_with(head), "{table}");
    let charts = std::fs::read_dir(&dir).unwrap().flatten();
    let charts = charts.filter(|e| e.path().extension().is_some_and(|e| e == "svg"));
    assert!(charts.count() >= 1);

    // Nothing is run again, unless it has changed or its results are gone.
    let again = run(&[]);
    assert_eq!(
        stderr(&again).matches(": finished before").count(),
        4,
        "{}",
        stderr(&again)
    );
    let printed = String::from_utf8_lossy(&again.stdout).into_owned();
    assert!(
        printed.contains("youngs_modulus  poissons_ratio"),
        "{printed}"
    );
    std::fs::remove_dir_all(dir.join("youngs_modulus_100000.0-poissons_ratio_0.3")).unwrap();
    let third = run(&[]);
    assert_eq!(
        stderr(&third).matches(": done in").count(),
        1,
        "{}",
        stderr(&third)
    );
    let changed = run(&["--set", "title=other"]);
    assert_eq!(
        stderr(&changed).matches(": done in").count(),
        4,
        "{}",
        stderr(&changed)
    );
}

#[test]
fn what_is_wrong_with_any_point_is_said_before_the_first_runs() {
    let folder = tempfile::tempdir().unwrap();
    let scene = patch(folder.path());
    for (vary, part) in [
        (
            "kind=plane_strain,plane_straim",
            "did you mean \"plane_strain\"?",
        ),
        ("program.targets=1", "program.targets"),
    ] {
        let refused = brinell(&["sweep", &scene, "--vary", vary]);
        assert_eq!(refused.status.code(), Some(2), "{}", stderr(&refused));
        assert!(stderr(&refused).contains(part), "{}", stderr(&refused));
        assert!(!folder.path().join("patch.sweep").exists());
    }
    let mine = folder.path().join("mine");
    std::fs::create_dir(&mine).unwrap();
    std::fs::write(mine.join("notes.txt"), "mine").unwrap();
    let refused = brinell(&[
        "sweep",
        &scene,
        "--vary",
        "symmetry=1,2",
        "--out",
        mine.to_str().unwrap(),
    ]);
    assert_eq!(refused.status.code(), Some(2), "{}", stderr(&refused));
    assert!(
        stderr(&refused).contains("is no sweep of brinell"),
        "{}",
        stderr(&refused)
    );
    assert_eq!(std::fs::read_dir(&mine).unwrap().count(), 1);
    // No key of that name: the point would be refused.
    assert_eq!(
        sweep(&scene, &["--vary", "no.such.key=1"]).status.code(),
        Some(2)
    );
}

/// A point that fails is a row with its reason; the others are run.
#[test]
fn a_point_that_fails_is_told_in_its_row() {
    let folder = tempfile::tempdir().unwrap();
    let scene = patch(folder.path());
    let run = brinell(&["sweep", &scene, "--vary", "support=[],[]  ", "--no-report"]);
    // The same value twice is a slip.
    assert_eq!(run.status.code(), Some(2), "{}", stderr(&run));
    let unheld = brinell(&["sweep", &scene, "--vary", "support=[]", "--no-report"]);
    assert_eq!(unheld.status.code(), Some(5), "{}", stderr(&unheld));
    let printed = String::from_utf8_lossy(&unheld.stdout).into_owned();
    assert!(printed.contains("exit code 4"), "{printed}");
    assert!(
        stderr(&unheld).contains("1 of 1 points did not end well"),
        "{}",
        stderr(&unheld)
    );
}

/// Ctrl-C reaches the running point, which writes what it has; the same command goes on.
#[cfg(all(unix, any(feature = "cholmod", feature = "faer")))]
#[test]
fn an_interrupted_sweep_keeps_what_it_has() {
    use std::process::Stdio;
    use std::time::{Duration, Instant};
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("ball.toml");
    succeeds(&[
        "new",
        "ball-on-flat",
        "--load",
        "1000",
        "--resolution",
        "16",
        "--out",
        scene.to_str().unwrap(),
    ]);
    let out = folder.path().join("swept");
    let mut child = program()
        .args([
            "sweep",
            scene.to_str().unwrap(),
            "--no-estimate",
            "--no-report",
        ])
        .args(["--vary", "materials.steel.yield_stress=400,500,600"])
        .args(["--out", out.to_str().unwrap()])
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // The first point is under way as soon as its directory is in the making.
    let start = Instant::now();
    while std::fs::read_dir(&out).map_or(0, |d| d.count()) == 0 {
        assert!(start.elapsed() < Duration::from_secs(60));
        std::thread::sleep(Duration::from_millis(20));
    }
    let pid = rustix::process::Pid::from_raw(i32::try_from(child.id()).unwrap()).unwrap();
    rustix::process::kill_process(pid, rustix::process::Signal::INT).unwrap();
    let status = child.wait().unwrap();
    assert_eq!(status.code(), Some(130));
    let record = std::fs::read_to_string(out.join("sweep.json")).unwrap();
    let record: Value = serde_json::from_str(&record).unwrap();
    let points = record["points"].as_array().unwrap();
    assert_eq!(points.len(), 3);
    assert!(points[2]["exit_code"].is_null(), "{record}");
    // No temporary is left behind.
    let hidden = std::fs::read_dir(&out).unwrap().flatten();
    let hidden = hidden.filter(|e| e.file_name().to_string_lossy().starts_with('.'));
    assert_eq!(hidden.count(), 0);
}

#[test]
fn materials_are_listed_with_their_sources_and_taken_by_name() {
    let list = String::from_utf8(brinell(&["materials"]).stdout).unwrap();
    assert!(
        list.contains("42CrMo4+QT") && list.contains("Ti-6Al-4V"),
        "{list}"
    );
    let one = String::from_utf8(brinell(&["materials", "S355"]).stdout).unwrap();
    assert!(
        one.contains("yield_stress") && one.contains("EN 1993-1-1"),
        "{one}"
    );
    let unknown = brinell(&["materials", "S356"]);
    assert_eq!(unknown.status.code(), Some(2));
    assert!(
        stderr(&unknown).contains("did you mean \"S355\"?"),
        "{}",
        stderr(&unknown)
    );

    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("ball.toml");
    succeeds(&[
        "new",
        "ball-on-flat",
        "--diameter",
        "10",
        "--material",
        "100Cr6",
        "--second-material",
        "S355",
        "--load",
        "5",
        "--resolution",
        "2",
        "--out",
        scene.to_str().unwrap(),
    ]);
    let checked = brinell(&["check", scene.to_str().unwrap()]);
    let text = String::from_utf8_lossy(&checked.stdout).into_owned();
    assert!(checked.status.success(), "{}", stderr(&checked));
    // The steel of the list yields at its 355 MPa, the ball not at all.
    let yields = text.lines().find(|l| l.contains("plasticity")).unwrap();
    assert!(
        yields.contains("flat") && !yields.contains("ball"),
        "{text}"
    );
}
