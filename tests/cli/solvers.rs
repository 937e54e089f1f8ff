//! Which solvers a build has.

use super::{brinell, scene};
#[cfg(feature = "faer")]
use {crate::support::scenes, serde_json::Value};

/// The solver in Rust alone runs every scene to its end, and comes to what CHOLMOD comes to where
/// the build has that.
#[cfg(feature = "faer")]
#[test]
fn faer_runs_every_scene() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let run = |name: &str, solver: &str| {
        let path = scene(name);
        let quietly = ["run", &path, "-q", "--json", "--no-estimate", "--no-report"];
        let out = ["--solver", solver, "--out", out.to_str().unwrap()];
        let smaller = scenes::smaller(name).iter().flat_map(|set| ["--set", set]);
        let arguments: Vec<&str> = quietly.into_iter().chain(out).chain(smaller).collect();
        let output = brinell(&arguments);
        let summary: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(summary["solver"], solver);
        (output.status.code().unwrap(), summary)
    };
    let names = scenes::all();
    let mut close = 0;
    for name in &names {
        let (code, found) = run(name, "faer");
        // Two scenes are there for their limit load.
        let end = match ["hard/limit_load", "hard/nearly_incompressible"].contains(&name.as_str()) {
            true => 6,
            false => 0,
        };
        assert_eq!(code, end, "{name}: {}", found["incomplete"]);
        if cfg!(feature = "cholmod") {
            let (code, expected) = run(name, "cholmod");
            assert_eq!(code, end, "{name}: {}", expected["incomplete"]);
            let off = scenes::difference(&found, &expected);
            println!("{name}: {off:.1e}");
            assert!(off <= scenes::agreement(name), "{name}: {off:e}");
            close += usize::from(off <= 1e-10);
        }
    }
    println!("of {} scenes within 1e-10 of CHOLMOD: {close}", names.len());
}

/// A solver that this build does not have is named with the cargo feature that brings it.
#[test]
fn a_solver_that_is_not_built_in_is_refused_with_its_feature() {
    for (solver, is_there) in [
        ("cholmod", cfg!(feature = "cholmod")),
        ("faer", cfg!(feature = "faer")),
        ("dense", true),
    ] {
        let output = brinell(&["check", &scene("contact_patch"), "--solver", solver]);
        let stderr = String::from_utf8_lossy(&output.stderr);
        if is_there {
            assert_eq!(output.status.code(), Some(0), "{solver}: {stderr}");
        } else {
            assert_eq!(output.status.code(), Some(2), "{solver}: {stderr}");
            let words = [format!("`{solver}`"), "cargo feature".into()];
            assert!(words.iter().all(|w| stderr.contains(w)), "{stderr}");
        }
    }
}
