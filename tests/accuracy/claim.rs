//! The claim of the estimate: over many scenes and settings the true error lies below the stated one in nine of ten cases, and the
//! stated one is not more than four times the true one in the median.

use crate::demand::demanded;
use crate::effectivity::{estimated, hertz, run_to};
use crate::running;
use brinell::accuracy::{Extent, estimate, quantities, reach, value_of};
use brinell::analytical::{
    DiscInPlate, HertzLine, HertzPoint, Plane, ThickCylinder, contact_modulus,
};
use brinell::linalg::Backend;
use brinell::progress::Silent;
use brinell::scene::Scene;

/// What is judged: a scene, how far it is run, and quantities with their exact values.
struct Case {
    name: String,
    scene: Scene,
    extent: Extent,
    exact: Vec<(&'static str, f64)>,
}

fn cases() -> Vec<Case> {
    let mut out = Vec::new();
    let modulus = contact_modulus(210e3, 0.3, 210e3, 0.3);
    let line = HertzLine::new(10.0, modulus).unwrap();
    let point = HertzPoint::new(10.0, modulus).unwrap();
    for n in [6, 8, 10, 12, 16, 20, 24] {
        out.push(Case {
            name: format!("line {n}"),
            scene: hertz("cylinder_on_half_plane", n, 20e3),
            extent: Extent::Yield,
            exact: vec![
                ("yield.load", line.yield_load(0.3, 50.0)),
                ("yield.max_pressure", HertzLine::yield_pressure(0.3, 50.0)),
                ("yield.half_width", line.yield_half_width(0.3, 50.0)),
            ],
        });
        out.push(Case {
            name: format!("point {n}"),
            scene: hertz("ball_on_half_space", n, 2e3),
            extent: Extent::Yield,
            exact: vec![
                ("yield.load", point.yield_load(0.3, 50.0)),
                ("yield.max_pressure", HertzPoint::yield_pressure(0.3, 50.0)),
                ("yield.half_width", point.yield_contact_radius(0.3, 50.0)),
            ],
        });
    }
    let tube = ThickCylinder::new(100.0, 200.0, 210e3, 0.3, Plane::Strain).unwrap();
    let mean = 8f64.sqrt() / std::f64::consts::PI;
    for shape in ["quad4", "quad8", "tri3", "tri6"] {
        for n in [6, 12, 24] {
            let exact = vec![
                (
                    "states.pressed.approach",
                    tube.displacement(100.0, 10.0, 0.0) * mean,
                ),
                ("yield.load", tube.yield_pressure(240.0)),
            ];
            out.push(Case {
                name: format!("tube {shape} {n}"),
                scene: running::load(
                    "thick_cylinder",
                    &[
                        &format!("mesh.parts.0.element={shape}"),
                        &format!("mesh.parts.0.ring.elements=[{n},{n}]"),
                        "program.targets=[{ name = \"pressed\", load_factor = 10.0 }, { yield = true }]",
                    ],
                ),
                extent: Extent::Program,
                exact,
            });
        }
    }
    let disc = DiscInPlate::new(10.0).unwrap();
    for n in [20, 30, 44, 60] {
        let growth = 1.05f64.powf(90.0 / n as f64);
        let scene = running::load(
            "disc_in_plate",
            &[
                &format!("mesh.disc_in_plate.resolution={n}"),
                &format!("mesh.disc_in_plate.growth={growth}"),
            ],
        );
        let material = &scene.materials.values().next().unwrap();
        let plane = match scene.kind {
            brinell::scene::Kind::PlaneStress => Plane::Stress,
            _ => Plane::Strain,
        };
        let load = disc
            .yield_tension(
                plane,
                material.poissons_ratio,
                material.yield_stress.unwrap(),
            )
            .unwrap();
        out.push(Case {
            name: format!("disc {n}"),
            scene,
            extent: Extent::Yield,
            exact: vec![
                ("yield.load", load),
                ("yield.half_width", 10.0 * disc.half_angle()),
            ],
        });
    }
    out
}

#[test]
fn the_true_error_lies_below_the_stated_one_in_nine_of_ten() {
    let cases = cases();
    assert!(cases.len() >= 30, "{}", cases.len());
    let mut ratios: Vec<f64> = Vec::new();
    for case in &cases {
        let (_, accuracy) = estimated(&case.scene, case.extent);
        for (path, exact) in &case.exact {
            let row = accuracy
                .quantities
                .iter()
                .find(|q| q.quantity == *path)
                .unwrap();
            let (stated, true_error) = (row.error.unwrap(), (row.value - exact).abs());
            println!(
                "{:14} {path:24} true {:9.2e} stated {:9.2e} ratio {:8.2} order {:?}",
                case.name,
                true_error / exact,
                stated / exact,
                stated / true_error,
                row.order
            );
            ratios.push(stated / true_error);
        }
    }
    ratios.sort_by(f64::total_cmp);
    let kept = ratios.iter().filter(|r| **r >= 1.0).count();
    let median = ratios[ratios.len() / 2];
    println!("{kept} of {} kept, median {median:.2}", ratios.len());
    assert!(10 * kept >= 9 * ratios.len(), "{kept} of {}", ratios.len());
    assert!(median <= 4.0, "{median}");
}

/// The same of what a demand reports, extrapolated where that is better known, on the meshes that demands from 20 to 0.2 % lead to.
#[test]
fn what_a_demand_states_is_kept_in_nine_of_ten() {
    let yielding = "program.targets=[{ yield = true }]";
    let tube = ThickCylinder::new(100.0, 200.0, 210e3, 0.3, Plane::Strain).unwrap();
    let contacts = cases().into_iter();
    let mut scenes: Vec<_> = contacts
        .filter(|case| ["line 12", "point 12", "disc 60"].contains(&case.name.as_str()))
        .map(|case| (case.name, case.scene, case.extent, case.exact))
        .collect();
    assert_eq!(scenes.len(), 3);
    scenes.push((
        "punch".to_string(),
        running::load("flat_punch", &[]),
        Extent::Program,
        vec![("states.flow.load", 296.85)],
    ));
    for shape in ["quad4", "quad8", "tri3", "tri6"] {
        let shape = format!("mesh.parts.0.element={shape}");
        scenes.push((
            shape.clone(),
            running::load("thick_cylinder", &[&shape, yielding]),
            Extent::Yield,
            vec![("yield.load", tube.yield_pressure(240.0))],
        ));
    }
    let mut ratios: Vec<f64> = Vec::new();
    let mut extrapolated = 0;
    for (name, scene, extent, exact) in &scenes {
        let mut meshes = Vec::new();
        for accuracy in [0.2, 0.1, 0.05, 0.03, 0.02, 0.01, 0.005, 0.003, 0.002] {
            if *extent == Extent::Program && accuracy < 0.01 {
                continue;
            }
            let asked = demanded(scene, accuracy);
            let found = reach(&asked, Backend::default(), *extent, &mut Silent).unwrap();
            // Demands that lead to the same mesh say the same.
            let mesh = format!("{:?}", found.scene.mesh);
            if meshes.contains(&mesh) {
                continue;
            }
            meshes.push(mesh);
            for (path, exact) in exact {
                let rows = &found.results.accuracy.as_ref().unwrap().quantities;
                let row = rows.iter().find(|q| q.quantity == *path).unwrap();
                let (stated, actual) = (row.error.unwrap(), (row.value - exact).abs());
                println!(
                    "{name:30} {accuracy:5} {path:20} true {:9.2e} stated {:9.2e} ratio {:8.2} {}",
                    actual / exact,
                    stated / exact,
                    stated / actual,
                    row.of_mesh.is_some()
                );
                extrapolated += usize::from(row.of_mesh.is_some());
                ratios.push(stated / actual);
            }
        }
    }
    ratios.sort_by(f64::total_cmp);
    let kept = ratios.iter().filter(|r| **r >= 1.0).count();
    let median = ratios[ratios.len() / 2];
    println!(
        "{kept} of {} kept, {extrapolated} extrapolated, median {median:.2}",
        ratios.len()
    );
    assert!(
        ratios.len() >= 30 && extrapolated >= 20,
        "{} {extrapolated}",
        ratios.len()
    );
    assert!(10 * kept >= 9 * ratios.len(), "{kept} of {}", ratios.len());
    assert!(median <= 4.0, "{median}");
}

/// Whole programs with fewer than eight elements over the contact, against one with 32: errors that finer meshes alone tell count 1.5 times, so that at least two thirds
/// of the true ones have to be estimated. What is right to a thousandth is left out: the reference is no better.
#[test]
fn coarse_programs_are_wrong_by_what_finer_meshes_say() {
    let program = |name: &str, n: usize| {
        let of_generator =
            |key: &str, value: String| format!("mesh.cylinder_on_half_plane.{key}={value}");
        let growth = 1.15f64.powf(16.0 / n as f64);
        let set = [
            of_generator("resolution", n.to_string()),
            of_generator("growth", growth.to_string()),
        ];
        running::load(name, &set.each_ref().map(String::as_str))
    };
    let (mut told, mut kept, mut all) = (0, 0, 0);
    for name in ["cylinder_on_half_plane", "ball_on_half_space"] {
        let reference = quantities(&run_to(&program(name, 32), Extent::Program));
        for n in 4..8 {
            let scene = program(name, n);
            let results = run_to(&scene, Extent::Program);
            let (backend, extent) = (Backend::default(), Extent::Program);
            let found = estimate(&scene, backend, &results, extent, &mut Silent);
            for row in &found.quantities {
                let exact = value_of(&reference, &row.quantity).unwrap();
                let actual = (row.value - exact).abs();
                if actual <= 1e-3 * exact.abs() {
                    continue;
                }
                all += 1;
                told += usize::from(row.discretisation.unwrap() >= actual / 1.5);
                kept += usize::from(row.error.unwrap() >= actual);
            }
        }
    }
    println!("{told} of {all} estimated at two thirds at least, {kept} kept");
    assert!(all >= 200, "{all}");
    assert!(
        10 * told >= 9 * all && 10 * kept >= 9 * all,
        "{told} {kept} of {all}"
    );
}
