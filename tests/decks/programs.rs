//! Decks as FreeCAD, PrePoMax, Gmsh and Abaqus/CAE write them, beside CalculiX.
//!
//! `BRINELL_TABLE=FILE` writes the differences of all decks as a table.

use super::folder;
use crate::support::frd::{Frd, difference, largest};
use crate::support::program::program;
use crate::support::{limit, tools};
use brinell::mesh::gmsh;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A deck with the largest differences allowed, as shares of the largest value: of displacements,
/// and of stresses (CalculiX carries these to nodes by factors of four digits).
struct Case {
    name: &'static str,
    bounds: [f64; 2],
    /// What CalculiX does not take of the deck as it is written, and is taken out for it.
    without: &'static [&'static str],
}

const fn case(name: &'static str, bounds: [f64; 2]) -> Case {
    Case {
        name,
        bounds,
        without: &[],
    }
}

const PRINTED: [f64; 2] = [2e-6, 5e-5];

const CASES: [Case; 10] = [
    case("freecad_face_load", PRINTED),
    case("freecad_node_load", PRINTED),
    case("freecad_displacement", PRINTED),
    case("freecad_hexahedra", PRINTED),
    case("freecad_box", PRINTED),
    case("freecad_two_materials", PRINTED),
    case("prepomax_contact", PRINTED),
    case("prepomax_tie", PRINTED),
    // CPS6: CalculiX's thickness follows shape functions, so that the stress across it vanishes in
    // the mean, here at each point.
    Case {
        without: &["T3D3"],
        ..case("gmsh_plate", [1e-2, 1e-1])
    },
    Case {
        without: &["CPS6"],
        ..case("gmsh_bar", PRINTED)
    },
];

fn programs() -> PathBuf {
    folder().join("programs")
}

/// Copies all decks, for CalculiX without some elements.
fn copy(to: &Path, without: &[&str]) {
    for entry in std::fs::read_dir(programs()).unwrap() {
        let path = entry.unwrap().path();
        if !path.extension().is_some_and(|e| e == "inp" || e == "inc") {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        let mut is_left_out = false;
        let kept = text.lines().filter(|line| {
            if line.starts_with('*') {
                let is_of = |kind: &&str| line.contains(&format!("type={kind}"));
                is_left_out = without.iter().any(is_of);
            }
            !is_left_out
        });
        let kept: Vec<&str> = kept.collect();
        std::fs::write(to.join(path.file_name().unwrap()), kept.join("\n") + "\n").unwrap();
    }
}

fn results_of(program: &mut Command, work: &Path, name: &str) -> Frd {
    let output = limit::output(program.args(["-i", name]).current_dir(work));
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{name}: {printed}");
    let path = work.join(name).with_extension("frd");
    Frd::parse(&std::fs::read_to_string(path).unwrap())
}

#[test]
fn decks_of_other_programs_run_as_in_calculix() {
    let both = tools::has("ccx");
    let mut table = String::new();
    let mut wrong = Vec::new();
    for case in &CASES {
        let [ours, theirs] = [0, 1].map(|_| tempfile::tempdir().unwrap());
        copy(ours.path(), &[]);
        let own = results_of(program().arg("ccx"), ours.path(), case.name);
        assert!(!own.last("DISP").values.is_empty(), "{}", case.name);
        if !both {
            continue;
        }
        copy(theirs.path(), case.without);
        let other = results_of(&mut Command::new("ccx"), theirs.path(), case.name);
        let mut line = format!("| `{}` |", case.name);
        for (block, bound) in [("DISP", case.bounds[0]), ("STRESS", case.bounds[1])] {
            let (a, b) = (own.last(block), other.last(block));
            let size = largest(&other, block).max(f64::MIN_POSITIVE);
            let off = difference(&a.values, &b.values) / size;
            line.push_str(&format!(" {off:.1e} |"));
            if off > bound {
                wrong.push(format!("{} {block}: {off:.2e}", case.name));
            }
        }
        println!("{line}");
        table.push_str(&(line + "\n"));
    }
    if let Some(path) = std::env::var_os("BRINELL_TABLE") {
        let head = "| deck | displacements | stresses |\n|---|---|---|\n";
        std::fs::write(path, head.to_string() + &table).unwrap();
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// CalculiX reads no parts; the exact answer is: both blocks under 50, the contact gives way by 50
/// over its slope.
#[test]
fn a_deck_of_abaqus_has_the_exact_answer() {
    let work = tempfile::tempdir().unwrap();
    copy(work.path(), &[]);
    let text = std::fs::read_to_string(programs().join("cae_blocks.inp")).unwrap();
    // Abaqus writes displacements unasked; here they go into the file of CalculiX.
    let text = text.replace("*Output, field, variable=PRESELECT", "*Node file\nU");
    std::fs::write(work.path().join("cae_blocks.inp"), text).unwrap();
    let own = results_of(program().arg("ccx"), work.path(), "cae_blocks");
    let top = &own.last("DISP").values;
    let lowest = top.values().map(|u| u[2]).fold(0.0, f64::min);
    let exact = -2.0 * 50.0 / 210_000.0 - 50.0 / 1e9;
    assert!((lowest / exact - 1.0).abs() < 1e-5, "{lowest} {exact}");
}

/// Files that Gmsh 4.8.4 wrote: binary ones of both versions and the deck are one mesh.
#[test]
fn binary_meshes_of_gmsh_are_those_of_its_decks() {
    let [old, new] = ["gmsh_bar_22.msh", "gmsh_bar_41.msh"].map(|name| {
        let mesh = gmsh::read(&programs().join(name)).unwrap();
        assert!(mesh.surfaces.contains_key("root") && mesh.surfaces.contains_key("end"));
        mesh
    });
    let deck = brinell::mesh::inp::read(&programs().join("gmsh_bar.inp")).unwrap();
    for other in [&new, &deck] {
        assert_eq!(old.n_nodes(), other.n_nodes());
        assert_eq!(old.n_elements(), other.n_elements());
        // By number: files list nodes in orders of their own.
        let places = |mesh: &brinell::mesh::Mesh| {
            let mut all: Vec<(u64, [f64; 3])> = (0..mesh.n_nodes())
                .map(|node| (mesh.node_label(node), mesh.point(node)))
                .collect();
            all.sort_by_key(|(label, _)| *label);
            all
        };
        for ((a, x), (b, y)) in places(&old).iter().zip(places(other)) {
            assert_eq!(*a, b);
            assert!((0..3).all(|d| (x[d] - y[d]).abs() < 1e-12), "{a}");
        }
    }
}
