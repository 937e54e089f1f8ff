//! What the history follows: motion and force of sets, approach, and what each contact carries.

use crate::support::{SMALL_BALL, load, run};
use brinell::output::{RunHeader, read, write_without_report};
use brinell::results::Results;

/// The values of a column, row by row.
fn column(results: &Results, name: &str) -> Vec<f64> {
    let columns = &results.history_columns;
    let place = columns.iter().position(|column| column == name);
    let place = place.unwrap_or_else(|| panic!("no {name} in {columns:?}"));
    results
        .history
        .iter()
        .map(|row| row.measured[place])
        .collect()
}

fn close(a: f64, b: f64, scale: f64, what: &str) {
    assert!((a - b).abs() <= 1e-8 * scale.abs(), "{what}: {a} {b}");
}

/// The force on the top of a ball is the load of the whole, the support below it takes it up, the
/// contact carries it, and the top comes down by the approach, in every increment of loading and
/// unloading.
fn follows_the_load(results: &Results, [top, bottom]: [&str; 2], axis: &str, total: f64) {
    let n = results.history.len();
    assert!(n > 5);
    let of = |set: &str, key: &str| column(results, &format!("{set}.{key}_{axis}"));
    let (force, held, moved) = (
        of(top, "force"),
        of(bottom, "force"),
        of(top, "displacement"),
    );
    let (carried, approach) = (
        column(results, "contact_1.force"),
        column(results, "approach"),
    );
    let of_contact = column(results, "contact_1.approach");
    let deepest = approach.iter().fold(0.0f64, |m, a| m.max(*a));
    for (k, row) in results.history.iter().enumerate() {
        close(-force[k], row.load, total, "pressed");
        close(held[k], row.load, total, "held");
        close(carried[k], row.contact_force, total, "carried");
        close(-moved[k], approach[k], deepest, "approach");
        close(
            of_contact[k],
            approach[k],
            deepest,
            "approach of the contact",
        );
    }
    assert!(of(bottom, "displacement").iter().all(|u| *u == 0.0));
    for state in &results.states {
        let row = results
            .history
            .iter()
            .position(|row| row.alpha == state.alpha);
        close(approach[row.unwrap()], state.approach, deepest, "state");
    }
}

#[test]
fn the_force_depth_curve_of_a_ball() {
    let overrides = [
        "mesh.cylinder_on_half_plane.resolution=4",
        "mesh.cylinder_on_half_plane.far_size=60",
        "program.targets=[{ load_factor = 2.0 }, { load_factor = 0.0 }]",
    ];
    let sets = "program.history=[\"cylinder.top\", \"half_plane.bottom\"]";
    let followed = run(&load(
        "ball_on_half_space",
        &[overrides[0], overrides[1], overrides[2], sets],
    ));
    let total = followed.states[0].load;
    follows_the_load(&followed, ["cylinder.top", "half_plane.bottom"], "y", total);
    // To follow changes nothing but round-off.
    let plain = run(&load("ball_on_half_space", &overrides));
    assert!(plain.history_columns.is_empty());
    assert_eq!(plain.history.len(), followed.history.len());
    let dents = [&plain, &followed].map(|results| results.states[1].residual_depth);
    close(dents[0], dents[1], dents[0], "dent");
}

/// A quarter of a solid ball: figures are those of the whole.
#[test]
fn a_quarter_in_space_is_followed_as_the_whole() {
    let mut overrides = SMALL_BALL.to_vec();
    overrides.extend([
        "program.targets=[{ load_factor = 1.5 }, { load_factor = 0.5 }]",
        "program.history=[\"upper.top\", \"lower.bottom\"]",
    ]);
    let results = run(&load("ball_on_flat_3d", &overrides));
    let total = results.states[0].load;
    follows_the_load(&results, ["upper.top", "lower.bottom"], "z", total);
}

/// The columns stand in `history.csv` and between its rows in `path.csv`, and are read back.
#[test]
fn the_columns_are_written_and_read_back() {
    let scene = load(
        "ball_on_half_space",
        &[
            "mesh.cylinder_on_half_plane.resolution=4",
            "mesh.cylinder_on_half_plane.far_size=60",
            "program.targets=[{ load_factor = 0.8 }, { load_factor = 0.0 }]",
            "program.history=[\"cylinder.top\"]",
        ],
    );
    let results = run(&scene);
    let model = brinell::model::Model::new(&scene).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let dir = folder.path().join("out");
    let header = RunHeader {
        bodies: model.mesh.bodies.clone(),
        ..RunHeader::default()
    };
    write_without_report(&dir, &header, &model, &results).unwrap();
    let recorded = read(&dir).unwrap().results;
    assert_eq!(recorded.history, results.history);
    assert_eq!(recorded.history_columns, results.history_columns);
    let path = std::fs::read_to_string(dir.join("path.csv")).unwrap();
    let head = path.lines().next().unwrap();
    assert!(
        head.ends_with("cylinder.top.force_x,cylinder.top.force_y"),
        "{head}"
    );
    let commas = |line: &str| line.matches(',').count();
    assert!(path.lines().count() > 1 && path.lines().all(|line| commas(line) == commas(head)));
}

/// A shim between two blocks: each contact carries the load, and what the two bring together adds
/// up to the way of the stamp's loaded surface, also where the shim is held by nothing else.
#[test]
fn approaches_of_a_stack_add_up() {
    let results = run(&load(
        "three_bodies",
        &[
            "mesh.parts.0.block.elements=[10, 5]",
            "mesh.parts.1.block.elements=[10, 2]",
            "mesh.parts.2.block.elements=[10, 4]",
            "load=[{ on = \"stamp.pad\", pressure = 100.0 }]",
            "program={ targets = [{ load_factor = 1.0 }], history = [\"stamp.pad\"] }",
        ],
    ));
    let [one, two] = [1, 2].map(|n| column(&results, &format!("contact_{n}.approach")));
    let whole = column(&results, "approach");
    let largest = whole.iter().fold(0.0f64, |m, a| m.max(*a));
    assert!(largest > 0.0);
    for (k, whole) in whole.iter().enumerate() {
        close(one[k] + two[k], *whole, largest, "sum");
        assert!(one[k] > 0.0 && two[k] > 0.0, "{k}: {} {}", one[k], two[k]);
    }
}
