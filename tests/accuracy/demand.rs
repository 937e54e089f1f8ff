//! `accuracy = "x %"`: reached and true, or not and why.

use crate::support;
use crate::support::families::{on_flat, tube};
use brinell::accuracy::{Extent, Reached, reach};
use brinell::linalg::Backend;
use brinell::progress::{Observer, Silent};
use brinell::results::{Demand, Results};
use brinell::scene::{AccuracyDemand, Kind, Scene};
use brinell::{ErrorKind, Result};

pub fn demanding(scene: &Scene, accuracy: &str) -> Scene {
    let mut scene = scene.clone();
    scene.accuracy = Some(AccuracyDemand::try_from(accuracy.to_string()).unwrap());
    scene
}

fn try_reach(scene: &Scene, accuracy: &str, extent: Extent) -> Result<Reached> {
    let scene = demanding(scene, accuracy);
    reach(&scene, Backend::default(), extent, Some(60.0), &mut Silent)
}

pub fn demand(results: &Results) -> Demand {
    let accuracy = results.accuracy.as_ref().unwrap();
    accuracy.demand.clone().unwrap()
}

pub fn reached(scene: &Scene, accuracy: &str, extent: Extent) -> Reached {
    let found = try_reach(scene, accuracy, extent).unwrap();
    let demand = demand(&found.results);
    println!("{}: {demand:#?}", scene.title);
    assert!(demand.reached && demand.stated <= demand.accuracy && demand.reason.is_none());
    // Three meshes at least have to say so.
    assert!(demand.choices.len() >= 3, "{demand:?}");
    found
}

/// The errors against the closed forms that the scene names.
fn errors(results: &Results) -> Vec<f64> {
    let rows = results
        .reference
        .iter()
        .filter(|r| r.quantity != "yield.location.y");
    rows.map(|r| (r.ratio - 1.0).abs()).collect()
}

#[test]
fn the_true_error_is_within_the_demanded_one() {
    let far = "mesh.cylinder_on_half_plane.far_size=2000.0";
    for (scene, accuracies) in [
        (
            on_flat("cylinder_on_half_plane", 16, &[far]),
            &[0.1, 0.01, 0.003][..],
        ),
        (on_flat("ball_on_half_space", 16, &[far]), &[0.1, 0.03]),
        (support::load("disc_in_plate", &[]), &[0.1, 0.03]),
    ] {
        for accuracy in accuracies {
            let found = reached(&scene, &accuracy.to_string(), Extent::Yield);
            let errors = errors(&found.results);
            assert!(errors.len() >= 2);
            println!("{} {accuracy}: {errors:?}", scene.title);
            assert!(
                errors.iter().all(|e| e <= accuracy),
                "{accuracy}: {errors:?}"
            );
        }
    }
}

/// Perfectly plastic, in plane stress, without contact: nothing ends an increment but the target,
/// and what is asked for is above all that of the path.
#[test]
fn increments_follow_where_the_path_is_too_coarse() {
    let targets = "program.targets=[{ load_factor = 150.0 }]";
    let mut scene = tube("quad8", 16, targets);
    scene.kind = Kind::PlaneStress;
    let found = reached(
        &scene,
        "states.alpha 150.approach = 0.05 %",
        Extent::Program,
    );
    let choices = demand(&found.results).choices;
    assert!(
        choices
            .iter()
            .any(|c| c.contains("increments for each target")),
        "{choices:?}"
    );
    let rows = &found.results.accuracy.as_ref().unwrap().quantities;
    for row in rows.iter().filter(|r| r.quantity.ends_with("150.approach")) {
        assert!(
            row.path.unwrap() > 0.0 && row.relative_error.unwrap() <= 0.0005,
            "{row:?}"
        );
    }
}

/// Each of several quantities has its own demand, and the others none.
#[test]
fn only_what_is_named_is_asked_for() {
    let targets = "program.targets=[{ yield = true }, { load_factor = 170.0 }]";
    let scene = tube("quad4", 16, targets);
    let coarse = reached(&scene, "yield.load = 5 %", Extent::Program);
    let fine = reached(&scene, "yield.load = 5 %, strain = 5 %", Extent::Program);
    let elements = |found: &Reached| found.results.sizes.elements;
    assert!(elements(&fine) > elements(&coarse));
    let worst = demand(&fine.results).worst.unwrap();
    assert!(worst.ends_with("max_equivalent_plastic_strain"), "{worst}");
    let nothing = try_reach(&scene, "dent = 1 %", Extent::Program);
    let error = nothing.err().unwrap();
    assert_eq!(error.kind(), ErrorKind::Input);
    assert!(
        error.message().contains("states.alpha 170.approach"),
        "{error}"
    );
}

/// What round-off leaves is no matter of meshes.
#[test]
fn a_demand_below_round_off_ends() {
    let found = try_reach(
        &tube("quad8", 16, "program.targets=[{ load_factor = 10.0 }]"),
        "1e-15",
        Extent::Program,
    );
    let demand = demand(&found.unwrap().results);
    assert!(!demand.reached);
    let why = demand.reason.unwrap();
    assert!(why.contains("round-off"), "{why}");
}

/// Stops in the third mesh.
struct Impatient(usize);

impl Observer for Impatient {
    fn phase(&mut self, name: &str) {
        self.0 += usize::from(name.starts_with("accuracy"));
    }
    fn stop_requested(&self) -> bool {
        self.0 > 2
    }
}

#[test]
fn stopped_it_keeps_the_last_mesh() {
    let targets = "program.targets=[{ yield = true }, { load_factor = 170.0 }]";
    let scene = demanding(&tube("quad4", 16, targets), "0.01 %");
    let mut observer = Impatient(0);
    let found = reach(
        &scene,
        Backend::default(),
        Extent::Program,
        None,
        &mut observer,
    )
    .unwrap();
    // The second mesh of 3, 4, 6, ... elements across the wall.
    assert_eq!(found.results.sizes.elements, 16);
    assert_eq!(found.results.states.len(), 2);
    let demand = demand(&found.results);
    assert!(!demand.reached && demand.reason.unwrap().contains("stopped"));
    let ending = brinell::output::ending(&found.results).unwrap_err();
    assert_eq!(ending.kind(), ErrorKind::Stopped);
}
