//! Contacts of two bodies on meshes as a mesher makes them: unlike, graded, jittered, of all
//! shapes, in every kind of model, from elastic to far beyond yield.
//!
//! Codes that follow yielding and contact at once give up where the one upsets the other: a load
//! under which all points balance, and a pair that closes meanwhile. Passing means that the default
//! settings come to the end of the program, or to a limit load that fixed increments find, too.

use crate::support::msh::{Body, Msh};
use crate::support::random::Random;
use crate::support::{either, run_text_as_far_as_it_goes};
use brinell::ErrorKind;
use brinell::results::Results;
use std::path::Path;

const YIELD: [f64; 2] = [200.0, 800.0];

/// A body pressed onto a plate: the scene, its mesh in `folder`.
fn model(seed: u64, folder: &Path) -> String {
    let mut random = Random::new(seed);
    let random = &mut random;
    let kind = random.one_of(&[
        "plane_strain",
        "plane_stress",
        "axisymmetric",
        "plane_strain",
        "axisymmetric",
        "solid",
    ]);
    let radius = random.one_of(&[3.0f64, 5.0, 10.0, 20.0]);
    let shape = random.one_of(&["round", "round", "punch", "flat"]);
    let base = random.one_of(&[1.0, 1.5, 3.0]);
    let grading = random.one_of(&[1.0, 1.0, 1.5, 2.0]);
    let jitter = random.one_of(&[0.0, 0.3, 0.6]);
    const FLAT: f64 = 0.3;
    let round = |x: f64| radius - (radius * radius - x * x).sqrt();
    let punch = |x: f64| 2.5 * (x - FLAT).max(0.0).powi(2) / radius;
    let flat = |_: f64| 0.0;
    let bottom: &dyn Fn(f64) -> f64 = match shape {
        "round" => &round,
        "punch" => &punch,
        _ => &flat,
    };
    let is_solid = kind == "solid";
    let mut cells = || match is_solid {
        true => [2 + random.below(3), 2 + random.below(2)],
        false => [3 + random.below(8), 2 + random.below(7)],
    };
    let [top, under] = [|_: f64| 2.0, |_: f64| -3.0];
    let bodies = [
        Body {
            name: "plate",
            from: 0.0,
            width: base,
            cells: cells(),
            heights: [&under, &flat],
            kink: None,
            grading,
            jitter,
        },
        Body {
            name: "upper",
            from: 0.0,
            width: 1.0,
            cells: cells(),
            heights: [bottom, &top],
            kink: (shape == "punch").then_some(FLAT),
            grading,
            jitter,
        },
    ];
    let triangles = random.share() < 0.5;
    let order = 1 + random.below(2);
    // Quadratic faces across the punch's edge, where no nodes lie in space, would bulge.
    let order = if is_solid && shape == "punch" {
        1
    } else {
        order
    };
    let mut msh = Msh::default();
    for body in &bodies {
        match is_solid {
            true => body.solid(&mut msh, triangles, order, random),
            false => body.plane(&mut msh, triangles, order, random),
        }
    }
    let file = folder.join(format!("{seed}.msh"));
    std::fs::write(&file, msh.text()).unwrap();

    let up = if is_solid { "z" } else { "y" };
    let yield_stress = random.one_of(&YIELD);
    let load = match random.share() < 0.35 {
        true => {
            let down = random.one_of(&[0.003, 0.01, 0.03]) * yield_stress / 400.0;
            format!("displacement = {{ {up} = {} }}", -down)
        }
        false => {
            let pressure = random.one_of(&[0.1, 0.3, 0.6, 1.0]) * yield_stress;
            let still = if is_solid { "0.0, 0.0" } else { "0.0" };
            format!("traction = [{still}, {}]", -pressure)
        }
    };
    let axes: &[(&str, &str)] = match is_solid {
        true => &[("axis 0", "x"), ("axis 1", "y")],
        false => &[("axis", "x")],
    };
    let held = ["plate", "upper"].map(|body| {
        let on_axes = axes
            .iter()
            .map(|(axis, fix)| format!("{{ on = \"{body} {axis}\", fix = [\"{fix}\"] }}"));
        on_axes.collect::<Vec<_>>().join(", ")
    });
    let which = random.one_of(&[["p", "p"], ["p", "p"], ["p", "e"], ["e", "p"]]);
    let surfaces = match random.share() < 0.7 {
        true => ["upper bottom", "plate top"],
        false => ["plate top", "upper bottom"],
    };
    format!(
        "kind = \"{kind}\"
mesh.file = {file:?}
contact = [{{ first = \"{}\", second = \"{}\" }}]
materials.e = {{ youngs_modulus = 210e3, poissons_ratio = 0.3 }}
materials.p = {{ youngs_modulus = 210e3, poissons_ratio = 0.3, yield_stress = {yield_stress},
                plastic_modulus = {} }}
bodies = {{ plate.material = \"{}\", upper.material = \"{}\" }}
support = [{{ on = \"plate bottom\", fix = [\"{up}\"] }}, {}, {}]
load = [{{ on = \"upper top\", {load} }}]
program.targets = [{{ yield = true }}, {{ load_factor = 1.0 }}, {{ load_factor = 0.0 }}]
",
        surfaces[0],
        surfaces[1],
        random.one_of(&[0.0, 210.0, 2100.0, 21000.0]),
        which[0],
        which[1],
        held[0],
        held[1],
    )
}

/// The load factor at which a run came to its limit load; `None` where it reached its end.
fn limit(results: &Results, what: &str) -> Option<f64> {
    let kind = results.ending().kind()?;
    assert_eq!(
        kind,
        ErrorKind::Collapse,
        "{what}\n{:?}",
        results.incomplete
    );
    results.history.last().map(|row| row.alpha)
}

#[test]
fn default_settings_come_to_the_end_or_to_a_limit_load() {
    let folder = tempfile::tempdir().unwrap();
    let (mut yielded, mut limits) = (0, 0);
    for seed in 1..=either(100, 500) {
        let text = model(seed, folder.path());
        let results = run_text_as_far_as_it_goes(&text);
        yielded += usize::from(results.states.iter().any(|state| state.plastic_points > 0));
        if let Some(held) = limit(&results, &text) {
            limits += 1;
            let steps = text.replace("program.", "program.stepping = \"steps\"\nprogram.");
            let steps = run_text_as_far_as_it_goes(&steps);
            let other = limit(&steps, &text).expect("a limit load");
            // Known to a millionth of the step, and to the tolerance of contact.
            assert!(
                (held - other).abs() <= 1e-3 * held,
                "{held} {other}\n{text}"
            );
        }
    }
    println!("{yielded} yielded, {limits} came to a limit load");
    assert!(yielded > either(50, 250), "{yielded}");
}
