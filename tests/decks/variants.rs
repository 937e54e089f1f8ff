//! Decks as other programs and systems write them: they say the same in other ways.

use super::{folder, run_file};
use brinell::deck::{self, Options};
use brinell::model::Model;
use brinell::results::Results;
use std::path::Path;

fn model_of(path: &Path, overrides: &[&str]) -> brinell::Result<Model> {
    let overrides: Vec<String> = overrides.iter().map(ToString::to_string).collect();
    Model::new(&deck::load_with(path, &overrides, Options::default())?)
}

/// Runs a deck with some of its text replaced, beside the files that it includes.
fn changed(name: &str, changes: &[(&str, &str)]) -> Results {
    let beside = tempfile::tempdir().unwrap();
    std::fs::create_dir(beside.path().join("parts")).unwrap();
    for file in ["included_nodes.inc", "included_elements.inc"] {
        let from = folder().join(file);
        std::fs::copy(&from, beside.path().join(file)).unwrap();
        std::fs::copy(&from, beside.path().join("parts").join(file)).unwrap();
    }
    let mut text = std::fs::read_to_string(folder().join(format!("{name}.inp"))).unwrap();
    for (from, to) in changes {
        assert!(text.contains(from), "{name}: {from}");
        text = text.replacen(from, to, 1);
    }
    let path = beside.path().join("changed.inp");
    std::fs::write(&path, text).unwrap();
    run_file(&path, &[]).1
}

fn same(name: &str, changes: &[(&str, &str)]) {
    let [plain, other] = [&[][..], changes].map(|changes| changed(name, changes));
    let last = |results: &Results| results.states.last().unwrap().clone();
    let [plain, other] = [last(&plain), last(&other)];
    let displacements = |state: &brinell::results::State| {
        let fields = state.fields.as_ref().unwrap();
        fields.displacement.clone()
    };
    assert_eq!(
        displacements(&plain),
        displacements(&other),
        "{name}: {changes:?}"
    );
    assert_eq!(plain.contact_force, other.contact_force);
    assert!(plain.contact_force > 0.0);
}

/// What Windows' editors put before the first line.
#[test]
fn a_byte_order_mark_is_read_over() {
    same("two_blocks", &[("*HEADING", "\u{feff}*HEADING")]);
}

/// Numbers between the ends of `GENERATE` that no node or element has.
#[test]
fn generated_numbers_may_have_holes() {
    let far = "*NSET, NSET=TOP, GENERATE\n111, 100000, 1";
    same(
        "two_blocks",
        &[("*NSET, NSET=TOP, GENERATE\n111, 115, 1", far)],
    );
    let near = "*ELSET, ELSET=UNDER, GENERATE\n5, 12";
    same(
        "two_blocks",
        &[("*ELSET, ELSET=UNDER, GENERATE\n5, 8", near)],
    );
}

/// A displacement that stands before the first step is reached over it.
#[test]
fn a_displacement_before_the_first_step_is_one_of_it() {
    let before = "MIDDLE, 1\n*BOUNDARY\nLID, 2, 2, -0.01\n*STEP\n*STATIC\n";
    let within = "MIDDLE, 1\n*STEP\n*STATIC\n*BOUNDARY\nLID, 2, 2, -0.01\n";
    same("included", &[(within, before)]);
}

/// Folders as Windows writes them.
#[test]
fn included_files_may_lie_behind_backslashes() {
    same(
        "included",
        &[(
            "INPUT=included_nodes.inc",
            "INPUT=parts\\included_nodes.inc",
        )],
    );
}

/// Blocks that overlap in the mesh press each other apart: of the heights `h` and stiffness `E`
/// between fixed ends, without Poisson's effect, with `E d/(h_1 + h_2)`. Their nodes face each
/// other or not.
#[test]
fn an_overlap_in_the_mesh_is_an_interference() {
    let overlap = 0.01;
    for [lower, upper] in [[4, 4], [4, 3], [3, 5]] {
        let mut nodes = String::from("*NODE\n");
        let mut elements = String::new();
        let mut sets = String::new();
        let blocks = [
            (0, "LOW", lower, 0.0, 1.0),
            (100, "UPP", upper, 1.0 - overlap, 2.0),
        ];
        for (first, name, n, from, to) in blocks {
            for (row, y) in [(0, from), (1, to)] {
                for i in 0..=n {
                    let x = i as f64 / n as f64;
                    nodes += &format!("{}, {x:?}, {y:?}\n", first + 20 * row + i + 1);
                }
            }
            elements += &format!("*ELEMENT, TYPE=CPS4, ELSET={name}\n");
            for i in 1..=n {
                let [a, b] = [first + i, first + i + 20];
                elements += &format!("{a}, {a}, {}, {}, {b}\n", a + 1, b + 1);
            }
            sets += &format!("*SOLID SECTION, ELSET={name}, MATERIAL=M\n1.\n");
            for (side, face, row) in [("BOTTOM", "S1", 0), ("TOP", "S3", 20)] {
                sets += &format!("*SURFACE, NAME={name}_{side}\n{name}, {face}\n");
                let ends = format!("{}, {}", first + row + 1, first + row + n + 1);
                sets += &format!("*NSET, NSET={name}_{side}_NODES, GENERATE\n{ends}\n");
            }
        }
        let text = format!(
            "{nodes}{elements}*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n{sets}\
             *SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n\
             *CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE\nUPP_BOTTOM, LOW_TOP\n\
             *BOUNDARY\nLOW_BOTTOM_NODES, 1, 2\nUPP_TOP_NODES, 1, 2\n\
             *STEP\n*STATIC\n*END STEP\n"
        );
        let beside = tempfile::tempdir().unwrap();
        let path = beside.path().join("overlap.inp");
        std::fs::write(&path, text).unwrap();
        let (model, results) = run_file(&path, &[]);
        assert!(
            model
                .warnings
                .iter()
                .any(|text| text.contains("overlap by up to 1.0000e-2")),
            "{:?}",
            model.warnings
        );
        let exact = 1000.0 * overlap / (2.0 + overlap);
        let force = results.states[0].contact_force;
        assert!(
            (force / exact - 1.0).abs() < 1e-9,
            "{lower}, {upper}: {force}"
        );
        // Whoever does not say so is told.
        let apart = model_of(
            &path,
            &["contact.0.overlap=false", "contact.0.interference=0.1"],
        )
        .unwrap_err();
        assert!(apart.message().contains("`overlap = true`"), "{apart}");
    }
}

/// A mesh as Gmsh writes it: lines with their sets beside the elements of a plane.
const LINES: &str = "*Heading
 blocks.inp
*NODE
1, 0, 0, 0
2, 1, 0, 0
3, 2, 0, 0
4, 0, 1, 0
5, 1, 1, 0
6, 2, 1, 0
******* E L E M E N T S *************
*ELEMENT, type=T3D2, ELSET=Line1
1, 1, 2
2, 2, 3
*ELEMENT, type=T3D2, ELSET=Line3
3, 4, 5
4, 5, 6
*ELEMENT, type=CPS4, ELSET=Surface1
5, 1, 2, 5, 4
6, 2, 3, 6, 5
*ELSET,ELSET=bottom
1, 2,
*ELSET,ELSET=top
3, 4,
*ELSET,ELSET=block
5, 6,
";

const ON_LINES: &str = "*MATERIAL, NAME=S
*ELASTIC
210000., 0.
*SOLID SECTION, ELSET=block, MATERIAL=S
1.
*SURFACE, NAME=T
top
*NSET, NSET=NB, ELSET=bottom
*BOUNDARY
NB, 1, 2
*STEP
*STATIC
*DSLOAD
T, P, 10.
*END STEP
";

/// A scene with the mesh: held at one set, pressed at another.
fn of_scene(kind: &str, mesh: &std::path::Path, [held, pressed]: [&str; 2]) -> Results {
    let axes = match kind {
        "solid" => "\"x\", \"y\", \"z\"",
        _ => "\"x\", \"y\"",
    };
    let scene = format!(
        "kind = \"{kind}\"
mesh.file = {mesh:?}
materials.s = {{ youngs_modulus = 210e3, poissons_ratio = 0.0 }}
bodies.block.material = \"s\"
support = [{{ on = \"{held}\", fix = [{axes}] }}]
load = [{{ on = \"{pressed}\", pressure = 10.0 }}]
program.targets = [{{ load_factor = 1.0 }}]
"
    );
    crate::support::run_text(&scene)
}

/// Sets of lines are surfaces, of a deck as of a scene's mesh; a truss that a section makes one is
/// refused.
#[test]
fn lines_carry_the_sets_of_faces() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    };
    let mesh = write("mesh.inp", LINES);
    let deck = write("deck.inp", &format!("*INCLUDE, INPUT=mesh.inp\n{ON_LINES}"));
    let sunk = |results: &Results| {
        let fields = results.states[0].fields.as_ref().unwrap();
        fields.displacement[4 * 2 + 1]
    };
    let of_deck = sunk(&run_file(&deck, &[]).1);
    assert!((of_deck + 10.0 / 210e3).abs() < 1e-15, "{of_deck}");
    let results = of_scene("plane_stress", &mesh, ["bottom", "top"]);
    assert_eq!(sunk(&results), of_deck);
    let truss = ON_LINES.replace("ELSET=block", "ELSET=top");
    let truss = write("truss.inp", &format!("*INCLUDE, INPUT=mesh.inp\n{truss}"));
    let why = model_of(&truss, &[]).unwrap_err().to_string();
    assert!(why.contains("element 3 (T3D2) is a truss, a beam"), "{why}");
}

/// The same of a solid mesh: plane elements beside the solids, which come after them.
const FACES: &str = "*Heading
 blocks.inp
*NODE
1, 0, 0, 0
2, 1, 0, 0
3, 2, 0, 0
4, 0, 1, 0
5, 1, 1, 0
6, 2, 1, 0
7, 0, 0, 1
8, 1, 0, 1
9, 2, 0, 1
10, 0, 1, 1
11, 1, 1, 1
12, 2, 1, 1
******* E L E M E N T S *************
*ELEMENT, type=T3D2, ELSET=Line1
1, 1, 2
*ELEMENT, type=CPS4, ELSET=Surface1
2, 1, 4, 5, 2
3, 2, 5, 6, 3
*ELEMENT, type=CPS4, ELSET=Surface2
4, 7, 8, 11, 10
5, 8, 9, 12, 11
*ELEMENT, type=C3D8, ELSET=Volume1
6, 1, 2, 5, 4, 7, 8, 11, 10
7, 2, 3, 6, 5, 8, 9, 12, 11
*ELSET,ELSET=bottom
2, 3,
*ELSET,ELSET=top
4, 5,
*ELSET,ELSET=block
6, 7,
";

/// Sets of plane elements beside solids are surfaces, by the sets that `*ELEMENT` names and by
/// those of numbers; a section on them is refused.
#[test]
fn plane_elements_beside_solids_carry_the_sets_of_faces() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    };
    let mesh = write("mesh.inp", FACES);
    let sunk = |results: &Results| {
        let fields = results.states[0].fields.as_ref().unwrap();
        fields.displacement[10 * 3 + 2]
    };
    let held = ON_LINES
        .replace("NB, 1, 2", "NB, 1, 3")
        .replace("1.\n*SURF", "*SURF");
    for [top, bottom] in [["top", "bottom"], ["Surface2", "Surface1"]] {
        let text = held.replace("\ntop\n", &format!("\n{top}\n"));
        let text = text.replace("ELSET=bottom", &format!("ELSET={bottom}"));
        let deck = write("deck.inp", &format!("*INCLUDE, INPUT=mesh.inp\n{text}"));
        let of_deck = sunk(&run_file(&deck, &[]).1);
        assert!((of_deck + 10.0 / 210e3).abs() < 1e-15, "{of_deck}");
        let results = of_scene("solid", &mesh, [bottom, top]);
        assert_eq!(sunk(&results), of_deck);
    }
    // Lines of a solid are no faces: a scene finds their nodes. A body has the name of its group,
    // in whatever order the names are.
    let named = write("named.inp", &FACES.replace("ELSET=block", "ELSET=zylinder"));
    for (file, body) in [(&mesh, "block"), (&named, "zylinder")] {
        let mesh = brinell::mesh::inp::read(file).unwrap();
        assert_eq!(mesh.node_sets["Line1"], [0, 1]);
        assert_eq!(mesh.bodies, [body]);
    }
    let plate = held.replace("ELSET=block", "ELSET=top");
    let plate = write("plate.inp", &format!("*INCLUDE, INPUT=mesh.inp\n{plate}"));
    let why = model_of(&plate, &[]).unwrap_err().to_string();
    assert!(why.contains("element 4 (CPS4, T3D2)"), "{why}");
}
