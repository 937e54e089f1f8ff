//! Beyond what the theory and its numbers carry: said, or refused, and ended.

use crate::support::{load, parse, try_run};
use brinell::analysis::Analysis;
use brinell::linalg::Backend;
use brinell::model::Model;
use brinell::progress::Silent;

fn pressed(kind: &str, modulus: f64, factor: f64) -> String {
    let (part, load, held) = match kind {
        "solid" => (
            "brick = { x = [0, 1], y = [0, 2], z = [0, 3], elements = [2, 2, 2] }",
            "[0.0, 0.0, -50.0]",
            "[{ on = \"block.bottom\", fix = [\"x\", \"y\", \"z\"] }]",
        ),
        _ => (
            "block = { x = [0, 1], y = [0, 2], elements = [2, 2] }",
            "[0.0, -50.0]",
            "[{ on = \"block.bottom\", fix = [\"x\", \"y\"] }]",
        ),
    };
    format!(
        "kind = \"{kind}\"\nload = [{{ on = \"block.top\", traction = {load} }}]\n\
         support = {held}\n[[mesh.parts]]\nbody = \"block\"\n{part}\n[materials.steel]\n\
         youngs_modulus = {modulus:?}\npoissons_ratio = 0.3\n[bodies.block]\nmaterial = \"steel\"\n\
         [program]\ntargets = [{{ load_factor = {factor:?} }}]\n"
    )
}

/// A modulus in GPa beside stresses in MPa: a strain of a quarter, which is no small one, whatever
/// the direction of the load.
#[test]
fn strains_that_are_not_small_are_warned_of() {
    for kind in ["plane_strain", "plane_stress", "axisymmetric", "solid"] {
        for factor in [1.0, -1.0] {
            let [wrong, right] = [210.0, 210_000.0].map(|modulus| {
                let scene = parse(&pressed(kind, modulus, factor));
                let warnings = try_run(&scene, Backend::default()).unwrap().warnings;
                warnings
                    .iter()
                    .any(|w| w.contains("look for units that contradict"))
            });
            assert!(wrong && !right, "{kind} {factor}: {wrong} {right}");
        }
    }
}

/// Loads whose stresses, or their squares, no number can hold end the run, with words.
#[test]
fn overflow_ends_and_is_named() {
    for factor in [1e160, 1e304, -1e304, 1.7e308] {
        for name in ["three_bodies", "contact_patch"] {
            let targets = format!("program.targets=[{{ load_factor = {factor:?} }}]");
            let scene = load(name, &[&targets, "program.unit=\"load\""]);
            let model = Model::new(&scene).unwrap();
            let ended = Analysis::new(model, Backend::default())
                .and_then(|mut analysis| analysis.run(&mut Silent));
            let is_said = match ended {
                Ok(results) => {
                    let warned = results
                        .warnings
                        .iter()
                        .any(|w| w.contains("taken for small"));
                    warned || results.incomplete.is_some() || !results.inaccurate.is_empty()
                }
                Err(error) => !error.to_string().is_empty(),
            };
            assert!(is_said, "{name} {factor:e}");
        }
    }
}
