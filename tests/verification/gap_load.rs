//! Gaps that change with the load factor: what an interference of the same size does, and contact
//! that is off for a while.

use crate::support::{load, run, run_text};
use brinell::model::Model;
use brinell::results::{Results, State};
use brinell::scene::Scene;

/// Both are equilibria of the same linear system, found to 1e-10 of its forces.
fn alike(a: &State, b: &State) {
    assert!(b.max_pressure > 0.0);
    for (a, b) in [
        (a.max_pressure, b.max_pressure),
        (a.contact_force, b.contact_force),
    ] {
        assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
    }
}

fn fitted(targets: &str, loads: &str, interference: f64) -> Results {
    let mut scene = load(
        "shrink_fit",
        &[
            &format!("contact.0.interference={interference:?}"),
            &format!("load={loads}"),
            &format!("program.targets={targets}"),
        ],
    );
    scene.reference.clear();
    run(&scene)
}

#[test]
fn a_fit_in_steps_is_an_interference() {
    let whole = fitted("[{ load_factor = 0.0 }]", "[]", 0.02);
    for (on, rest) in [("shaft.outer", 0.0), ("ring.inner", 0.005)] {
        let load = format!("[{{ on = {on:?}, gap = {:?} }}]", rest - 0.02);
        let targets = "[{ load_factor = 0.5 }, { load_factor = 1.0 }]";
        alike(&fitted(targets, &load, rest).states[1], &whole.states[0]);
    }
}

/// Faces of hexahedra with middle nodes, whose pairs are of control points.
#[test]
fn a_wedge_between_quadratic_faces_is_an_interference() {
    let text = |interference: f64, load: &str| {
        format!(
            r#"
kind = "solid"
contact = [{{ first = "upper.bottom", second = "lower.top", interference = {interference:?} }}]
support = [
    {{ on = "lower.bottom", fix = ["x", "y", "z"] }}, {{ on = "upper.top", fix = ["x", "y", "z"] }},
]
load = {load}
[[mesh.parts]]
body = "upper"
element = "hex20"
brick = {{ x = [0, 1], y = [0, 1], z = [1, 2], elements = [2, 3, 2] }}
[[mesh.parts]]
body = "lower"
element = "hex20"
brick = {{ x = [0, 1], y = [0, 1], z = [0, 1], elements = [2, 2, 2] }}
[materials.m]
youngs_modulus = 1000.0
poissons_ratio = 0.3
[bodies]
upper = {{ material = "m" }}
lower = {{ material = "m" }}
[program]
targets = [{{ load_factor = 1.0 }}]
"#
        )
    };
    let of =
        |interference, load: &str| run(&Scene::parse(&text(interference, load), "test").unwrap());
    let idle = "[{ on = \"lower.right\", force = [0.0, 0.0, 0.0] }]";
    let stated = of(0.01, idle);
    let wedged = of(0.0, "[{ on = \"lower.top\", gap = -0.01 }]");
    alike(&wedged.states[0], &stated.states[0]);
}

/// Pressed, taken apart and put together again under the same force of the fit.
#[test]
fn contact_that_is_off_for_a_while() {
    let load = "[{ on = \"ring.inner\", gap = 50.0, history = [[0, 0], [1, 0], [2, 1], [3, 0]] }]";
    let targets = "[{ load_factor = 1.0 }, { load_factor = 2.0 }, { load_factor = 3.0 }]";
    let results = fitted(targets, load, 0.02);
    let [before, off, after] = &results.states[..] else {
        panic!("{} states", results.states.len());
    };
    assert_eq!(off.contact_force, 0.0);
    assert_eq!(off.max_pressure, 0.0);
    alike(after, before);
    let fields = off.fields.as_ref().unwrap();
    let most = fields.stress.iter().fold(0.0f64, |m, s| m.max(s.abs()));
    // Round-off of the pressure that was.
    assert!(most < 1e-9 * before.max_pressure, "{most}");
}

#[test]
fn a_gap_on_a_surface_without_contact_is_refused() {
    let nowhere = "load=[{ on = \"ring.start\", gap = 0.1 }]";
    let error = Model::new(&load("shrink_fit", &[nowhere])).unwrap_err();
    for fragment in [
        "`ring.start`, which no contact has",
        "`shaft.outer`, `ring.inner`",
    ] {
        assert!(error.message().contains(fragment), "{error}");
    }
}

/// Two blocks of height 1 and no Poisson's ratio, wedged apart by 0.01: the stress is `E 0.01 / 2`,
/// its force that of the whole, of which a symmetric model has a part.
#[test]
fn the_load_of_a_gap_is_that_of_the_whole() {
    for symmetry in [1, 2] {
        let text = format!(
            r#"
kind = "plane_strain"
symmetry = {symmetry}
contact = [{{ first = "upper.bottom", second = "lower.top" }}]
support = [
    {{ on = "lower.bottom", fix = ["y"] }}, {{ on = "upper.top", fix = ["y"] }},
    {{ on = "lower.left", fix = ["x"] }}, {{ on = "upper.left", fix = ["x"] }},
]
load = [{{ on = "lower.top", gap = -0.01 }}]
[[mesh.parts]]
body = "upper"
block = {{ x = [0.0, 1.5], y = [1.0, 2.0], elements = [3, 2] }}
[[mesh.parts]]
body = "lower"
block = {{ x = [0.0, 1.5], y = [0.0, 1.0], elements = [3, 2] }}
[materials.m]
youngs_modulus = 1000.0
poissons_ratio = 0.0
[bodies]
upper = {{ material = "m" }}
lower = {{ material = "m" }}
[program]
targets = [{{ load_factor = 1.0 }}]
"#
        );
        let state = &run_text(&text).states[0];
        let exact = f64::from(symmetry) * 1.5 * 1000.0 * 0.01 / 2.0;
        assert!(
            (state.load / exact - 1.0).abs() < 1e-9,
            "{symmetry}: {}",
            state.load
        );
    }
}
