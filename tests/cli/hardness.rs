//! `brinell new hardness` and `brinell hardness`: what is read off an indentation.

use super::{brinell, near, stderr, stdout, succeeds};
use brinell::analytical::{HertzPoint, contact_modulus};
use serde_json::Value;
use std::f64::consts::PI;
use std::path::Path;

/// Makes and runs a scene; its results.
fn tested(folder: &Path, line: &str) -> String {
    let scene = folder.join("test.toml");
    let _ = std::fs::remove_file(&scene);
    let scene = scene.to_str().unwrap();
    let mut arguments = vec!["new"];
    arguments.extend(line.split_whitespace());
    arguments.extend(["--out", scene]);
    for arguments in [
        &arguments[..],
        &["run", "-q", "--no-report", "--no-estimate", scene],
    ] {
        succeeds(arguments);
    }
    folder.join("test.out").to_str().unwrap().to_string()
}

/// The figures, and the warnings.
fn sheet(results: &str) -> (Value, String) {
    let output = brinell(&["hardness", results, "--json"]);
    let warned = stderr(&output);
    assert!(output.status.success(), "{warned}");
    (serde_json::from_str(&stdout(&output)).unwrap(), warned)
}

fn number(value: &Value, key: &str) -> f64 {
    value[key]
        .as_f64()
        .unwrap_or_else(|| panic!("{key} of {value}"))
}

/// By load: the figures are those of their formulas, unloading is elastic with the stiffness of the
/// contact, and both ways to a modulus come near that of the materials.
#[test]
#[cfg(any(feature = "cholmod", feature = "faer"))]
fn a_ball_by_load() {
    let folder = tempfile::tempdir().unwrap();
    let line = "hardness --diameter 10 --load 400 --yield-stress 500 --plastic-modulus 2000 \
                --resolution 6";
    let results = tested(folder.path(), line);
    let (sheet, warned) = sheet(&results);
    assert_eq!(warned, "");
    assert_eq!(sheet["state"], "indented");
    let of = |key| number(&sheet, key);
    near(of("force"), 400.0, 1e-9);
    let d = 2.0 * of("contact_radius");
    let hbw = 0.102 * 800.0 / (PI * 10.0 * (10.0 - (100.0 - d * d).sqrt()));
    near(of("hbw"), hbw, 1e-9);
    near(of("mean_pressure"), 400.0 / (0.25 * PI * d * d), 1e-9);
    // Between first yield and fully plastic.
    let constraint = of("mean_pressure_over_yield_stress");
    assert!((1.1..3.0).contains(&constraint), "{constraint}");
    // Between an elastic contact and one without hardening.
    let pile_up = of("pile_up");
    assert!((0.5..1.45).contains(&pile_up), "{pile_up}");
    assert!(of("residual_depth") > 0.0 && of("residual_depth") < of("depth"));
    let modulus = contact_modulus(2.1e8, 0.3, 210e3, 0.3);
    near(of("contact_modulus"), modulus, 1e-12);
    // Half an element over the radius, as it is read.
    near(of("reduced_modulus"), modulus, 1.0 / 12.0);
    assert!(of("reduced_modulus_by_depth") > 0.0);
    let text = stdout(&brinell(&["hardness", &results]));
    for part in [
        "HBW",
        "p_m/Y",
        "unloading stiffness S",
        "N/mm",
        "the standard measures that of the residual indent",
    ] {
        let text = text.replace('\n', " ");
        assert!(text.contains(part), "{part:?} is not in {text}");
    }
}

/// By depth: the ball is where it was asked to be, with a ball that gives way too.
#[test]
#[cfg(any(feature = "cholmod", feature = "faer"))]
fn a_ball_by_depth() {
    let folder = tempfile::tempdir().unwrap();
    let line = "hardness --radius 5 --depth 0.0005 --ball-modulus 600000 --ball-poissons-ratio \
                0.22 --yield-stress 400 --resolution 4";
    let (sheet, _) = sheet(&tested(folder.path(), line));
    near(number(&sheet, "depth"), 0.0025, 1e-6);
    let modulus = contact_modulus(6e5, 0.22, 210e3, 0.3);
    near(number(&sheet, "contact_modulus"), modulus, 1e-12);
    // It bears less than an elastic flat.
    let hertz = HertzPoint::new(5.0, modulus).unwrap();
    assert!(number(&sheet, "force") < hertz.load_for_approach(0.0025));
}

/// A contact as wide as a fifth of the radius is warned of, also where it is elastic; what is not
/// known is said to be.
#[test]
#[cfg(any(feature = "cholmod", feature = "faer"))]
fn beyond_small_strains_and_without_a_history() {
    let folder = tempfile::tempdir().unwrap();
    let flat = "--youngs-modulus 10000 --yield-stress 800 --resolution 4";
    let modulus = contact_modulus(1e7, 0.3, 1e4, 0.3);
    let hertz = HertzPoint::new(5.0, modulus).unwrap();
    let load = hertz.load_for_contact_radius(1.1);
    let results = tested(folder.path(), &format!("hardness --load {load} {flat}"));
    let scene = std::fs::read_to_string(folder.path().join("test.toml")).unwrap();
    assert!(scene.contains("small strains no\n# longer hold"), "{scene}");
    let (wide, warned) = sheet(&results);
    assert_eq!(wide["beyond_small_strains"], true);
    assert!(warned.contains("strains are no longer small"), "{warned}");
    near(number(&wide, "pile_up"), 0.5, 0.05);

    let ball = tested(folder.path(), "ball-on-flat --load 20 --resolution 3");
    let (unfollowed, _) = sheet(&ball);
    assert!(unfollowed["unloading_stiffness"].is_null());
    let text = stdout(&brinell(&["hardness", &ball])).replace('\n', " ");
    assert!(
        text.contains("a history that follows the approach"),
        "{text}"
    );
}

#[test]
fn what_is_no_indentation_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("patch.out");
    let out = out.to_str().unwrap();
    let scene = super::scene_path("contact_patch");
    let run = [
        "run",
        "-q",
        "--no-report",
        "--no-estimate",
        "--out",
        out,
        &scene,
    ];
    assert!(brinell(&run).status.success());
    let nowhere = folder.path().join("nothing");
    for (arguments, code, part) in [
        (&["hardness", out][..], 2, "no ball on a flat"),
        (&["hardness", nowhere.to_str().unwrap()], 3, "nothing"),
        (&["new", "hardness"], 2, "--load"),
        (
            &["new", "hardness", "--load", "3", "--depth", "0.1"],
            2,
            "cannot be used with",
        ),
        (&["new", "hardness", "--depth", "-1"], 2, "greater than 0"),
        (
            &["new", "hardness", "--load", "3", "--ball-modulus", "0"],
            2,
            "greater than 0",
        ),
    ] {
        let output = brinell(arguments);
        let why = stderr(&output);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {why}");
        assert!(
            why.contains(part),
            "{arguments:?}: {part:?} is not in {why}"
        );
    }
}
