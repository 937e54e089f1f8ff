//! Running scenes in tests, and comparing what came out.
#![allow(dead_code)] // benches, examples and tests/mpi use a part of it

pub mod build;
pub mod families;
pub mod frd;
pub mod grid;
pub mod interpreter;
pub mod limit;
pub mod meshes;
pub mod msh;
pub mod program;
pub mod random;
pub mod scenes;
pub mod svg;
pub mod tools;

use brinell::Result;
use brinell::analysis::Analysis;
use brinell::linalg::Backend;
use brinell::mesh::Mesh;
use brinell::model::{Model, ModelBuilder};
use brinell::progress::Silent;
use brinell::results::{Results, State, Status};
use brinell::scene::Scene;
use std::path::PathBuf;

/// What `make test` runs, or what `make test-long` does, which sets `BRINELL_THOROUGH`: finer
/// meshes and more of them, held to the same bounds in terms of the element's size.
pub fn either<T>(quick: T, thorough: T) -> T {
    match std::env::var_os("BRINELL_THOROUGH") {
        Some(_) => thorough,
        None => quick,
    }
}

/// The folder of the repository.
pub fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// A file under `data/scenes`.
pub fn scene_file(name: &str) -> PathBuf {
    root().join(format!("data/scenes/{name}.toml"))
}

/// A file under `data/scenes`, as an argument of the program.
pub fn scene_path(name: &str) -> String {
    scene_file(name).to_str().unwrap().to_string()
}

/// Overrides that make `ball_on_flat_3d` a matter of tenths of a second.
pub const SMALL_BALL: [&str; 3] = [
    "mesh.curved_bodies.resolution=2",
    "mesh.curved_bodies.contact_width=2.5",
    "mesh.curved_bodies.far_size=10",
];

/// Overrides that make `square_punch` small.
pub const SMALL_PUNCH: [&str; 2] = [
    "mesh.parts.0.brick.elements=[2, 2, 2]",
    "mesh.parts.1.brick.elements=[6, 6, 4]",
];

/// A scene of `data/scenes` with values overridden.
pub fn load(name: &str, overrides: &[&str]) -> Scene {
    limit::watch();
    let overrides: Vec<String> = overrides.iter().map(|o| o.to_string()).collect();
    Scene::load_with(scene_file(name), &overrides).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// A scene from its text.
pub fn parse(text: &str) -> Scene {
    limit::watch();
    Scene::parse(text, "test.toml").unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// The sparse backends of this build that run in this process; MUMPS has tests of its own.
pub fn sparse() -> Vec<Backend> {
    let mut all = Backend::built_in();
    all.retain(|backend| ![Backend::Dense, Backend::Mumps].contains(backend));
    all
}

/// Runs a scene; an incomplete run is an error, as on the command line.
pub fn try_run(scene: &Scene, backend: Backend) -> Result<Results> {
    complete(Analysis::new(Model::new(scene)?, backend)?.run(&mut Silent)?)
}

fn complete(results: Results) -> Result<Results> {
    match &results.incomplete {
        None => Ok(results),
        Some(incomplete) => Err(incomplete.to_error()),
    }
}

/// Runs a scene that must succeed.
#[track_caller]
pub fn run(scene: &Scene) -> Results {
    try_run(scene, Backend::default()).unwrap_or_else(|e| panic!("{}: {e}", scene.title))
}

/// Runs a scene that must succeed; its model comes along.
#[track_caller]
pub fn run_with_model(scene: &Scene) -> (Model, Results) {
    let mut analysis = analysis(scene);
    let results = analysis.run(&mut Silent).and_then(complete);
    let results = results.unwrap_or_else(|e| panic!("{}: {e}", scene.title));
    (analysis.model().clone(), results)
}

/// Runs a scene of `data/scenes` that must succeed.
#[track_caller]
pub fn run_file(name: &str, overrides: &[&str]) -> Results {
    run(&load(name, overrides))
}

/// Runs a scene from its text that must succeed.
#[track_caller]
pub fn run_text(text: &str) -> Results {
    try_run(&parse(text), Backend::default()).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// Runs a scene on a given mesh.
#[track_caller]
pub fn run_on(scene: &Scene, mesh: Mesh) -> Results {
    let model = Model::from_mesh(scene, mesh).unwrap_or_else(|e| panic!("{}: {e}", scene.title));
    run_model(model, Backend::default())
}

/// Runs a model that must succeed.
#[track_caller]
pub fn run_model(model: Model, backend: Backend) -> Results {
    let results = Analysis::new(model, backend).and_then(|mut a| a.run(&mut Silent));
    results.and_then(complete).unwrap_or_else(|e| panic!("{e}"))
}

/// Runs a model that was built by hand and must succeed.
#[track_caller]
pub fn run_built(builder: &ModelBuilder) -> Results {
    let model = builder.build().unwrap_or_else(|e| panic!("{e}"));
    run_model(model, Backend::default())
}

/// Runs a scene to its end or to its limit load.
#[track_caller]
pub fn run_as_far_as_it_goes(scene: &Scene, backend: Backend) -> Results {
    let results = Model::new(scene)
        .and_then(|model| Analysis::new(model, backend))
        .and_then(|mut a| a.run(&mut Silent));
    results.unwrap_or_else(|e| panic!("{}: {e}", scene.title))
}

/// Runs a scene from its text to its end or to its limit load.
#[track_caller]
pub fn run_text_as_far_as_it_goes(text: &str) -> Results {
    let mut analysis = analysis(&parse(text));
    let results = analysis.run(&mut Silent);
    results.unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// What is ready to run a scene.
#[track_caller]
pub fn analysis(scene: &Scene) -> Analysis {
    Model::new(scene)
        .and_then(|model| Analysis::new(model, Backend::default()))
        .unwrap_or_else(|e| panic!("{}: {e}", scene.title))
}

/// First yield alone.
#[track_caller]
pub fn yield_load(scene: &Scene) -> Results {
    let found = analysis(scene).yield_load(&mut Silent);
    found.unwrap_or_else(|e| panic!("{}: {e}", scene.title))
}

/// The state of a name.
pub fn state<'r>(results: &'r Results, name: &str) -> &'r State {
    results
        .states
        .iter()
        .find(|s| s.name == name)
        .unwrap_or_else(|| panic!("no state `{name}`"))
}

/// Largest absolute value.
pub fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |m, v| m.max(v.abs()))
}

/// `|a - b| <= tolerance * scale`, with a message.
#[track_caller]
pub fn close(what: &str, a: f64, b: f64, scale: f64, tolerance: f64) {
    let off = (a - b).abs();
    assert!(
        off <= tolerance * scale.abs(),
        "{what}: {a:.17e} against {b:.17e}, off by {:.3e} of {scale:.3e}, allowed {tolerance:.1e}",
        off / scale.abs()
    );
}

/// Two states have the same statuses and, to `tolerance` of the largest of each kind, the same gaps
/// and forces.
#[track_caller]
pub fn same_contact(what: &str, a: &State, b: &State, tolerance: f64) {
    assert_eq!(a.pairs.len(), b.pairs.len(), "{what}");
    let gap = largest(a.pairs.iter().map(|p| p.gap));
    let force = largest(a.pairs.iter().map(|p| p.force));
    for (p, q) in a.pairs.iter().zip(&b.pairs) {
        close(
            &format!("{what}: gap of pair {}", p.pair),
            p.gap,
            q.gap,
            gap,
            tolerance,
        );
        close(
            &format!("{what}: force of pair {}", p.pair),
            p.force,
            q.force,
            force,
            tolerance,
        );
        // A pair with neither gap nor force may be called either.
        if p.gap > tolerance * gap || p.force > tolerance * force {
            assert_eq!(p.status, q.status, "{what}: status of pair {}", p.pair);
        }
    }
}

/// Two states have the same figures to a share of those of the `largest` state; the second is of a
/// part, so many `times` of which are the whole.
#[track_caller]
pub fn same_figures(a: &State, b: &State, times: f64, largest: &State, share: f64) {
    let figures = |state: &State, times: f64| {
        [
            ("force", times * state.contact_force),
            ("pressure", state.max_pressure),
            ("approach", state.approach),
            ("dent", state.residual_depth),
            ("plastic strain", state.max_equivalent_plastic_strain),
        ]
    };
    let mut scales = figures(largest, 1.0).map(|(_, scale)| scale);
    // A dent is a part of the approach.
    scales[3] = largest.approach;
    for (((what, x), (_, y)), scale) in (figures(a, 1.0).iter()).zip(figures(b, times)).zip(scales)
    {
        assert!((x - y).abs() < share * scale, "{} {what}: {x} {y}", a.name);
    }
}

/// A Cholesky solve with `n` unknowns has a normwise backward error of the order of `n` times the
/// unit round-off at most (N. J. Higham, *Accuracy and Stability of Numerical Algorithms*, 2nd ed.,
/// theorem 10.4; its constants are never met).
pub fn backward_error_bound(results: &Results) -> f64 {
    f64::EPSILON * results.sizes.freedoms as f64
}

/// Every state obeys equilibrium (`<= 1e-8` of the load), complementarity and non-penetration
/// (round-off of `n` freedoms), with a small backward error.
#[track_caller]
pub fn healthy(results: &Results) {
    for state in &results.states {
        let q = &state.quality;
        let name = &state.name;
        assert!(
            q.backward_error <= backward_error_bound(results),
            "{name}: {q:?}"
        );
        assert!(q.equilibrium <= 1e-8, "{name}: {q:?}");
        // Forces are those that the stresses leave over: as good as equilibrium.
        assert!(q.complementarity <= 1e-8, "{name}: {q:?}");
        assert!(q.adhesion <= 1e-8, "{name}: {q:?}");
        // Relative to the displacements, but the round-off is that of the gaps they are a small
        // part of.
        let gap = largest(state.pairs.iter().map(|p| p.gap));
        let cancelled = if gap > 0.0 {
            gap / state.approach.abs()
        } else {
            0.0
        };
        assert!(q.penetration <= 1e-12 * (1.0 + cancelled), "{name}: {q:?}");
        // Points on the axis that are no pairs have no area: what they tell is what the pairs
        // beside them make of them.
        for pair in state.pairs.iter().filter(|pair| pair.area > 0.0) {
            assert!(pair.gap >= 0.0 && pair.force >= 0.0, "{name}: {pair:?}");
            match pair.status {
                Status::Open => assert_eq!(pair.force, 0.0, "{name}: {pair:?}"),
                Status::Closed => assert_eq!(pair.gap, 0.0, "{name}: {pair:?}"),
            }
        }
    }
}
