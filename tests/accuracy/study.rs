//! A study finds what is known: order of convergence, references, prices; it keeps to its budget
//! and what it has.

use crate::support;
use brinell::accuracy::{Knob, Plan, Study, study};
use brinell::analytical::{Plane, ThickCylinder};
use brinell::linalg::Backend;
use brinell::progress::{Observer, Silent};
use brinell::scene::Scene;

fn cylinder(element: &str) -> Scene {
    support::load(
        "thick_cylinder",
        &[
            &format!("mesh.parts.0.element={element}"),
            "program.targets=[{ load_factor = 60.0 }, { yield = true }, { load_factor = 140.0 }]",
        ],
    )
}

fn plan(knobs: &[Knob]) -> Plan {
    Plan {
        knobs: knobs.to_vec(),
        levels: 4,
        budget: None,
    }
}

fn studied(scene: &Scene, plan: &Plan) -> Study {
    study(scene, Backend::default(), plan, &mut Silent).unwrap()
}

#[test]
fn a_study_prices_accuracy_against_the_closed_form() {
    let found = studied(
        &cylinder("quad8"),
        &plan(&[Knob::Resolution, Knob::Tolerance, Knob::Stepping]),
    );
    assert!(
        !found.stopped && found.left_out.is_empty(),
        "{:?}",
        found.left_out
    );
    let first = found
        .quantities
        .iter()
        .find(|q| q.quantity == "yield.alpha")
        .unwrap();
    let reference = first.reference.as_ref().unwrap();
    assert_eq!((reference.value, reference.uncertainty), (103.750, 0.0));
    // Stresses of a quadratic element, recovered at the bore: at least of the order of the energy
    // norm, 2.
    let order = first.orders.iter().find(|o| o.0 == "quad8").unwrap().1;
    assert!(order > 2.0, "{:?}", first.orders);
    for quantity in &found.quantities {
        assert_eq!(quantity.errors.len(), found.runs.len());
        let time = |i: usize| found.runs[i].usage.undisturbed_seconds();
        for pair in quantity.pareto.windows(2) {
            assert!(time(pair[0]) <= time(pair[1]));
            assert!(
                quantity.errors[pair[0]] > quantity.errors[pair[1]],
                "{}",
                quantity.quantity
            );
        }
        for price in &quantity.prices {
            if let Some(i) = price.run {
                assert!(quantity.errors[i].unwrap() <= price.accuracy);
            }
        }
        assert!(!quantity.words.is_empty());
    }
    let percent = first.prices.iter().find(|p| p.accuracy == 0.01).unwrap();
    assert!(percent.run.is_some());
    // The tolerance of the scene is 1e-10: 1e-3 is looser by far and the mesh still hides it.
    let says = |what: &[&str]| {
        let mut words = first.words.iter();
        assert!(
            words.any(|w| what.iter().all(|part| w.contains(part))),
            "{:?}",
            first.words
        );
    };
    says(&["tolerance 1e-", "would be accurate enough"]);
    says(&["1.0 % costs"]);
    // Beyond yield the reference is extrapolated, the increments included.
    let opened = found
        .quantities
        .iter()
        .find(|q| q.quantity == "states.alpha 140.approach")
        .unwrap();
    let reference = opened.reference.as_ref().unwrap();
    assert!(
        reference.source.contains("increments") && reference.uncertainty > 0.0,
        "{reference:?}"
    );
    let settings = found
        .runs
        .iter()
        .filter(|r| r.knob == Knob::Stepping)
        .count();
    // Fixed increments, path errors, and from change to change of contact.
    assert_eq!(settings, 5 + 3 + 1);
    for run in &found.runs {
        assert!(
            run.usage.wall_seconds > 0.0 && run.factor[0] > 0.0 && run.counts.factorizations > 0
        );
    }
}

#[test]
fn elements_converge_with_their_orders() {
    // The mean over the bore of the displacement along the resultant, at 45 degrees.
    let tube = ThickCylinder::new(100.0, 200.0, 210e3, 0.3, Plane::Strain).unwrap();
    let exact = tube.displacement(100.0, 60.0, 0.0) * 8f64.sqrt() / std::f64::consts::PI;
    let reference = format!(
        "reference=[{{ quantity = \"states.alpha 60.approach\", value = {exact:?}, source \
         = \"Lame\" }}]"
    );
    let scene = support::load(
        "thick_cylinder",
        &[
            "mesh.parts.0.element=quad4",
            "program.targets=[{ load_factor = 60.0 }]",
            &reference,
        ],
    );
    let mut plan = plan(&[Knob::Resolution, Knob::Element]);
    plan.levels = 6;
    let found = studied(&scene, &plan);
    let approach = found
        .quantities
        .iter()
        .find(|q| q.quantity == "states.alpha 60.approach")
        .unwrap();
    // Functionals of a smooth solution: twice the degree.
    for (element, expected) in [("quad4", 2.0), ("quad8", 4.0), ("tri3", 2.0), ("tri6", 4.0)] {
        let order = approach.orders.iter().find(|o| o.0 == element).map(|o| o.1);
        assert!(
            order.is_some_and(|o| (o - expected).abs() < 0.1 * expected),
            "{element}: {order:?}"
        );
    }
}

#[test]
fn a_budget_leaves_out_what_does_not_fit() {
    let mut plan = plan(&[Knob::Resolution]);
    plan.budget = Some(1e-6);
    let found = studied(&cylinder("quad4"), &plan);
    // The cheapest run is made whatever the budget: else there would be nothing to go by.
    assert_eq!(found.runs.len(), 1);
    assert!(found.left_out.len() > 2 && found.left_out.iter().all(|l| l.contains("budget")));
}

/// A run that is under way at the end of the budget is given up.
#[test]
fn a_budget_ends_what_is_under_way() {
    let mut plan = plan(&[Knob::Resolution]);
    /// Sleeps through the budget at the beginning of the second run.
    struct Late;
    impl Observer for Late {
        fn phase(&mut self, name: &str) {
            if name.starts_with("run 2") {
                std::thread::sleep(std::time::Duration::from_secs(3));
            }
        }
    }
    plan.budget = Some(3.0);
    let found = study(&cylinder("quad4"), Backend::default(), &plan, &mut Late).unwrap();
    assert!(found.runs.len() == 1 && !found.stopped);
    assert!(found.left_out.iter().all(|l| l.contains("budget")));
}

/// Asks to stop once a run has begun.
struct Impatient(usize);

impl Observer for Impatient {
    fn phase(&mut self, name: &str) {
        self.0 += usize::from(name.starts_with("run 3"));
    }
    fn stop_requested(&self) -> bool {
        self.0 > 0
    }
}

#[test]
fn stopped_it_keeps_what_it_has() {
    let plan = plan(&[Knob::Resolution]);
    let found = study(
        &cylinder("quad4"),
        Backend::default(),
        &plan,
        &mut Impatient(0),
    )
    .unwrap();
    assert!(found.stopped);
    assert_eq!(found.runs.len(), 2);
    assert!(found.runs.iter().all(|r| r.failed.is_none()));
}
