//! Scene to results, as a user of the library would.

use brinell::analysis::Analysis;
use brinell::linalg::Backend;
use brinell::model::Model;
use brinell::progress::Silent;
use brinell::results::{Results, State};
use brinell::scene::Scene;

fn analysis(scene: &Scene) -> Analysis {
    Analysis::new(Model::new(scene).unwrap(), Backend::default()).unwrap()
}

/// A scene of `data/scenes` with overrides.
pub fn scene(name: &str, overrides: &[&str]) -> Scene {
    let path = format!("{}/data/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let overrides: Vec<String> = overrides.iter().map(|o| o.to_string()).collect();
    Scene::load_with(path, &overrides).unwrap()
}

/// Runs a scene's program as far as it goes: to its end, or to the limit load.
pub fn run_as_far_as_it_goes(scene: &Scene) -> Results {
    analysis(scene).run(&mut Silent).unwrap()
}

/// Runs a scene's whole program, which it must reach the end of.
pub fn run(scene: &Scene) -> Results {
    let results = run_as_far_as_it_goes(scene);
    assert_eq!(results.incomplete, None);
    results
}

/// Mean radial displacement of a circular surface about the origin in the first state.
pub fn radial_displacement(scene: &Scene, surface: &str) -> f64 {
    let mut analysis = analysis(scene);
    let results = analysis.run(&mut Silent).unwrap();
    assert_eq!(results.incomplete, None);
    let displacement = &results.states[0].fields.as_ref().unwrap().displacement;
    let mesh = &analysis.model().mesh;
    let nodes = mesh.set_nodes(surface).unwrap();
    let radial = |&n: &usize| {
        let x = mesh.point(n);
        (x[0] * displacement[2 * n] + x[1] * displacement[2 * n + 1]) / x[0].hypot(x[1])
    };
    nodes.iter().map(radial).sum::<f64>() / nodes.len() as f64
}

/// Runs a scene that may end early.
pub fn run_until_it_ends(scene: &Scene) -> Results {
    analysis(scene).run(&mut Silent).unwrap()
}

/// The yield load only.
pub fn yield_load(scene: &Scene) -> Results {
    analysis(scene).yield_load(&mut Silent).unwrap()
}

/// The state of a name.
pub fn state<'a>(results: &'a Results, name: &str) -> &'a State {
    results.states.iter().find(|s| s.name == name).unwrap()
}

/// Panics unless `value` is within `tolerance` (relative) of `exact`.
#[track_caller]
pub fn close(value: f64, exact: f64, tolerance: f64) {
    let error = (value / exact - 1.0).abs();
    assert!(
        error <= tolerance,
        "{value} against {exact}: off by {error:.3e}, more than {tolerance:.1e}"
    );
}
