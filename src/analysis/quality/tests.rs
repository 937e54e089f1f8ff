//! Faults put in on purpose: each must show in the run's own figures. The structure that the engine works with is corrupted, the
//! figures see the true one.

use super::tolerances;
use crate::analysis::drive::{Arrival, IncrementReport};
use crate::analysis::engine::Engine;
use crate::assembly::{System, assemble};
use crate::contact::Tableau;
use crate::linalg::Backend;
use crate::model::Model;
use crate::results::Quality;
use crate::scene::Scene;

/// A block with a rounded face on another: some pairs closed, some open.
const SCENE: &str = r#"
kind = "plane_strain"
[mesh.cylinder_on_half_plane]
radius = 10.0
resolution = 3
half_width = 0.1
far_size = 20.0
[materials.steel]
youngs_modulus = 210000.0
poissons_ratio = 0.3
[bodies]
cylinder = { material = "steel" }
half_plane = { material = "steel" }
[[contact]]
first = "cylinder.contact"
second = "half_plane.contact"
[[support]]
on = "cylinder.symmetry"
fix = ["x"]
[[support]]
on = "half_plane.symmetry"
fix = ["x"]
[[support]]
on = "half_plane.bottom"
fix = ["y"]
[[load]]
on = "cylinder.top"
plane_force = { direction = "y", total = -20.0 }
[program]
targets = [{ load_factor = 1.0 }]
"#;

fn model() -> (Model, System) {
    let scene = Scene::parse(SCENE, "test").expect("scene");
    let model = Model::new(&scene).expect("model");
    let system = assemble(&model).expect("system");
    (model, system)
}

/// The quality of the state at the end of the load, found by an engine on `used`, `tamper`ed with before and `after` the way there,
/// and judged by `system`.
fn quality(
    model: &Model,
    system: &System,
    used: &System,
    tamper: impl Fn(&mut Engine),
    after: impl Fn(&mut Engine),
) -> Quality {
    let mut engine =
        Engine::new(model, used, Backend::default(), &[], Vec::new(), &[]).expect("engine");
    engine.system = system;
    tamper(&mut engine);
    let end = engine.point(1.0);
    let mut report = |_: &mut Engine, _: &IncrementReport| Ok(true);
    let arrival = engine.drive_elastic(&end, None, None, None, &mut report);
    assert_eq!(arrival.expect("drive"), Arrival::End);
    after(&mut engine);
    engine.state("end", false).expect("state").quality
}

fn nothing(_: &mut Engine) {}

#[track_caller]
fn caught(model: &Model, quality: Quality, by: &[&str]) {
    let misses = quality.misses(&tolerances(model));
    for figure in by {
        assert!(
            misses.iter().any(|(name, _, _)| name == figure),
            "{figure} does not notice: {quality:?}"
        );
    }
}

#[test]
fn a_sound_run_misses_nothing() {
    let (model, system) = model();
    let q = quality(&model, &system, &system, nothing, nothing);
    assert_eq!(q.misses(&tolerances(&model)), []);
}

/// One entry of the factored matrix is off by 1e-4 of itself: the factor is that of another structure.
#[test]
fn a_corrupted_factor_is_caught() {
    let (model, system) = model();
    let pole = model.pairs.len() / 2;
    let freedom = model
        .freedoms
        .normal_freedom(model.pairs[pole].second)
        .expect("free");
    let mut corrupted = system.clone();
    *corrupted
        .stiffness
        .get_mut(freedom, freedom)
        .expect("diagonal") *= 1.0 + 1e-4;
    let q = quality(&model, &system, &corrupted, nothing, nothing);
    caught(&model, q, &["backward_error", "equilibrium"]);
}

/// The condensed contact matrix is off by 1e-4 in the entry that couples the outermost pair, which stays open, with the pole.
#[test]
fn a_wrong_schur_complement_is_caught() {
    let (model, system) = model();
    let tamper = |engine: &mut Engine| {
        let mut matrix = engine.tableau.matrix().clone();
        let n = matrix.nrows();
        assert!(model.pairs[0].gap > model.pairs[n - 1].gap);
        for (i, j) in [(0, n - 1), (n - 1, 0)] {
            matrix[(i, j)] *= 1.0 + 1e-4;
        }
        let open = engine.tableau.open().to_vec();
        engine.tableau = Tableau::new(matrix);
        engine.tableau.reset(&open);
    };
    let q = quality(&model, &system, &system, tamper, nothing);
    caught(&model, q, &["equilibrium"]);
}

/// The status of a pair is wrong in the end state: the surfaces overlap where it should be closed, hold together where it should be
/// open. The flip clips gaps and forces as if they were sound: displacements and forces then do not belong together.
#[test]
fn a_flipped_status_is_caught() {
    let (model, system) = model();
    for closed in [true, false] {
        let flip = |engine: &mut Engine| {
            let open = engine.tableau.open().to_vec();
            let edge = (0..open.len() - 1)
                .find(|&k| open[k] != open[k + 1])
                .expect("an edge of the contact");
            let k = if open[edge] != closed { edge } else { edge + 1 };
            assert!(engine.tableau.flip(k));
            engine.fresh = false;
            engine.refresh();
            for value in engine.now.gap.iter_mut().chain(&mut engine.now.force) {
                *value = value.max(0.0);
            }
        };
        caught(
            &model,
            quality(&model, &system, &system, nothing, flip),
            &["equilibrium", "backward_error"],
        );
    }
}

/// A run keeps the worst condition of all its factorisations, not the last one's, and a run that goes on from a checkpoint knows it too.
#[test]
fn the_condition_of_an_earlier_factorisation_is_not_forgotten() {
    let (model, system) = model();
    let backend = Backend::default();
    let elements = [0, model.mesh.n_elements() - 1];
    let bound = |within: usize| {
        let engine = Engine::new(&model, &system, backend, &[within], vec![within], &[false]);
        engine.expect("engine").sub.condition()
    };
    // Which freedoms come last in the factor is all that differs: so do the pivots.
    let mut ordered = elements.map(|element| (bound(element), element));
    ordered.sort_by(|a, b| b.0.total_cmp(&a.0));
    let [(worst, first), (least, last)] = ordered;
    assert!(worst > least, "{worst} {least}");
    let mut engine =
        Engine::new(&model, &system, backend, &[first], vec![first], &[false]).expect("engine");
    assert_eq!(engine.condition, worst);
    engine.set_zone(vec![last], &[false]).expect("zone");
    assert_eq!(engine.counts.factorizations, 2);
    assert_eq!((engine.sub.condition(), engine.condition), (least, worst));
    let record = engine.record(&[false], engine.fingerprint());
    let (resumed, same) = Engine::recall(&model, &system, backend, &record).expect("resumed");
    assert!(same);
    assert_eq!((resumed.sub.condition(), resumed.condition), (least, worst));
}
