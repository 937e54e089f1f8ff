//! `brinell new iso76`: the load of a dent of 1e-4 D, and what Hertz says beside it.

use super::{brinell, near, stderr, stdout, succeeds};
use brinell::analytical::{HertzContact, RelativeRadii, contact_modulus};
use brinell::scene::Scene;
use serde_json::Value;
use std::path::Path;

const STEEL: &str = "--youngs-modulus 208000 --yield-stress 2000 --plastic-modulus 20000";

/// Makes a scene: what was printed, and the scene's text.
fn made(folder: &Path, line: &str) -> [String; 2] {
    let scene = folder.join("c0.toml");
    let mut arguments = vec!["new", "iso76", "--out", scene.to_str().unwrap()];
    arguments.extend(line.split_whitespace());
    let output = succeeds(&arguments);
    [stdout(&output), std::fs::read_to_string(&scene).unwrap()]
}

#[cfg(any(feature = "cholmod", feature = "faer"))]
fn run_made_scene(folder: &Path) -> Value {
    let scene = folder.join("c0.toml");
    let scene = scene.to_str().unwrap();
    let output = succeeds(&["run", "-q", "--no-report", "--no-estimate", "--json", scene]);
    serde_json::from_str(&stdout(&output)).unwrap()
}

/// The load that stands behind a phrase.
fn told(text: &str, phrase: &str) -> f64 {
    let line = text.lines().find(|line| line.contains(phrase));
    let line = line.unwrap_or_else(|| panic!("{phrase:?} is not in\n{text}"));
    let (_, load) = line.rsplit_once(" at ").unwrap();
    load.split(' ').next().unwrap().parse().unwrap()
}

fn hertz(first: [f64; 2], second: [f64; 2]) -> HertzContact {
    let relative = RelativeRadii::new(first, second, 0.0).unwrap();
    let modulus = contact_modulus(208e3, 0.3, 208e3, 0.3);
    HertzContact::new(relative, modulus).unwrap()
}

/// The residual dent is 1e-4 of the diameter, and first yield is Hertz's.
#[test]
#[cfg(any(feature = "cholmod", feature = "faer"))]
fn a_ball_on_a_flat_keeps_a_ten_thousandth_of_its_diameter() {
    let folder = tempfile::tempdir().unwrap();
    let [told_by_new, text] = made(
        folder.path(),
        &format!("{STEEL} --diameter 10 --resolution 4"),
    );
    let ball = hertz([5.0; 2], [f64::INFINITY; 2]);
    let rated = ball.load_for_max_pressure(4200.0);
    for text in [&told_by_new, &text] {
        near(
            told(text, "first yield"),
            ball.yield_load(0.3, 2000.0),
            1e-3,
        );
        near(told(text, "4200 MPa (ISO 76:2006, ball"), rated, 1e-3);
        let of_other = ball.load_for_max_pressure(4600.0);
        near(told(text, "4600 MPa (ISO 76:2006, self"), of_other, 1e-3);
    }
    let summary = run_made_scene(folder.path());
    let number = |value: &Value| value.as_f64().unwrap();
    let states = summary["states"].as_array().unwrap();
    let [yields, found, free] = [0, 1, 2].map(|k| &states[k]);
    assert_eq!([&yields["name"], &found["name"]], ["yield", "C0"]);
    // Four elements over the contact radius.
    near(
        number(&yields["load"]),
        ball.yield_load(0.3, 2000.0),
        1.0 / 16.0,
    );
    near(
        number(&found["alpha"]),
        number(&found["load"]) / rated,
        1e-9,
    );
    assert_eq!(number(&free["load"]), 0.0);
    near(number(&free["residual_depth"]), 1e-3, 1e-6);
}

/// A roller on a raceway is one of the relative radius on a flat; the dent is still that of its own
/// diameter.
#[test]
#[cfg(any(feature = "cholmod", feature = "faer"))]
fn a_roller_on_a_raceway() {
    let folder = tempfile::tempdir().unwrap();
    let line = format!("{STEEL} --roller --diameter 10 --race 20 --resolution 3");
    let [told_by_new, text] = made(folder.path(), &line);
    let flat = f64::INFINITY;
    let roller = hertz([flat, 5.0], [flat, 20.0]);
    let rated = roller.load_for_max_pressure(4000.0);
    near(
        told(&told_by_new, "4000 MPa (ISO 76:2006, roller"),
        rated,
        1e-3,
    );
    assert!(!told_by_new.contains("4200"), "{told_by_new}");
    let scene = Scene::parse(&text, "made").unwrap();
    near(
        scene.mesh.cylinder_on_half_plane.unwrap().radius,
        4.0,
        1e-12,
    );
    let summary = run_made_scene(folder.path());
    let free = &summary["states"][2];
    near(free["residual_depth"].as_f64().unwrap(), 1e-3, 1e-6);
}

/// Grooves, outer races and self-aligning bearings: the scene has the race's radii, load factor 1
/// is the load of the standard's stress.
#[test]
fn a_ball_in_a_groove() {
    for (race, line, stress) in [
        ([-5.2, 20.0], "--groove 5.2 --race 20", 4200.0),
        ([-5.2, -30.0], "--groove 5.2 --race -30", 4200.0),
        ([-5.2, 0.0], "--groove 5.2", 4200.0),
        ([0.0, -30.0], "--race -30 --self-aligning", 4600.0),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let [_, text] = made(folder.path(), &format!("{STEEL} {line}"));
        let scene = Scene::parse(&text, "made").unwrap();
        let bodies = scene.mesh.curved_bodies.as_ref().unwrap();
        assert_eq!((bodies.upper, bodies.lower), ([5.0; 2], race), "{line}");
        let load = scene.load[0].plane_force.unwrap().total;
        let rated = hertz([5.0; 2], race).load_for_max_pressure(stress);
        near(-load, rated, 1e-12);
    }
}

/// A solid's coarser mesh, whose elements see no yielding at the load of first yield, and targets
/// that know of no larger load: first yield is found all the same.
#[test]
#[cfg(any(feature = "cholmod", feature = "faer"))]
fn a_groove_yields_where_no_larger_load_is_known() {
    let folder = tempfile::tempdir().unwrap();
    let line = format!("{STEEL} --groove 5.2 --race 20 --resolution 3");
    made(folder.path(), &line);
    let scene = folder.path().join("c0.toml");
    let run = succeeds(&[
        "run",
        "-q",
        "--no-report",
        "--no-estimate",
        "--json",
        "--set",
        "program.targets=[{ yield = true, fields = false }]",
        // As far as the contact of the dent may reach.
        "--set",
        "mesh.curved_bodies.contact_width=2.0",
        scene.to_str().unwrap(),
    ]);
    let summary: Value = serde_json::from_str(&stdout(&run)).unwrap();
    let hertz = hertz([5.0; 2], [-5.2, 20.0]).yield_load(0.3, 2000.0);
    // Three elements over the smaller half axis.
    near(summary["yield"]["load"].as_f64().unwrap(), hertz, 0.1);
}

/// Below the rated contact of a ball on a flat the largest shear is 0.310 p_0 at 0.481 a, and
/// rolling changes the orthogonal shear by +-0.214 p_0 at 0.350 a (Johnson, Contact Mechanics,
/// section 3.4; Lundberg and Palmgren 1947); the crown of a roller makes its contact a point.
#[test]
fn shear_below_the_contact_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let [told_by_new, _] = made(folder.path(), &format!("{STEEL} --diameter 10"));
    let ball = hertz([5.0; 2], [f64::INFINITY; 2]);
    let [a, _] = ball.semi_axes(ball.load_for_max_pressure(4200.0));
    for (phrase, stress, depth) in [
        ("largest shear ", 0.310 * 4200.0, 0.481 * a),
        (
            "orthogonal shear, amplitude in rolling, ",
            0.214 * 4200.0,
            0.350 * a,
        ),
    ] {
        let (_, rest) = told_by_new.split_once(phrase).unwrap();
        let words: Vec<&str> = rest.split_whitespace().collect();
        near(words[0].parse().unwrap(), stress, 5e-3);
        near(words[2].parse().unwrap(), depth, 5e-3);
    }
    let folder = tempfile::tempdir().unwrap();
    let line = format!("{STEEL} --roller --diameter 10 --race 20 --crown 500");
    let [told_by_new, text] = made(folder.path(), &line);
    let rated = hertz([500.0, 5.0], [f64::INFINITY, 20.0]).load_for_max_pressure(4000.0);
    near(
        told(&told_by_new, "4000 MPa (ISO 76:2006, roller"),
        rated,
        1e-3,
    );
    let bodies = Scene::parse(&text, "made")
        .unwrap()
        .mesh
        .curved_bodies
        .unwrap();
    assert_eq!((bodies.upper, bodies.lower), ([500.0, 5.0], [0.0, 20.0]));
}

/// Under the load of its profile a roller presses evenly along its axis, a cylinder most at its
/// end.
#[test]
#[cfg(any(feature = "cholmod", feature = "faer"))]
fn a_logarithmic_profile_presses_evenly() {
    for (profile, is_even) in [("logarithmic", true), ("straight", false)] {
        let folder = tempfile::tempdir().unwrap();
        let line = format!("{STEEL} --roller --diameter 10 --race 20 --length 8");
        made(folder.path(), &format!("{line} --profile {profile}"));
        let scene = folder.path().join("c0.toml");
        let out = folder.path().join("out");
        let mut arguments = vec!["run", "-q", "--no-report", "--no-estimate"];
        arguments.extend([scene.to_str().unwrap(), "--out", out.to_str().unwrap()]);
        for set in [
            "program.targets=[{ load_factor = 1.0, fields = false }]",
            "bodies.roller.plastic=false",
            "bodies.race.plastic=false",
            // Coarse, as the question is coarse.
            "mesh.parts.0.brick.elements=[8, 11, 8]",
            "mesh.parts.1.brick.elements=[16, 11, 8]",
        ] {
            arguments.extend(["--set", set]);
        }
        succeeds(&arguments);
        let mut rows = csv::Reader::from_path(out.join("contact.csv")).unwrap();
        let head = rows.headers().unwrap().clone();
        let column = |name: &str| head.iter().position(|key| key == name).unwrap();
        let [x, y, pressure] = ["x", "y", "pressure"].map(column);
        let number = |row: &csv::StringRecord, k: usize| row[k].parse::<f64>().unwrap();
        let mut along: Vec<[f64; 2]> = rows
            .records()
            .map(Result::unwrap)
            .filter(|row| number(row, y).abs() < 1e-9)
            .map(|row| [number(&row, x), number(&row, pressure)])
            .collect();
        along.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let middle = along[0][1];
        near(middle, 4000.0, 0.2);
        let most = along.iter().fold(0.0f64, |m, place| m.max(place[1]));
        assert_eq!(most < 1.05 * middle, is_even, "{profile}: {along:?}");
        // Even as far as nine tenths of its length.
        let inside = along.iter().filter(|place| place[0] < 3.6);
        let least = inside.fold(f64::INFINITY, |m, place| m.min(place[1]));
        assert!(least > 0.9 * middle, "{profile}: {along:?}");
    }
}

#[test]
fn what_leaves_no_dent_is_refused() {
    for (line, part) in [
        ("--diameter 10", "the dent depends on the steel"),
        ("--material 100Cr6", "nothing yields"),
        ("--yield-stress 2000 --groove 4.9", "leave no gap"),
        ("--yield-stress 2000 --race -4", "leave no gap"),
        ("--yield-stress 2000 --race 0", "other than 0"),
        (
            "--yield-stress 2000 --roller --groove 6",
            "cannot be used with",
        ),
        ("--yield-stress 2000 --crown 500", "--roller"),
        ("--yield-stress 2000 --length 8", "--roller"),
        (
            "--yield-stress 2000 --roller --crown 500 --length 8",
            "cannot be used with",
        ),
        (
            "--yield-stress 2000 --roller --self-aligning",
            "cannot be used with",
        ),
    ] {
        let mut arguments = vec!["new", "iso76"];
        arguments.extend(line.split(' '));
        let output = brinell(&arguments);
        let why = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{line}: {why}");
        assert!(why.contains(part), "{line}: {part:?} is not in {why}");
    }
}
