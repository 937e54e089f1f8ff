//! A deck, and the scene and mesh that it is written as, are the same model.

use super::{deck_path, folder, run};
use std::process::Command;

/// All decks of the folder.
fn decks() -> Vec<String> {
    let entries = std::fs::read_dir(folder()).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    let mut names: Vec<String> = paths
        .filter(|path| path.extension().is_some_and(|e| e == "inp"))
        .map(|path| path.file_stem().unwrap().to_str().unwrap().to_string())
        .collect();
    names.sort();
    assert!(names.len() >= 12);
    names
}

#[test]
fn a_deck_and_what_it_is_converted_to_give_the_same_results() {
    let work = tempfile::tempdir().unwrap();
    for name in decks() {
        let scene = work.path().join(format!("{name}.toml"));
        let mut command = Command::new(env!("CARGO_BIN_EXE_brinell"));
        command
            .arg("convert")
            .arg(deck_path(&name))
            .arg("--out")
            .arg(&scene);
        assert!(command.output().unwrap().status.success(), "{name}");
        let (model, results) = run(&deck_path(&name), &[]);
        let (again, converted) = run(&scene, &[]);
        assert_eq!(model.mesh.coordinates, again.mesh.coordinates, "{name}");
        assert_eq!(model.mesh.connectivity, again.mesh.connectivity, "{name}");
        assert_eq!(model.mesh.bodies, again.mesh.bodies, "{name}");
        assert_eq!(results.states.len(), converted.states.len());
        for (a, b) in results.states.iter().zip(&converted.states) {
            assert_eq!(a.name, b.name);
            let [a, b] = [a, b].map(|state| &state.fields.as_ref().unwrap().displacement);
            let scale = a.iter().fold(0.0, |m: f64, u| m.max(u.abs()));
            let worst = a
                .iter()
                .zip(b)
                .fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
            // Facets of a surface may come in another order: sums of nodal forces are rounded otherwise.
            assert!(worst <= 1e-12 * scale, "{name}: {worst:e} of {scale:e}");
        }
        // What is there is not written over.
        assert_eq!(command.output().unwrap().status.code(), Some(3), "{name}");
    }
}

#[test]
fn the_program_tells_what_it_made_of_a_deck() {
    let program = || Command::new(env!("CARGO_BIN_EXE_brinell"));
    let output = program()
        .arg("check")
        .arg(deck_path("two_blocks"))
        .output()
        .unwrap();
    assert!(output.status.success());
    let text = String::from_utf8(output.stdout).unwrap();
    // Where a line is broken depends on the length of the path in it.
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    for fragment in [
        "30 nodes, 16 elements",
        "*CONTACT PAIR 1",
        "line 85: *SURFACE BEHAVIOR: PRESSURE-OVERCLOSURE=LINEAR: soft contact of pressure",
        "line 78: *DENSITY: loads are applied slowly: mass has no effect",
        "5 contact pairs",
    ] {
        assert!(text.contains(fragment), "{fragment}\n{text}");
    }
    let out = tempfile::tempdir().unwrap();
    let mut command = program();
    command.arg("run").arg(deck_path("tilted_block"));
    command
        .args(["--no-estimate", "--no-report", "--out"])
        .arg(out.path().join("out"));
    let output = command.output().unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    // The folder holds a scene that can be run again.
    let (_, results) = run(&out.path().join("out/scene_as_run.toml"), &[]);
    assert_eq!(results.states[1].name, "step-2");
}
