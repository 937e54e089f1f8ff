//! What good commands print and write.

use super::{Folder, brinell, program, scene_path, stderr, stdout};
use crate::support::{SMALL_BALL, SMALL_PUNCH};
use serde_json::Value;

#[test]
fn run_prints_a_report_and_writes_the_results() {
    let folder = Folder::with_changes("contact_patch", &[]);
    let output = folder.brinell("run", &["--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert!(output.stderr.is_empty(), "not quiet: {output:?}");
    let text = stdout(&output);
    for fragment in [
        "Contact patch test (plane strain)",
        "64 elements, 90 nodes",
        "no plastic zone",
        "floating bodies",
        "upper held by contact alone",
        "States\n",
        "pressed",
        "states.pressed.max_pressure",
        "total",
        "summary.json, history.csv, contact.csv, fields.pvd",
    ] {
        assert!(text.contains(fragment), "no {fragment:?} in\n{text}");
    }
    for line in text.lines() {
        assert!(
            line.chars().count() <= 110 && line == line.trim_end(),
            "{line:?}"
        );
    }
    let files = ["summary.json", "history.csv", "contact.csv", "fields.pvd"];
    for file in files {
        assert!(folder.path("out").join(file).is_file(), "{file}");
    }
    let summary = folder.summary();
    assert_eq!(summary["scene"], "Contact patch test");
    assert_eq!(summary["scene_file"], folder.scene().to_str().unwrap());
    assert_eq!(summary["incomplete"], Value::Null);
    assert!(summary["timings"]["mesh and model"].as_f64().unwrap() > 0.0);
}

#[test]
fn progress_goes_to_standard_error() {
    let folder = Folder::with_changes("contact_patch", &[]);
    let output = folder.brinell("run", &[]);
    let stderr = String::from_utf8(output.stderr).unwrap();
    for phase in ["mesh and model", "assembly", "factorisation", "output"] {
        assert!(stderr.contains(phase), "no {phase:?} in {stderr}");
    }
}

#[test]
fn a_scene_without_a_title_goes_by_its_file() {
    let folder = Folder::with_changes("contact_patch", &[("title = \"Contact patch test\"\n", "")]);
    let output = folder.brinell("run", &["-q"]);
    assert!(
        stdout(&output).starts_with(folder.scene().to_str().unwrap()),
        "{output:?}"
    );
    assert_eq!(folder.summary()["scene"], "scene.toml");
}

#[test]
fn json_is_the_summary() {
    for command in ["run", "yield"] {
        let folder = Folder::with_changes(
            "thick_cylinder",
            &[
                ("elements = [16, 16]", "elements = [4, 4]"),
                (
                    "    { load_factor = 160.0 },\n    { load_factor = 180.0 },\n    \
                     { load_factor = 190.0 },\n",
                    "",
                ),
            ],
        );
        let output = folder.brinell(command, &["--json", "--quiet", "--threads", "1"]);
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        let mut printed: Value = serde_json::from_slice(&output.stdout).unwrap();
        let mut written = folder.summary();
        // The printed one also knows how long writing took, and what memory.
        for value in [&mut printed, &mut written] {
            value["timings"] = Value::Null;
            value["peak_memory_bytes"] = Value::Null;
        }
        assert_eq!(printed, written);
        assert_eq!(printed["yield"]["location"]["body"], "tube");
        let [x, y] = ["x", "y"].map(|k| printed["yield"]["location"][k].as_f64().unwrap());
        // First yield is at the bore; the chord of a quad8 side leaves the circle by less than 1e-3
        // radii.
        assert!((x.hypot(y) / 100.0 - 1.0).abs() < 1e-3, "{x} {y}");
        assert_eq!(
            printed["states"].as_array().unwrap().is_empty(),
            command == "yield"
        );
    }
}

#[test]
fn yield_writes_nothing_unless_asked() {
    let folder = Folder::with_changes(
        "thick_cylinder",
        &[("elements = [16, 16]", "elements = [4, 4]")],
    );
    let output = brinell(&["yield", folder.scene().to_str().unwrap(), "-q"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let text = stdout(&output);
    assert!(
        text.contains("First yield") && text.contains("in body"),
        "{text}"
    );
    assert!(
        !text.contains("States") && !text.contains("Results in"),
        "{text}"
    );
    // No contact in the scene: no columns for it.
    assert!(!text.contains("pressure  "), "{text}");
    assert_eq!(folder.entries(), 1);
}

#[test]
fn check_tells_effects_sizes_cost_and_blas_of_every_scene() {
    let scenes = concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes");
    let mut n = 0;
    for entry in std::fs::read_dir(scenes).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "toml") {
            continue;
        }
        n += 1;
        let before = std::fs::read_dir(scenes).unwrap().count();
        // The dense solver takes small models only.
        let output = brinell(&["check", path.to_str().unwrap()]);
        if cfg!(any(feature = "cholmod", feature = "faer")) {
            assert_eq!(output.status.code(), Some(0), "{path:?} {output:?}");
            let text = stdout(&output);
            for fragment in [
                "Model",
                "Factor",
                "Predicted",
                "BLAS",
                "Effects",
                "friction",
            ] {
                assert!(
                    text.contains(fragment),
                    "{path:?}: no {fragment:?} in\n{text}"
                );
            }
        } else {
            assert!(
                [Some(0), Some(2)].contains(&output.status.code()),
                "{path:?} {output:?}"
            );
        }
        assert_eq!(std::fs::read_dir(scenes).unwrap().count(), before);
    }
    assert!(n >= 10, "{n} scenes");
    let output = brinell(&["check", &scene_path("contact_patch"), "--json"]);
    let check: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(check["sizes"]["elements"], 64);
}

/// Where both solvers are built in: on one thread faer takes less for large solids.
#[test]
#[cfg(all(feature = "cholmod", feature = "faer"))]
fn check_names_the_faster_solver() {
    let notes = |name: &str, resolution: &str, solver: &str| {
        let output = program()
            .args(["check", &scene_path(name), "--solver", solver, "--json"])
            .args([
                "--set",
                &format!("mesh.curved_bodies.resolution={resolution}"),
            ])
            .env("OPENBLAS_NUM_THREADS", "1")
            .output()
            .unwrap();
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    let says = |text: String| text.contains("--solver faer");
    assert!(says(notes("ball_on_flat_3d", "9", "cholmod")));
    assert!(!says(notes("ball_on_flat_3d", "9", "faer")));
    assert!(!says(notes("ball_on_flat_3d", "3", "cholmod")));
}

#[test]
fn the_disc_scene_shows_the_contact_arc() {
    let folder = Folder::with_changes(
        "disc_in_plate",
        &[
            ("resolution = 90 ", "resolution = 16 "),
            (
                "resolution = 16          # one element per degree",
                "resolution = 16\nfar_radius = 4.0\ngrowth = 1.2",
            ),
            (
                "    { load_factor = 1.25 },\n    { load_factor = 1.5 },\n    \
                 { load_factor = 1.75 },\n    { load_factor = 2.0 },\n",
                "",
            ),
            (
                "    { name = \"unloading 1.75\", load_factor = 1.75 },\n    \
                 { name = \"unloading 1.5\", load_factor = 1.5 },\n    \
                 { name = \"unloading 1.25\", load_factor = 1.25 },\n    \
                 { name = \"unloading 1\", load_factor = 1.0 },\n",
                "",
            ),
        ],
    );
    let output = folder.brinell("run", &["-q"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let text = stdout(&output);
    for fragment in [
        "States (load factor 1 is first yield)",
        "[deg]",
        "contact",
        "pole",
        "arc",
    ] {
        assert!(text.contains(fragment), "no {fragment:?} in\n{text}");
    }
    let states = folder.summary()["states"].clone();
    // One element spans 5.6 degrees; the exact half angle is 19.625 (integral equation of the
    // receding contact).
    let to = states[0]["contact_arc"]["to"].as_f64().unwrap();
    assert!((to - 19.625).abs() < 0.5 * 90.0 / 16.0, "{to}");
    assert_eq!(states[0]["contact_arc"]["from"], 0.0);
    for key in ["pole_pressure", "max_pressure", "contact_force"] {
        assert!(states[0][key].as_f64().unwrap() > 0.0, "{key}");
    }
}

#[test]
fn backends_and_thread_counts_agree() {
    let folder = Folder::with_changes("shrink_fit", &[]);
    let mut pressures = Vec::new();
    for more in [
        ["--solver", "dense"],
        ["--threads", "1"],
        ["--threads", "2"],
    ] {
        let output = folder.brinell("run", &[&more[..], &["-q"]].concat());
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        pressures.push(
            folder.summary()["states"][0]["max_pressure"]
                .as_f64()
                .unwrap(),
        );
    }
    assert_eq!(pressures[1], pressures[2]);
    assert!(
        (pressures[0] / pressures[1] - 1.0).abs() < 1e-10,
        "{pressures:?}"
    );
}

#[test]
fn the_limit_load_is_reported_as_collapse_with_what_was_held() {
    let folder = Folder::with_changes(
        "thick_cylinder",
        &[
            ("elements = [16, 16]", "elements = [2, 2]"),
            (
                "    { load_factor = 160.0 },\n    { load_factor = 180.0 },\n    \
                 { load_factor = 190.0 },\n",
                "    { load_factor = 300.0 },\n",
            ),
        ],
    );
    let output = folder.brinell("run", &["-q"]);
    let stderr = String::from_utf8(output.stderr.clone()).unwrap();
    assert_eq!(output.status.code(), Some(6), "{stderr}");
    assert!(stderr.contains("limit load: load factor"), "{stderr}");
    assert!(
        stdout(&output).contains("INCOMPLETE: limit load"),
        "{output:?}"
    );
    let summary = folder.summary();
    assert!(
        summary["incomplete"]
            .as_str()
            .unwrap()
            .contains("limit load")
    );
    assert_eq!(summary["states"].as_array().unwrap().len(), 3);
    let history = std::fs::read_to_string(folder.path("out/history.csv")).unwrap();
    let held: f64 = history
        .lines()
        .last()
        .unwrap()
        .split(',')
        .nth(1)
        .unwrap()
        .parse()
        .unwrap();
    // Exact collapse of the wall is 2k ln(b/a) = 192.09 (Hill, chapter V); two elements through the
    // wall are coarse.
    assert!((held / 192.09 - 1.0).abs() < 0.02, "{held}");
}

/// `brinell accuracy`: three kinds of files, and the words on standard output.
#[test]
fn a_study_leaves_its_data_and_plots() {
    let root = tempfile::tempdir().unwrap();
    let out = root.path().join("study");
    let scene = format!(
        "{}/data/scenes/thick_cylinder.toml",
        env!("CARGO_MANIFEST_DIR")
    );
    let output = crate::support::limit::output(
        program()
            .args([
                "accuracy",
                &scene,
                "--quiet",
                "--levels",
                "3",
                "--knobs",
                "resolution,gamma",
                "--out",
            ])
            .arg(&out)
            .args(["--set", "mesh.parts.0.ring.elements=[8,8]"])
            .args(["--set", "program.targets=[{ yield = true }]"]),
    );
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{text}{}", stderr(&output));
    assert!(
        text.contains("Prices") && text.contains(" costs "),
        "{text}"
    );
    let json: serde_json::Value =
        serde_json::from_slice(&std::fs::read(out.join("accuracy.json")).unwrap()).unwrap();
    let runs = json["runs"].as_array().unwrap();
    assert!(
        runs.len() >= 3
            && runs
                .iter()
                .all(|r| r["wall_seconds"].as_f64().unwrap() > 0.0)
    );
    let mut table = csv::Reader::from_path(out.join("accuracy.csv")).unwrap();
    let quantity = table
        .headers()
        .unwrap()
        .iter()
        .position(|h| h == "quantity")
        .unwrap();
    let rows: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
    assert_eq!(
        rows.iter().filter(|r| &r[quantity] == "yield.load").count(),
        runs.len()
    );
    let plot = std::fs::read_to_string(out.join("yield_load.svg")).unwrap();
    assert!(
        roxmltree::Document::parse(&plot)
            .unwrap()
            .descendants()
            .any(|n| n.has_tag_name("polyline"))
    );
    // A second study replaces the first, another directory in use is left alone.
    let refused = root.path().join("notes");
    std::fs::create_dir(&refused).unwrap();
    std::fs::write(refused.join("mine.txt"), "mine").unwrap();
    let output = crate::support::limit::output(
        program().args(["accuracy", &scene, "--quiet", "--knobs", "mesh"]),
    );
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("unknown knob `mesh`"));
    let output = crate::support::limit::output(
        program()
            .args(["accuracy", &scene, "--quiet", "--out"])
            .arg(&refused),
    );
    assert_eq!(output.status.code(), Some(2));
    assert!(refused.join("mine.txt").exists());
}

/// What a killed run left beside its results goes with the next run that ends well, whether that
/// goes on from it or not.
#[test]
fn a_leftover_checkpoint_goes_with_the_next_run_that_ends() {
    let folder = Folder::with_changes("contact_patch", &[]);
    let left = folder.path("out.checkpoint");
    let leave = || {
        std::fs::create_dir_all(&left).unwrap();
        for name in ["checkpoint", "part-000001", "lock"] {
            std::fs::write(left.join(name), "of a run that was killed").unwrap();
        }
    };
    leave();
    let output = folder.brinell("run", &["-q", "--set", "symmetry=3"]);
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    assert!(
        left.join("checkpoint").exists(),
        "a run that did not start took it"
    );
    let output = folder.brinell("run", &["-q"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert!(!left.exists());
    // What is the user's stays.
    leave();
    std::fs::write(left.join("notes.txt"), "mine").unwrap();
    assert_eq!(folder.brinell("run", &["-q"]).status.code(), Some(0));
    let names = std::fs::read_dir(&left).unwrap();
    let names: Vec<_> = names.map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(names, ["notes.txt"]);
}

/// The time that `check` predicts grows with the mesh: more than the elements, less than the cube
/// of those along a line.
#[test]
#[cfg_attr(
    not(any(feature = "cholmod", feature = "faer")),
    ignore = "needs a sparse backend"
)]
fn the_predicted_time_of_a_run_grows_with_its_mesh() {
    let predicted = |resolution: usize| {
        let scene = scene_path("cylinder_on_half_plane");
        let resolution = format!("mesh.cylinder_on_half_plane.resolution={resolution}");
        let growth = "mesh.cylinder_on_half_plane.growth=1.05";
        let arguments = [
            "check",
            &scene,
            "--json",
            "--set",
            &resolution,
            "--set",
            growth,
        ];
        let found: Value = serde_json::from_str(&stdout(&brinell(&arguments))).unwrap();
        let elements = found["sizes"]["elements"].as_f64().unwrap();
        (found["predicted_run_seconds"].as_f64().unwrap(), elements)
    };
    let [(coarse, few), (fine, many)] = [16, 48].map(predicted);
    let (times, elements) = (fine / coarse, many / few);
    assert!(
        times > elements && times < elements.powf(1.5) * 3f64.powi(2),
        "{times} {elements}"
    );
}

/// Share of a run that may lie between two rows of its time table, and seconds of a machine that is
/// busy with other things: rows end where the next begins.
const BETWEEN: [f64; 2] = [0.01, 0.02];

/// Every second of a run is in a row: where contacts are measured in each increment, where a zone
/// is chosen and the structure factored again, with an estimate, with checkpoints.
#[test]
fn the_rows_of_the_time_table_add_up_to_the_whole() {
    let check = |folder: &Folder, what: &str| {
        let summary = folder.summary();
        let timings = summary["timings"].as_object().unwrap();
        let seconds = |value: &Value| value.as_f64().unwrap();
        let total = seconds(&timings["total"]);
        let rows = timings.iter().filter(|(name, _)| *name != "total");
        let sum: f64 = rows.map(|(_, value)| seconds(value)).sum();
        assert!(
            (total - sum).abs() <= BETWEEN[0] * total + BETWEEN[1],
            "{what}: {sum} of {total} in {timings:#?}"
        );
    };
    let coarse = ["mesh.cylinder_on_half_plane.resolution=6"];
    let ring = ["mesh.parts.0.ring.elements=[4, 4]"];
    let runs: [(&str, &[&str], &[&str]); 5] = [
        ("square_punch", &SMALL_PUNCH, &["--no-estimate"]),
        ("ball_on_flat_3d", &SMALL_BALL, &["--no-estimate"]),
        ("cylinder_on_half_plane", &coarse, &[]),
        ("thick_cylinder", &ring, &["--accuracy=20%"]),
        (
            "thick_cylinder",
            &ring,
            &["--checkpoint=1", "--no-estimate"],
        ),
    ];
    for (scene, changes, options) in runs {
        let folder = Folder::with_changes(scene, &[]);
        let set = changes.iter().flat_map(|change| ["--set", change]);
        let words: Vec<&str> = set.chain(options.iter().copied()).collect();
        let output = folder.brinell("run", &words);
        let stderr = stderr(&output);
        assert!(output.status.success(), "{stderr}");
        check(&folder, &format!("{scene} {options:?}"));
    }
}
