//! Forces through surfaces (`*SECTION PRINT`) beside those of CalculiX.

use super::{deck_path, folder};
use crate::support::program::program;
use crate::support::{limit, tools};
use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

/// Faces of a deck, as lines of a surface, and how far what passes them may differ from what
/// CalculiX has, as a share of the largest value of its row.
struct Case {
    name: &'static str,
    faces: &'static str,
    bound: f64,
}

const fn case(name: &'static str, faces: &'static str, bound: f64) -> Case {
    Case { name, faces, bound }
}

/// CalculiX carries stresses to the nodes by factors of four digits. Each surface turns, so that
/// forces and moments have all components.
const ROUNDED: f64 = 1e-4;
const CASES: [Case; 8] = [
    case("bricks", "1, S4\n1, S2", ROUNDED),
    case("full_solids", "1, S1\n1, S4\n11, S2\n11, S3", ROUNDED),
    case("ring", "1, S1\n1, S6\n2, S2", ROUNDED),
    case("tetrahedra", "1, S1\n2, S3", ROUNDED),
    case("wedges", "1, S2\n1, S3", ROUNDED),
    case("every_solid", "1, S2\n1, S3", ROUNDED),
    case("full_stress", "1, S2\n1, S1", 2e-2),
    // CalculiX computes a slice with plane faces.
    case("full_slice", "1, S2\n1, S3", 2e-3),
];

impl Case {
    /// The deck, which asks for what passes the faces from its first step on.
    fn deck(&self) -> String {
        let text = std::fs::read_to_string(deck_path(self.name)).unwrap();
        let surface = format!("*SURFACE, NAME=CUT\n{}\n*STEP", self.faces);
        let ask = "*SECTION PRINT, SURFACE=CUT, NAME=PASSES\nSOF, SOM\nSOAREA\n*END STEP";
        let text = text.replacen("*STEP", &surface, 1);
        text.replacen("*END STEP", ask, 1)
    }

    /// What a program prints for it: the lines from each head on.
    fn printed_by(&self, program: &mut Command) -> String {
        let work = tempfile::tempdir().unwrap();
        let path = work.path().join("deck");
        std::fs::write(path.with_extension("inp"), self.deck()).unwrap();
        let output = limit::output(program.args(["-i", "deck"]).current_dir(work.path()));
        let printed = String::from_utf8_lossy(&output.stdout);
        assert!(printed.contains("Job finished"), "{}: {printed}", self.name);
        sections(&path.with_extension("dat"))
    }
}

/// The tables of sections of a `.dat` file, each of 17 lines behind its three empty ones.
fn sections(path: &Path) -> String {
    let text = std::fs::read_to_string(path).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let mut out = String::new();
    for (at, _) in (lines.iter().enumerate()).filter(|(_, line)| line.contains("surface set")) {
        assert_eq!(lines[at - 3..at], [""; 3]);
        (lines[at..at + 17].iter()).for_each(|line| writeln!(out, "{line}").unwrap());
    }
    out
}

/// Lines that differ but for their numbers, and numbers that differ by more than a share of the
/// largest of their row; of a row of the last block, of force, area and moment, each by itself.
fn differences(ours: &str, theirs: &str, bound: f64) -> Vec<String> {
    let [a, b]: [Vec<&str>; 2] = [ours, theirs].map(|text| text.lines().collect());
    if a.len() != b.len() || b.is_empty() {
        return vec![format!("{ours}\n{theirs}")];
    }
    let mut out = Vec::new();
    for (a, b) in a.iter().zip(b) {
        let numbers = |line: &str| -> Vec<f64> {
            let words = line.split_whitespace().filter(|word| word.contains('E'));
            words.filter_map(|word| word.parse().ok()).collect()
        };
        let (own, their) = (numbers(a), numbers(b));
        let largest = their.iter().fold(1e-6f64, |most, x| most.max(x.abs()));
        let is_off = |(x, y): (&f64, &f64)| (x - y).abs() > bound * largest;
        let text_differs = their.is_empty() && *a != b;
        if text_differs
            || a.len() != b.len()
            || own.len() != their.len()
            || own.iter().zip(&their).any(is_off)
        {
            out.push(format!("{a}\n{b}"));
        }
    }
    out
}

fn stored(name: &str) -> String {
    let text = std::fs::read_to_string(folder().join("reference/sections.dat")).unwrap();
    let mut parts = text.split("** deck ").skip(1);
    let own = parts.find_map(|part| part.strip_prefix(name)?.strip_prefix('\n'));
    own.unwrap_or_default().to_string()
}

#[test]
fn what_passes_a_surface_is_what_calculix_prints() {
    let mut wrong = Vec::new();
    for case in &CASES {
        let mut brinell = program();
        let ours = case.printed_by(brinell.arg("ccx"));
        for line in differences(&ours, &stored(case.name), case.bound) {
            wrong.push(format!("{}:\n{line}", case.name));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// What is stored is what CalculiX prints, where it is installed; with `BRINELL_TABLE=FILE` it is
/// written into that file.
#[test]
fn calculix_prints_the_sections_that_are_stored() {
    // Debian: calculix-ccx.
    if !tools::has("ccx") {
        return;
    }
    let mut all = String::new();
    for case in &CASES {
        let fresh = case.printed_by(&mut Command::new("ccx"));
        write!(all, "** deck {}\n{fresh}", case.name).unwrap();
        if std::env::var_os("BRINELL_TABLE").is_none() {
            let wrong = differences(&fresh, &stored(case.name), 1e-6);
            assert!(wrong.is_empty(), "{}: {wrong:#?}", case.name);
        }
    }
    if let Some(path) = std::env::var_os("BRINELL_TABLE") {
        std::fs::write(path, all).unwrap();
    }
}

/// A plate of two elements and a thickness of 2, pulled along x.
const PLATE: &str = "\
*NODE
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
5, 2., 0.
6, 2., 1.
*ELEMENT, TYPE=CPE4, ELSET=PLATE
1, 1, 2, 3, 4
2, 2, 5, 6, 3
*SURFACE, NAME=CUT
1, S2
*SURFACE, NAME=END
2, S2
*MATERIAL, NAME=STEEL
*ELASTIC
210000., 0.3
*SOLID SECTION, ELSET=PLATE, MATERIAL=STEEL
2.
*BOUNDARY
1, 1, 2
4, 1
*STEP
*STATIC
*DSLOAD
END, P, -100.
*SECTION PRINT, SURFACE=NOWHERE, NAME=A
SOF
*SECTION PRINT, SURFACE=cut, NAME=B
SOF
SOM
*END STEP
*STEP
*STATIC
*DSLOAD
END, P, -300.
*END STEP
*STEP
*STATIC
*SECTION PRINT, SURFACE=END, NAME=B
SOAREA
*END STEP
";

/// What passes is exact where the stress is uniform, over the whole thickness (CalculiX counts half
/// of it for this element); requests hold until a step has its own; a surface that there is not is
/// said.
#[test]
fn a_plate_passes_on_what_pulls_it() {
    let work = tempfile::tempdir().unwrap();
    let path = work.path().join("deck");
    std::fs::write(path.with_extension("inp"), PLATE).unwrap();
    let mut brinell = program();
    brinell.args(["ccx", "-i", "deck"]).current_dir(work.path());
    let output = limit::output(&mut brinell);
    let printed = String::from_utf8_lossy(&output.stdout);
    let said = "there is no surface NOWHERE: nothing is written";
    assert!(printed.contains(said), "{printed}");
    let found = sections(&path.with_extension("dat"));
    let tables: Vec<&str> = found
        .split(" statistics for surface set ")
        .skip(1)
        .collect();
    assert_eq!(tables.len(), 3, "{found}");
    for (table, (name, force, x)) in (tables.iter()).zip([
        ("CUT", 200.0, 1.0),
        ("CUT", 600.0, 1.0),
        ("END", 600.0, 2.0),
    ]) {
        assert!(table.starts_with(name), "{found}");
        let words = table
            .split_whitespace()
            .filter_map(|word| word.parse().ok());
        let numbers: Vec<f64> = words.skip(1).collect();
        let expected = [
            [force, 0.0, 0.0, 0.0, 0.0, -0.5 * force],
            [x, 0.5, 0.0, 1.0, 0.0, 0.0],
        ];
        let last = [0.0, 0.0, 0.0, 2.0, force, 0.0, 0.0, 0.0];
        for (number, exact) in numbers
            .iter()
            .zip(expected.as_flattened().iter().chain(&last))
        {
            assert!((number - exact).abs() < 2e-6 * force, "{table}");
        }
        assert_eq!(numbers.len(), 20, "{table}");
    }
}
