//! Meshes whose file gives coordinates to a few decimal places: round bodies are not quite round,
//! and surfaces that touch overlap a little.
//!
//! Passing means that the run is complete and trusted, with the results of the same mesh in full
//! precision, and that a warning says what was held or taken off.

use crate::support::msh::{Body, Disc, Msh};
use crate::support::random::Random;
use crate::support::{either, parse, run_model, run_text};
use brinell::linalg::Backend;
use brinell::mesh::Mesh;
use brinell::model::Model;
use brinell::scene::Scene;
use std::f64::consts::TAU;

/// A pin ring in the hole of another ring, and the direction in which it is pushed.
fn pin_in_hole(random: &mut Random) -> Scene {
    let element = random.one_of(&["quad4", "quad8", "tri6"]);
    // Facets of linear elements need a gap that they fit into, or a neat fit of matching facets.
    let clearance = match element {
        "quad4" => 0.0,
        _ => random.one_of(&[0.0, 0.02]),
    };
    let of_hole = match element {
        "quad4" => 0,
        _ => 2 * random.below(4),
    };
    let radius = 5.0;
    let around = 16 + 2 * random.below(6);
    let [x, y] = [random.within(-9.0, 9.0), random.within(-9.0, 9.0)];
    let turned = random.within(0.0, 360.0);
    let angle = random.within(0.0, TAU);
    let kind = random.one_of(&["plane_strain", "plane_stress"]);
    let (first, second) = random.one_of(&[("pin.outer", "lug.inner"), ("lug.inner", "pin.outer")]);
    parse(&format!(
        r#"
kind = "{kind}"
materials.steel = {{ youngs_modulus = 210e3, poissons_ratio = 0.3, density = 1.0 }}
bodies = {{ pin.material = "steel", lug.material = "steel" }}
contact = [{{ first = "{first}", second = "{second}" }}]
support = [{{ on = "lug.outer", fix = ["x", "y"] }}]
load = [{{ on = "pin", acceleration = [{:?}, {:?}] }}]
program.targets = [{{ load_factor = 1.0 }}, {{ load_factor = 0.0 }}]
[[mesh.parts]]
body = "pin"
element = "{element}"
[mesh.parts.ring]
center = [{x:?}, {y:?}]
radius = [2.0, {radius:?}]
angle = [{turned:?}, {:?}]
elements = [3, {around}]
[[mesh.parts]]
body = "lug"
element = "{element}"
[mesh.parts.ring]
center = [{x:?}, {y:?}]
radius = [{:?}, 11.0]
angle = [{turned:?}, {:?}]
elements = [3, {}]
"#,
        angle.cos(),
        angle.sin(),
        turned + 360.0,
        radius + clearance,
        turned + 360.0,
        around + of_hole,
    ))
}

/// The mesh of a scene as a file brings it: without curves, its coordinates to `places` decimal
/// places.
fn from_file(scene: &Scene, places: Option<i32>) -> Mesh {
    let mut mesh = Model::new(scene).unwrap().mesh.clone();
    mesh.surfaces.values_mut().for_each(|s| s.curve = None);
    if let Some(places) = places {
        for x in &mut mesh.coordinates {
            *x = format!("{x:.*}", places as usize).parse().unwrap();
        }
    }
    mesh
}

/// A pin that fits its hole, or has a little room in it, gives the pressure of the exact mesh on a
/// mesh of 6 to 9 decimal places.
#[test]
fn a_pin_turns_in_its_hole_on_a_mesh_of_few_digits() {
    let mut warned = [0; 2];
    for seed in 0..either(12, 120) {
        let mut random = Random::new(seed);
        let scene = pin_in_hole(&mut random);
        let run = |places| {
            let model = Model::from_mesh(&scene, from_file(&scene, places)).unwrap();
            run_model(model, Backend::default())
        };
        let exact = run(None);
        for places in [6, 7, 9] {
            let results = run(Some(places));
            let what = format!("seed {seed}, {places} places");
            assert!(
                results.incomplete.is_none(),
                "{what}: {:?}",
                results.incomplete
            );
            assert!(
                results.inaccurate.is_empty(),
                "{what}: {:?}",
                results.inaccurate
            );
            let [is, was] = [&results, &exact].map(|r| r.states[0].max_pressure);
            assert!((is / was - 1.0).abs() <= 0.01, "{what}: {is} for {was}");
            let says = |words: &str| results.warnings.iter().any(|text| text.contains(words));
            warned[0] += usize::from(says("can rotate about"));
            warned[1] += usize::from(says("because the mesh gives its coordinates to 1e-"));
        }
    }
    assert!(warned.iter().all(|n| *n > 0), "{warned:?}");
}

/// An overlap that is larger than the last decimal place is still refused, and one that the scene
/// takes for an interference is kept.
#[test]
fn an_overlap_of_more_than_the_last_place_is_refused() {
    let scene = pin_in_hole(&mut Random::new(2));
    let with = |scene: &Scene, deeper: f64| {
        let mut mesh = from_file(scene, Some(6));
        let pin = mesh.set_nodes("pin.outer").unwrap();
        let center = mesh
            .set_nodes("lug.outer")
            .unwrap()
            .iter()
            .fold([0.0; 2], |sum, &node| {
                let (x, share) = (
                    mesh.point(node),
                    1.0 / mesh.set_nodes("lug.outer").unwrap().len() as f64,
                );
                [sum[0] + share * x[0], sum[1] + share * x[1]]
            });
        for node in pin {
            for axis in 0..2 {
                let x = &mut mesh.coordinates[2 * node + axis];
                let out = (*x - center[axis]) / 5.0;
                *x = format!("{:.6}", *x + deeper * out).parse().unwrap();
            }
        }
        Model::from_mesh(scene, mesh)
    };
    let why = with(&scene, 1e-4).unwrap_err();
    assert!(
        why.message().contains("in the mesh; move the bodies apart"),
        "{why}"
    );
    let mut fitted = scene.clone();
    fitted.contact[0].overlap = true;
    let model = with(&fitted, 1e-6).unwrap();
    assert!(model.pairs.iter().any(|pair| pair.interference > 0.0));
}

/// The refinement of a mesh of few digits computes places with all digits, and the surfaces that
/// touch still overlap by the last decimal place of the file.
#[test]
fn a_refined_mesh_of_few_digits_fits_as_well() {
    let folder = tempfile::tempdir().unwrap();
    let mut msh = Msh::default();
    let disc = Disc {
        name: "disc",
        center: [0.0, 0.0],
        radius: 1.0,
        angles: (0..24).map(|k| f64::from(k) / 24.0).collect(),
        rings: 2,
    };
    disc.plane(&mut msh, 2);
    let block = Body {
        name: "block",
        from: -1.0,
        width: 2.0,
        cells: [16, 4],
        heights: [&|_| -3.0, &|_| -1.0],
        kink: None,
        grading: 1.0,
        jitter: 0.0,
    };
    block.plane(&mut msh, false, 2, &mut Random::new(1));
    // Turned, so that no coordinate of the flat surface is exact.
    let [s, c] = [0.3f64.sin(), 0.3f64.cos()];
    let rounded = |x: f64| (1e7 * x).round() / 1e7;
    msh.map(|[x, y, z]| [rounded(c * x - s * y), rounded(s * x + c * y), z]);
    let file = folder.path().join("disc.msh");
    std::fs::write(&file, msh.text()).unwrap();
    for times in 0..3 {
        let text = format!(
            r#"
kind = "plane_strain"
materials.steel = {{ youngs_modulus = 210e3, poissons_ratio = 0.3 }}
bodies = {{ disc.material = "steel", block.material = "steel" }}
contact = [{{ first = "disc outline", second = "block top" }}]
support = [{{ on = "block bottom", fix = ["x", "y"] }}]
load = [{{ on = "disc outline", force = [{:?}, {:?}] }}]
program.targets = [{{ load_factor = 1.0 }}]
[mesh]
file = {:?}
subdivisions = {times}
"#,
            100.0 * s,
            -100.0 * c,
            file.display().to_string(),
        );
        let results = run_text(&text);
        assert!(
            results.inaccurate.is_empty(),
            "{times}: {:?}",
            results.inaccurate
        );
        let force = results.states[0].contact_force;
        assert!((force / 100.0 - 1.0).abs() <= 1e-6, "{times}: {force}");
    }
}

/// A block on another, both turned in space, with the load along the normal of their faces: the
/// mesh of few digits gives the pressure of the exact one. The faces are planes only to within the
/// last decimal place, so forces balance to that, and a state that is off by more than usual says
/// so.
#[test]
fn blocks_on_a_plane_at_any_angle() {
    for seed in 0..either(3, 30) {
        let mut random = Random::new(seed);
        let [a, b] = [0, 1].map(|_| random.within(0.2, 1.2));
        let turn = |[x, y, z]: [f64; 3]| {
            let [x, y] = [a.cos() * x - a.sin() * y, a.sin() * x + a.cos() * y];
            [x, b.cos() * y - b.sin() * z, b.sin() * y + b.cos() * z]
        };
        let mut cells = || 2 + random.below(3);
        let [low, up] = [[cells(), cells(), 2], [cells(), cells(), 2]];
        let scene = |[x, y, z]: [f64; 3]| {
            parse(&format!(
                r#"
kind = "solid"
materials.steel = {{ youngs_modulus = 210e3, poissons_ratio = 0.3 }}
bodies = {{ low.material = "steel", up.material = "steel" }}
contact = [{{ first = "up.bottom", second = "low.top" }}]
support = [{{ on = "low.bottom", fix = ["x", "y", "z"] }}]
load = [{{ on = "up.top", force = [{x:?}, {y:?}, {z:?}] }}]
program.targets = [{{ load_factor = 1.0 }}]
[[mesh.parts]]
body = "low"
element = "hex8"
brick = {{ x = [0, 3], y = [0, 3], z = [-2, 0], elements = {low:?} }}
[[mesh.parts]]
body = "up"
element = "hex8"
brick = {{ x = [0.5, 2.1], y = [0.7, 2.3], z = [0, 1.5], elements = {up:?} }}
"#
            ))
        };
        let force = [0.0, 0.0, -30.0];
        let (upright, scene) = (from_file(&scene(force), None), scene(turn(force)));
        let state = |places: Option<i32>| {
            let mut mesh = upright.clone();
            for x in mesh.coordinates.chunks_mut(3) {
                x.copy_from_slice(&turn([x[0], x[1], x[2]]));
                for x in x.iter_mut() {
                    if let Some(places) = places {
                        *x = format!("{x:.*}", places as usize).parse().unwrap();
                    }
                }
            }
            let model = Model::from_mesh(&scene, mesh).unwrap();
            let results = run_model(model, Backend::default());
            assert!(results.incomplete.is_none(), "{:?}", results.incomplete);
            results.states[0].clone()
        };
        let exact = state(None).max_pressure;
        for places in [6, 8] {
            let off = state(Some(places)).max_pressure / exact - 1.0;
            // The last decimal place, over edges of a third, and a factor for the edge of contact.
            let bound = 1e2 * 10f64.powi(-places);
            assert!(off.abs() <= bound, "seed {seed}, {places} places: {off:e}");
        }
    }
}
