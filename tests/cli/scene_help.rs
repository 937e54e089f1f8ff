//! What helps to write a scene: schema, examples, new scenes, completions, manual page.

use super::{brinell, scene_path, stderr, stdout, succeeds};
use brinell::analytical::HertzEllipse;
use brinell::scene::Scene;
use serde_json::Value;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn printed_schema() -> Value {
    let output = succeeds(&["schema"]);
    serde_json::from_str(&stdout(&output)).unwrap()
}

/// The pages of keys are those that the program prints: none is missing, none is invented.
#[test]
fn the_reference_pages_are_those_that_are_printed() {
    for (file, arguments) in [
        ("scene.md", &["schema", "--markdown"][..]),
        ("summary.md", &["schema", "--summary", "--markdown"]),
    ] {
        let printed = stdout(&brinell(arguments));
        let page = std::fs::read_to_string(root().join("data/guide").join(file)).unwrap();
        let command = arguments.join(" ");
        let anew = format!("write it anew: brinell {command} > data/guide/{file}");
        assert!(
            page == printed,
            "data/guide/{file} is not what the program says; {anew}"
        );
    }
}

/// All scenes of the repository.
fn scenes() -> Vec<PathBuf> {
    ["data/scenes", "data/scenes/hard"]
        .iter()
        .flat_map(|folder| std::fs::read_dir(root().join(folder)).unwrap())
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .collect()
}

fn document(path: &Path) -> Value {
    let text = std::fs::read_to_string(path).unwrap();
    serde_json::to_value(text.parse::<toml::Table>().unwrap()).unwrap()
}

#[test]
fn the_schema_in_the_repository_is_the_one_that_is_printed() {
    let path = root().join("data/schema/scene.schema.json");
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    let printed = stdout(&brinell(&["schema"]));
    assert!(
        kept == printed,
        "data/schema/scene.schema.json is not what the program says; write it anew: brinell schema \
         > data/schema/scene.schema.json"
    );
    assert_eq!(
        stdout(&brinell(&["schema", "--summary"])),
        brinell::output::SUMMARY_SCHEMA
    );
}

#[test]
fn every_scene_obeys_the_schema_as_written_and_as_read() {
    let schema = jsonschema::validator_for(&printed_schema()).unwrap();
    let scenes = scenes();
    assert!(scenes.len() > 20, "{scenes:?}");
    for path in scenes {
        if let Err(error) = schema.validate(&document(&path)) {
            panic!("{}: {error} at {}", path.display(), error.instance_path());
        }
        // With every key that the file leaves out: histories, plasticity, program, settings.
        let whole = serde_json::to_value(Scene::load(&path).unwrap()).unwrap();
        if let Err(error) = schema.validate(&whole) {
            panic!("{}: {error} at {}", path.display(), error.instance_path());
        }
    }
}

#[test]
fn the_schema_refuses_what_the_program_refuses() {
    let schema = jsonschema::validator_for(&printed_schema()).unwrap();
    let good = document(Path::new(&scene_path("three_bodies")));
    assert!(schema.is_valid(&good));
    let changes: [(&str, Value); 8] = [
        ("/kind", "plane_stretch".into()),
        ("/materials/steel/youngs_modulus", "stiff".into()),
        ("/bodies/base/plastic", "perhaps".into()),
        ("/load/0/history", "sometimes".into()),
        ("/support/0/fix/0", "w".into()),
        ("/mesh/parts/0/block/elements", serde_json::json!([1])),
        ("/program/targets", Value::Null),
        ("/title", 3.into()),
    ];
    for (place, value) in changes {
        let mut bad = good.clone();
        *bad.pointer_mut(place).unwrap() = value;
        assert!(!schema.is_valid(&bad), "{place}");
    }
    for table in ["", "/mesh", "/materials/steel", "/contact/0", "/program"] {
        let mut bad = good.clone();
        let keys = bad.pointer_mut(table).unwrap().as_object_mut().unwrap();
        keys.insert("frction".into(), 0.1.into());
        assert!(!schema.is_valid(&bad), "{table}");
    }
}

#[test]
fn an_example_is_printed_as_it_stands_in_the_repository() {
    let list = stdout(&brinell(&["example"]));
    for name in ["ball_on_half_space", "disc_in_plate", "three_bodies"] {
        assert!(list.contains(name), "{list}");
        let printed = stdout(&brinell(&["example", name]));
        assert_eq!(printed, std::fs::read_to_string(scene_path(name)).unwrap());
    }
    let unknown = brinell(&["example", "nothing"]);
    assert_eq!(unknown.status.code(), Some(2));
    assert!(stderr(&unknown).contains("thick_sphere"));
}

/// Makes a scene, runs it and returns its summary.
fn made_and_run(folder: &Path, arguments: &[&str]) -> Value {
    let scene = folder.join(format!("{}.toml", arguments[0]));
    let scene = scene.to_str().unwrap();
    succeeds(&[&["new"], arguments, &["--out", scene]].concat());
    let text = std::fs::read_to_string(scene).unwrap();
    assert!(
        text.lines().filter(|l| l.contains('#')).count() >= 6,
        "few comments:\n{text}"
    );
    // The estimate, which runs other meshes, is wanted of one scene.
    let mut run = vec!["run", "-q", "--no-report", "--json", scene];
    run.extend(match arguments[0] {
        "roller-between-raceways" => ["--estimate", "full"],
        _ => ["--estimate", "none"],
    });
    let run = succeeds(&run);
    serde_json::from_str(&stdout(&run)).unwrap()
}

/// The meshes are beyond what the dense backend takes.
#[test]
#[cfg_attr(
    not(any(feature = "cholmod", feature = "faer")),
    ignore = "needs a sparse backend"
)]
fn new_scenes_run_and_give_what_their_comments_say() {
    let folder = tempfile::tempdir().unwrap();
    let near = |value: &Value, expected: f64, share: f64| {
        let value = value.as_f64().unwrap();
        assert!(
            (value / expected - 1.0).abs() < share,
            "{value} against {expected}"
        );
    };

    // Hertz, point contact: the mesh of 8 elements is right to about h/a squared.
    let ball = made_and_run(
        folder.path(),
        &[
            "ball-on-flat",
            "--radius",
            "5",
            "--load",
            "20",
            "--resolution",
            "8",
        ],
    );
    let modulus = brinell::analytical::contact_modulus(210e3, 0.3, 210e3, 0.3);
    let hertz = brinell::analytical::HertzPoint::new(5.0, modulus).unwrap();
    near(
        &ball["yield"]["load"],
        hertz.yield_load(0.3, 500.0),
        1.0 / 64.0,
    );
    near(&ball["states"][1]["load"], 20.0, 1e-9);
    assert!(ball["states"][2]["residual_depth"].as_f64() > Some(0.0));
    std::fs::remove_file(folder.path().join("ball-on-flat.toml")).unwrap();

    // Line contact, elastic: below the yield load no dent stays and no yield is asked for.
    let roller = made_and_run(
        folder.path(),
        &["roller-on-flat", "--load", "150", "--resolution", "8"],
    );
    let hertz = brinell::analytical::HertzLine::new(10.0, modulus).unwrap();
    assert_eq!(roller["states"].as_array().unwrap().len(), 2);
    near(
        &roller["states"][0]["max_pressure"],
        hertz.max_pressure(150.0),
        1.0 / 64.0,
    );
    assert_eq!(roller["states"][1]["residual_depth"], 0.0);

    // Hertz, elliptical contact, 3 elements over the smaller half axis.
    for (problem, radii) in [
        (&["ball-in-groove"][..], [[5.0, 5.0], [-5.2, 20.0]]),
        (
            &["crossed-cylinders", "--upper", "6"],
            [[0.0, 6.0], [12.0, 0.0]],
        ),
        (
            &["ball-on-flat", "--three-dimensional"],
            [[10.0, 10.0], [0.0, 0.0]],
        ),
    ] {
        let solid = made_and_run(folder.path(), &[problem, &["--resolution", "3"]].concat());
        let [upper, lower] = radii;
        let relative = HertzEllipse::relative_radii(upper, lower).unwrap();
        let hertz = HertzEllipse::new(relative, modulus).unwrap();
        near(
            &solid["yield"]["load"],
            hertz.yield_load(0.3, 500.0),
            0.9 / 9.0,
        );
        assert!(solid["states"][2]["residual_depth"].as_f64() > Some(0.0));
        std::fs::remove_file(folder.path().join(format!("{}.toml", problem[0]))).unwrap();
    }

    // Hertz at both raceways of a roller: 1/R = 1/5 + 1/20 and 1/5 - 1/30.
    let bearing = made_and_run(
        folder.path(),
        &[
            "roller-between-raceways",
            "--diameter",
            "10",
            "--load",
            "80",
        ],
    );
    let table = folder
        .path()
        .join("roller-between-raceways.out/contact.csv");
    let mut rows = csv::Reader::from_path(table).unwrap();
    let mut largest = [0.0f64; 2];
    for row in rows.records().map(|row| row.unwrap()) {
        if row[0] == *"1" {
            let contact: usize = row[3].parse().unwrap();
            largest[contact - 1] = largest[contact - 1].max(row[9].parse().unwrap());
        }
    }
    for (pressure, radius) in largest.iter().zip([4.0, 6.0]) {
        let hertz = brinell::analytical::HertzLine::new(radius, modulus).unwrap();
        near(
            &Value::from(*pressure),
            hertz.max_pressure(80.0),
            1.0 / 64.0,
        );
    }
    near(&bearing["states"][0]["load"], 80.0, 1e-9);
    // Both contacts have the same force: on finer meshes too figures are of the first.
    let stated = bearing["accuracy"]["quantities"].as_array().unwrap();
    let width = stated
        .iter()
        .find(|row| row["quantity"] == "states.pressed.half_width");
    let error = width.unwrap()["relative_error"].as_f64().unwrap();
    assert!(error < 0.1, "{error}");
    let nowhere = brinell(&["new", "roller-between-raceways"]);
    let words = stderr(&nowhere);
    assert!(
        words.contains("a mesh belongs to this scene: give --out"),
        "{words}"
    );

    // Lame: p = E d (b^2 - a^2)/(2 a b^2) for one material.
    let fit = made_and_run(
        folder.path(),
        &["shaft-in-bore", "--radius", "25", "--interference", "0.02"],
    );
    let pressure = 210e3 * 0.02 * (50.0f64.powi(2) - 625.0) / (2.0 * 25.0 * 50.0f64.powi(2));
    near(&fit["states"][0]["max_pressure"], pressure, 0.01);

    // Persson: the ring ends at ten radii, the contact at whole elements of 3.75 degrees.
    std::fs::remove_file(folder.path().join("shaft-in-bore.toml")).unwrap();
    let loose = made_and_run(
        folder.path(),
        &[
            "shaft-in-bore",
            "--diameter",
            "20",
            "--clearance",
            "0.02",
            "--resolution",
            "24",
        ],
    );
    let pin = brinell::analytical::PinInHole::new(10.0, 0.02, 105e3).unwrap();
    let pressed = &loose["states"][0];
    let load = pressed["load"].as_f64().unwrap();
    near(
        &pressed["max_pressure"],
        pin.max_pressure(load).unwrap(),
        0.05,
    );
    let angle = pin.half_angle(load).unwrap().to_degrees();
    assert!((pressed["contact_arc"]["to"].as_f64().unwrap() - angle).abs() < 3.75);

    // Two materials: the contact modulus is that of both, the softer one yields.
    let folder_of_two = tempfile::tempdir().unwrap();
    let two = made_and_run(
        folder_of_two.path(),
        &[
            "ball-on-flat",
            "--diameter",
            "10",
            "--material",
            "100Cr6",
            "--second-material",
            "EN AW-6082-T6",
            "--resolution",
            "8",
        ],
    );
    let modulus = brinell::analytical::contact_modulus(207e3, 0.3, 70e3, 0.3);
    let hertz = brinell::analytical::HertzPoint::new(5.0, modulus).unwrap();
    near(
        &two["yield"]["load"],
        hertz.yield_load(0.3, 260.0),
        1.0 / 64.0,
    );
    assert_eq!(two["yield"]["location"]["body"], "flat");
    assert_eq!(
        (&two["half_width_is"], &two["units"]["load"]),
        (&"radius".into(), &"N".into())
    );

    // Between Prandtl's load and a tenth above it: elements of an eighth of the half width.
    let punch = made_and_run(
        folder.path(),
        &["punch", "--plastic-modulus", "0", "--depth", "0.06"],
    );
    let prandtl = (2.0 + std::f64::consts::PI) * 500.0 / 3f64.sqrt() * 2.0;
    let load = punch["states"][2]["load"].as_f64().unwrap() / prandtl;
    assert!((1.0..1.1).contains(&load), "{load}");
}

#[test]
fn a_new_scene_overwrites_nothing_and_refuses_nonsense() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    std::fs::write(&path, "mine").unwrap();
    let refused = brinell(&["new", "punch", "--out", path.to_str().unwrap()]);
    assert_eq!(refused.status.code(), Some(3));
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "mine");
    for arguments in [
        ["ball-on-flat", "--radius", "-1"],
        ["ball-on-flat", "--load", "-300"],
        ["roller-on-flat", "--poissons-ratio", "0.7"],
        ["shaft-in-bore", "--outer-radius", "10"],
        ["shaft-in-bore", "--interference", "0"],
        ["shaft-in-bore", "--clearance", "-0.1"],
        ["punch", "--half-width", "inf"],
        ["punch", "--depth", "-1"],
        ["ball-on-flat", "--load", "NaN"],
    ] {
        let refused = brinell(&[&["new"], &arguments[..]].concat());
        assert_eq!(
            refused.status.code(),
            Some(2),
            "{arguments:?}: {}",
            stdout(&refused)
        );
        assert!(refused.stdout.is_empty(), "{arguments:?}");
        let why = stderr(&refused);
        let named = why.contains(arguments[1]) || why.contains("outer radius");
        assert!(named && why.contains(arguments[2]), "{arguments:?}: {why}");
    }
}

#[test]
fn an_interference_below_zero_points_to_the_clearance() {
    let refused = brinell(&["new", "shaft-in-bore", "--interference", "-0.02"]);
    assert_eq!(refused.status.code(), Some(2));
    let why = stderr(&refused);
    assert!(why.contains("give --clearance 0.02"), "{why}");
    let scene = scene_path("shrink_fit");
    let refused = brinell(&["check", &scene, "--set", "contact.0.interference=-0.05"]);
    assert_eq!(refused.status.code(), Some(2));
    let why = stderr(&refused);
    assert!(why.contains("a clearance is given by `gap`"), "{why}");
}

/// A curve from a file stands in the scene, and gives the material that it describes.
#[test]
fn a_new_scene_takes_a_curve_from_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let curve = folder.path().join("curve.csv");
    std::fs::write(
        &curve,
        "strain,stress\n0,0\n0.001,210\n0.003,420\n0.05,520\n",
    )
    .unwrap();
    let curve = curve.to_str().unwrap();
    let made = succeeds(&["new", "ball-on-flat", "--tensile-test", curve]);
    let scene = Scene::parse(&stdout(&made), "made").unwrap();
    let steel = &scene.materials["steel"];
    assert_eq!(steel.tensile_test.as_ref().unwrap().len(), 4);
    assert_eq!(steel.yield_stress, None);
    // 210 MPa at 0.1 % lies a little below the line of 210000 MPa: yield is soon after.
    let yields = steel.first_yield_stress().unwrap();
    assert!((210.0..220.0).contains(&yields), "{yields}");
    // As a hardening table it would begin at no stress.
    let refused = brinell(&["new", "ball-on-flat", "--hardening-table", curve]);
    assert_eq!(refused.status.code(), Some(2));
    let why = stderr(&refused);
    assert!(why.contains("hardening_table"), "{why}");
}

#[test]
fn completions_and_manual_know_every_command() {
    let help = stdout(&brinell(&["--help"]));
    let commands: Vec<&str> = help
        .lines()
        .skip_while(|l| !l.starts_with("Commands:"))
        .skip(1)
        .take_while(|l| !l.trim().is_empty())
        .filter(|l| l.starts_with("  ") && !l.starts_with("    "))
        .filter_map(|l| l.split_whitespace().next())
        .filter(|name| *name != "help")
        .collect();
    assert!(commands.len() >= 9, "{commands:?}");
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let text = stdout(&brinell(&["completions", shell]));
        for command in &commands {
            assert!(text.contains(command), "{shell}: {command}");
        }
        assert!(text.contains("solver"), "{shell}");
    }
    let manual = stdout(&brinell(&["man"]));
    assert!(manual.contains(".TH brinell 1"));
    for command in &commands {
        assert!(
            manual.contains(&format!("COMMAND {}", command.to_uppercase())),
            "{command}"
        );
    }
}
