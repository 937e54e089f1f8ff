//! `history.csv`, `path.csv` and `contact.csv`.

use crate::output::fixture;
use brinell::output::{RunHeader, write};
use brinell::results::{HistoryRow, QUANTITIES, Results};
use std::path::Path;

fn read(file: &Path) -> (Vec<String>, Vec<Vec<String>>) {
    let mut reader = csv::Reader::from_path(file).unwrap();
    let strings = |record: &csv::StringRecord| record.iter().map(str::to_owned).collect();
    let header = strings(reader.headers().unwrap());
    let rows = reader.records().map(|r| strings(&r.unwrap())).collect();
    (header, rows)
}

const HISTORY: [&str; 13] = [
    "increment",
    "alpha",
    "load",
    "max_pressure",
    "half_width",
    "contact_force",
    "closed_pairs",
    "plastic_points",
    "max_equivalent_plastic_strain",
    "iterations",
    "trailing_solves",
    "residual",
    "event",
];

const CONTACT: [&str; 12] = [
    "state", "alpha", "pair", "contact", "x", "y", "gap", "force", "area", "pressure", "status",
    "name",
];

#[test]
fn history_has_a_row_per_increment_in_full_precision() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("run.out");
    let mesh = fixture::mesh();
    let results = fixture::results(&mesh);
    write(&dir, &fixture::header(), &mesh, &results).unwrap();
    let (header, rows) = read(&dir.join("history.csv"));
    assert_eq!(header, HISTORY);
    assert_eq!(rows.len(), 2);
    assert_eq!(rows[0][12], "target: \"a, b\"");
    assert_eq!(rows[0][11], "", "a number that is not finite");
    assert_eq!(rows[1][0], "2");
    assert_eq!(rows[1][1].parse::<f64>().unwrap(), 1.0 / 3.0);
    assert_eq!(rows[1][8].parse::<f64>().unwrap(), 1e-300);
    assert_eq!(rows[1][12], "closes: pair 1");
}

/// The columns are the fields of the type, so the second row can be read back into it.
#[test]
fn history_reads_back_into_its_type() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("run.out");
    let row = HistoryRow {
        increment: 3,
        alpha: 0.1 + 0.2,
        load: 1e22,
        max_pressure: -1.5,
        half_width: 5e-324,
        contact_force: f64::MAX,
        closed_pairs: 4,
        plastic_points: 5,
        max_equivalent_plastic_strain: std::f64::consts::PI,
        iterations: 6,
        trailing_solves: 7,
        residual: 1e-10,
        event: "step".into(),
        measured: Vec::new(),
    };
    let results = Results {
        history: vec![row.clone()],
        ..Results::default()
    };
    write(&dir, &fixture::header(), &fixture::mesh(), &results).unwrap();
    let (_, rows) = read(&dir.join("history.csv"));
    let cell = |name: &str| {
        let column = HISTORY.iter().position(|&h| h == name).unwrap();
        rows[0][column].as_str()
    };
    let number = |name: &str| cell(name).parse::<f64>().unwrap();
    let count = |name: &str| cell(name).parse::<usize>().unwrap();
    let read = HistoryRow {
        increment: count("increment"),
        alpha: number("alpha"),
        load: number("load"),
        max_pressure: number("max_pressure"),
        half_width: number("half_width"),
        contact_force: number("contact_force"),
        closed_pairs: count("closed_pairs"),
        plastic_points: count("plastic_points"),
        max_equivalent_plastic_strain: number("max_equivalent_plastic_strain"),
        iterations: count("iterations"),
        trailing_solves: count("trailing_solves"),
        residual: number("residual"),
        event: cell("event").into(),
        measured: Vec::new(),
    };
    assert_eq!(read, row);
    // What is a quantity stands under its key.
    for quantity in &QUANTITIES {
        let column = HISTORY.contains(&quantity.key);
        assert_eq!(column, quantity.in_history.is_some(), "{}", quantity.key);
        if let Some(field) = quantity.in_history {
            assert_eq!(number(quantity.key), (field.get)(&row), "{}", quantity.key);
        }
    }
}

#[test]
fn contact_has_a_row_per_state_and_pair() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("run.out");
    let mesh = fixture::mesh();
    write(&dir, &fixture::header(), &mesh, &fixture::results(&mesh)).unwrap();
    let (header, rows) = read(&dir.join("contact.csv"));
    assert_eq!(header, CONTACT);
    assert_eq!(rows.len(), 3 * 2);
    assert_eq!(
        rows[1],
        [
            "1",
            "2.0635",
            "2",
            "1",
            "0.1",
            "-0.0",
            "1e-17",
            "12.5",
            "0.25",
            "50.0",
            "open",
            "b = 1.5 b*"
        ]
    );
    assert_eq!(rows[4][0], "3");
    assert_eq!(rows[4][10], "closed");
    assert_eq!(rows[4][11], "released");
}

#[test]
fn the_path_between_increments_has_a_row_per_point() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("run.out");
    let mesh = fixture::mesh();
    write(&dir, &fixture::header(), &mesh, &fixture::results(&mesh)).unwrap();
    let (header, rows) = read(&dir.join("path.csv"));
    assert_eq!(
        header,
        ["increment", "alpha", "load", "max_pressure", "half_width"]
    );
    assert_eq!(rows, [["2", "0.2", "30.0", "100.0", "0.6666666666666666"]]);
}

#[test]
fn tables_without_rows_have_their_header() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("run.out");
    let (header, mesh, results) = (RunHeader::default(), fixture::mesh(), Results::default());
    write(&dir, &header, &mesh, &results).unwrap();
    let history = read(&dir.join("history.csv"));
    assert_eq!(history.0, HISTORY);
    assert!(history.1.is_empty());
    let contact = read(&dir.join("contact.csv"));
    assert_eq!(contact.0, CONTACT);
    assert!(contact.1.is_empty());
}
