//! Plastic flow that keeps its volume, in all element shapes.

use crate::support::{either, load, run_as_far_as_it_goes, run_file};
use brinell::ErrorKind;
use brinell::linalg::Backend;
use brinell::results::Status;

/// Limit pressure of the tube over Hill's, and the warnings; `None` where no collapse was found up
/// to 200 (1.04 of the limit).
fn limit(shape: &str, nu: f64) -> (Option<f64>, Vec<String>) {
    let set = [
        format!("mesh.parts.0.element={shape}"),
        format!("materials.steel.poissons_ratio={nu}"),
    ];
    let scene = load("hard/nearly_incompressible", &[&set[0], &set[1]]);
    let results = run_as_far_as_it_goes(&scene, Backend::default());
    let exact = 2.0 * 240.0 / 3f64.sqrt() * 2f64.ln();
    let collapsed = results.ending().kind() == Some(ErrorKind::Collapse);
    let last = results.history.last().unwrap().alpha;
    (collapsed.then_some(last / exact), results.warnings)
}

/// Flow is isochoric: elements with as many constraints as freedoms cannot flow, their limit load
/// is too high or does not exist. Hill's is exact for nu = 1/2, and for any nu at the limit, where
/// the elastic part has no say; linear elements, 12 over the wall, are off by h^2.
#[test]
fn limit_loads_of_all_shapes_that_claim_not_to_lock() {
    for shape in ["quad4", "quad8", "tri6"] {
        // `stability::flow` has all shapes at 0.4999, where what locks does so.
        let all = if shape == "quad4" { 1 } else { either(0, 3) };
        for nu in &[0.3, 0.49, 0.4999][..either(all, 3)] {
            let nu = *nu;
            let (limit, warnings) = limit(shape, nu);
            let limit = limit.unwrap_or(f64::INFINITY);
            assert!((limit - 1.0).abs() < 0.01, "{shape}, nu {nu}: {limit}");
            assert!(warnings.iter().all(|w| !w.contains("lock")), "{warnings:?}");
        }
    }
}

/// The same in a sphere, axisymmetric: three constraints at a point instead of two, one of them the
/// hoop strain. Hill's limit is exact for any nu.
#[test]
fn limit_loads_of_a_sphere() {
    let exact = 2.0 * 240.0 * 2f64.ln();
    for shape in ["quad4", "quad8", "tri6"] {
        let some = if shape == "quad4" { 0 } else { either(1, 0) };
        for nu in &[0.3, 0.4999][some..] {
            let set = [
                format!("mesh.parts.0.element={shape}"),
                format!("materials.steel.poissons_ratio={nu}"),
                "mesh.parts.0.ring.elements=[12,4]".to_string(),
                "program.targets=[{ load_factor = 300.0 }, { load_factor = 345.0 }]".to_string(),
            ];
            let set: Vec<&str> = set.iter().map(String::as_str).collect();
            let scene = load("thick_sphere", &set);
            let results = run_as_far_as_it_goes(&scene, Backend::default());
            assert_eq!(
                results.ending().kind(),
                Some(ErrorKind::Collapse),
                "{shape} {nu}"
            );
            let limit = results.history.last().unwrap().alpha / exact;
            assert!((limit - 1.0).abs() < 0.01, "{shape}, nu {nu}: {limit}");
        }
    }
}

/// Near the limit the tangent is almost singular: iterations stall, and codes accept what they
/// have. At 99.9 % of the mesh's own limit load the state is in balance to the tolerance of the
/// iteration, 1e-10, with room for where it is measured.
#[test]
fn just_below_the_limit_load_forces_balance() {
    let own = limit("quad4", 0.4999).0.unwrap() * 2.0 * 240.0 / 3f64.sqrt() * 2f64.ln();
    let target = format!("program.targets=[{{ load_factor = {:e} }}]", 0.999 * own);
    let results = run_file("hard/nearly_incompressible", &[&target]);
    crate::support::healthy(&results);
    let state = &results.states[0];
    assert!(state.quality.equilibrium <= 1e-9, "{:?}", state.quality);
    assert!(state.plastic_points > 0);
}

/// tri3 locks, and says so before the run: a warning that names it, and a limit load above that of
/// quad4 on the same nodes.
#[test]
fn locking_is_reported() {
    let (tri3, warnings) = limit("tri3", 0.4999);
    assert!(
        warnings
            .iter()
            .any(|w| w.contains("tri3") && w.contains("lock")),
        "{warnings:?}"
    );
    let (quad4, _) = limit("quad4", 0.4999);
    let (tri3, quad4) = (tri3.unwrap_or(f64::INFINITY), quad4.unwrap());
    assert!(tri3 > quad4 && tri3 > 1.0, "{tri3} {quad4}");
}

/// The nearer nu comes to 1/2, the fewer digits of a stress are left beside the stiffness against a
/// change of volume: lambda / mu times round-off. The bound knows, and figures are right: linear in
/// 1/2 - nu near the end (Hertz: 1 - nu^2), so that the last tenth of the way changes them by a
/// tenth of what the nine tenths before did. Events are hit within gamma, 1e-8.
#[test]
fn contact_near_incompressibility_is_as_good_as_its_round_off() {
    for scene in ["cylinder_on_half_plane", "ball_on_half_space"] {
        let figures = |nu: f64| {
            let set = [
                "mesh.cylinder_on_half_plane.resolution=4".to_string(),
                format!("materials.steel.poissons_ratio={nu}"),
                "program.targets=[{ yield = true }, { load_factor = 1.3 }, { load_factor = 0.0 }]"
                    .to_string(),
            ];
            let results = run_file(scene, &[&set[0], &set[1], &set[2]]);
            assert!(
                results.inaccurate.is_empty(),
                "{scene} {nu}: {:?}",
                results.inaccurate
            );
            for s in &results.states {
                let bound = s.quality.round_off.unwrap().max(1e-7);
                assert!(s.quality.equilibrium <= bound, "{:?}", s.quality);
            }
            let yielded = results.first_yield.unwrap();
            let pressed = &results.states[1];
            [
                yielded.load,
                yielded.max_pressure,
                pressed.load,
                pressed.max_pressure,
            ]
        };
        let [far, near, nearest] = [0.499, 0.4999, 0.49999].map(figures);
        for i in 0..far.len() {
            let [last, before] = [nearest[i] - near[i], near[i] - far[i]].map(f64::abs);
            assert!(before <= 0.01 * far[i], "{scene}, figure {i}: {before}");
            assert!(
                last <= 0.2 * before + 1e-6 * far[i],
                "{scene}, figure {i}: {last:e} after {before:e}"
            );
        }
    }
}

/// Contact forces below what round-off leaves in them are none: parted bodies are apart, and where
/// elastic states balance to no more than their round-off the run says to what.
#[test]
fn parted_bodies_carry_nothing_and_round_off_is_told() {
    for nu in ["0.499999", "0.4999999"] {
        let nu = format!("materials.steel.poissons_ratio={nu}");
        let results = run_file("hard/separation", &[&nu]);
        let unloaded = crate::support::state(&results, "unloaded");
        assert_eq!(unloaded.contact_force, 0.0);
        for pair in &unloaded.pairs {
            assert_eq!((pair.force, pair.status), (0.0, Status::Open), "{nu}");
        }
    }
    let set = [
        "materials.steel.poissons_ratio=0.499999",
        "program.targets=[{ yield = true }]",
    ];
    let results = run_file("cylinder_on_half_plane", &set);
    assert!(results.inaccurate.is_empty(), "{:?}", results.inaccurate);
    let told = |w: &String| w.contains("forces balance to their round-off");
    assert!(results.states[0].quality.equilibrium > 1e-8);
    assert!(results.warnings.iter().any(told), "{:?}", results.warnings);
}

/// The last pair opens at a load that is less than what round-off leaves in its force: the program
/// ends there all the same.
#[test]
fn the_last_of_the_load_may_be_round_off() {
    for nu in ["0.4999", "0.499999"] {
        let nu = format!("materials.steel.poissons_ratio={nu}");
        let results = run_file("cylinder_on_half_plane", &[&nu]);
        let unloaded = crate::support::state(&results, "unloaded");
        assert_eq!((unloaded.load, unloaded.contact_force), (0.0, 0.0));
        assert!(results.inaccurate.is_empty(), "{:?}", results.inaccurate);
    }
}
