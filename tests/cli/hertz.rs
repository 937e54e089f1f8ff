//! `brinell hertz`: closed forms against published figures, and what it refuses.

use super::{brinell, stderr, stdout, succeeds};
use brinell::analytical::{HertzEllipse, HertzLine, contact_modulus};
use serde_json::Value;
use std::time::Instant;

/// The sheet of a command line.
fn sheet(line: &str) -> Value {
    let mut arguments = vec!["hertz", "--json"];
    arguments.extend(line.split_whitespace());
    let output = succeeds(&arguments);
    serde_json::from_str(&stdout(&output)).unwrap()
}

fn near(found: &Value, expected: f64, tolerance: f64) {
    super::near(found.as_f64().unwrap(), expected, tolerance);
}

/// code_aster SSNV104: two balls, R = 50, E = 20000, nu = 0.3, an approach of 4: contact radius 10,
/// p0 = 2798. By load, by pressure and by approach it is one contact.
#[test]
fn a_point_contact_by_load_pressure_and_approach() {
    let balls = "--radius 50 --second-radius 50 --youngs-modulus 20000";
    let by_approach = sheet(&format!("{balls} --approach 4"));
    assert_eq!(by_approach["contact"], "point");
    near(&by_approach["semi_axes"][0], 10.0, 1e-12);
    near(&by_approach["max_pressure"], 2798.3, 1e-4);
    near(
        &by_approach["stiffness"],
        {
            let load = by_approach["load"].as_f64().unwrap();
            1.5 * load / 4.0
        },
        1e-14,
    );
    // Johnson p. 62: 0.31 p0 at 0.48 a for nu = 0.3.
    let shear = &by_approach["bodies"][0]["largest_shear"];
    near(&shear["stress"], 0.310 * 2798.3, 2e-3);
    near(&shear["depth"], 0.48 * 10.0, 3e-3);
    for key in ["load", "max_pressure"] {
        let flag = if key == "load" {
            "--load"
        } else {
            "--pressure"
        };
        let again = sheet(&format!("{balls} {flag} {}", by_approach[key]));
        for figure in ["load", "max_pressure", "approach", "area"] {
            near(&again[figure], by_approach[figure].as_f64().unwrap(), 1e-12);
        }
    }
}

/// NAFEMS R0094 CB1: half width 6.215, p0 = 3585; over a length the load is the total. Depth and
/// size of the shears: Johnson pp. 102-103.
#[test]
fn a_line_contact() {
    let roller = "--radius 50,flat --youngs-modulus 210000 --second-youngs-modulus 70000";
    let line = sheet(&format!("{roller} --load 35000"));
    assert_eq!(line["contact"], "line");
    near(&line["semi_axes"][1], 6.215, 1e-4);
    near(&line["max_pressure"], 3585.0, 2e-4);
    assert!(line["semi_axes"][0].is_null() && line["approach"].is_null());
    let (b, p0) = (6.215, 3585.0);
    let shear = &line["bodies"][0]["largest_shear"];
    near(&shear["stress"], 0.300 * p0, 2e-3);
    near(&shear["depth"], 0.786 * b, 2e-3);
    let orthogonal = &line["orthogonal_shear"]["along_smaller"];
    near(&orthogonal["stress"], 0.25 * p0, 1e-3);
    near(&orthogonal["depth"], 0.5 * b, 1e-3);
    let total = sheet(&format!("{roller} --load 350000 --length 10 --depth 100"));
    near(&total["load"], 35000.0, 1e-14);
    near(&total["total_load"], 350_000.0, 1e-14);
    // A steel cylinder to its axis, and 100 of aluminium below it.
    let modulus = contact_modulus(210e3, 0.3, 70e3, 0.3);
    let hertz = HertzLine::new(50.0, modulus).unwrap();
    let approach = hertz.cylinder_compression(35e3, 50.0, 210e3, 0.3)
        + hertz.half_space_compression(35e3, 100.0, 70e3, 0.3);
    near(&total["approach"], approach, 1e-13);
}

/// A ball in a groove, in other units too, and first yield of the weaker body where no load is
/// given.
#[test]
fn an_ellipse_its_first_yield_and_units() {
    let groove = "--radius 5 --second-radius=-5.2,20 --material S355";
    let first = sheet(groove);
    assert_eq!(first["contact"], "ellipse");
    let modulus = contact_modulus(210e3, 0.3, 210e3, 0.3);
    let hertz = HertzEllipse::new([130.0, 4.0], modulus).unwrap();
    near(&first["load"], hertz.yield_load(0.3, 355.0), 1e-9);
    near(
        &first["bodies"][0]["largest_von_mises"]["stress"],
        355.0,
        1e-9,
    );
    near(
        &first["bodies"][1]["first_yield"]["load"],
        first["load"].as_f64().unwrap(),
        1e-12,
    );
    // In metres and pascals: forces are the same, stresses a million times the number.
    let metres = "--radius 0.005 --second-radius=-0.0052,0.02 --material S355 --units m,N,Pa";
    let in_metres = sheet(metres);
    near(&in_metres["load"], first["load"].as_f64().unwrap(), 1e-9);
    near(
        &in_metres["max_pressure"],
        1e6 * first["max_pressure"].as_f64().unwrap(),
        1e-9,
    );
    near(
        &in_metres["semi_axes"][0],
        1e-3 * first["semi_axes"][0].as_f64().unwrap(),
        1e-9,
    );
    // Another yield stress of the second body: it yields first.
    let weak = sheet(&format!("{groove} --second-yield-stress 200 --load 30"));
    let loads = [0, 1].map(|i| weak["bodies"][i]["first_yield"]["load"].as_f64().unwrap());
    assert!((loads[1] / loads[0] / (200.0f64 / 355.0).powi(3) - 1.0).abs() < 1e-12);
}

/// Equal cylinders at right angles are a ball on a flat; at less, an ellipse between their axes.
#[test]
fn crossed_cylinders_and_a_rigid_body() {
    let crossed =
        sheet("--radius 4,flat --second-radius 4,flat --angle 90 --load 9 --material 100Cr6");
    assert_eq!(crossed["contact"], "point");
    let ball = sheet("--radius 4 --load 9 --material 100Cr6");
    near(
        &crossed["max_pressure"],
        ball["max_pressure"].as_f64().unwrap(),
        1e-12,
    );
    let turned =
        sheet("--radius 4,flat --second-radius 4,flat --angle 60 --load 9 --material 100Cr6");
    near(&turned["direction"], 120.0, 1e-12);
    assert_eq!(turned["contact"], "ellipse");
    let rigid = sheet("--radius 4 --youngs-modulus rigid --second-youngs-modulus 3000 --load 9");
    near(&rigid["contact_modulus"], 3000.0 / 0.91, 1e-13);
    let [first, second] = [0, 1].map(|i| &rigid["bodies"][i]);
    assert!(first["youngs_modulus"].is_null() && first["largest_shear"].is_null());
    assert!(second["largest_shear"]["stress"].as_f64().unwrap() > 0.0);
}

/// Tables have every figure with its unit, and say what holds no more beyond first yield.
#[test]
fn tables_for_readers() {
    let started = Instant::now();
    let line = "hertz --radius 5 --second-radius=-5.2,20 --material S355 --load 1000";
    let output = brinell(&line.split(' ').collect::<Vec<_>>());
    // A table, not a run: what an unoptimised program on a busy machine may take.
    assert!(started.elapsed().as_secs_f64() < 5.0);
    assert!(output.status.success());
    let text = stdout(&output);
    for part in [
        "an ellipse",
        "-5.2, 20",
        "greatest pressure p0",
        "half axis b",
        "orthogonal shear, rolling along b",
        "largest shear, either body",
        "load at first yield, either body",
        "Johnson sec. 4.2",
        "Yield of either body from",
    ] {
        assert!(text.contains(part), "{part:?} is not in\n{text}");
    }
    assert!(
        text.lines().all(|line| line.chars().count() <= 110),
        "{text}"
    );
    let line = "hertz --radius 5,flat --youngs-modulus 210000 --load 400";
    let text = stdout(&brinell(&line.split(' ').collect::<Vec<_>>()));
    assert!(
        text.contains("No approach: in the plane it depends on the size"),
        "{text}"
    );
    assert!(text.contains("N/mm"), "{text}");
}

/// The commands of its page run, and the load that ISO 76 asks for is what stands there.
#[test]
fn its_page_of_the_guide() {
    let path = format!("{}/data/guide/hertz.md", env!("CARGO_MANIFEST_DIR"));
    let page = std::fs::read_to_string(path).unwrap();
    let lines = page
        .lines()
        .filter_map(|line| line.strip_prefix("brinell hertz "));
    let commands: Vec<&str> = lines.collect();
    assert_eq!(commands.len(), 4);
    for command in &commands {
        let line = command.replace(" --json", "");
        assert!(sheet(&line)["load"].as_f64().unwrap() > 0.0);
    }
    let load = sheet(commands[1])["load"].as_f64().unwrap();
    assert!(
        page.contains(&format!("{load:.0} N press a ball")),
        "{load}"
    );
}

#[test]
fn what_is_no_contact_is_refused() {
    for (line, part) in [
        ("--radius 5 --material S355 --load 0", "greater than 0"),
        ("--radius 5 --material S355 --load -3", "greater than 0"),
        (
            "--radius 5 --youngs-modulus -1 --load 3",
            "greater than 0 is wanted, or rigid",
        ),
        (
            "--radius 5 --youngs-modulus 1e5 --poissons-ratio 0.5 --load 3",
            "between -1 and 0.5",
        ),
        (
            "--radius 5 --second-radius=-5 --material S355 --load 1",
            "leave no gap",
        ),
        (
            "--radius 5 --second-radius=-4,20 --material S355 --load 1",
            "leave no gap",
        ),
        ("--radius flat --material S355 --load 1", "leave no gap"),
        (
            "--radius 5,6,7 --material S355 --load 1",
            "one radius or two",
        ),
        ("--radius 5 --material S356 --load 1", "did you mean"),
        ("--radius 5 --load 1", "--youngs-modulus"),
        ("--radius 5 --youngs-modulus 1e5", "--yield-stress"),
        (
            "--radius 5 --youngs-modulus rigid --load 1",
            "both bodies are rigid",
        ),
        (
            "--radius 5 --material S355 --load 1 --pressure 2",
            "cannot be used with",
        ),
        (
            "--radius 5,flat --material S355 --approach 0.1",
            "size of the bodies",
        ),
        (
            "--radius 5 --material S355 --load 1 --length 4",
            "touch in a point",
        ),
        (
            "--radius 5 --material S355 --load 1 --units mm,N,Pa",
            "force over length squared",
        ),
        (
            "--radius 5 --material S355 --load 1 --units furlong,N,bar",
            "none of the units",
        ),
        ("--radius 5 --material S355 --load 1 --angle nan", "finite"),
    ] {
        let mut arguments = vec!["hertz"];
        arguments.extend(line.split(' '));
        let output = brinell(&arguments);
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{line}: {text}");
        assert!(text.contains(part), "{line}: {part:?} is not in {text}");
    }
}
