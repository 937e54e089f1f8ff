//! The cases of `data/peers`, on which CalculiX fails without a word: each runs here as it stands, first time.

use crate::running::{close, healthy, run};
use brinell::analytical::{DiscInPlate, HertzLine, HertzPoint, contact_modulus};
use brinell::results::{Results, State};
use brinell::scene::Scene;

fn peer(name: &str) -> Results {
    let path = format!("{}/data/peers/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let results = run(&Scene::load(path).unwrap());
    assert!(results.inaccurate.is_empty(), "{:?}", results.inaccurate);
    results
}

/// From pair `from`, counted from the pole outwards, no pair carries more than the one before it: no spikes, no node left out.
#[track_caller]
fn falls_from_the_pole(state: &State, from: usize) {
    // The pairs run towards the pole or from it.
    let mut pressures: Vec<f64> = state.pairs.iter().map(|p| p.pressure).collect();
    if pressures[0] < pressures[pressures.len() - 1] {
        pressures.reverse();
    }
    for pair in pressures[from..].windows(2) {
        assert!(pair[1] <= pair[0] * (1.0 + 1e-9), "{pressures:?}");
    }
}

/// With one node touching a penalty code begins without stiffness and cuts back (CalculiX, on some meshes, until it gives up). Hertz; four elements over
/// the half width, of order h^2.
#[test]
fn a_single_node_touches_at_the_beginning() {
    let results = peer("single_node");
    healthy(&results);
    let elastic = &results.states[0];
    let hertz = HertzLine::new(10.0, contact_modulus(210e3, 0.3, 210e3, 0.3)).unwrap();
    close("force", elastic.contact_force, 0.8 * 218.991, 175.0, 1e-9);
    let exact = hertz.max_pressure(elastic.contact_force);
    close("pole", elastic.pole_pressure, exact, exact, 0.02);
    falls_from_the_pole(elastic, 0);
}

/// The node on the axis has no area of its own: CalculiX gives it no force and doubles its neighbour's, without a warning. The pole's pressure is of
/// order h, 0.15 times it.
#[test]
fn the_node_on_the_axis_carries_the_largest_pressure() {
    let results = peer("axis_node");
    healthy(&results);
    let pushed = &results.states[0];
    let hertz = HertzPoint::new(10.0, contact_modulus(210e3, 0.3, 210e3, 0.3)).unwrap();
    let exact = hertz.max_pressure(pushed.contact_force);
    close("pole", pushed.pole_pressure, exact, exact, 0.15 / 8.0);
    falls_from_the_pole(pushed, 1);
    close("largest", pushed.max_pressure, exact, exact, 0.15 / 8.0);
}

/// A stiff penalty bounces between nodes and reports convergence with ten times the pressure (CalculiX); thirty elements over the quarter, of order h^2.
#[test]
fn a_conforming_disc_has_the_pressure_of_the_closed_form() {
    let results = peer("conforming_disc");
    healthy(&results);
    let pulled = &results.states[0];
    let exact = DiscInPlate::new(10.0).unwrap().pressure(0.0, 100.0);
    close("pole", pulled.pole_pressure, exact, exact, 0.01);
    close("largest", pulled.max_pressure, exact, exact, 0.01);
    falls_from_the_pole(pulled, 0);
}
