//! Stresses and plastic strains that bodies bring along: bars and layers, whose answers are those
//! of one dimension.

use crate::support::{parse, run, yield_load};
use crate::verification::close;
use brinell::model::Model;
use brinell::results::Results;
use brinell::scene::Scene;

const E: f64 = 200_000.0;
const YIELD: f64 = 200.0;

/// A bar of length 2 and depth 1 with what it brings along; `load` pulls its right side, or not.
fn bar(kind: &str, element: &str, initial: &str, load: &str) -> Scene {
    let (part, faces) = match kind {
        "solid" => (
            "brick = { x = [0.0, 2.0], y = [0.0, 1.0], z = [0.0, 1.0], elements = [2, 1, 2] }",
            r#"{ on = "bar.front", fix = ["y"] }, { on = "bar.bottom", fix = ["z"] }"#,
        ),
        _ => (
            "block = { x = [0.0, 2.0], y = [0.0, 1.0], elements = [2, 4] }",
            r#"{ on = "bar.bottom", fix = ["y"] }"#,
        ),
    };
    let text = format!(
        r#"
kind = "{kind}"
support = [{{ on = "bar.left", fix = ["x"] }}, {faces}]
load = [{load}]
[[mesh.parts]]
body = "bar"
element = "{element}"
{part}
[materials.metal]
youngs_modulus = {E:?}
poissons_ratio = 0.3
yield_stress = {YIELD:?}
plastic_modulus = 20000.0
[bodies.bar]
material = "metal"
{initial}
[program]
targets = [{{ load_factor = 0.0 }}]
"#
    );
    parse(&text)
}

const KINDS: [(&str, &str); 6] = [
    ("plane_stress", "quad4"),
    ("plane_stress", "quad8"),
    ("plane_stress", "tri3"),
    ("plane_stress", "tri6"),
    ("solid", "hex8"),
    ("solid", "hex20"),
];
/// Pulled by its right side.
const PULLED: &str = r#"{ on = "bar.right", displacement = { x = 1.0 } }"#;
/// No load: what a body brings along is enough.
const FREE: &str = "";

fn stress_xx(results: &Results) -> Vec<f64> {
    let stress = &results.states[0].fields.as_ref().unwrap().stress;
    let size = stress.len() / results.sizes.elements;
    stress.chunks(size).map(|s| s[0]).collect()
}

/// Stresses that cancel leave their round-off, equilibrium a share of 1e-10 of its forces.
fn near(found: &[f64], exact: f64, case: &str) {
    for value in found {
        assert!(
            (value - exact).abs() < 1e-8 * YIELD,
            "{case}: {value} {exact}"
        );
    }
}

/// What a bar brings along everywhere relaxes where it is free, and stays where its ends are held.
#[test]
fn a_bar_has_the_stress_that_its_ends_hold() {
    let plastic = "initial_plastic_strain = [[0.0, 5e-4, -2e-4, -3e-4]]";
    let stress = "initial_stress = [[0.0, 120.0, 0.0, 0.0]]";
    for (kind, element) in KINDS {
        for (initial, held) in [(plastic, -E * 5e-4), (stress, 120.0)] {
            let case = format!("{kind} {element} {initial}");
            let free = run(&bar(kind, element, initial, FREE));
            near(&stress_xx(&free), 0.0, &case);
            let clamped = run(&bar(kind, element, initial, PULLED));
            near(&stress_xx(&clamped), held, &case);
            // Its own strain is no flow.
            assert_eq!(clamped.states[0].plastic_points, 0, "{case}");
            let effect = clamped.effects.iter().find(|e| e.name == "initial state");
            assert!(effect.unwrap().on);
        }
    }
}

/// A free bar takes the plastic strain on, and a stress as the strain that releases it.
#[test]
fn a_free_bar_changes_its_length() {
    for (initial, longer) in [
        ("initial_plastic_strain = [[0.0, 5e-4, -2e-4, -3e-4]]", 1e-3),
        ("initial_stress = [[0.0, 100.0, 0.0, 0.0]]", -1e-3),
        ("initial_stress = [[0.0, 0.0, 100.0, 0.0]]", 0.3 * 1e-3),
    ] {
        let scene = bar("plane_stress", "quad8", initial, FREE);
        let results = run(&scene);
        let model = Model::new(&scene).unwrap();
        let u = &results.states[0].fields.as_ref().unwrap().displacement;
        for &node in &model.mesh.set_nodes("bar.right").unwrap() {
            close(u[2 * node], longer, 1e-9);
        }
    }
}

/// First yield counts what is there already: a bar pulled with its stress of 120 yields after 80
/// more, against it after 320.
#[test]
fn first_yield_counts_the_stress_that_is_there() {
    for (kind, element) in KINDS {
        for (stress, more) in [(120.0, 80.0), (-120.0, 320.0)] {
            let initial = format!("initial_stress = [[0.0, {stress:?}, 0.0, 0.0]]");
            let first = yield_load(&bar(kind, element, &initial, PULLED)).first_yield;
            close(first.unwrap().alpha, 2.0 * more / E, 1e-9);
        }
    }
}

/// A bar that is given more than its yield stress yields while it is put there.
#[test]
fn what_is_beyond_yield_flows() {
    let initial = "initial_plastic_strain = [[0.0, -2e-3, 0.0, 0.0]]";
    let results = run(&bar("plane_stress", "quad8", initial, PULLED));
    let flow = (E * 2e-3 - YIELD) / (E + 20_000.0);
    close(results.states[0].max_equivalent_plastic_strain, flow, 1e-8);
    near(&stress_xx(&results), E * (2e-3 - flow), "flow");
}

/// A stress that falls from 160 at the top to -160 at the bottom is in equilibrium with straight
/// ends: quadratic elements have it exactly, linear ones its mean over each.
#[test]
fn a_profile_counts_from_its_surface() {
    let initial = "initial_stress = [[0.0, 160.0, 0.0, 0.0], [1.0, -160.0, 0.0, 0.0]]\n\
                   depth_from = \"bar.top\"";
    // The recovered stress of linear elements lies between their mean and that of the surface.
    for (element, least) in [("quad8", 160.0), ("quad4", 120.0)] {
        let scene = bar("plane_stress", element, initial, PULLED);
        let first = yield_load(&scene).first_yield.unwrap();
        let there = YIELD - E * first.alpha / 2.0;
        let range = least - 1e-6..160.0 + 1e-6;
        assert!(range.contains(&there), "{element} {there}");
        assert!(first.location[1] > 0.75 - 1e-9, "{:?}", first.location);
        let layers = [-120.0, -40.0, 40.0, 120.0];
        for (k, stress) in stress_xx(&run(&scene)).iter().enumerate() {
            assert!(
                layers.iter().any(|l| (l - stress).abs() < 1e-7),
                "{k} {stress}"
            );
        }
    }
}

#[test]
fn what_does_not_fit_is_named() {
    let refused = |initial: &str, load: &str| {
        let text = bar("plane_stress", "quad8", "", load).to_toml().unwrap();
        let text = text.replacen("[bodies.bar]", &format!("[bodies.bar]\n{initial}"), 1);
        let scene = Scene::parse(&text, "bar.toml").and_then(|scene| Model::new(&scene));
        scene.unwrap_err()
    };
    for (initial, words) in [
        (
            "initial_stress = [[0.0, 1.0]]",
            "initial_stress.0: has 2 numbers; give rows of [depth, xx, yy, zz]",
        ),
        (
            "initial_stress = [[0.0, 1.0, 0.0, 5.0]]",
            "initial_stress.0: zz 5 must be 0 in plane stress",
        ),
        (
            "initial_plastic_strain = [[0.5, 1.0, 0.0, 0.0], [0.5, 0.0, 0.0, 0.0]]",
            "initial_plastic_strain.1: depth 0.5 must be greater than 0.5 of the row before",
        ),
        ("initial_stress = []", "initial_stress: is empty"),
        (
            "initial_stress = [[0.0, 1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]]",
            "bodies.bar.initial_stress: no surface of the body may touch another",
        ),
        (
            "initial_stress = [[0.0, 1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]]\n\
             depth_from = \"bar.topp\"",
            "did you mean `bar.top`?",
        ),
    ] {
        let error = refused(initial, PULLED);
        assert_eq!(error.kind(), brinell::ErrorKind::Input);
        assert!(error.to_string().contains(words), "{error}");
    }
}
