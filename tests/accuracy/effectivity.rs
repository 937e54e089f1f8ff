//! Estimated over true error of yield load, maximum pressure and displacement, where a closed form tells the true one.
//!
//! With a yield stress of 50 MPa the contact is 5e-4 of the radius wide: Hertz' theory then is exact for these models to about
//! 1e-4, the error of the finest mesh here.

use crate::running;
use brinell::accuracy::{Extent, estimate};
use brinell::analysis::Analysis;
use brinell::analytical::{HertzLine, HertzPoint, Plane, ThickCylinder, contact_modulus};
use brinell::linalg::Backend;
use brinell::model::Model;
use brinell::progress::Silent;
use brinell::results::{Accuracy, EstimateMethod, Results};
use brinell::scene::Scene;

const YIELD_STRESS: f64 = 50.0;

pub fn estimated(scene: &Scene, extent: Extent) -> (Results, Accuracy) {
    let model = Model::new(scene).unwrap();
    let mut analysis = Analysis::new(model, Backend::default()).unwrap();
    let results = match extent {
        Extent::Yield => analysis.yield_load(&mut Silent).unwrap(),
        Extent::Program => analysis.run(&mut Silent).unwrap(),
    };
    let accuracy = estimate(scene, Backend::default(), &results, extent, &mut Silent);
    assert_eq!(accuracy.notes, Vec::<String>::new());
    assert_eq!(accuracy.method, EstimateMethod::CoarserMeshes);
    (results, accuracy)
}

/// Estimated discretisation error over the true error of a quantity.
fn effectivity(accuracy: &Accuracy, path: &str, exact: f64) -> f64 {
    let row = accuracy
        .quantities
        .iter()
        .find(|q| q.quantity == path)
        .unwrap();
    row.discretisation.unwrap() / (row.value - exact).abs()
}

/// A contact scene with `n` elements over the contact, growing outside as a family of meshes does.
pub fn hertz(name: &str, n: usize, far_size: f64) -> Scene {
    let growth = 1.15f64.powf(16.0 / n as f64);
    running::load(
        name,
        &[
            &format!("mesh.cylinder_on_half_plane.resolution={n}"),
            &format!("mesh.cylinder_on_half_plane.growth={growth}"),
            &format!("mesh.cylinder_on_half_plane.far_size={far_size:.1}"),
            &format!("materials.steel.yield_stress={YIELD_STRESS:.1}"),
        ],
    )
}

#[test]
fn hertz_line_yield_load_and_pressure() {
    let modulus = contact_modulus(210e3, 0.3, 210e3, 0.3);
    let load = HertzLine::new(10.0, modulus)
        .unwrap()
        .yield_load(0.3, YIELD_STRESS);
    let pressure = HertzLine::yield_pressure(0.3, YIELD_STRESS);
    for n in [8, 11, 16, 24, 32] {
        let (_, accuracy) = estimated(&hertz("cylinder_on_half_plane", n, 20e3), Extent::Yield);
        let found = [
            effectivity(&accuracy, "yield.load", load),
            effectivity(&accuracy, "yield.max_pressure", pressure),
        ];
        println!(
            "line {n}: yield load {:.2}, pressure {:.2}",
            found[0], found[1]
        );
        assert!(
            found.iter().all(|e| (0.5..=2.3).contains(e)),
            "{n}: {found:?}"
        );
    }
}

#[test]
fn hertz_point_yield_load_and_pressure() {
    let modulus = contact_modulus(210e3, 0.3, 210e3, 0.3);
    let load = HertzPoint::new(10.0, modulus)
        .unwrap()
        .yield_load(0.3, YIELD_STRESS);
    let pressure = HertzPoint::yield_pressure(0.3, YIELD_STRESS);
    for n in [6, 8, 11, 16, 24, 32] {
        let (_, accuracy) = estimated(&hertz("ball_on_half_space", n, 2e3), Extent::Yield);
        let found = [
            effectivity(&accuracy, "yield.load", load),
            effectivity(&accuracy, "yield.max_pressure", pressure),
        ];
        println!(
            "point {n}: yield load {:.2}, pressure {:.2}",
            found[0], found[1]
        );
        assert!(
            found.iter().all(|e| (0.5..=4.0).contains(e)),
            "{n}: {found:?}"
        );
    }
}

#[test]
fn thick_cylinder_displacement() {
    // The approach is the mean over the bore's nodes of the displacement along the resultant, at 45 degrees: the mean of
    // cos over +-45 degrees times the radial displacement.
    let cylinder = ThickCylinder::new(100.0, 200.0, 210e3, 0.3, Plane::Strain).unwrap();
    let exact = cylinder.displacement(100.0, 10.0, 0.0) * 8f64.sqrt() / std::f64::consts::PI;
    for shape in ["quad4", "quad8", "tri3", "tri6"] {
        for n in [6, 8, 12, 16, 24, 32] {
            let scene = running::load(
                "thick_cylinder",
                &[
                    &format!("mesh.parts.0.element={shape}"),
                    &format!("mesh.parts.0.ring.elements=[{n},{n}]"),
                    "program.targets=[{ name = \"pressed\", load_factor = 10.0 }]",
                ],
            );
            let (_, accuracy) = estimated(&scene, Extent::Program);
            let found = effectivity(&accuracy, "states.pressed.approach", exact);
            println!("thick cylinder {shape} {n}: displacement {found:.2}");
            assert!((0.5..=2.0).contains(&found), "{shape} {n}: {found}");
        }
    }
}
