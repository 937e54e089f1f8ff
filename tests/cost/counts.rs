//! Factorisations, solves, iterations, and the size of the factor, against those kept in
//! `tests/cost/counts_*.json`, a file for each sparse backend.
//!
//! A run that takes more than a tenth more of anything than it did fails: something has become
//! dearer. So does one that takes a third less, so that the file stays worth comparing with. Orders
//! and the last bit of a status depend on the libraries, hence the tenth.
//! `BRINELL_WRITE_COUNTS=1 cargo test --test all cost` writes the files anew; the difference
//! belongs into the commit's message.

use crate::support::{either, load, sparse, try_run};
use brinell::linalg::Backend;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Name, scene, and what is changed in it.
const RUNS: [(&str, &str, &[&str]); 8] = [
    ("cylinder", "cylinder_on_half_plane", &[]),
    (
        "cylinder, H/E = 0.05",
        "cylinder_on_half_plane",
        &["materials.steel.plastic_modulus=10500.0"],
    ),
    (
        "cylinder, 32 elements",
        "cylinder_on_half_plane",
        &["mesh.cylinder_on_half_plane.resolution=32"],
    ),
    ("disc", "disc_in_plate", &[]),
    ("ball", "ball_on_half_space", &[]),
    ("flat punch", "flat_punch", &[]),
    ("thick cylinder", "thick_cylinder", &[]),
    ("three bodies", "three_bodies", &[]),
];
const DEARER: f64 = 1.1;
const CHEAPER: f64 = 1.0 / 1.5;
/// Counts as small as this may differ by one.
const FEW: f64 = 10.0;

#[derive(Debug, Serialize, Deserialize)]
struct Cost {
    freedoms: f64,
    factor_flops: f64,
    factor_nonzeros: f64,
    trailing_nonzeros: f64,
    factorizations: f64,
    zone_factorizations: f64,
    full_solves: f64,
    increments: f64,
    contact_changes: f64,
    plastic_iterations: f64,
    trailing_solves: f64,
}

fn cost(backend: Backend, scene: &str, changes: &[&str]) -> Cost {
    let results = try_run(&load(scene, changes), backend).unwrap();
    let counts = &results.counts;
    Cost {
        freedoms: results.sizes.freedoms as f64,
        factor_flops: results.factor.flops,
        factor_nonzeros: results.factor.factor_nonzeros,
        trailing_nonzeros: results.factor.trailing_nonzeros,
        factorizations: counts.factorizations as f64,
        zone_factorizations: counts.zone_factorizations as f64,
        full_solves: counts.full_solves as f64,
        increments: results.history.len() as f64,
        contact_changes: counts.contact_changes as f64,
        plastic_iterations: counts.plastic_iterations as f64,
        trailing_solves: counts.trailing_solves as f64,
    }
}

#[test]
fn runs_are_no_dearer_than_they_were() {
    // Most scenes are too large for the dense one.
    for (backend, every) in sparse().into_iter().zip([1, either(2, 1)]) {
        assert_no_dearer(backend, every);
    }
}

/// Of the runs every first, second and so on.
fn assert_no_dearer(backend: Backend, every: usize) {
    let (root, name) = (env!("CARGO_MANIFEST_DIR"), backend.name());
    let file = format!("{root}/tests/cost/counts_{name}.json");
    let is_written = std::env::var_os("BRINELL_WRITE_COUNTS").is_some();
    let costs: BTreeMap<&str, Cost> = RUNS
        .into_iter()
        .step_by(if is_written { 1 } else { every })
        .map(|(name, scene, changes)| (name, cost(backend, scene, changes)))
        .collect();
    if is_written {
        let text = serde_json::to_string_pretty(&costs).unwrap();
        std::fs::write(&file, text + "\n").unwrap();
        return;
    }
    let values = |cost: &Cost| serde_json::to_value(cost).unwrap();
    let kept: BTreeMap<String, Cost> =
        serde_json::from_str(&std::fs::read_to_string(&file).unwrap()).unwrap();
    assert_eq!(kept.len(), RUNS.len());
    let mut wrong = Vec::new();
    for (name, cost) in &costs {
        let (is, was) = (values(cost), values(&kept[*name]));
        for (what, is) in is.as_object().unwrap() {
            let (is, was) = (is.as_f64().unwrap(), was[what].as_f64().unwrap());
            let slack = if was <= FEW { 1.0 } else { 0.0 };
            if is > DEARER * was + slack || is < CHEAPER * was - slack {
                wrong.push(format!("{name}: {what} {is}, was {was}"));
            }
        }
    }
    assert!(
        wrong.is_empty(),
        "BRINELL_WRITE_COUNTS=1 writes {file} anew if this is meant: {wrong:#?}"
    );
}
