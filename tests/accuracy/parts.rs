//! Each reported quantity has its three errors, and the error of the path is honest where a scene takes few increments.

use crate::effectivity::estimated;
use crate::running;
use brinell::accuracy::Extent;
use brinell::results::QuantityError;
use brinell::scene::{Scene, Stepping};

#[test]
fn every_quantity_has_a_value_and_three_errors() {
    let scene = running::load(
        "cylinder_on_half_plane",
        &[
            "mesh.cylinder_on_half_plane.resolution=6",
            "program.targets=[{ yield = true }, { name = \"pressed\", load_factor = 1.6 }, { name = \"unloaded\", load_factor = 0.0 }]",
        ],
    );
    let (results, accuracy) = estimated(&scene, Extent::Program);
    let find = |path: &str| -> &QuantityError {
        let row = accuracy.quantities.iter().find(|q| q.quantity == path);
        row.unwrap_or_else(|| panic!("{path}"))
    };
    let yielding = results.first_yield.unwrap();
    let pressed = results.states.iter().find(|s| s.name == "pressed").unwrap();
    let unloaded = results
        .states
        .iter()
        .find(|s| s.name == "unloaded")
        .unwrap();
    for (path, value) in [
        ("yield.load", yielding.load),
        ("yield.max_pressure", yielding.max_pressure),
        ("yield.half_width", yielding.half_width),
        ("states.pressed.max_pressure", pressed.max_pressure),
        ("states.pressed.half_width", pressed.half_width),
        ("states.pressed.approach", pressed.approach),
        (
            "states.pressed.plastic_zone_size",
            pressed.plastic_zone_size,
        ),
        ("states.unloaded.residual_depth", unloaded.residual_depth),
        ("states.pressed.pole_pressure", pressed.pole_pressure),
        (
            "states.pressed.max_equivalent_plastic_strain",
            pressed.max_equivalent_plastic_strain,
        ),
    ] {
        let row = find(path);
        assert_eq!(row.value, value, "{path}");
        assert!(row.value.abs() > 0.0, "{path}");
        let parts = [row.discretisation, row.path, Some(row.algebraic)];
        for part in parts {
            let part = part.unwrap_or_else(|| panic!("{path}: {row:?}"));
            assert!(part.is_finite() && part >= 0.0, "{path}: {row:?}");
        }
        // The mesh and round-off always count; the path does where it matters.
        assert!(
            row.discretisation > Some(0.0) && row.algebraic > 0.0,
            "{path}: {row:?}"
        );
        assert!(
            row.error.unwrap() >= row.discretisation.unwrap() + row.path.unwrap() + row.algebraic
        );
    }
    // The stated error takes that of the mesh one and a half times where meshes follow a law, else
    // twice. Half widths have bounds of their own.
    for row in &accuracy.quantities {
        let mesh = row.discretisation.unwrap();
        if mesh == 0.0 || row.quantity.ends_with("half_width") {
            continue;
        }
        let factor = (row.error.unwrap() - row.path.unwrap() - row.algebraic) / mesh;
        let off = (factor - 1.5).abs().min((factor - 2.0).abs());
        assert!(off < 1e-9, "{row:?}: {factor}");
    }
    // What flows has the error of its increments.
    assert!(find("states.unloaded.residual_depth").path.unwrap() > 0.0);
}

#[test]
fn an_elastic_path_is_exact_and_says_so() {
    let scene = running::load(
        "ball_on_half_space",
        &["mesh.cylinder_on_half_plane.resolution=6"],
    );
    let (_, accuracy) = estimated(&scene, Extent::Yield);
    assert!(accuracy.quantities.iter().all(|q| q.path == Some(0.0)));
}

/// Without contact `stepping = "events"` takes one increment from target to target. What the increments leave is known from a run with
/// a hundred times as many.
#[test]
fn few_increments_state_the_error_that_they_make() {
    let tube = |element: &str| -> Scene {
        running::load(
            "thick_cylinder",
            &[
                &format!("mesh.parts.0.element={element}"),
                "mesh.parts.0.ring.elements=[16,6]",
                "program.targets=[{ name = \"pressed\", load_factor = 180.0 }, { name = \"unloaded\", load_factor = 0.0 }]",
            ],
        )
    };
    for element in ["quad4", "quad8"] {
        let scene = tube(element);
        let (results, accuracy) = estimated(&scene, Extent::Program);
        assert!(results.history.len() <= 3, "{}", results.history.len());
        let mut fine = scene.clone();
        fine.program.stepping = Stepping::Steps;
        fine.program.steps = 100;
        let exact = running::run(&fine);
        for name in ["pressed", "unloaded"] {
            let limit = exact
                .states
                .iter()
                .find(|s| s.name == name)
                .unwrap()
                .approach;
            let path = format!("states.{name}.approach");
            let row = accuracy
                .quantities
                .iter()
                .find(|q| q.quantity == path)
                .unwrap();
            let (stated, made) = (row.path.unwrap(), (row.value - limit).abs());
            println!("{element} {path}: path {stated:.2e}, made {made:.2e}, of {limit:.2e}");
            // Twice the change from n to 2n is the error of the first order; higher orders make it less.
            assert!(
                stated >= 0.5 * made,
                "{element} {path}: {stated:e} {made:e}"
            );
            assert!(
                stated <= 5.0 * made + 1e-9 * limit.abs(),
                "{element} {path}: {stated:e} {made:e}"
            );
        }
    }
}
