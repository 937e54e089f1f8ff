//! The claim of the estimate: over many scenes and settings the true error lies below the stated one in nine of ten cases, and the
//! stated one is not more than four times the true one in the median.

use crate::effectivity::{estimated, hertz};
use crate::running;
use brinell::accuracy::Extent;
use brinell::analytical::{
    DiscInPlate, HertzLine, HertzPoint, Plane, ThickCylinder, contact_modulus,
};
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
            let mut exact = vec![(
                "states.pressed.approach",
                tube.displacement(100.0, 10.0, 0.0) * mean,
            )];
            // Yield at the bore recovered from tri3 converges to a value 15 % too low: all meshes agree, and no
            // comparison of meshes can see it.
            if shape != "tri3" {
                exact.push(("yield.load", tube.yield_pressure(240.0)));
            }
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
