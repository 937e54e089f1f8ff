//! Points of a sweep from a table, taken together, in shares, and what they will cost.

use super::sweep::patch;
use super::{brinell, stderr, stdout};
use serde_json::Value;
use std::process::Output;

fn swept(scene: &str, more: &[&str]) -> Output {
    brinell(&[&["sweep", scene, "--no-estimate", "--no-report"], more].concat())
}

/// The figures of a sweep that must end well.
fn points(scene: &str, more: &[&str]) -> Vec<Value> {
    let run = swept(scene, &[&["--json"], more].concat());
    assert!(run.status.success(), "{}", stderr(&run));
    let found: Value = serde_json::from_slice(&run.stdout).unwrap();
    found["points"].as_array().unwrap().clone()
}

const MODULUS: &str = "materials.steel.youngs_modulus";
const RATIO: &str = "materials.steel.poissons_ratio";

#[test]
fn values_taken_together_and_rows_of_a_table_are_the_same_points() {
    let folder = tempfile::tempdir().unwrap();
    let scene = patch(folder.path());
    let (moduli, ratios) = (format!("{MODULUS}=1e5,2e5"), format!("{RATIO}=0.0,0.3"));
    let out = folder.path().join("zipped");
    let vary = ["--vary", &moduli, "--vary", &ratios, "--zip"];
    let zipped = points(
        &scene,
        &[&vary[..], &["--out", out.to_str().unwrap()]].concat(),
    );
    assert_eq!(zipped.len(), 2);
    assert_eq!(zipped[1]["values"][MODULUS], "2e5");
    assert_eq!(zipped[1]["values"][RATIO], "0.3");

    let table = folder.path().join("points.csv");
    std::fs::write(&table, format!("{MODULUS}, {RATIO}\n1e5, 0.0\n2e5, 0.3\n")).unwrap();
    let table = table.to_str().unwrap();
    let out = folder.path().join("tabled");
    let out = ["--out", out.to_str().unwrap()];
    let tabled = points(&scene, &[&["--points", table], &out[..]].concat());
    for (a, b) in zipped.iter().zip(&tabled) {
        assert_eq!((&a["values"], &a["figures"]), (&b["values"], &b["figures"]));
    }
    // With what varies besides.
    let more = ["--points", table, "--vary", "symmetry=1,2"];
    assert_eq!(points(&scene, &more).len(), 4);
}

/// Shares are run side by side; the same command without a share runs nothing again.
#[test]
fn shares_are_gathered() {
    let folder = tempfile::tempdir().unwrap();
    let scene = patch(folder.path());
    let moduli = format!("{MODULUS}=1e5,2e5,3e5,4e5,5e5");
    let shares: Vec<_> = ["1/2", "2/2"]
        .map(|shard| {
            let (scene, moduli) = (scene.clone(), moduli.clone());
            std::thread::spawn(move || swept(&scene, &["--vary", &moduli, "--shard", shard]))
        })
        .into_iter()
        .map(|share| share.join().unwrap())
        .collect();
    for (share, count) in shares.iter().zip([3, 2]) {
        assert!(share.status.success(), "{}", stderr(share));
        assert_eq!(stderr(share).matches(": done in").count(), count);
        assert!(stdout(share).contains("without --shard gathers all"));
    }
    let dir = folder.path().join("patch.sweep");
    assert!(dir.join("sweep-1-of-2.json").exists() && dir.join("sweep-2-of-2.json").exists());
    assert!(!dir.join("sweep.csv").exists());
    let whole = swept(&scene, &["--vary", &moduli]);
    assert!(whole.status.success(), "{}", stderr(&whole));
    assert_eq!(stderr(&whole).matches("finished before").count(), 5);
    let table = std::fs::read_to_string(dir.join("sweep.csv")).unwrap();
    assert_eq!(table.lines().count(), 6, "{table}");
}

/// Nothing is run, and what is finished costs nothing.
#[test]
fn the_cost_of_the_whole_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let scene = patch(folder.path());
    let moduli = format!("{MODULUS}=1e5,2e5,3e5");
    let cost = |more: &[&str]| {
        let output = swept(&scene, &[&["--check", "--vary", &moduli], more].concat());
        assert!(output.status.success(), "{}", stderr(&output));
        stdout(&output)
    };
    let text = cost(&[]);
    assert!(text.contains("3 of 3 points to run"), "{text}");
    assert!(!folder.path().join("patch.sweep").exists());
    points(&scene, &["--vary", &moduli, "--shard", "1/3"]);
    let found: Value = serde_json::from_str(&cost(&["--json"])).unwrap();
    assert_eq!(found["to_run"], 2);
    assert_eq!(found["points"][0]["finished"], true);
    let seconds = |k: usize| {
        found["points"][k]["predicted_run_seconds"]
            .as_f64()
            .unwrap()
    };
    let total = found["predicted_run_seconds"].as_f64().unwrap();
    assert!((total / (seconds(1) + seconds(2)) - 1.0).abs() < 1e-12);
}

/// Names that are cut or written out would be one folder for two points.
#[test]
fn points_have_folders_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    let scene = patch(folder.path());
    let found = points(&scene, &["--vary", "title=\"a b\",\"a/b\""]);
    let names: Vec<&str> = found
        .iter()
        .map(|p| p["folder"].as_str().unwrap())
        .collect();
    assert_ne!(names[0], names[1]);
    assert!(
        names.iter().all(|name| name.starts_with("title__a_b_-")),
        "{names:?}"
    );
}

#[test]
fn points_that_are_none_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let scene = patch(folder.path());
    let table = folder.path().join("points.csv");
    std::fs::write(&table, format!("{MODULUS}\n1e5\n1e5\n")).unwrap();
    let table = table.to_str().unwrap();
    let (moduli, ratio) = (format!("{MODULUS}=1e5,2e5"), format!("{RATIO}=0.3"));
    for (arguments, part) in [
        (
            &["--vary", &moduli, "--vary", &ratio, "--zip"][..],
            "has 1 of them",
        ),
        (&["--points", table], "points.csv: line 3 is line 2 again"),
        (&["--points", "none.csv"], "none.csv"),
        (
            &["--vary", &moduli, "--shard", "3/2"],
            "share 3 of 2 is none",
        ),
        (&["--vary", &moduli, "--shard", "half"], "give I/N"),
        (&["--zip", "--points", table], "--vary"),
        (&[], "--vary"),
    ] {
        let refused = swept(&scene, arguments);
        let code = if part == "none.csv" { 3 } else { 2 };
        assert_eq!(refused.status.code(), Some(code), "{}", stderr(&refused));
        assert!(
            stderr(&refused).contains(part),
            "{part:?} is not in {}",
            stderr(&refused)
        );
    }
    assert!(!folder.path().join("patch.sweep").exists());
}
