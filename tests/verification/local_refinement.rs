//! `mesh.refine`: smaller elements around points of a plane mesh.

use crate::accuracy::demand::reached;
use crate::support::{close, healthy, parse, run, state};
use brinell::accuracy::Extent;
use brinell::analytical::HertzPoint;
use brinell::model::Model;
use brinell::scene::Scene;

/// A block of 4 by 4 units, refined as the lines say.
fn block(kind: &str, element: &str, n: usize, refine: &str) -> String {
    format!(
        r#"kind = "{kind}"
[mesh]
{refine}
[[mesh.parts]]
body = "block"
element = "{element}"
block = {{ x = [0.0, 4.0], y = [-4.0, 0.0], elements = [{n}, {n}] }}
[materials.soft]
youngs_modulus = 210e3
poissons_ratio = 0.3
yield_stress = 200.0
[bodies.block]
material = "soft"
[[support]]
on = "block.left"
fix = ["x"]
[[support]]
on = "block.bottom"
fix = ["y"]
"#
    )
}

/// The block under a rigid ball of radius 10, whose contact at first yield has a radius of 0.02.
fn under_a_ball(element: &str, n: usize, refine: &str) -> Scene {
    parse(&format!(
        r#"{}
[rigid.ball]
sphere = {{ center = [0.0, 10.0], radius = 10.0 }}
[[contact]]
first = "ball"
second = "block.top"
[[load]]
on = "ball"
force = [0.0, -1.0]
[program]
unit = "yield"
targets = [{{ yield = true }}]
"#,
        block("axisymmetric", element, n, refine)
    ))
}

/// `1/E* = (1 - nu^2)/E` of the block alone (K. L. Johnson, Contact Mechanics, 1985, section 4.2).
fn hertz() -> HertzPoint {
    HertzPoint::new(10.0, 210e3 / (1.0 - 0.09)).unwrap()
}

/// Uniform stress is exact whatever the elements: sides of divided elements fit together.
#[test]
fn uniform_stress_is_exact() {
    let places = "refine = [{ at = [1.0, 0.0], radius = 0.1, times = 3 }, \
                  { at = [2.3, -1.8], radius = 0.2, times = 2 }]";
    for element in ["tri3", "tri6", "quad4", "quad8"] {
        let load = "[[load]]\non = \"block.top\"\npressure = 10.0\n[program]\n\
                    targets = [{ name = \"pressed\", load_factor = 1.0 }]";
        let text = block("plane_strain", element, 4, places) + load;
        let results = run(&parse(&text));
        healthy(&results);
        assert!(results.sizes.elements > 100, "{element}");
        let fields = state(&results, "pressed").fields.as_ref().unwrap();
        for stress in fields.stress.chunks(4) {
            close(element, stress[1], -10.0, 10.0, 1e-10);
            close(element, stress[0], 0.0, 10.0, 1e-10);
            close(element, stress[3], 0.0, 10.0, 1e-10);
        }
    }
}

/// Four elements along each side of a block and nine halvings of them, to eleven elements over the
/// radius of the contact: the load at first yield of Hertz' closed form.
#[test]
fn a_coarse_mesh_refined_at_the_contact_knows_its_first_yield() {
    let exact = hertz().yield_load(0.3, 200.0);
    for (element, most) in [("quad4", 0.03), ("quad8", 0.02), ("tri6", 0.02)] {
        let places = "refine = [{ at = [0.0, 0.0], radius = 0.05, times = 9 }]";
        let results = run(&under_a_ball(element, 4, places));
        healthy(&results);
        assert!(results.sizes.elements < 8000, "{element}");
        let load = results.first_yield.as_ref().unwrap().load;
        println!(
            "{element}: {} elements, {:+.4}",
            results.sizes.elements,
            load / exact - 1.0
        );
        assert!(
            (load / exact - 1.0).abs() < most,
            "{element}: {load} {exact}"
        );
    }
}

/// A mesh whose elements are seven times as large as the contact at first yield: the demand finds
/// where it has to be refined, and the true error is within the stated one.
#[test]
fn a_demand_refines_the_mesh_where_it_does_not_resolve_the_contact() {
    let scene = under_a_ball("quad8", 12, "");
    let found = reached(&scene, "yield.load = 5 %", Extent::Yield);
    let [refinement] = &found.scene.mesh.refine[..] else {
        panic!("{:?}", found.scene.mesh.refine);
    };
    assert!(refinement.at[0].abs() < 0.05 && refinement.radius < 0.2);
    assert!(refinement.times >= 4, "{refinement:?}");
    let load = found.results.first_yield.as_ref().unwrap().load;
    let exact = hertz().yield_load(0.3, 200.0);
    let accuracy = found.results.accuracy.as_ref().unwrap();
    let stated = accuracy.demand.as_ref().unwrap().stated;
    assert!(
        (load / exact - 1.0).abs() < stated,
        "{load} {exact} {stated}"
    );
}

/// A run on such a mesh says how to refine it.
#[test]
fn a_run_that_does_not_resolve_its_contact_says_how() {
    use brinell::accuracy::{Effort, estimate};
    use brinell::{linalg::Backend, progress::Silent};
    let scene = under_a_ball("quad4", 12, "");
    let results = run(&scene);
    let backend = Backend::default();
    let effort = Effort::Quick;
    let found = estimate(
        &scene,
        backend,
        &results,
        Extent::Program,
        effort,
        &mut Silent,
    );
    let note = found.notes.iter().find(|note| note.contains("mesh.refine"));
    let note = note.unwrap_or_else(|| panic!("{:?}", found.notes));
    let line = note
        .split('`')
        .find(|part| part.contains("mesh.refine"))
        .unwrap();
    // The words are a key of the scene.
    let refined = under_a_ball("quad4", 12, line.trim_start_matches("mesh."));
    assert_eq!(refined.mesh.refine.len(), 1);
    let finer = run(&refined);
    let pairs = |r: &brinell::results::Results| {
        let first = r.first_yield.as_ref().unwrap();
        (first.half_width, first.half_width_reading.pairs)
    };
    assert!(pairs(&finer).0 < 0.5 * pairs(&results).0, "{note}");
}

#[test]
fn solids_and_wrong_values_are_refused() {
    let refused = |text: &str| {
        let program = "[program]\ntargets = [{ load_factor = 1.0 }]";
        let load = "[[load]]\non = \"block.top\"\npressure = 10.0";
        let text = format!("{text}{load}\n{program}\n");
        let error = Scene::parse(&text, "scene.toml").and_then(|scene| Model::new(&scene));
        error.err().unwrap().to_string()
    };
    let solid = block(
        "solid",
        "hex8",
        2,
        "refine = [{ at = [0.0, 0.0], radius = 1.0, times = 1 }]",
    )
    .replace(
        "block = { x = [0.0, 4.0], y = [-4.0, 0.0], elements = [2, 2] }",
        "brick = { x = [0.0, 1.0], y = [0.0, 1.0], z = [0.0, 1.0], elements = [2, 2, 2] }",
    );
    let error = refused(&solid);
    assert!(
        error.contains("mesh.refine") && error.contains("plane meshes"),
        "{error}"
    );
    for (value, word) in [
        (
            "at = [0.0, 0.0], radius = -1.0, times = 1",
            "mesh.refine.0.radius",
        ),
        (
            "at = [0.0, 0.0], radius = 1.0, times = 0",
            "mesh.refine.0.times",
        ),
        (
            "at = [0.0, 0.0], radius = 1.0, times = 99",
            "mesh.refine.0.times",
        ),
        (
            "at = [nan, 0.0], radius = 1.0, times = 1",
            "mesh.refine.0.at",
        ),
        ("at = [0.0, 0.0], radius = 5.0, times = 20", "pass 11 of 20"),
    ] {
        let refine = format!("refine = [{{ {value} }}]");
        let error = refused(&block("plane_strain", "quad4", 4, &refine));
        assert!(error.contains(word), "{value}: {error}");
    }
}

/// The section is refined before it is drawn out.
#[test]
fn a_refined_section_is_extruded() {
    let places = "refine = [{ at = [1.0, 0.0], radius = 0.1, times = 2 }]\n\
                  extrude = { depth = 1.0, elements = 2 }";
    let load = "[[support]]\non = \"block.front\"\nfix = [\"z\"]\n\
                [[load]]\non = \"block.top\"\npressure = 10.0\n[program]\n\
                targets = [{ name = \"pressed\", load_factor = 1.0 }]";
    let results = run(&parse(&(block("solid", "quad4", 4, places) + load)));
    healthy(&results);
    let fields = state(&results, "pressed").fields.as_ref().unwrap();
    for stress in fields.stress.chunks(6) {
        close("extruded", stress[1], -10.0, 10.0, 1e-10);
        close("extruded", stress[2], 0.0, 10.0, 1e-10);
    }
}
