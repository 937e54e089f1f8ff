//! Disc in the hole of a plate under tension, the paper's Table II and figures 5.6 to 5.9.
//!
//! Source: N. Endahl, section 5.2; integral equation of the receding contact,
//! `brinell::analytical::DiscInPlate`.

use crate::support::run_file;
use crate::verification::close;
use brinell::analytical::{DiscInPlate, Plane};
use brinell::results::Results;

/// Elastic states at half the yield load and at yield.
fn elastic(overrides: &[&str]) -> Results {
    let mut all = vec!["program.targets=[{load_factor=0.5},{yield=true}]"];
    all.extend(overrides);
    run_file("disc_in_plate", &all)
}

fn half_angle(results: &Results, state: usize) -> f64 {
    results.states[state].contact_arc.unwrap()[1]
}

#[test]
fn table_two_converges_to_the_exact_values() {
    let exact = DiscInPlate::new(10.0).unwrap();
    let angle = exact.half_angle().to_degrees();
    close(angle, 19.625, 1e-5);
    let yield_stress = exact.yield_tension(Plane::Stress, 0.3, 500.0).unwrap();
    let mut errors = Vec::new();
    for resolution in [30, 60, 120] {
        let results = elastic(&[&format!("mesh.disc_in_plate.resolution={resolution}")]);
        let spacing = 90.0 / resolution as f64;
        // The contact ends between two nodes: the angle is known to a fraction (measured 0.1 to
        // 0.22) of their spacing.
        let off = (half_angle(&results, 1) - angle).abs();
        assert!(off <= 0.25 * spacing, "{resolution}: {off}");
        let at_yield = results.first_yield.unwrap();
        assert_eq!(at_yield.body, 1);
        close(
            results.states[1].pole_pressure,
            exact.pressure(0.0, at_yield.load),
            0.006 * 30.0 / resolution as f64,
        );
        errors.push((at_yield.load / yield_stress - 1.0).abs());
    }
    // Order about 2.4 (measured 0.35 %, 0.07 %, 0.02 %), until the size of the plate (1e-4) shows.
    assert!(
        errors[1] <= errors[0] / 4.0 && errors[2] <= 3e-4,
        "{errors:?}"
    );
}

#[test]
fn contact_angle_depends_on_nothing_but_geometry() {
    let of = |overrides: &[&str]| {
        let mut all = vec!["mesh.disc_in_plate.resolution=60"];
        all.extend(overrides);
        elastic(&all)
    };
    let steel = of(&[]);
    let reference = half_angle(&steel, 0);
    close(half_angle(&steel, 1), reference, 1e-9);
    close(
        half_angle(&of(&["materials.steel.youngs_modulus=70000.0"]), 0),
        reference,
        1e-9,
    );
    // nu does not enter the continuum's angle; it does enter a mesh's error, a fraction of the node
    // spacing of 1.5 degrees.
    for other in [
        &["materials.steel.poissons_ratio=0.1"],
        &["kind=\"plane_strain\""],
    ] {
        assert!((half_angle(&of(other), 0) - reference).abs() < 0.05 * 1.5);
    }
}

#[test]
fn plane_strain_yields_later() {
    let exact = DiscInPlate::new(10.0)
        .unwrap()
        .yield_tension(Plane::Strain, 0.3, 500.0)
        .unwrap();
    close(exact, 0.3566 * 500.0, 2e-4);
    let results = elastic(&["kind=\"plane_strain\"", "mesh.disc_in_plate.resolution=60"]);
    close(results.first_yield.unwrap().load, exact, 1e-3);
}

#[test]
fn size_of_the_plate_matters_less_than_the_mesh() {
    let load = |resolution: usize, far: f64| {
        let overrides = [
            format!("mesh.disc_in_plate.resolution={resolution}"),
            format!("mesh.disc_in_plate.far_radius={far:.1}"),
        ];
        elastic(&[&overrides[0], &overrides[1]])
            .first_yield
            .unwrap()
            .load
    };
    let coarse = load(60, 100.0);
    assert!((load(60, 200.0) - coarse).abs() < (load(120, 100.0) - coarse).abs());
}

#[test]
fn disc_stays_elastic_and_the_surfaces_part_on_the_way_down() {
    let results = run_file("disc_in_plate", &["mesh.disc_in_plate.resolution=60"]);
    let top = &results.states[4];
    assert_eq!(top.alpha, 2.0);
    for state in &results.states {
        assert_eq!(state.plastic_points_by_body[0], 0, "{}", state.name);
    }
    assert!(top.plastic_points_by_body[1] > 0);
    // Flow at the pole takes pressure off it.
    assert!(top.pole_pressure / top.alpha < 0.7 * results.states[0].pole_pressure);
    let last = results.states.last().unwrap();
    assert_eq!(last.alpha, 0.0);
    assert_eq!(last.contact_force, 0.0);
    assert!(last.pairs.iter().all(|p| p.gap > 0.0));
    assert!(last.residual_depth > 0.0);
}
