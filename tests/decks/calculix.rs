//! Displacements of every node at the end of every step, compared with those of CalculiX.

use super::{deck_path, folder, run_file};
use crate::support::tools;
use brinell::model::Model;
use brinell::results::Results;
use std::collections::BTreeMap;
use std::process::{Command, Stdio};

/// A deck and how far its displacements may be from those of CalculiX, as a share of the largest.
struct Case {
    name: &'static str,
    overrides: &'static [&'static str],
    bound: f64,
}

/// CalculiX prints seven digits.
const PRINTED: f64 = 1e-6;
const FULL: &[&str] = &["mesh.formulation=full"];

const CASES: [Case; 45] = [
    case("two_blocks", FULL, PRINTED),
    case("history", &[], PRINTED),
    // Flow turns, and CalculiX takes each of its increments in one step of the implicit rule; with
    // ten times as many increments brinell changes by 3e-6.
    case("plastic", &[], 1.5e-3),
    case("bricks", FULL, PRINTED),
    case("ring", &[], PRINTED),
    case("tetrahedra", &[], PRINTED),
    case("wedges", &[], PRINTED),
    case("tube", &[], 2e-4),
    case("heat", FULL, PRINTED),
    case("gradient", &[], PRINTED),
    case("held_plane", &[], PRINTED),
    case("lever", FULL, PRINTED),
    case("included", FULL, 1e-3),
    case("interference", FULL, PRINTED),
    case("switched", FULL, PRINTED),
    case("tied", FULL, PRINTED),
    case("weight", FULL, PRINTED),
    case("tilted_block", FULL, 2e-3),
    case("one_brick", &[], PRINTED),
    case("full_solids", &[], PRINTED),
    case("full_strain", &[], PRINTED),
    // CalculiX computes a solid whose thickness is free in the mean only.
    case("full_stress", &[], 2e-2),
    case("full_slice", &[], 2e-4),
    case("full_plastic", &[], 2e-4),
    case("secant", FULL, PRINTED),
    case("expanding_bar", &[], PRINTED),
    case("expanding_ring", &[], 2e-4),
    case("equations", FULL, PRINTED),
    case("rigid", FULL, PRINTED),
    case("rigid_moved", FULL, PRINTED),
    case("coupled", FULL, PRINTED),
    case("periodic", FULL, PRINTED),
    case("moved_along", FULL, PRINTED),
    case("ball_joint", FULL, PRINTED),
    case("cyclic", FULL, PRINTED),
    case("two_axes", FULL, PRINTED),
    case("fixed", FULL, PRINTED),
    case("in_steps", FULL, PRINTED),
    case("rigid_released", FULL, PRINTED),
    case("sums_in_steps", FULL, PRINTED),
    case("springback", &[], 2e-4),
    case("held_middles", &[], PRINTED),
    case("adjusted", FULL, PRINTED),
    // What presses on held nodes goes into their supports; CalculiX's springs give way there.
    case("held_edge", FULL, 1e-5),
    // Other nodes are the slaves.
    case("two_pairs", FULL, 1e-3),
];

const fn case(name: &'static str, overrides: &'static [&'static str], bound: f64) -> Case {
    Case {
        name,
        overrides,
        bound,
    }
}

/// Displacements by node, by time.
pub(super) type Table = BTreeMap<String, BTreeMap<u64, [f64; 3]>>;

/// The tables of displacements of a `.dat` file.
fn read_table(text: &str) -> Table {
    let mut out = Table::new();
    let mut time = None;
    for line in text.lines() {
        if let Some((_, given)) = line.split_once("and time ") {
            time = line
                .contains("displacements")
                .then(|| given.trim().to_string());
            continue;
        }
        let words: Vec<&str> = line.split_whitespace().collect();
        if let (Some(time), [node, x, y, z]) = (&time, &words[..]) {
            let u = [x, y, z].map(|word| word.parse().unwrap());
            out.entry(time.clone())
                .or_default()
                .insert(node.parse().unwrap(), u);
        }
    }
    out
}

pub(super) fn stored(name: &str) -> Table {
    let path = folder().join(format!("reference/{name}.dat"));
    read_table(&std::fs::read_to_string(path).unwrap())
}

fn largest(table: &BTreeMap<u64, [f64; 3]>) -> f64 {
    table
        .values()
        .flatten()
        .fold(0.0, |m: f64, u| m.max(u.abs()))
}

/// How far the displacements of a run are from those of a table, as a share of the largest.
pub(super) fn far((model, results): &(Model, Results), stored: &Table) -> f64 {
    let scale = stored.values().map(largest).fold(0.0, f64::max);
    let d = model.mesh.dimension;
    let mut worst: f64 = 0.0;
    for (state, table) in results.states.iter().zip(stored.values()) {
        let u = &state.fields.as_ref().unwrap().displacement;
        for (node, u) in u.chunks(d).enumerate() {
            let theirs = &table[&model.mesh.node_label(node)];
            let off = u.iter().zip(theirs).map(|(a, b)| (a - b).abs());
            worst = off.fold(worst, f64::max);
        }
    }
    worst / scale
}

#[test]
fn displacements_are_those_of_calculix() {
    let mut wrong = Vec::new();
    for case in &CASES {
        let (model, results) = run_file(&deck_path(case.name), case.overrides);
        let stored = stored(case.name);
        assert_eq!(results.states.len(), stored.len(), "{}", case.name);
        let scale = stored.values().map(largest).fold(0.0, f64::max);
        for (state, (time, table)) in results.states.iter().zip(&stored) {
            let fields = state.fields.as_ref().unwrap();
            let d = model.mesh.dimension;
            let mut worst = (0.0, 0);
            for (node, u) in fields.displacement.chunks(d).enumerate() {
                let label = model.mesh.node_label(node);
                for (a, b) in u.iter().zip(table[&label]) {
                    let error = (a - b).abs() / scale;
                    if error > worst.0 {
                        worst = (error, label);
                    }
                }
            }
            println!(
                "{} at {time}: {:.2e} at node {}",
                case.name, worst.0, worst.1
            );
            if worst.0 > case.bound {
                wrong.push(format!(
                    "{} at {time}: {:.2e} at node {}",
                    case.name, worst.0, worst.1
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// What is stored is what CalculiX prints, where it is installed.
#[test]
fn calculix_prints_what_is_stored() {
    // Debian: calculix-ccx.
    if !tools::has("ccx") {
        return;
    }
    let work = tempfile::tempdir().unwrap();
    for entry in std::fs::read_dir(folder()).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "inp" || e == "inc") {
            std::fs::copy(&path, work.path().join(path.file_name().unwrap())).unwrap();
        }
    }
    for case in &CASES {
        let mut command = Command::new("ccx");
        command.args(["-i", case.name]).current_dir(work.path());
        let status = command
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status()
            .unwrap();
        assert!(status.success(), "{}", case.name);
        let text = std::fs::read_to_string(work.path().join(format!("{}.dat", case.name))).unwrap();
        let (fresh, stored) = (read_table(&text), stored(case.name));
        for (time, table) in &stored {
            let scale = largest(table).max(f64::MIN_POSITIVE);
            for (node, u) in table {
                for (a, b) in u.iter().zip(fresh[time][node]) {
                    assert!(
                        (a - b).abs() <= PRINTED * scale,
                        "{} {time} {node}",
                        case.name
                    );
                }
            }
        }
    }
}
