//! Why ties and slave surfaces of nodes differ from those of CalculiX, and a page with all decks
//! beside it: `BRINELL_DECKS=data/peers/decks.md cargo test --test all decks::table`.

use super::calculix::{far, stored};
use super::{deck_path, folder, run_file};
use crate::support::frd::{Frd, difference, largest};
use crate::support::program::program;
use crate::support::{limit, tools};
use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

/// CalculiX moves the slave nodes of a `*TIE` onto the master and lets each follow the point that
/// it lies on: the same as equations, which brinell computes to the digits printed. A slave of a
/// node to surface contact presses where it lies, too: the stiffer its spring the nearer.
#[test]
fn slaves_of_calculix_follow_points() {
    for (deck, equations, bound, apart) in [
        ("tied_apart", "tied_apart_equations", 1e-6, 5e-3),
        ("node_slaves", "node_slaves_equations", 2e-3, 1e-2),
        ("node_to_surface", "node_slaves_equations", 2e-3, 1e-2),
    ] {
        let stored = stored(deck);
        let full = &["mesh.formulation=full"];
        let of = |name: &str| far(&run_file(&deck_path(name), full), &stored);
        assert!(of(equations) < bound, "{deck}: {:.2e}", of(equations));
        // The mean over faces is another thing.
        assert!(of(deck) > apart, "{deck}: {:.2e}", of(deck));
    }
}

/// A deck of the page: which row of the list of programs and keywords it is of, and why it differs.
struct Row {
    row: &'static str,
    name: &'static str,
    why: &'static str,
}

const fn row(row: &'static str, name: &'static str, why: &'static str) -> Row {
    Row { row, name, why }
}

const SLICE: &str = "ccx computes a slice of 2 degrees with plane faces";
const THICKNESS: &str = "the thickness of ccx follows shape functions: no stress across it in the \
                         mean, here at each point";
const TURNS: &str =
    "contact of ccx follows the rotation of the surfaces, a difference in proportion to the load";
const STEPS: &str = "ccx takes each of its increments in one step of the implicit rule";
const POINTS: &str = "slaves of ccx follow the points that they lie on, here the mean over the \
                      faces: `decks::table` shows that equations of that kind give the values of \
                      ccx";

const ROWS: [Row; 58] = [
    row("Gmsh", "programs/gmsh_bar", ""),
    row("Gmsh", "programs/gmsh_plate", THICKNESS),
    row("FreeCAD", "programs/freecad_face_load", ""),
    row("FreeCAD", "programs/freecad_node_load", ""),
    row("FreeCAD", "programs/freecad_displacement", ""),
    row("FreeCAD", "programs/freecad_hexahedra", ""),
    row("FreeCAD", "programs/freecad_box", ""),
    row("FreeCAD", "programs/freecad_two_materials", ""),
    row("PrePoMax", "programs/prepomax_contact", ""),
    row("PrePoMax", "programs/prepomax_tie", ""),
    row("contact", "two_blocks", ""),
    row("contact", "tilted_block", TURNS),
    row("contact", "included", TURNS),
    row("overlap, clearance", "interference", ""),
    row("contact off and on", "switched", ""),
    row("ADJUST", "adjusted", ""),
    row("slave surfaces of nodes", "node_slaves", POINTS),
    row("node to surface", "node_to_surface", POINTS),
    row(
        "two pairs that share slaves",
        "two_pairs",
        "the other surface has the slaves in one of them",
    ),
    row(
        "slaves that are held",
        "held_edge",
        "supports bear what presses there, springs of ccx give way",
    ),
    row("TIE", "tied", ""),
    row("TIE across a gap", "tied_apart", POINTS),
    row("full integration", "one_brick", ""),
    row("full integration", "full_solids", ""),
    row("full integration", "full_strain", ""),
    row("full integration", "full_stress", THICKNESS),
    row("full integration", "full_slice", SLICE),
    row("full integration", "full_plastic", STEPS),
    row("EXPANSION by temperature", "secant", ""),
    row("EXPANSION by temperature", "expanding_bar", ""),
    row("EXPANSION by temperature", "expanding_ring", SLICE),
    row("TEMPERATURE", "heat", ""),
    row("TEMPERATURE", "gradient", ""),
    row("EQUATION", "equations", ""),
    row("EQUATION", "lever", ""),
    row("EQUATION", "held_plane", ""),
    row("RIGID BODY", "rigid", ""),
    row("EQUATION", "periodic", ""),
    row("RIGID BODY", "rigid_moved", ""),
    row("RIGID BODY", "ball_joint", ""),
    row("COUPLING", "coupled", ""),
    row("FIXED, absent nodes, OFFSET", "fixed", ""),
    row("supports in steps", "in_steps", ""),
    row("supports in steps", "rigid_released", ""),
    row("supports in steps", "sums_in_steps", ""),
    row("supports in steps", "springback", STEPS),
    row("middles that are held", "held_middles", ""),
    row("TRANSFORM", "ring", ""),
    row("TRANSFORM", "moved_along", ""),
    row("TRANSFORM", "cyclic", ""),
    row("TRANSFORM", "two_axes", ""),
    row("AMPLITUDE, OP, steps", "history", ""),
    row("PLASTIC", "plastic", STEPS),
    row("DENSITY, GRAV, CENTRIF", "weight", ""),
    row("kinds of elements", "every_solid", ""),
    row("kinds of elements", "every_plane", ""),
    row("C3D10", "tetrahedra", ""),
    row("CAX8R", "tube", SLICE),
];

/// Names of slave and master surface of the first contact pair of a deck, where CalculiX prints the
/// force: between surfaces, in all steps.
fn surfaces(text: &str) -> Option<(&str, &str)> {
    let mut lines = text.lines();
    let head = lines.find(|line| line.to_uppercase().starts_with("*CONTACT PAIR"))?;
    let has_force = head.to_uppercase().contains("SURFACE TO SURFACE");
    if !has_force || text.to_uppercase().contains("*MODEL CHANGE") {
        return None;
    }
    let (slave, master) = lines.next()?.split_once(',')?;
    Some((slave.trim(), master.trim()))
}

/// Runs a program on a deck in a folder of its own, with the other decks, all changed: files `.frd`
/// and `.dat`, and the seconds.
fn job(
    mut program: Command,
    text: &str,
    change: impl Fn(&str) -> String,
) -> Option<(Frd, String, f64)> {
    let work = tempfile::tempdir().unwrap();
    for beside in [folder(), folder().join("programs")] {
        for entry in std::fs::read_dir(beside).unwrap() {
            let path = entry.unwrap().path();
            if path
                .extension()
                .is_some_and(|end| end == "inc" || end == "inp")
            {
                let text = std::fs::read_to_string(&path).unwrap();
                let to = work.path().join(path.file_name().unwrap());
                std::fs::write(to, change(&text)).unwrap();
            }
        }
    }
    std::fs::write(work.path().join("deck.inp"), change(text)).unwrap();
    let start = Instant::now();
    let output = limit::output(program.args(["-i", "deck"]).current_dir(work.path()));
    let seconds = start.elapsed().as_secs_f64();
    let read = |end: &str| std::fs::read_to_string(work.path().join(end)).ok();
    let (frd, dat) = (read("deck.frd")?, read("deck.dat")?);
    output
        .status
        .success()
        .then(|| (Frd::parse(&frd), dat, seconds))
}

/// The last force of a contact of a `.dat` file.
fn force(dat: &str) -> Option<[f64; 3]> {
    let (_, last) = dat.rsplit_once("total surface force")?;
    let mut words = last.lines().nth(2)?.split_whitespace();
    let mut next = || words.next()?.parse().ok();
    Some([next()?, next()?, next()?])
}

impl Row {
    /// The deck, which asks for all that is compared.
    fn text(&self) -> String {
        let path = folder().join(format!("{}.inp", self.name));
        let text = std::fs::read_to_string(path).unwrap();
        let print = surfaces(&text).map_or(String::new(), |(slave, master)| {
            format!("*CONTACT PRINT, SLAVE={slave}, MASTER={master}\nCF\n")
        });
        let ask = format!("*NODE FILE\nU\n*EL FILE\nS\n{print}*END STEP");
        let mut out = String::new();
        for line in text.lines() {
            match line.to_uppercase().trim() {
                "*END STEP" => out.push_str(&ask),
                _ => out.push_str(line),
            }
            out.push('\n');
        }
        out
    }

    /// The row of the page.
    fn compared(&self) -> String {
        let text = self.text();
        let mut brinell = program();
        brinell.arg("ccx");
        let ours = job(brinell, &text, str::to_string);
        let theirs = job(Command::new("ccx"), &text, for_ccx);
        let (Some(ours), Some(theirs)) = (ours, theirs) else {
            return format!(
                "| {} | `{}` | | | | | one of them did not end |",
                self.row, self.name
            );
        };
        let off = |block: &str| {
            let (a, b) = (ours.0.last(block), theirs.0.last(block));
            difference(&a.values, &b.values) / largest(&theirs.0, block).max(f64::MIN_POSITIVE)
        };
        let of_contact = force(&ours.1).zip(force(&theirs.1)).map(|(a, b)| {
            let size = b.iter().fold(0.0f64, |most, f| most.max(f.abs()));
            let most = (a.iter().zip(&b)).fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
            format!("{:.1e}", most / size.max(f64::MIN_POSITIVE))
        });
        format!(
            "| {} | `{}` | {:.1e} | {:.1e} | {} | {:.2}, {:.2} | {} |",
            self.row,
            self.name,
            off("DISP"),
            off("STRESS"),
            of_contact.unwrap_or_default(),
            ours.2,
            theirs.2,
            self.why
        )
    }
}

/// Without the elements of a mesher that CalculiX does not take beside others.
fn for_ccx(text: &str) -> String {
    let plane = ["type=T3D3", "type=CPS6"].map(|kind| text.contains(kind));
    let has_solids = text.contains("type=C3D10");
    let mut skips = false;
    let kept = text.lines().filter(|line| {
        if line.starts_with('*') {
            let is_line = plane[0] && line.contains("type=T3D3");
            skips = is_line || has_solids && line.contains("type=CPS6");
        }
        !skips
    });
    let kept: Vec<&str> = kept.collect();
    kept.join("\n") + "\n"
}

#[test]
fn the_page_of_decks_beside_calculix() {
    let Some(path) = std::env::var_os("BRINELL_DECKS").filter(|_| tools::has("ccx")) else {
        // All decks are there, with their row.
        let gone = ROWS
            .iter()
            .find(|row| !folder().join(format!("{}.inp", row.name)).exists());
        assert!(gone.is_none(), "{}", gone.unwrap().name);
        return;
    };
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    let optimised = match std::env::var("BRINELL_NOTE") {
        Ok(note) => format!(" ({note})"),
        Err(_) => String::new(),
    };
    let mut page = format!(
        "# Decks beside CalculiX\n\n`BRINELL_DECKS=data/peers/decks.md cargo test --test all \
         decks::table` writes this page{optimised}.\n\nThe decks of \
         [tests/decks](../../tests/decks) were run by `ccx` 2.20 and by `brinell ccx`. The \
         table has the largest differences at the end of a run,\nfor displacements, stresses at \
         nodes and the force of the first contact pair, each divided by the largest value, and \
         the seconds of the whole process.\nCalculiX carries stresses to nodes by factors of \
         four digits, so a difference of 5e-5 means equal stresses. CalculiX does not read \
         decks of parts\n(`programs/cae_blocks`, `p03` of Abaqus/CAE): brinell's results for \
         them are compared with those for equal decks without parts and with exact \
         answers\n(`decks::assemblies`, `decks::programs`).\n\n| what | deck | displacement | \
         stress | contact force | seconds: brinell, ccx | why they differ \
         |\n|---|---|---|---|---|---|---|\n"
    );
    for row in &ROWS {
        writeln!(page, "{}", row.compared()).unwrap();
    }
    assert!(!page.contains("did not end"), "{page}");
    std::fs::write(path, page).unwrap();
}
