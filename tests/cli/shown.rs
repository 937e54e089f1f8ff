//! What is shown: names, numbers, ratios.

use super::{Folder, stderr, stdout};

/// A title and names that would move the cursor, hide or start a new line: written out wherever
/// they are shown, one line each in the tables.
#[test]
fn hidden_and_control_characters_are_shown_as_what_they_are() {
    let folder = Folder::with_changes(
        "contact_patch",
        &[
            (
                "title = \"Contact patch test\"",
                "title = \"two\\nlines\\u200b\\u001b[31m\"",
            ),
            (
                "name = \"pressed\"",
                "name = \"a\\u001b[2Jb\\nc, \\\"d\\\"\\u200be\"",
            ),
            (
                "quantity = \"states.pressed.max_pressure\"",
                "quantity = \"yield.load\"",
            ),
        ],
    );
    let output = folder.brinell("run", &["--no-estimate"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let text = stdout(&output);
    assert!(
        text.starts_with(r"two\u{a}lines\u{200b}\u{1b}[31m (plane strain)"),
        "{text}"
    );
    assert!(
        text.contains(r#"a\u{1b}[2Jb\u{a}c, "d"\u{200b}e"#),
        "{text}"
    );
    let hidden = |text: &str| text.contains(['\u{1b}', '\u{200b}', '\u{7}']);
    assert!(!hidden(&text) && !hidden(&stderr(&output)));
    for entry in std::fs::read_dir(folder.path("out")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        let content = String::from_utf8_lossy(&std::fs::read(&path).unwrap()).into_owned();
        assert!(!hidden(&name), "{name:?}");
        // The arrays of a VTU file are bytes; the scene as it was run keeps names in TOML's
        // escapes.
        if !name.ends_with(".vtu") {
            let found = content.find(['\u{1b}', '\u{7}']);
            assert!(found.is_none(), "{name} at {found:?}");
        }
    }
    let contact = std::fs::read_to_string(folder.path("out").join("contact.csv")).unwrap();
    let mut rows = contact.lines();
    assert!(rows.next().unwrap().ends_with(",name"));
    for row in rows {
        assert!(
            row.ends_with(r#","a\u{1b}[2Jb\u{a}c, ""d""\u{200b}e""#),
            "{row}"
        );
    }
}

/// Wherever a number of 300 digits comes from, it is shown with an exponent.
#[test]
fn numbers_are_short_in_messages_and_in_the_scene_as_run() {
    let folder = Folder::with_changes("contact_patch", &[]);
    let long = |text: &str| {
        let digits = |run: &str| run.len() > 30;
        text.split(|c: char| !c.is_ascii_digit()).any(digits)
    };
    for change in [
        "symmetry=1e300",
        "program.steps=1e300",
        "title=1e300",
        "accuracy=1e300",
    ] {
        let output = folder.brinell("run", &["-q", "--set", change]);
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{change}: {text}");
        assert!(text.contains("1e300") && !long(&text), "{change}: {text}");
    }
    let change = "analysis.tolerance=1e-60";
    let far = "load.0.history=[[0.0, 0.0], [1.0, 1.0], [1e70, 1.0]]";
    let _ = folder.brinell("run", &["-q", "--set", far, "--set", change]);
    if let Ok(scene) = std::fs::read_to_string(folder.path("out").join("scene_as_run.toml")) {
        assert!(!long(&scene), "{scene}");
    }
}

/// The depth of first yield is zero by theory and in the run: there is no ratio of the two.
#[test]
#[cfg_attr(
    not(any(feature = "cholmod", feature = "faer")),
    ignore = "needs a sparse backend"
)]
fn a_ratio_of_nothing_to_nothing_is_said_to_be_none() {
    let folder = Folder::with_changes("cylinder_on_half_plane", &[]);
    let changes = [
        "materials.steel.poissons_ratio=-0.99",
        "mesh.cylinder_on_half_plane.resolution=4",
    ];
    let output = folder.brinell(
        "run",
        &[
            "-q",
            "--no-estimate",
            "--set",
            changes[0],
            "--set",
            changes[1],
        ],
    );
    let text = stdout(&output);
    let row = text
        .lines()
        .find(|line| line.contains("yield.location.y"))
        .unwrap();
    let cells: Vec<&str> = row.split_whitespace().collect();
    assert_eq!(cells[..4], ["yield.location.y", "0", "0", "none"], "{row}");
    let page = std::fs::read_to_string(folder.path("out").join("report.html")).unwrap();
    assert!(!text.contains("NaN") && !page.contains(">NaN"));
}
