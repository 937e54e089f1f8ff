//! What `accuracy = x` costs beside the cheapest setting that a user could have picked by hand, and graded meshes beside uniform ones:
//! in floating point operations, which no busy machine disturbs.

use crate::running;
use brinell::accuracy::{Extent, Knob, Plan, Study, StudyRun, reach, study};
use brinell::linalg::Backend;
use brinell::progress::Silent;
use brinell::scene::{AccuracyDemand, Scene};

/// A reference scene to first yield, where closed forms tell the true error.
struct Case {
    name: &'static str,
    scene: Scene,
    quantities: &'static [&'static str],
    demands: &'static [f64],
}

const CONTACT: &[&str] = &["yield.load", "yield.max_pressure", "yield.half_width"];

fn cases() -> Vec<Case> {
    let yielding = "program.targets=[{ yield = true }]";
    let contact = |name: &str, far: &str| {
        running::load(
            name,
            &[
                yielding,
                "materials.steel.yield_stress=50.0",
                "mesh.cylinder_on_half_plane.resolution=11",
                "mesh.cylinder_on_half_plane.growth=1.2254",
                far,
            ],
        )
    };
    vec![
        Case {
            name: "Hertz line",
            scene: contact(
                "cylinder_on_half_plane",
                "mesh.cylinder_on_half_plane.far_size=20000.0",
            ),
            quantities: CONTACT,
            demands: &[0.1, 0.03, 0.01, 0.003],
        },
        Case {
            name: "Hertz point",
            scene: contact(
                "ball_on_half_space",
                "mesh.cylinder_on_half_plane.far_size=2000.0",
            ),
            quantities: CONTACT,
            demands: &[0.1, 0.03, 0.01],
        },
        Case {
            name: "disc in a plate",
            scene: running::load(
                "disc_in_plate",
                &[
                    yielding,
                    "mesh.disc_in_plate.resolution=44",
                    "mesh.disc_in_plate.growth=1.10",
                ],
            ),
            quantities: &["yield.load", "yield.half_width"],
            demands: &[0.1, 0.03, 0.01],
        },
        Case {
            name: "thick cylinder",
            scene: running::load("thick_cylinder", &[yielding]),
            quantities: &["yield.alpha"],
            demands: &[0.1, 0.03, 0.01, 0.003],
        },
    ]
}

/// Largest error of a run of the study.
fn error(found: &Study, case: &Case, run: usize) -> f64 {
    let errors = case.quantities.iter().map(|name| {
        let quantity = found.quantities.iter().find(|q| q.quantity == *name);
        quantity.unwrap().errors[run].unwrap_or(f64::INFINITY)
    });
    errors.fold(0.0, f64::max)
}

/// The fewest operations of a run that is as accurate, among those that `picked` takes.
fn cheapest(found: &Study, case: &Case, accuracy: f64, picked: &dyn Fn(&StudyRun) -> bool) -> f64 {
    (0..found.runs.len())
        .filter(|&i| picked(&found.runs[i]) && error(found, case, i) <= accuracy)
        .map(|i| found.runs[i].work)
        .fold(f64::INFINITY, f64::min)
}

#[test]
fn a_demand_costs_at_most_twice_the_cheapest_setting_picked_by_hand() {
    for case in cases() {
        let plan = Plan {
            knobs: vec![Knob::Resolution, Knob::Element, Knob::Grading],
            levels: 5,
            budget: None,
        };
        let found = study(&case.scene, Backend::default(), &plan, &mut Silent).unwrap();
        for (i, run) in found.runs.iter().enumerate() {
            println!(
                "{}: {} {}: {} freedoms, {:.2e} operations, error {:.2e}",
                case.name,
                run.series,
                run.value,
                run.freedoms,
                run.work,
                error(&found, &case, i)
            );
        }
        println!("{}: {:?}", case.name, found.grading);
        for &accuracy in case.demands {
            let mut scene = case.scene.clone();
            scene.accuracy = Some(AccuracyDemand::new(accuracy).unwrap());
            let reached = reach(&scene, Backend::default(), Extent::Yield, &mut Silent).unwrap();
            let demand = reached.results.accuracy.unwrap().demand.unwrap();
            let rows = reached.results.reference.iter();
            let actual = rows
                .filter(|r| case.quantities.contains(&r.quantity.as_str()))
                .map(|r| (r.ratio - 1.0).abs())
                .fold(0.0, f64::max);
            let by_hand = cheapest(&found, &case, accuracy, &|r| r.knob != Knob::Grading);
            println!(
                "{} {accuracy}: stated {:.2e}, true {actual:.2e}, {:.2e} operations, {:.2} of {by_hand:.2e}\n  {:#?}",
                case.name,
                demand.stated,
                demand.work,
                demand.work / by_hand,
                demand.choices
            );
        }
    }
}
