//! What a demand reports agrees with itself and with what the scene prescribes, though each value is extrapolated on its own.

use crate::demand::reached;
use crate::running;
use brinell::accuracy::{Extent, quantities, value_of};
use brinell::results::{QuantityError, Results, State};

/// Round-off of products of reported values.
const ROUND_OFF: f64 = 1e-12;

fn is(found: f64, wanted: f64) -> bool {
    (found - wanted).abs() <= ROUND_OFF * wanted.abs()
}

fn rows(results: &Results) -> &[QuantityError] {
    &results.accuracy.as_ref().unwrap().quantities
}

fn state<'r>(results: &'r Results, name: &str) -> &'r State {
    results.states.iter().find(|s| s.name == name).unwrap()
}

/// Loads are those multiples of first yield's that their factors say, and rows the results.
fn agrees(results: &Results) {
    let first = results.first_yield.unwrap().load;
    for state in &results.states {
        assert!(
            is(state.load, state.alpha * first),
            "{}: {} {} {first}",
            state.name,
            state.load,
            state.alpha
        );
    }
    let reported = quantities(results);
    for row in rows(results) {
        assert_eq!(value_of(&reported, &row.quantity), Some(row.value));
    }
    assert!(rows(results).iter().any(|row| row.of_mesh.is_some()));
}

#[test]
fn loads_factors_and_pressures_agree() {
    let targets = "program.targets=[{ name = \"first\", yield = true }, { name = \"up\", load_factor = 1.3207 }, \
                   { name = \"wide\", half_width = 1.5 }, { name = \"down\", load_factor = 0.867 }, { name = \"off\", load_factor = 0.0 }]";
    let scene = running::load("cylinder_on_half_plane", &[targets]);
    let results = reached(&scene, 0.03, Extent::Program).results;
    agrees(&results);
    let first = results.first_yield.unwrap();
    for (name, factor) in [
        ("first", 1.0),
        ("up", 1.3207),
        ("down", 0.867),
        ("off", 0.0),
    ] {
        let found = state(&results, name).alpha;
        // As a run without a demand has it: targets are hit to the last digits.
        assert!(
            (found - factor).abs() <= 4.0 * f64::EPSILON,
            "{name}: {found}"
        );
    }
    let wide = state(&results, "wide");
    assert!(
        (wide.half_width / first.half_width - 1.5).abs() < 1e-6,
        "{wide:?}"
    );
    for state in &results.states {
        assert!(
            state.pole_pressure <= state.max_pressure,
            "{}: {} {}",
            state.name,
            state.pole_pressure,
            state.max_pressure
        );
        // All of the load goes through the contact; they are summed over different nodes.
        assert!((state.contact_force - state.load).abs() <= 1e-6 * first.load);
    }
}

/// First yield of an elastic tube converges faster than anything that flows, so that its law is another than that of the loads after it.
#[test]
fn loads_in_units_of_first_yield_follow_it() {
    let targets =
        "program.targets=[{ yield = true }, { load_factor = 1.2 }, { load_factor = 1.5 }]";
    let scene = running::load("thick_cylinder", &["program.unit=yield", targets]);
    for accuracy in [0.1, 0.03] {
        let results = reached(&scene, accuracy, Extent::Program).results;
        agrees(&results);
        let of_mesh = |path: &str| {
            let row = rows(&results).iter().find(|r| r.quantity == path);
            row.and_then(|r| r.discretisation).unwrap()
        };
        let (first, later) = (of_mesh("yield.load"), of_mesh("states.alpha 1.5.load"));
        assert!(is(later, 1.5 * first), "{later} {first}");
    }
}

/// Meshes of 8, 12 and 16 elements all have the edge at the node three quarters along; it lies at 1.325.
#[test]
fn an_edge_on_a_node_of_all_meshes_is_not_taken_for_known() {
    let scene = running::load("hard/lift_off", &[]);
    let half_width = |accuracy: f64| {
        let results = reached(&scene, accuracy, Extent::Program).results;
        state(&results, "down").half_width
    };
    let (found, wanted) = (half_width(0.03), half_width(0.003));
    assert!((found / wanted - 1.0).abs() <= 0.03, "{found} {wanted}");
}
