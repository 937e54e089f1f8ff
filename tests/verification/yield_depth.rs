//! Yield stress by depth: layers pulled in parallel, and line contact of a case-hardened half
//! plane.
//!
//! Source of the elastic stresses: K. L. Johnson, Contact Mechanics (1985), section 4.2.

use crate::support::{load, parse, run, yield_load};
use crate::verification::close;
use brinell::ErrorKind;
use brinell::analytical::{HertzLine, contact_modulus};
use brinell::model::Model;
use brinell::scene::Scene;

const E: f64 = 200_000.0;

/// A sheet of depth 2 pulled along x; its yield stress falls from the top to the bottom. Layers
/// have the same strain and nothing acts across them: each is a bar.
fn sheet(element: &str, hardening: f64, targets: &[f64]) -> Scene {
    let each: Vec<String> = targets
        .iter()
        .map(|t| format!("{{ load_factor = {t:?} }}"))
        .collect();
    let text = format!(
        r#"
kind = "plane_stress"
support = [{{ on = "sheet.left", fix = ["x"] }}, {{ on = "sheet.bottom_left", fix = ["y"] }}]
load = [{{ on = "sheet.right", displacement = {{ x = 1.0 }} }}]
[[mesh.parts]]
body = "sheet"
element = "{element}"
block = {{ x = [0.0, 1.0], y = [0.0, 2.0], elements = [1, 4] }}
[materials.metal]
youngs_modulus = {E:?}
poissons_ratio = 0.3
yield_stress = 250.0
plastic_modulus = {hardening:?}
[bodies.sheet]
material = "metal"
yield_by_depth = [[0.0, 300.0], [1.0, 300.0], [2.0, 100.0]]
depth_from = "sheet.top"
[program]
targets = [{}]
"#,
        each.join(", ")
    );
    parse(&text)
}

#[test]
fn layers_pulled_in_parallel_yield_one_after_the_other() {
    for element in ["quad4", "quad8"] {
        for h in [0.0, 20_000.0] {
            // The weakest layer yields at a stress of 100, the hardest at 300.
            let results = run(&sheet(element, h, &[0.9 * 100.0 / E, 0.01]));
            let first = results.first_yield.as_ref().unwrap();
            close(first.alpha, 100.0 / E, 1e-9);
            assert!(first.location[1].abs() < 1e-9, "{:?}", first.location);
            assert_eq!(results.states[0].plastic_points, 0);
            // All layers yield: stresses Y + H (E eps - Y)/(E + H), linear in Y, whose mean is 250.
            let mean = |y: f64| y + h * (E * 0.01 - y) / (E + h);
            let state = &results.states[1];
            // Across the load quad4 strains evenly over its depth while its points flow unevenly:
            // its own error, which quad8 has not.
            let accuracy = if element == "quad4" { 1e-3 } else { 1e-8 };
            close(state.load.abs(), 2.0 * mean(250.0), accuracy);
            // The weakest Gauss point flows most.
            // Either element has two of them over its depth.
            let depth = 1.75 + 0.25 / 3f64.sqrt();
            let weakest = (E * 0.01 - (500.0 - 200.0 * depth)) / (E + h);
            close(state.max_equivalent_plastic_strain, weakest, accuracy);
        }
    }
}

/// Hardness that falls with depth: first yield lies where the elastic stress first reaches the
/// yield stress there.
#[test]
fn a_case_hardened_half_plane_yields_below_its_case() {
    let rows = [[0.0, 1000.0], [0.05, 1000.0], [0.25, 420.0]];
    let profile = format!("{rows:?}");
    let mut found = Vec::new();
    for resolution in [16, 32] {
        let scene = load(
            "cylinder_on_half_plane",
            &[
                &format!("mesh.cylinder_on_half_plane.resolution={resolution}"),
                "bodies.cylinder.plastic=false",
                &format!("bodies.half_plane.yield_by_depth={profile}"),
                "reference=[]",
            ],
        );
        let first = yield_load(&scene).first_yield.unwrap();
        assert_eq!(first.body, 1);
        found.push((first.load, -first.location[1]));
    }
    let hertz = HertzLine::new(10.0, contact_modulus(210e3, 0.3, 210e3, 0.3)).unwrap();
    let yield_stress = |z: f64| match z {
        z if z <= 0.05 => 1000.0,
        z if z < 0.25 => 1000.0 - 580.0 * (z - 0.05) / 0.2,
        _ => 420.0,
    };
    let largest = |load: f64| {
        let depths = (1..4000).map(|k| f64::from(k) * 2.5e-4);
        let ratio = |z: f64| {
            let [xx, zz, yy, xz] = hertz.stress(0.0, z, load, 0.3);
            let [a, b, c] = [xx - zz, zz - yy, yy - xx];
            let mises = (0.5 * (a * a + b * b + c * c) + 3.0 * xz * xz).sqrt();
            (mises / yield_stress(z), z)
        };
        depths
            .map(ratio)
            .fold((0.0, 0.0), |m, r| if r.0 > m.0 { r } else { m })
    };
    let (mut low, mut high) = (1.0, 1e5);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        match largest(middle).0 < 1.0 {
            true => low = middle,
            false => high = middle,
        }
    }
    let (load, depth) = (low, largest(low).1);
    assert!(depth > 0.1, "{depth}");
    let errors: Vec<f64> = found.iter().map(|(l, _)| (l / load - 1.0).abs()).collect();
    assert!(
        errors[1] < 5e-3,
        "{errors:?}, exact {load} at {depth}: {found:?}"
    );
    assert!((found[1].1 - depth).abs() < 0.01, "{found:?} {depth}");
}

#[test]
fn surfaces_that_are_not_there_are_named() {
    for (change, words) in [
        (
            "bodies.half_plane.depth_from=half_plane.contct",
            "has no surface `half_plane.contct`, did you mean `half_plane.contact`?",
        ),
        (
            "bodies.half_plane.depth_from=cylinder.contact",
            "`cylinder.contact` is not one of body `half_plane`",
        ),
    ] {
        let profile = "bodies.half_plane.yield_by_depth=[[0.0, 900.0], [1.0, 500.0]]";
        let scene = load("cylinder_on_half_plane", &[profile, change, "reference=[]"]);
        let error = Model::new(&scene).map(|_| ()).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Input);
        assert!(error.message().contains(words), "{error}");
        assert!(error.message().contains("bodies.half_plane."), "{error}");
    }
    let mut scene = sheet("quad4", 0.0, &[1.0]);
    scene.bodies.get_mut("sheet").unwrap().depth_from = None;
    let error = Model::new(&scene).map(|_| ()).unwrap_err();
    let words = "bodies.sheet.yield_by_depth: no surface of the body may touch another";
    assert!(error.message().contains(words), "{error}");
}
