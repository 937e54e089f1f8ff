//! Which solvers a build has.

use super::{brinell, scene};

/// The solver in Rust alone runs every scene to its end.
#[cfg(feature = "faer")]
#[test]
fn faer_runs_every_scene() {
    let folder = tempfile::tempdir().unwrap();
    let scenes = concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes");
    let mut names = Vec::new();
    for entry in std::fs::read_dir(scenes).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "toml") {
            names.push(path.file_stem().unwrap().to_str().unwrap().to_string());
        }
    }
    assert!(names.len() > 10, "{names:?}");
    for name in names {
        let out = folder.path().join(&name);
        let text = std::fs::read_to_string(scene(&name)).unwrap();
        // Solids on a coarser mesh than their own.
        let coarse = match text.contains("[mesh.curved_bodies]") {
            true => "mesh.curved_bodies.resolution=4",
            false => "title=as it stands",
        };
        let output = brinell(&[
            "run",
            &scene(&name),
            "--set",
            coarse,
            "--solver",
            "faer",
            "-q",
            "--no-estimate",
            "--no-report",
            "--out",
            out.to_str().unwrap(),
        ]);
        assert_eq!(output.status.code(), Some(0), "{name}: {output:?}");
        let summary = std::fs::read_to_string(out.join("summary.json")).unwrap();
        assert!(summary.contains(r#""solver": "faer""#), "{name}");
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
