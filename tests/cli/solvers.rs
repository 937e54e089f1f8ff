//! Which solvers a build has.

use super::{brinell, scene_path, stderr};
use serde_json::Value;

/// Each solver of the build is the one that the run names.
#[test]
fn a_solver_is_the_one_that_was_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    for (solver, is_there) in [
        ("cholmod", cfg!(feature = "cholmod")),
        ("faer", cfg!(feature = "faer")),
    ] {
        if is_there {
            let path = scene_path("contact_patch");
            let run = ["run", &path, "-q", "--json", "--no-estimate", "--no-report"];
            let asked = ["--solver", solver, "--out", out.to_str().unwrap()];
            let output = brinell(&[&run[..], &asked].concat());
            let summary: Value = serde_json::from_slice(&output.stdout).unwrap();
            assert_eq!(output.status.code(), Some(0));
            assert_eq!(summary["solver"], solver);
        }
    }
}

/// A solver that this build does not have is named with the cargo feature that brings it.
#[test]
fn a_solver_that_is_not_built_in_is_refused_with_its_feature() {
    for (solver, is_there) in [
        ("cholmod", cfg!(feature = "cholmod")),
        ("faer", cfg!(feature = "faer")),
        ("dense", true),
    ] {
        let output = brinell(&["check", &scene_path("contact_patch"), "--solver", solver]);
        let stderr = stderr(&output);
        if is_there {
            assert_eq!(output.status.code(), Some(0), "{solver}: {stderr}");
        } else {
            assert_eq!(output.status.code(), Some(2), "{solver}: {stderr}");
            let words = [format!("`{solver}`"), "cargo feature".into()];
            assert!(words.iter().all(|w| stderr.contains(w)), "{stderr}");
        }
    }
}
