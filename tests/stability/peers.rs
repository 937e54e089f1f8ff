//! The cases of `data/peers`, on which CalculiX fails without a word: each runs here as it stands,
//! first time.

use crate::support::{close, healthy, run};
use brinell::analytical::{DiscInPlate, HertzLine, HertzPoint, contact_modulus};
use brinell::results::{Results, State};
use brinell::scene::Scene;

fn peer(name: &str) -> Results {
    let path = format!("{}/data/peers/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let results = run(&Scene::load(path).unwrap());
    assert!(results.inaccurate.is_empty(), "{:?}", results.inaccurate);
    healthy(&results);
    results
}

/// From pair `from`, counted from the pole outwards, no pair carries more than the one before it:
/// no spikes, no node left out.
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

/// The largest pressure is that of the closed form, at the pole, and falls from pair `from` on.
#[track_caller]
fn is_that_of(exact: f64, state: &State, tolerance: f64, from: usize) {
    close("pole", state.pole_pressure, exact, exact, tolerance);
    close("largest", state.max_pressure, exact, exact, tolerance);
    falls_from_the_pole(state, from);
}

/// With one node touching a penalty code begins without stiffness and cuts back (CalculiX, on some
/// meshes, until it gives up). Hertz; four elements over the half width, of order h^2.
#[test]
fn a_single_node_touches_at_the_beginning() {
    let results = peer("single_node");
    let elastic = &results.states[0];
    let hertz = HertzLine::new(10.0, contact_modulus(210e3, 0.3, 210e3, 0.3)).unwrap();
    close("force", elastic.contact_force, 0.8 * 218.991, 175.0, 1e-9);
    is_that_of(hertz.max_pressure(elastic.contact_force), elastic, 0.02, 0);
}

/// The node on the axis has no area of its own: CalculiX gives it no force and doubles its
/// neighbour's, without a warning. Eight elements over the radius, of order h^2.
#[test]
fn the_node_on_the_axis_carries_the_largest_pressure() {
    let results = peer("axis_node");
    let pushed = &results.states[0];
    let hertz = HertzPoint::new(10.0, contact_modulus(210e3, 0.3, 210e3, 0.3)).unwrap();
    is_that_of(
        hertz.max_pressure(pushed.contact_force),
        pushed,
        1.0 / 64.0,
        0,
    );
}

/// A stiff penalty bounces between nodes and reports convergence with ten times the pressure
/// (CalculiX); thirty elements over the quarter, of order h^2.
#[test]
fn a_conforming_disc_has_the_pressure_of_the_closed_form() {
    let results = peer("conforming_disc");
    let exact = DiscInPlate::new(10.0).unwrap().pressure(0.0, 100.0);
    is_that_of(exact, &results.states[0], 0.01, 0);
}
