//! `brinell view --below`: stresses below the centre of a contact as a table.

use super::{brinell, stdout};
use serde_json::Value;
use std::collections::HashMap;

/// Below an elastic line contact the largest shear is 0.300 p0 at a depth of 0.786 b in either body
/// (Johnson, Contact Mechanics, section 4.1(a)); at the surface the stress along the normal is the
/// pressure. Six elements over b: the depth is known to one.
#[test]
#[cfg(any(feature = "cholmod", feature = "faer"))]
fn shear_below_a_line_contact() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_string();
    let (scene, out, table) = (path("roller.toml"), path("roller.out"), path("below.csv"));
    let new = "new roller-on-flat --load 150 --resolution 6 --out";
    let mut made: Vec<&str> = new.split(' ').collect();
    made.push(&scene);
    assert!(brinell(&made).status.success());
    let run = brinell(&[
        "run",
        "-q",
        "--no-report",
        "--no-estimate",
        "--json",
        &scene,
    ]);
    let summary: Value = serde_json::from_str(&stdout(&run)).unwrap();
    let figure = |key: &str| summary["states"][0][key].as_f64().unwrap();
    let (pressure, half_width) = (figure("max_pressure"), figure("half_width"));
    let view = ["view", &out, "--below", &table];
    assert!(brinell(&view).status.success());
    let mut rows = csv::Reader::from_path(&table).unwrap();
    let rows: Vec<HashMap<String, String>> = rows.deserialize().map(Result::unwrap).collect();
    let number = |row: &HashMap<String, String>, key: &str| row[key].parse::<f64>().unwrap();
    for body in ["roller", "flat"] {
        let pressed = rows
            .iter()
            .filter(|r| r["state"] == "1" && r["body"] == body);
        let pressed: Vec<_> = pressed.collect();
        let place = |row: &HashMap<String, String>| number(row, "y").abs();
        let top = pressed.iter().min_by(|a, b| place(a).total_cmp(&place(b)));
        let top = number(top.unwrap(), "yy") / -pressure;
        assert!((top - 1.0).abs() < 0.05, "{body}: {top}");
        let shear = |row: &HashMap<String, String>| number(row, "largest_shear");
        let most = pressed.iter().max_by(|a, b| shear(a).total_cmp(&shear(b)));
        let most = most.unwrap();
        assert!(
            (shear(most) / pressure - 0.300).abs() < 0.01,
            "{body}: {}",
            shear(most)
        );
        let depth = place(most) / half_width;
        assert!((depth - 0.786).abs() < 1.0 / 6.0, "{body}: {depth}");
    }
    // Elastic: nothing is left.
    let left = rows.iter().filter(|row| row["state"] == "2");
    assert!(left.clone().count() > 10);
    for row in left {
        assert!(number(row, "von_mises") < 1e-6 * pressure);
    }
    // What is there is left as it is.
    let again = brinell(&view);
    assert_eq!(again.status.code(), Some(3));
}
