//! Each reported quantity has its three errors, and the error of the path is honest where a scene
//! takes few increments.

use crate::support;
use brinell::accuracy::{Effort, Extent, estimate, quantities, value_of, work};
use brinell::analytical::ThickSphere;
use brinell::linalg::Backend;
use brinell::progress::Silent;
use brinell::results::{Accuracy, EstimateMethod, QuantityError, Results};
use brinell::scene::{Scene, Stepping};

pub fn estimated(scene: &Scene, extent: Extent) -> (Results, Accuracy) {
    let results = match extent {
        Extent::Yield => support::yield_load(scene),
        Extent::Program => support::run(scene),
    };
    let accuracy = estimate(
        scene,
        Backend::default(),
        &results,
        extent,
        Effort::Full,
        &mut Silent,
    );
    assert_eq!(accuracy.notes, Vec::<String>::new());
    assert_eq!(accuracy.method, EstimateMethod::CoarserMeshes);
    (results, accuracy)
}

#[test]
fn every_quantity_has_a_value_and_three_errors() {
    let scene = support::load(
        "cylinder_on_half_plane",
        &[
            "mesh.cylinder_on_half_plane.resolution=6",
            "program.targets=[{ yield = true }, { name = \"pressed\", load_factor = 1.6 }, \
             { name = \"unloaded\", load_factor = 0.0 }]",
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
        let sum: f64 = parts.iter().flatten().sum();
        assert!((row.error.unwrap() / sum - 1.0).abs() < 1e-12, "{path}");
        if let Some(limit) = row.extrapolated {
            assert!(
                (limit - row.value).abs() <= row.discretisation.unwrap(),
                "{path}"
            );
        }
    }
    // What yields has the error of its increments.
    assert!(find("states.unloaded.residual_depth").path.unwrap() > 0.0);
}

#[test]
fn an_elastic_path_is_exact_and_says_so() {
    let scene = support::load(
        "ball_on_half_space",
        &["mesh.cylinder_on_half_plane.resolution=6"],
    );
    let (_, accuracy) = estimated(&scene, Extent::Yield);
    assert!(accuracy.quantities.iter().all(|q| q.path == Some(0.0)));
}

/// Without contact `stepping = "events"` takes one increment from target to target. What the
/// increments leave is known from a run with a hundred times as many.
#[test]
fn few_increments_state_the_error_that_they_make() {
    let tube = |element: &str| -> Scene {
        support::load(
            "thick_cylinder",
            &[
                &format!("mesh.parts.0.element={element}"),
                "mesh.parts.0.ring.elements=[16,6]",
                "program.stepping=events",
                "program.targets=[{ name = \"pressed\", load_factor = 180.0 }, \
                 { name = \"unloaded\", load_factor = 0.0 }]",
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
        let exact = support::run(&fine);
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
            // Twice the change from n to 2n is the error of the first order; higher orders make it
            // less.
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

/// The dent after a half width as target carries the error of the load at which each mesh reaches
/// that width, and the run says so; with the load as target there is nothing to say.
#[test]
fn a_half_width_as_target_says_what_it_adds() {
    let estimated = |target: &str| {
        let targets =
            format!("program.targets=[{{ name = \"wide\", {target} }}, {{ load_factor = 0.0 }}]");
        let scene = support::load(
            "cylinder_on_half_plane",
            &[
                &targets,
                "mesh.cylinder_on_half_plane.resolution=8",
                "mesh.cylinder_on_half_plane.growth=1.32",
            ],
        );
        let results = support::run(&scene);
        estimate(
            &scene,
            Backend::default(),
            &results,
            Extent::Program,
            Effort::Full,
            &mut Silent,
        )
    };
    let by_width = estimated("half_width = 1.4");
    let by_load = estimated("load_factor = 2.2");
    let note = by_width
        .notes
        .iter()
        .find(|n| n.starts_with("a half width as target"));
    let load = by_width
        .quantities
        .iter()
        .find(|q| q.quantity == "states.wide.load")
        .unwrap();
    assert!(load.relative_error.unwrap() > 0.0);
    assert!(
        note.is_some_and(|n| n.contains("`wide`: ") && n.contains(" %")),
        "{note:?}"
    );
    assert_eq!(by_load.notes, Vec::<String>::new());
    // The load that leaves a dent is an answer with an error, the dent is what was asked for.
    let by_dent = estimated("residual_depth = 5e-5");
    let of = |quantity: &str| {
        let row = by_dent.quantities.iter().find(|q| q.quantity == quantity);
        row.unwrap().relative_error.unwrap()
    };
    let (load, dent) = (of("states.wide.load"), of("states.alpha 0.residual_depth"));
    assert!(load > 1e-4 && dent < 1e-6, "{load:e} {dent:e}");
    let note = &by_dent.notes[0];
    assert!(note.starts_with("residual_depth as target is reached at another load"));
}

/// What a scene gives has no error: a load of a state at a load factor, and the approach where that
/// scales a prescribed displacement; the answer of the bodies has one.
#[test]
fn what_a_scene_gives_has_no_row() {
    for (scene, given, answer) in [
        ("flat_punch", "approach", "load"),
        ("ball_on_half_space", "load", "approach"),
    ] {
        let targets = "program.targets=[{ name = \"s\", load_factor = 0.1 }]";
        let scene = support::load(scene, &[targets, "program.unit=\"load\""]);
        let results = support::run(&scene);
        let paths: Vec<String> = quantities(&results).into_iter().map(|q| q.path).collect();
        assert!(!paths.contains(&format!("states.s.{given}")), "{paths:?}");
        assert!(paths.contains(&format!("states.s.{answer}")), "{paths:?}");
    }
}

/// By default other runs take no more operations than the run, and the errors that they state are
/// of the size of those that the full estimate states.
#[test]
fn the_default_estimate_takes_no_more_than_the_run() {
    let scene = support::load(
        "ball_on_half_space",
        &["mesh.cylinder_on_half_plane.resolution=12"],
    );
    let results = support::run(&scene);
    let of = |effort| {
        let (backend, extent) = (Backend::default(), Extent::Program);
        estimate(&scene, backend, &results, extent, effort, &mut Silent)
    };
    let [quick, full] = [Effort::Quick, Effort::Full].map(of);
    assert_eq!(quick.method, EstimateMethod::CoarserMeshes);
    assert!(quick.companions.iter().all(|c| c.ratio > 1.0));
    assert!(
        quick.work <= work(&results),
        "{}",
        quick.work / work(&results)
    );
    let load = |found: &Accuracy| {
        let row = found.quantities.iter().find(|q| q.quantity == "yield.load");
        row.unwrap().relative_error.unwrap()
    };
    let ratio = load(&quick) / load(&full);
    assert!((0.1..10.0).contains(&ratio), "{ratio}");
}

/// What the scene follows has errors at each state: displacements of sets, which depend on the
/// mesh, and forces on them, which do where a node belongs to two sides.
#[test]
fn columns_of_the_history_have_errors() {
    let scene = |n: usize| {
        support::load(
            "thick_cylinder",
            &[
                "mesh.parts.0.element=quad4",
                &format!("mesh.parts.0.ring.elements=[{n},{n}]"),
                "program.history=[\"tube.outer\", \"tube.start\"]",
                "program.targets=[{ yield = true }, { name = \"pressed\", load_factor = 170.0 }, \
                 { name = \"off\", load_factor = 0.0 }]",
            ],
        )
    };
    let (results, accuracy) = estimated(&scene(12), Extent::Program);
    let finer = support::run(&scene(60));
    let exact = quantities(&finer);
    let mut judged = 0;
    for (quantity, row) in quantities(&results).iter().zip(&accuracy.quantities) {
        if !row.quantity.contains(".history.") {
            continue;
        }
        let (truth, stated) = (value_of(&exact, &row.quantity).unwrap(), row.error.unwrap());
        assert!((row.value - truth).abs() <= stated, "{truth} {row:?}");
        let words = if quantity.kind == "set force" {
            "forces on"
        } else {
            "displacements of"
        };
        assert_eq!(row.of_part().unwrap(), format!("{words} sets"));
        judged += usize::from(stated > 1e-4 * quantity.scale);
        let most = if quantity.kind == "set force" {
            0.1
        } else {
            0.05
        };
        assert!(stated < most * quantity.scale, "{row:?}");
    }
    // Both directions of the outer surface and the radial one of the plane, in three states.
    assert!(judged >= 8, "{judged}");
}

/// Stresses at places, here those that stay in a hollow sphere that flowed from its bore outwards,
/// have errors that hold against their closed form (Hill).
#[test]
fn residual_stresses_at_places_have_errors() {
    let sphere = ThickSphere::new(100.0, 200.0, 210e3, 0.3, 240.0).unwrap();
    let mut judged = 0;
    for (element, n) in [("quad4", 16), ("quad8", 12)] {
        let mut entries = Vec::new();
        for r in [100.0, 150.0, 200.0] {
            let [radial, hoop] = sphere.residual_stress(r, 200.0).unwrap();
            for (key, value) in [("stress_rr", radial), ("stress_tt", hoop)] {
                entries.push(format!(
                    "{{ quantity = \"states.off.{key}\", at = [{r:?}, 0.0], value = {value:?}, \
                     source = \"Hill\" }}"
                ));
            }
        }
        let scene = support::load(
            "thick_sphere",
            &[
                &format!("mesh.parts.0.element={element}"),
                &format!("mesh.parts.0.ring.elements=[{n},{n}]"),
                &format!("reference=[{}]", entries.join(", ")),
                "program.targets=[{ name = \"pressed\", load_factor = 200.0 }, \
                 { name = \"off\", load_factor = 0.0 }]",
            ],
        );
        let (model, mut results) = support::run_with_model(&scene);
        brinell::reference::compare(&model, &mut results);
        let (backend, extent) = (Backend::default(), Extent::Program);
        let found = estimate(
            &scene,
            backend,
            &results,
            extent,
            Effort::Quick,
            &mut Silent,
        );
        for (k, row) in results.reference.iter().enumerate() {
            let path = format!("reference.{}.{}", k + 1, row.quantity);
            let error = found
                .quantities
                .iter()
                .find(|q| q.quantity == path)
                .unwrap();
            assert_eq!(error.of_part(), Some("stresses at places"));
            let (truth, stated) = ((row.computed - row.reference).abs(), error.error.unwrap());
            println!("{element} {path}: {truth:.3} {stated:.3}");
            assert!(truth <= stated, "{path}: {truth} {stated} {error:?}");
            assert!(error.relative_error.unwrap() < 0.5, "{error:?}");
            judged += 1;
        }
    }
    assert_eq!(judged, 12);
}
