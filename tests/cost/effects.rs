//! What an effect costs is paid by the scenes that ask for it.

use super::running::{load, try_run};
use brinell::linalg::Backend;
use brinell::results::{Counts, Effect, Results};

const CYLINDER: [&str; 2] = [
    "mesh.cylinder_on_half_plane.resolution=6",
    "program.targets=[{ yield = true }, { load_factor = 1.5 }, { load_factor = 0.0 }]",
];

fn run(changes: &[&str]) -> Results {
    let changes = [&CYLINDER[..], changes].concat();
    try_run(
        &load("cylinder_on_half_plane", &changes),
        Backend::default(),
    )
    .unwrap()
}

fn effect<'r>(results: &'r Results, name: &str) -> &'r Effect {
    let mut effects = results.effects.iter();
    effects.find(|effect| effect.name == name).unwrap()
}

/// Counts, bytes of the zone, and what came of it.
fn cost(results: &Results) -> (Counts, u64, usize) {
    let zone = effect(results, "plasticity").memory_bytes;
    (results.counts, zone, results.history.len())
}

/// Back stresses that are none, and those that follow the plastic strain, need no memory; each that
/// fades has six numbers at each point of a solid zone, four of a plane one, the work that is lost
/// with them is one more, and the tangent has a stress more.
#[test]
fn back_stresses_are_stored_where_they_fade() {
    let plain = run(&[]);
    assert!(!effect(&plain, "kinematic hardening").on);
    for none in ["back_stresses=[[0.0, 0.0]]", "kinematic_modulus=0.0"] {
        let results = run(&[&format!("materials.steel.{none}")]);
        assert_eq!(cost(&results), cost(&plain), "{none}");
        let effect = effect(&results, "kinematic hardening");
        assert!(!effect.on && effect.why.contains("no material that may yield"));
    }
    let bytes = |laws: &str| {
        let results = run(&[&format!("materials.steel.back_stresses={laws}")]);
        assert!(effect(&results, "kinematic hardening").on);
        effect(&results, "plasticity").memory_bytes
    };
    let linear = bytes("[[20000.0, 0.0]]");
    let [one, two] = [
        "[[20000.0, 50.0]]",
        "[[20000.0, 50.0], [9000.0, 200.0], [1000.0, 0.0]]",
    ]
    .map(bytes);
    let each = two - one;
    assert_eq!(one - linear, 2 * each + each / 4, "{linear} {one} {two}");
    let points = each / (4 * size_of::<f64>() as u64);
    assert!(points > 100 && each % (4 * size_of::<f64>() as u64) == 0);
    // The zone follows the load, which hardening changes: only its size may differ.
    let size = |bytes: u64| bytes as f64 / effect(&plain, "plasticity").memory_bytes as f64;
    assert!((size(linear) - 1.0).abs() < 0.2, "{}", size(linear));
}

/// A profile that is the material's yield stress everywhere is nothing; any other is a number at
/// each point of the zone.
#[test]
fn yield_stresses_by_depth_are_stored_where_there_are_any() {
    let plain = run(&[]);
    let profile = |rows: &str| run(&[&format!("bodies.half_plane.yield_by_depth={rows}")]);
    let none = profile("[[0.0, 500.0], [1.0, 500.0]]");
    assert_eq!(cost(&none), cost(&plain));
    let found = effect(&none, "yield stress by depth");
    assert!(!found.on && found.why.contains("no body that may yield"));
    // Harder far below all that yields: the same path, and the same cost but for the numbers.
    let deep = profile("[[0.0, 500.0], [30.0, 500.0], [40.0, 900.0]]");
    assert!(effect(&deep, "yield stress by depth").on);
    assert_eq!(deep.counts, plain.counts);
    let bytes = |results| effect(results, "plasticity").memory_bytes;
    let more = bytes(&deep) - bytes(&plain);
    assert!(
        more > 100 * 8 && more % 8 == 0 && more < bytes(&plain) / 20,
        "{more}"
    );
}
