//! Decks as other programs and systems write them: they say the same in other ways.

use super::{folder, run};
use brinell::results::Results;

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
    run(&path, &[]).1
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
