//! What yields far from the contact, where nobody looks for it at first: on meshes so large that
//! the zone is a part of them.

use crate::support::{close, healthy, parse, run};
use brinell::results::Results;

const YIELD_STRESS: f64 = 300.0;
const PLASTIC_MODULUS: f64 = 20_000.0;

/// A stamp at one end of a long block, a pressure at the other: 3,840 elements may yield, those
/// near the contact are the first guess.
fn block(press: f64, bump: f64, history: &str, targets: &str) -> Results {
    let results = run(&parse(&format!(
        r#"
        kind = "plane_strain"
        [[mesh.parts]]
        body = "low"
        [mesh.parts.block]
        x = [0.0, 60.0]
        y = [-6.0, 0.0]
        elements = [240, 16]
        pieces = [{{ name = "far", side = "top", from = 50.0, to = 52.0 }}, 
            {{ name = "near", side = "top", from = 0.0, to = 2.0 }}]
        [[mesh.parts]]
        body = "up"
        [mesh.parts.block]
        x = [0.0, 2.0]
        y = [0.0, 1.0]
        elements = [8, 4]
        [materials.soft]
        youngs_modulus = 200000.0
        poissons_ratio = 0.3
        yield_stress = {YIELD_STRESS:?}
        plastic_modulus = {PLASTIC_MODULUS:?}
        [materials.hard]
        youngs_modulus = 200000.0
        poissons_ratio = 0.3
        [bodies]
        low = {{ material = "soft" }}
        up = {{ material = "hard" }}
        [[contact]]
        first = "up.bottom"
        second = "low.near"
        [[support]]
        on = "low.bottom"
        fix = ["y"]
        [[support]]
        on = "low.left"
        fix = ["x"]
        [[support]]
        on = "up.left"
        fix = ["x"]
        [[load]]
        name = "press"
        on = "up.top"
        pressure = {press:?}
        [[load]]
        name = "bump"
        on = "low.far"
        pressure = {bump:?}
        history = {history}
        [program]
        targets = {targets}
        "#
    )));
    healthy(&results);
    // At first yield itself the recovered stress has come to yield, which the mean of an element is
    // not.
    for state in results.states.iter().filter(|s| s.name != "yield") {
        // The mean stress of an element is no more than the largest of its points, which lie within
        // the hardened yield surface.
        let limit = YIELD_STRESS + PLASTIC_MODULUS * state.max_equivalent_plastic_strain;
        let soft = &state.fields.as_ref().unwrap().von_mises[..3840];
        let largest = soft.iter().fold(0.0f64, |m, v| m.max(*v));
        assert!(largest <= limit * (1.0 + 1e-9), "{}: {largest}", state.name);
    }
    results
}

/// Nothing yields under the stamp, so nothing did where first yield was looked for. (Once the far
/// end then counted as elastic too: twice the yield stress, and no plastic strain.)
#[test]
fn a_load_far_from_a_contact_that_does_not_yield() {
    let at_once = block(1.0, 900.0, "\"proportional\"", "[{ load_factor = 1.0 }]");
    let by_yield = "[{ yield = true }, { load_factor = 1.0 }]";
    let by_yield = block(1.0, 900.0, "\"proportional\"", by_yield);
    assert!(at_once.states[0].plastic_points > 0);
    let [a, b] = [&at_once, &by_yield].map(|r| r.first_yield.unwrap().alpha);
    close("first yield", a, b, b, 1e-9);
}

/// A load that has come and gone before the target has left its dent. (Once only what the targets'
/// own loads make yield was looked at.)
#[test]
fn a_load_that_comes_and_goes_on_the_way_to_a_target() {
    let history = "[[0.0, 0.0], [0.5, 1.0], [1.0, 0.0]]";
    let past = block(400.0, 900.0, history, "[{ load_factor = 1.0 }]");
    let seen = "[{ load_factor = 0.5 }, { load_factor = 1.0 }]";
    let seen = block(400.0, 900.0, history, seen);
    let [a, b] = [&past.states[0], &seen.states[1]];
    assert!(b.max_equivalent_plastic_strain > 1e-3);
    assert_eq!(a.plastic_points, b.plastic_points);
    // The same path: a target is a point on it.
    let strain = b.max_equivalent_plastic_strain;
    close(
        "strain",
        a.max_equivalent_plastic_strain,
        strain,
        strain,
        1e-6,
    );
    let [a, b] = [&past, &seen].map(|r| r.first_yield.unwrap().alpha);
    close("first yield", a, b, b, 1e-9);
}

/// A preload that makes the far end yield: it is applied anew where that is seen, with its plastic
/// strains.
#[test]
fn a_preload_far_from_the_contact() {
    let results = block(
        1.0,
        900.0,
        "\"constant\"",
        "[{ load_factor = 0.0 }, { load_factor = 1.0 }]",
    );
    assert!(results.states[0].plastic_points > 0);
    // As a load that grows beside one that does not press at all.
    let alone = block(0.0, 900.0, "\"proportional\"", "[{ load_factor = 1.0 }]");
    let [a, b] = [&results, &alone].map(|r| r.states[0].max_equivalent_plastic_strain);
    close("strain", a, b, b, 1e-3);
}
