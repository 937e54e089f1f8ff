//! What accuracy costs, as the program says it: settings that buy nothing, whole programs to a
//! demanded accuracy, what ends one.

use super::{brinell, scene_path, stderr, stdout};
use crate::support::either;
use serde_json::Value;
use std::path::Path;

/// Runs `brinell` with a directory to write to; standard output with its lines joined, and a file
/// of what was written.
fn told(arguments: &[&str], out: &Path, file: &str) -> (String, Value) {
    ended(0, arguments, out, file)
}

/// As [`told`], of a run that ends with an exit code.
fn ended(code: i32, arguments: &[&str], out: &Path, file: &str) -> (String, Value) {
    let mut all: Vec<&str> = arguments.to_vec();
    all.extend(["--quiet", "--out", out.to_str().unwrap()]);
    let output = brinell(&all);
    let text = stdout(&output);
    let errors = stderr(&output);
    assert_eq!(output.status.code(), Some(code), "{text}{errors}");
    let words: Vec<&str> = text.split_whitespace().collect();
    let json = serde_json::from_slice(&std::fs::read(out.join(file)).unwrap()).unwrap();
    (words.join(" "), json)
}

fn quantity<'j>(json: &'j Value, name: &str) -> &'j Value {
    let rows = json["quantities"].as_array().unwrap();
    let found = rows.iter().find(|q| q["quantity"] == name);
    found.unwrap_or_else(|| panic!("no {name} in {json}"))
}

/// With two increments to near collapse the path is further off than the mesh; the tightest
/// tolerance is not to be seen beside the mesh.
#[test]
fn what_limits_and_what_would_do_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let (text, json) = told(
        &[
            "accuracy",
            &scene_path("thick_cylinder"),
            "--levels",
            "4",
            "--knobs",
            "resolution,stepping,tolerance",
            "--set",
            "mesh.parts.0.element=quad8",
            "--set",
            "mesh.parts.0.ring.elements=[12,12]",
            "--set",
            "program.targets=[{ load_factor = 180.0 }]",
        ],
        &folder.path().join("study"),
        "accuracy.json",
    );
    let words: Vec<&str> = quantity(&json, "states.alpha 180.approach")["words"]
        .as_array()
        .unwrap()
        .iter()
        .map(|w| w.as_str().unwrap())
        .collect();
    let said = |start: &str, end: &str| {
        let found = words
            .iter()
            .find(|w| w.starts_with(start) && w.ends_with(end))
            .unwrap_or_else(|| panic!("{words:?}"));
        assert!(text.contains(*found), "{found}: {text}");
    };
    said("the increments limit", "gain more than a finer mesh");
    said(
        "tolerance 1e-",
        "would be accurate enough: the error of the mesh is larger than the difference",
    );
}

/// What is compared.
const KEYS: [&str; 5] = [
    "load",
    "max_pressure",
    "half_width",
    "approach",
    "residual_depth",
];

/// Largest share by which the figures of two runs of one program differ, relative to the largest
/// size of each figure.
fn difference(a: &Value, b: &Value) -> f64 {
    let states = |json: &Value| json["states"].as_array().unwrap().clone();
    let (a, b) = (states(a), states(b));
    assert_eq!(a.len(), b.len());
    let mut most = 0.0;
    for key in KEYS {
        let value = |state: &Value| state[key].as_f64().unwrap();
        let scale = b.iter().map(|s| value(s).abs()).fold(0.0, f64::max);
        for (a, b) in a.iter().zip(&b) {
            assert_eq!(a["name"], b["name"]);
            let off = (value(a) - value(b)).abs() / scale;
            if off > most {
                println!("{key} of {}: {off:.4}", a["name"]);
                most = off;
            }
        }
    }
    most
}

/// A whole program to a demanded accuracy: reached, and as near as that to the run on a mesh that
/// is finer by far.
fn to_accuracy(demanded: f64, name: &str, settings: &[&str], fine: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let file = scene_path(name);
    let mut arguments = vec!["run", &file];
    arguments.extend(settings.iter().flat_map(|s| ["--set", s]));
    let percent = format!("{demanded}%");
    let asked = [&arguments[..], &["--accuracy", &percent]].concat();
    let (text, asked) = told(&asked, &folder.path().join("asked"), "summary.json");
    let demand = &asked["accuracy"]["demand"];
    println!("{demand:#}");
    assert_eq!(demand["reached"], true, "{demand}");
    assert!(demand["stated"].as_f64().unwrap() <= demanded / 100.0);
    assert!(text.contains(" %: reached; the stated error is "), "{text}");
    arguments.push("--no-estimate");
    arguments.extend(fine.iter().flat_map(|s| ["--set", s]));
    let (_, fine) = told(&arguments, &folder.path().join("fine"), "summary.json");
    let off = difference(&asked, &fine);
    assert!(off <= demanded / 100.0, "{name} to {demanded} %: {off}");
}

#[test]
#[cfg_attr(
    not(any(feature = "cholmod", feature = "faer")),
    ignore = "needs a sparse backend"
)]
fn the_papers_cylinder_to_ten_percent() {
    let resolution = either(16, 32);
    let fine = [
        &format!("mesh.cylinder_on_half_plane.resolution={resolution}"),
        "mesh.cylinder_on_half_plane.growth=1.1",
    ];
    to_accuracy(10.0, "cylinder_on_half_plane", &[], &fine);
}

/// The states in the midst of unloading are left out: their largest pressure is a peak at the edge
/// of the dent that grows with the mesh.
#[test]
#[cfg_attr(
    not(any(feature = "cholmod", feature = "faer")),
    ignore = "needs a sparse backend"
)]
fn the_papers_disc_to_ten_percent() {
    to_accuracy(
        10.0,
        "disc_in_plate",
        &["program.targets=[{ yield = true }, { load_factor = 2.0 }, \
           { name = \"unloaded\", load_factor = 0.0 }]"],
        &[
            &format!("mesh.disc_in_plate.resolution={}", either(72, 120)),
            "mesh.disc_in_plate.growth=1.05",
        ],
    );
}

/// Near collapse displacements run away, and errors of coarse meshes change their sign.
#[test]
#[cfg_attr(
    not(any(feature = "cholmod", feature = "faer")),
    ignore = "needs a sparse backend"
)]
fn the_tube_to_one_percent() {
    for &demanded in either(&[1.0][..], &[1.0, 0.3]) {
        let fine = ["mesh.parts.0.ring.elements=[96,96]"];
        to_accuracy(demanded, "thick_cylinder", &[], &fine);
    }
}

/// A piece of a block must end on a node of every mesh on the way. The value is that of the last
/// mesh, the one that the meshes lead to stands beside it under a name of its own.
#[test]
#[cfg_attr(
    not(any(feature = "cholmod", feature = "faer")),
    ignore = "needs a sparse backend"
)]
fn the_punch_to_ten_percent() {
    let file = scene_path("flat_punch");
    for &demanded in either(&[10.0][..], &[10.0, 3.0]) {
        let folder = tempfile::tempdir().unwrap();
        let asked = format!("states.flow.load={demanded}%");
        let arguments = ["run", &file, "--accuracy", &asked];
        let (_, json) = told(&arguments, &folder.path().join("out"), "summary.json");
        let demand = &json["accuracy"]["demand"];
        assert_eq!(demand["reached"], true, "{demand}");
        let state = json["states"].as_array().unwrap().last().unwrap().clone();
        let limit = state["load"].as_f64().unwrap();
        // Prandtl's mean pressure on the half model's width of 1.
        let exact = (2.0 + std::f64::consts::PI) * 100.0 / 3f64.sqrt();
        let off = limit / exact - 1.0;
        println!("{demanded} %: {off:.2e}");
        assert!(100.0 * off.abs() <= demanded, "{limit} {exact}");
        let rows = json["accuracy"]["quantities"].as_array().unwrap();
        let row = rows.iter().find(|r| r["quantity"] == "states.flow.load");
        assert_eq!(row.unwrap()["value"], state["load"]);
    }
}

/// A block with sharp corners on a wider one: below the corner the pressure has no limit.
const CORNER: &str = r#"
kind = "plane_strain"

[[mesh.parts]]
body = "block"

[mesh.parts.block]
x = [0.0, 5.0]
y = [-5.0, 0.0]
elements = [40, 40]
pieces = [{ name = "below", side = "top", from = 0.0, to = 1.0 }]

[[mesh.parts]]
body = "punch"
block = { x = [0.0, 1.0], y = [0.0, 1.0], elements = [8, 8] }

[materials.steel]
youngs_modulus = 210000.0
poissons_ratio = 0.3

[bodies]
block = { material = "steel" }
punch = { material = "steel" }

[[contact]]
first = "punch.bottom"
second = "block.below"

[[support]]
on = "block.bottom"
fix = ["x", "y"]

[[support]]
on = "block.left"
fix = ["x"]

[[support]]
on = "punch.left"
fix = ["x"]

[[load]]
on = "punch.top"
pressure = 100.0

[program]
targets = [{ load_factor = 1.0 }]
"#;

/// The sequence of meshes ends, with the results and the name of what has no limit.
#[test]
fn a_pressure_that_grows_with_the_mesh_is_not_reached() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("corner.toml");
    std::fs::write(&file, CORNER).unwrap();
    let arguments = ["run", file.to_str().unwrap(), "--accuracy", "10%"];
    let (text, json) = ended(7, &arguments, &folder.path().join("out"), "summary.json");
    let demand = &json["accuracy"]["demand"];
    assert_eq!(demand["reached"], false, "{demand}");
    assert!(demand["stated"].as_f64().unwrap() > 0.1, "{demand}");
    let why = "states.alpha 1.max_pressure has no limit under refinement";
    assert!(demand["reason"].as_str().unwrap().contains(why), "{demand}");
    assert!(text.contains(why), "{text}");
    // What has one is reached where it alone is asked for.
    let arguments = [&arguments[..3], &["approach=2%"]].concat();
    let (_, json) = told(&arguments, &folder.path().join("named"), "summary.json");
    assert_eq!(json["accuracy"]["demand"]["reached"], true);
    assert_eq!(json["states"].as_array().unwrap().len(), 1);
}

/// What makes no sense is one clear error: before a run where that can be known.
#[test]
fn demands_that_make_no_sense_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let file = scene_path("thick_cylinder");
    for (more, says) in [
        (&["--accuracy", "0%"][..], "above 0 and below 100 %"),
        (&["--accuracy", "100%"], "above 0 and below 100 %"),
        (&["--accuracy", "presure=1%"], "`presure` is no quantity"),
        (
            &["--accuracy", "dent=1%"],
            "demands nothing that this scene has",
        ),
        (&["--budget", "10s"], "--budget is the time for an accuracy"),
    ] {
        let mut arguments = vec!["run", &file, "--quiet", "--out", out.to_str().unwrap()];
        arguments.extend(more);
        let output = brinell(&arguments);
        let errors = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{more:?}: {errors}");
        assert!(errors.contains(says), "{more:?}: {errors}");
        assert!(!out.exists());
    }
    // A piece that does not end at a node: longer or shorter on another mesh.
    let file = folder.path().join("corner.toml");
    let piece = CORNER.replace("from = 0.0, to = 1.0 }]", "from = 0.0, to = 1.01 }]");
    std::fs::write(&file, piece).unwrap();
    let arguments = [
        "run",
        file.to_str().unwrap(),
        "--accuracy",
        "10%",
        "--quiet",
    ];
    let output = brinell(&arguments);
    let errors = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{errors}");
    assert!(
        errors.contains("cannot be refined") && errors.contains("`block`"),
        "{errors}"
    );
}

/// A time that is too short keeps the mesh that was run, and says why it is the last.
#[test]
fn a_budget_keeps_what_it_has() {
    let folder = tempfile::tempdir().unwrap();
    let file = scene_path("thick_cylinder");
    let arguments = ["run", &file, "--accuracy", "0.001%", "--budget", "1s"];
    let (text, json) = ended(7, &arguments, &folder.path().join("out"), "summary.json");
    let demand = &json["accuracy"]["demand"];
    assert_eq!(demand["reached"], false);
    assert!(
        demand["reason"].as_str().unwrap().contains("budget"),
        "{demand}"
    );
    assert!(
        text.contains("NOT reached: the next mesh would take about"),
        "{text}"
    );
    assert!(!json["states"].as_array().unwrap().is_empty());
}
