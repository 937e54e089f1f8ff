//! A deck, and the scene and mesh that it is written as, are the same model.

use super::{deck_path, folder, run_file};
use crate::support::program::{program, stdout, succeeds};

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
        let mut command = program();
        command
            .arg("convert")
            .arg(deck_path(&name))
            .arg("--out")
            .arg(&scene);
        succeeds(&mut command);
        let (model, results) = run_file(&deck_path(&name), &[]);
        let (again, converted) = run_file(&scene, &[]);
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
            // Facets of a surface may come in another order: sums of nodal forces are rounded
            // otherwise.
            assert!(worst <= 1e-12 * scale, "{name}: {worst:e} of {scale:e}");
        }
        // What is there is not written over.
        assert_eq!(command.output().unwrap().status.code(), Some(3), "{name}");
    }
}

#[test]
fn the_program_tells_what_it_made_of_a_deck() {
    let text = stdout(&succeeds(
        program().arg("check").arg(deck_path("two_blocks")),
    ));
    // Where a line is broken depends on the length of the path in it.
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    for fragment in [
        "30 nodes, 16 elements",
        "*CONTACT PAIR 1",
        "line 85: *SURFACE BEHAVIOR: PRESSURE-OVERCLOSURE=LINEAR: soft contact of pressure",
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
    succeeds(&mut command);
    // The folder holds a scene that can be run again.
    let (_, results) = run_file(&out.path().join("out/scene_as_run.toml"), &[]);
    assert_eq!(results.states[1].name, "step-2");
}

/// The tables of displacements as CalculiX prints them, and the force that holds the base.
#[test]
fn tables_are_those_of_calculix() {
    let work = tempfile::tempdir().unwrap();
    let (out, dat) = (work.path().join("out"), work.path().join("tied.dat"));
    let mut command = program();
    command.arg("run").arg(deck_path("tied"));
    command.args([
        "--no-estimate",
        "--no-report",
        "--set",
        "mesh.formulation=full",
    ]);
    command.arg("--out").arg(&out).arg("--dat").arg(&dat);
    succeeds(&mut command);
    let text = std::fs::read_to_string(&dat).unwrap();
    let tables = |head: &str| -> Vec<Vec<f64>> {
        let from = text.find(head).unwrap_or_else(|| panic!("{head}\n{text}"));
        let rows = text[from..].lines().skip(2);
        let rows = rows.take_while(|line| !line.trim().is_empty());
        let numbers = |line: &str| {
            line.split_whitespace()
                .map(|w| w.parse().unwrap())
                .collect()
        };
        rows.map(numbers).collect()
    };
    let reference = std::fs::read_to_string(folder().join("reference/tied.dat")).unwrap();
    let printed = tables("displacements (vx,vy,vz) for set NALL and time  0.1000000E+01");
    let theirs: Vec<Vec<f64>> = (reference.lines().skip(2))
        .filter(|line| !line.trim().is_empty())
        .map(|line| {
            line.split_whitespace()
                .map(|w| w.parse().unwrap())
                .collect()
        })
        .collect();
    assert_eq!(printed.len(), theirs.len());
    let scale = theirs
        .iter()
        .flat_map(|row| &row[1..])
        .fold(0.0, |m: f64, u| m.max(u.abs()));
    for (a, b) in printed.iter().zip(&theirs) {
        assert_eq!(a[0], b[0]);
        for (a, b) in a[1..].iter().zip(&b[1..]) {
            assert!((a - b).abs() <= 1e-6 * scale, "{a} {b}");
        }
    }
    // Twelve nodes are pulled along x by 10, a face of 6 along z by 50.
    let total = &tables("total force (fx,fy,fz) for set BASE and time")[0];
    for (force, exact) in total.iter().zip([-120.0, 0.0, -300.0]) {
        assert!((force - exact).abs() < 1e-4, "{total:?}");
    }
    // Of nodes that follow and of those inside nothing is left.
    for row in tables("forces (fx,fy,fz) for set OVER and time") {
        assert!(row[1..].iter().all(|f| f.abs() < 1e-9), "{row:?}");
    }
    let stresses = tables("stresses (elem, integ.pnt.,sxx,syy,szz,sxy,sxz,syz) for set UPPER");
    // Eight integration points each.
    assert_eq!((stresses.len(), stresses[0].len()), (96, 8));
    let mean = stresses.iter().map(|row| row[4]).sum::<f64>() / 96.0;
    assert!((mean / 50.0 - 1.0).abs() < 0.1, "{mean}");
}

#[test]
fn a_new_scene_from_a_deck_is_its_conversion() {
    let work = tempfile::tempdir().unwrap();
    let scene = work.path().join("new.toml");
    let output = program()
        .args(["new", "--from"])
        .arg(deck_path("ring"))
        .arg("--out")
        .arg(&scene)
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(
        output.status.success() && text.contains("run it with: brinell run"),
        "{text}"
    );
    let (_, results) = run_file(&scene, &[]);
    assert_eq!(results.states[0].name, "step-1");
    for arguments in [&["new"][..], &["new", "punch", "--from", "x.inp"]] {
        let output = program().args(arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    }
}
