//! Results in the formats of CalculiX: `.frd` and `.dat` files, beside those of CalculiX.

use super::{deck_path, folder};
use crate::support::frd::{Frd, difference, largest};
use crate::support::program::program;
use crate::support::{limit, load, run_with_model, tools};
use brinell::deck::{self, Options};
use brinell::model::Model;
use brinell::output;
use brinell::results::Results;
use brinell::scene::Scene;
use std::path::Path;
use std::process::Command;

/// CalculiX carries stresses to the nodes by factors of four digits.
const ROUNDED: f64 = 5e-5;

/// A deck whose files CalculiX and brinell write, and how far values may differ as a share of the
/// largest of a block.
struct Case {
    name: &'static str,
    /// Of displacements, and of stresses, strains and contact pressures.
    bounds: [f64; 2],
    /// Of forces; `None` where CalculiX counts those that hold its expanded elements of the plane
    /// or its ties together.
    force: Option<f64>,
}

const fn case(name: &'static str, bounds: [f64; 2], force: Option<f64>) -> Case {
    Case {
        name,
        bounds,
        force,
    }
}

const SAME: [f64; 2] = [2e-6, ROUNDED];

const CASES: [Case; 25] = [
    case("every_solid", SAME, Some(2e-6)),
    case("every_plane", SAME, Some(2e-6)),
    case("two_blocks", SAME, Some(2e-6)),
    case("bricks", SAME, Some(2e-6)),
    case("ring", SAME, Some(2e-6)),
    case("tetrahedra", SAME, Some(2e-6)),
    case("wedges", SAME, Some(2e-6)),
    case("full_solids", SAME, Some(2e-6)),
    case("full_strain", SAME, Some(2e-6)),
    case("secant", SAME, Some(2e-6)),
    // CalculiX computes a slice with plane faces.
    case("tube", [2e-4, 2e-4], None),
    case("tied", SAME, None),
    case("heat", SAME, Some(2e-6)),
    case("weight", SAME, Some(2e-6)),
    case("held_plane", SAME, None),
    case("interference", SAME, Some(2e-6)),
    case("rigid", SAME, Some(2e-6)),
    case("rigid_moved", SAME, Some(2e-6)),
    case("coupled", SAME, Some(2e-6)),
    case("ball_joint", SAME, Some(2e-6)),
    case("equations", SAME, Some(2e-6)),
    case("lever", SAME, Some(2e-6)),
    case("switched", SAME, Some(2e-6)),
    // CalculiX takes 200 increments, each in one step of the implicit rule.
    case("plastic", [2e-3, 5e-3], Some(2e-3)),
    // Contact that is hard is a stiff spring there.
    case("hard", [1e-2, ROUNDED], Some(2e-6)),
];

/// A deck that asks for all results at the end of each of its steps.
fn asking(name: &str) -> String {
    let file = if name == "hard" { "two_blocks" } else { name };
    let text = std::fs::read_to_string(deck_path(file)).unwrap();
    let text = match name {
        // Increments of a fixed size, and only the last of each step is written.
        "plastic" => (text.replace("*STATIC", "*STATIC, DIRECT")).replace(
            "*NODE PRINT, NSET=NALL",
            "*NODE PRINT, NSET=NALL, FREQUENCY=1000",
        ),
        "hard" => text.replace("=LINEAR\n1.E9", "=HARD"),
        _ => text,
    };
    if text.contains("*EL FILE") {
        return text;
    }
    let contact = match text.contains("*CONTACT PAIR") {
        true => "*CONTACT FILE\nCDIS, CSTR\n",
        false => "",
    };
    let contact = match text.contains("FACE, FLOOR") {
        true => format!("{contact}*CONTACT PRINT, SLAVE=FACE, MASTER=FLOOR\nCF, CFS\n"),
        false => contact.to_string(),
    };
    // Nodes without elements, whose forces are those of all that follows them.
    let reference = match text.contains("*RIGID BODY") || text.contains("*COUPLING") {
        true => "*NODE PRINT, NSET=REF\nU, RF\n*NODE PRINT, NSET=TOP, TOTALS=YES\nRF\n",
        false => "",
    };
    let asked = format!("*NODE FILE\nU, RF\n*EL FILE\nS, E, PEEQ\n{contact}{reference}*END STEP");
    text.replace("*END STEP", &asked)
}

/// Runs a scene or deck that asks for results, in this process; the text of its `.frd` file.
fn written(scene: &Scene) -> (Model, Results, String) {
    let (model, results) = run_with_model(scene);
    let work = tempfile::tempdir().unwrap();
    let path = work.path().join("results.frd");
    output::write_frd(&path, &model, &results).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    (model, results, text)
}

fn run_deck(name: &str) -> String {
    let work = tempfile::tempdir().unwrap();
    let path = work.path().join("deck.inp");
    std::fs::write(&path, asking(name)).unwrap();
    let full = ["mesh.formulation=full".to_string()];
    let scene = deck::load_with(&path, &full, Options::default()).unwrap();
    written(&scene).2
}

/// Lines that are not the same, and values that differ by more than their bound.
fn compare(case: &Case, [ours, theirs]: [&Frd; 2]) -> Vec<String> {
    let name = case.name;
    let mut wrong = Vec::new();
    let both = ours.lines.iter().zip(&theirs.lines).enumerate();
    for (number, (our, their)) in both.filter(|(_, (a, b))| a != b).take(3) {
        wrong.push(format!("{name}, line {}: `{our}`, `{their}`", number + 1));
    }
    if ours.lines.len() != theirs.lines.len() || !wrong.is_empty() {
        wrong.push(format!("{name}: other lines"));
        return wrong;
    }
    let places = difference(&ours.nodes, &theirs.nodes);
    assert!(places < 1e-12, "{name}: places of nodes");
    assert_eq!(ours.elements, theirs.elements, "{name}");
    for (our, their) in ours.blocks.iter().zip(&theirs.blocks) {
        let bound = match our.name.as_str() {
            "DISP" => case.bounds[0],
            // CalculiX has another measure.
            "ERROR" => continue,
            "FORC" => match case.force {
                Some(bound) => bound,
                None => continue,
            },
            _ => case.bounds[1],
        };
        let scale = largest(theirs, &our.name).max(f64::MIN_POSITIVE);
        let found = difference(&our.values, &their.values) / scale;
        println!("{name} step {} {}: {found:.1e}", our.step, our.name);
        if found > bound {
            wrong.push(format!(
                "{name} step {} {}: {found:.2e}",
                our.step, our.name
            ));
        }
    }
    wrong
}

/// Every line but for values and date, all kinds of elements, and the values of uniform strains and
/// of a contact.
#[test]
fn files_are_those_that_calculix_wrote() {
    for case in &CASES[..3] {
        let path = folder().join(format!("reference/{}.frd", case.name));
        let stored = Frd::parse(&std::fs::read_to_string(path).unwrap());
        let ours = Frd::parse(&run_deck(case.name));
        let wrong = compare(case, [&ours, &stored]);
        assert!(wrong.is_empty(), "{wrong:#?}");
    }
}

/// Runs a deck in a folder; the text of a file that this leaves.
fn job(program: &mut Command, work: &Path, name: &str) -> impl Fn(&str) -> String + use<> {
    let output = limit::output(program.args(["-i", name]).current_dir(work));
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{name}: {printed}");
    assert!(output.stderr.is_empty(), "{name}: {output:?}");
    assert!(printed.contains("Job finished"), "{name}: {printed}");
    let path = work.join(name);
    move |ending| std::fs::read_to_string(path.with_extension(ending)).unwrap()
}

/// A line of a `.dat` or `.sta` file: its length, the line with a cross for each number, and the
/// numbers.
type Line = (usize, String, Vec<f64>);

fn lines(text: &str) -> Vec<Line> {
    let of_line = |line: &str| {
        let mut numbers = Vec::new();
        let words = line.split_whitespace().map(|word| match word.parse() {
            Ok(number) if word.contains('.') => {
                numbers.push(number);
                "x"
            }
            _ => word,
        });
        let words: Vec<&str> = words.collect();
        (line.len(), words.join(" "), numbers)
    };
    text.lines().map(of_line).collect()
}

/// What is not the same in two `.dat` files: lines, and values that differ by more than their bound
/// as a share of the largest of their table or of 1e-9.
fn tables(case: &Case, [ours, theirs]: [&[Line]; 2]) -> Vec<String> {
    let name = case.name;
    let other = (ours.iter().zip(theirs)).find(|(a, b)| (a.0, &a.1) != (b.0, &b.1));
    if ours.len() != theirs.len() || other.is_some() {
        return vec![format!("{name}.dat: {other:?}")];
    }
    let mut wrong = Vec::new();
    let (mut head, mut worst, mut largest) = ("", 0.0f64, 1e-9f64);
    let end = (0, "time".to_string(), Vec::new());
    for (our, their) in ours.iter().zip(theirs).chain([(&end, &end)]) {
        if our.1.contains("time") {
            let bound = match (
                head.contains("force") || head.contains("statistics"),
                case.force,
            ) {
                (true, None) => f64::INFINITY,
                _ => case.bounds[0].max(case.bounds[1]),
            };
            if worst > bound * largest {
                wrong.push(format!("{name}.dat: {head}: {worst:.2e} of {largest:.2e}"));
            }
            (head, worst, largest) = (&our.1, 0.0, 1e-9);
        }
        for (a, b) in our.2.iter().zip(&their.2) {
            worst = worst.max((a - b).abs());
            largest = largest.max(b.abs());
        }
    }
    wrong
}

/// `brinell ccx` beside `ccx` for the same decks.
#[test]
fn jobs_leave_what_those_of_calculix_leave() {
    // Debian: calculix-ccx.
    if !tools::has("ccx") {
        return;
    }
    let mut wrong = Vec::new();
    for case in &CASES {
        let [ours, theirs] = [0, 1].map(|_| tempfile::tempdir().unwrap());
        for work in [&ours, &theirs] {
            let path = work.path().join(case.name).with_extension("inp");
            std::fs::write(path, asking(case.name)).unwrap();
        }
        let mut brinell = program();
        let of_brinell = job(brinell.arg("ccx"), ours.path(), case.name);
        let of_ccx = job(&mut Command::new("ccx"), theirs.path(), case.name);
        let files = [&of_brinell("frd"), &of_ccx("frd")].map(|text| Frd::parse(text));
        wrong.extend(compare(case, [&files[0], &files[1]]));
        if files[1].blocks.is_empty() {
            wrong.push(format!("{}: no results", case.name));
        }
        let [ours, theirs] = [&of_brinell("dat"), &of_ccx("dat")].map(|text| lines(text));
        wrong.extend(tables(case, [&ours, &theirs]));
        let [ours, theirs] = [&of_brinell("sta"), &of_ccx("sta")].map(|text| lines(text));
        // What is not written has no row.
        let is_longer = theirs.len() > ours.len() && case.name == "plastic";
        let numbers = |lines: &[Line]| lines.iter().map(|line| line.2.clone()).collect::<Vec<_>>();
        if !is_longer && numbers(&ours) != numbers(&theirs) {
            wrong.push(format!("{}.sta: {ours:?} {theirs:?}", case.name));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// A scene that asks for nothing writes the usual results where it is told to; what is read is what
/// was computed.
#[test]
fn what_is_read_back_is_what_was_computed() {
    let mut scene = load("contact_patch", &[]);
    scene.requests.ask_for_usual(scene.program.targets.len());
    scene.requests.point_values = true;
    let (model, results, text) = written(&scene);
    let read = Frd::parse(&text);
    let (mesh, state) = (&model.mesh, results.states.last().unwrap());
    assert_eq!(read.nodes.len(), mesh.n_nodes());
    for (node, place) in read.nodes.values().enumerate() {
        let exact = mesh.point(node);
        assert!((0..3).all(|d| (place[d] - exact[d]).abs() < 1e-5), "{node}");
    }
    for (element, (_, nodes)) in read.elements.values().enumerate() {
        let own = mesh.nodes(element).iter();
        let own: Vec<u64> = own.map(|&node| mesh.node_label(node as usize)).collect();
        assert_eq!(*nodes, own);
    }
    let fields = state.fields.as_ref().unwrap();
    let vectors = |values: &[f64]| {
        let each = values.chunks(2).enumerate();
        each.map(|(node, v)| (node as u64 + 1, vec![v[0], v[1], 0.0]))
            .collect()
    };
    for (name, values) in [("DISP", &fields.displacement), ("FORC", &fields.force)] {
        let found = difference(&read.last(name).values, &vectors(values));
        assert!(found < 1e-5 * largest(&read, name), "{name}: {found}");
    }
    // A uniform pressure of 10.
    let stress = &read.last("STRESS").values;
    assert!(stress.values().all(|s| (s[1] + 10.0).abs() < 1e-4));
    let contact = &read.last("CONTACT").values;
    let pressed = contact.values().filter(|c| c[3] != 0.0).count();
    assert_eq!(pressed, model.pairs.len());
    assert!(
        contact
            .values()
            .all(|c| c[3] == 0.0 || (c[3] - 10.0).abs() < 1e-4)
    );
}
