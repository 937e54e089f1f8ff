//! One thread or two: the same bits.

use crate::support::program::{program, succeeds, summary};
use crate::support::tools::with_these_kernels;
use crate::support::{SMALL_BALL, either, scene_file, sparse};
use serde_json::Value;
use std::path::Path;

fn run_on_threads(name: &str, [solver, threads]: [&str; 2], out: &Path, overrides: &[&str]) {
    let mut command = program();
    command
        .arg("run")
        .arg(scene_file(name))
        .args(["-q", "--solver", solver, "--threads", threads, "--out"])
        .arg(out)
        .env_remove("OPENBLAS_NUM_THREADS");
    // Companions are runs like any other: of the small models they are made, too.
    if !name.starts_with("hard/") {
        command.arg("--no-estimate");
    }
    for set in overrides {
        command.args(["--set", set]);
    }
    succeeds(with_these_kernels(&mut command));
}

/// The summary without what depends on the clock and the process.
fn summary_without_times(out: &Path) -> Value {
    let mut summary = summary(out);
    let object = summary.as_object_mut().unwrap();
    assert!(object.remove("timings").is_some());
    assert!(object.remove("peak_memory_bytes").is_some());
    for effect in object["effects"].as_object_mut().unwrap().values_mut() {
        assert!(effect.as_object_mut().unwrap().remove("seconds").is_some());
    }
    if let Some(accuracy) = object["accuracy"].as_object_mut() {
        assert!(accuracy.remove("seconds").is_some());
        for companion in accuracy["companions"].as_array_mut().unwrap() {
            assert!(
                companion
                    .as_object_mut()
                    .unwrap()
                    .remove("seconds")
                    .is_some()
            );
        }
    }
    summary
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    // The models are too large for the dense one. What is computed outside the backend is the same
    // whichever it is.
    for (backend, scenes) in sparse().iter().zip([3, either(1, 3)]) {
        assert_threads_change_no_bit(backend.name(), scenes);
    }
}

fn assert_threads_change_no_bit(solver: &str, scenes: usize) {
    let all = [
        (
            "hard/unload_reload",
            vec!["mesh.cylinder_on_half_plane.resolution=6"],
        ),
        ("ball_on_flat_3d", SMALL_BALL.to_vec()),
        // Deep in plastic flow, its tangents factored.
        ("flat_punch", vec!["mesh.parts.0.block.elements=[20,20]"]),
        (
            "hard/zero_gap_conforming",
            vec!["mesh.disc_in_plate.resolution=32"],
        ),
    ];
    for (name, overrides) in &all[..scenes] {
        let folder = tempfile::tempdir().unwrap();
        let [one, two] = ["1", "2"].map(|threads| {
            let out = folder.path().join(threads);
            run_on_threads(name, [solver, threads], &out, overrides);
            out
        });
        assert_eq!(
            summary_without_times(&one),
            summary_without_times(&two),
            "{name}"
        );
        let files = |out: &Path| {
            let mut names: Vec<_> = std::fs::read_dir(out)
                .unwrap()
                .map(|e| e.unwrap().file_name())
                .collect();
            names.sort();
            names
        };
        assert_eq!(files(&one), files(&two));
        assert!(files(&one).len() >= 4);
        // The report tells the time by phase.
        let timed = ["summary.json", "report.html"];
        for file in files(&one).iter().filter(|f| !timed.iter().any(|t| f == t)) {
            let [a, b] = [&one, &two].map(|out| std::fs::read(out.join(file)).unwrap());
            assert!(a == b, "{name}: {} differs", file.display());
        }
    }
}
