//! `brinell ccx` as FreeCAD and PrePoMax start it.

use super::program;
use crate::support::limit;
use std::path::Path;
use std::process::Output;

fn ccx(folder: &Path, words: &[&str]) -> Output {
    let mut command = program();
    limit::output(command.arg("ccx").args(words).current_dir(folder))
}

fn printed(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// The deck, the command and the number of the page of the guide.
#[test]
fn the_page_of_the_guide_is_what_happens() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/data/guide/in-place-of-ccx.md");
    let page = std::fs::read_to_string(path).unwrap();
    let block = |language: &str| {
        let rest = page.split(&format!("```{language}\n")).nth(1).unwrap();
        rest.split("```").next().unwrap().to_string()
    };
    let work = tempfile::tempdir().unwrap();
    std::fs::write(work.path().join("press.inp"), block("inp")).unwrap();
    let line = block("sh");
    let words: Vec<&str> = line.split_whitespace().collect();
    assert_eq!(words[..2], ["brinell", "ccx"]);
    let output = ccx(work.path(), &words[2..]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert!(output.stderr.is_empty(), "{output:?}");
    assert!(printed(&output).contains("\n Job finished\n"));
    let read = |ending: &str| {
        let path = work.path().join("press").with_extension(ending);
        std::fs::read_to_string(path).unwrap()
    };
    let row = page.lines().find(|line| line.starts_with("| 7 | "));
    let cells: Vec<&str> = row.unwrap().split(" | ").collect();
    let displacement = cells[1].trim_end_matches(" |");
    let tables = read("dat");
    let of_node = tables.lines().find(|line| line.trim().starts_with("7 "));
    assert!(of_node.unwrap().contains(displacement), "{tables}");
    let results = read("frd");
    for name in ["DISP", "STRESS", "TOSTRAIN", "FORC", "CONTACT", "ERROR"] {
        assert!(page.contains(&format!("`{name}`")), "{name}");
        assert!(results.contains(&format!(" -4  {name} ")), "{name}");
    }
    assert_eq!(read("sta").lines().count(), 3);
    assert_eq!(read("cvg").lines().count(), 5);
}

/// The picture of the page is what its command draws, but for the last digit of places.
#[test]
fn the_picture_of_the_page_is_what_its_command_draws() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = std::fs::read_to_string(root.join("data/guide/in-place-of-ccx.md")).unwrap();
    let line = page
        .lines()
        .find(|line| line.starts_with("brinell run data/"));
    let work = tempfile::tempdir().unwrap();
    let out = work.path().join("disc");
    let words = line.unwrap().split_whitespace().skip(1);
    let words = words.map(|word| match word {
        "disc" => out.display().to_string(),
        _ => word.to_string(),
    });
    let mut command = program();
    let output = limit::output(command.args(words).arg("--quiet").current_dir(root));
    assert!(output.status.success(), "{output:?}");
    let name = page.split("This is `disc/").nth(1).unwrap();
    let drawn = std::fs::read_to_string(out.join(name.split('`').next().unwrap())).unwrap();
    let stored = root.join("data/figures/deck_von_mises.svg");
    let stored = std::fs::read_to_string(stored).unwrap();
    let marks = |text: &str| -> Vec<String> {
        let parts = text
            .split('<')
            .map(|part| part.split(" d=").next().unwrap());
        parts.map(str::to_string).collect()
    };
    assert_eq!(marks(&drawn), marks(&stored));
}

/// What FreeCAD asks first: whether it is CalculiX, and which version. Without a deck ccx ends with
/// 201.
#[test]
fn it_answers_as_ccx_where_there_is_no_deck() {
    let work = tempfile::tempdir().unwrap();
    let usage = ccx(work.path(), &[]);
    assert_eq!(usage.status.code(), Some(201));
    assert!(printed(&usage).contains("CalculiX"));
    let version = printed(&ccx(work.path(), &["-v"]));
    let first = version
        .split(|c: char| !c.is_ascii_digit())
        .find(|w| !w.is_empty());
    assert_eq!(first, Some("2"), "{version}");
    let absent = ccx(work.path(), &["-i", "absent"]);
    assert_eq!(absent.status.code(), Some(201));
    assert!(printed(&absent).contains(" *ERROR in brinell: cannot read the deck absent.inp"));
}

/// What brinell does not have is an error line of its own for each keyword; results of an earlier
/// run are gone.
#[test]
fn what_there_is_not_is_an_error_as_of_ccx() {
    let work = tempfile::tempdir().unwrap();
    let deck = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/decks/two_blocks.inp");
    let text = std::fs::read_to_string(deck).unwrap();
    let text = text.replace("*SURFACE BEHAVIOR", "*FRICTION\n0.2\n*SURFACE BEHAVIOR");
    let text = text.replace("*STEP, INC=100", "*STEP, PERTURBATION");
    std::fs::write(work.path().join("rough.inp"), text).unwrap();
    std::fs::write(work.path().join("rough.frd"), "of an earlier run").unwrap();
    // FreeCAD writes a blank behind `-i`.
    let output = ccx(work.path(), &["-i ", "rough"]);
    assert_eq!(output.status.code(), Some(201));
    assert!(output.stderr.is_empty(), "{output:?}");
    let text = printed(&output);
    for start in [
        " *ERROR reading *FRICTION: rough.inp, line ",
        " *ERROR reading *STEP: rough",
    ] {
        assert!(text.contains(start), "{start}\n{text}");
    }
    assert!(!text.contains("Job finished"));
    assert!(!work.path().join("rough.frd").exists());
    assert!(work.path().join("rough.sta").exists());
}
