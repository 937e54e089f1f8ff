//! Tests with faults put in on purpose: each fault must show in the run's own figures. The
//! structure that the solver works with is corrupted; the figures are computed with the true one.

use super::{Displacements, tolerances};
use crate::analysis::figures::reading::Reading;
use crate::analysis::increments::elastic::ElasticDrive;
use crate::analysis::increments::step::Arrival;
use crate::analysis::structure::record::{SolverRecord, fingerprint};
use crate::analysis::structure::solver::Solver;
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
    let system = assemble(&model, Backend::default()).expect("system");
    (model, system)
}

/// The quality, judged by `system`, of the state at the end of the load. The solver works on
/// `used`. `tamper` changes the solver before it goes to this state; `after` changes it in that
/// state.
fn quality(
    model: &Model,
    system: &System,
    used: &System,
    tamper: impl Fn(&mut Solver),
    after: impl Fn(&mut Solver),
) -> Quality {
    let mut solver =
        Solver::new(model, used, Backend::default(), &[], Vec::new(), &[]).expect("solver");
    solver.structure.system = system;
    tamper(&mut solver);
    let end = solver.structure.point(1.0);
    let arrival = ElasticDrive::go(&mut solver, &end, None);
    assert_eq!(arrival.expect("drive"), Arrival::End);
    after(&mut solver);
    Reading::of(&mut solver)
        .figures("end", false)
        .expect("state")
        .state
        .quality
}

fn nothing(_: &mut Solver) {}

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

/// One entry of the factored matrix is off by 1e-4 of its value, so the factor is that of another
/// structure.
#[test]
fn a_corrupted_factor_is_caught() {
    let (model, system) = model();
    let pole = model.pairs.len() / 2;
    let freedom = model
        .freedoms
        .normal_freedom(model.pairs[pole].slave)
        .expect("free");
    let mut matrix = system.stiffness.whole().expect("here").clone();
    *matrix.get_mut(freedom, freedom).expect("diagonal") *= 1.0 + 1e-4;
    let corrupted = System {
        stiffness: matrix.into(),
        ..system.clone()
    };
    let q = quality(&model, &system, &corrupted, nothing, nothing);
    caught(&model, q, &["backward_error", "equilibrium"]);
}

/// The condensed contact matrix is off by 1e-4 in the entry that couples the pole with the
/// outermost pair, which stays open.
#[test]
fn a_wrong_schur_complement_is_caught() {
    let (model, system) = model();
    let tamper = |solver: &mut Solver| {
        let mut matrix = solver.tableau.matrix().dense();
        let n = matrix.nrows();
        assert!(model.pairs[0].gap > model.pairs[n - 1].gap);
        for (i, j) in [(0, n - 1), (n - 1, 0)] {
            matrix[(i, j)] *= 1.0 + 1e-4;
        }
        let open = solver.tableau.open().to_vec();
        solver.tableau = Tableau::new(matrix);
        solver.tableau.reset(&open);
    };
    let q = quality(&model, &system, &system, tamper, nothing);
    caught(&model, q, &["equilibrium"]);
}

/// The status of a pair is wrong in the final state: the surfaces overlap at a pair that should be
/// closed, or stick together at one that should be open. Gaps and forces are clipped after the flip
/// as if they were sound, so that displacements and forces do not belong together.
#[test]
fn a_flipped_status_is_caught() {
    let (model, system) = model();
    for closed in [true, false] {
        let flip = |solver: &mut Solver| {
            let open = solver.tableau.open().to_vec();
            let edge = (0..open.len() - 1)
                .find(|&k| open[k] != open[k + 1])
                .expect("an edge of the contact");
            let k = if open[edge] != closed { edge } else { edge + 1 };
            assert!(solver.tableau.flip(k));
            solver.fresh = false;
            solver.refresh();
            for value in solver.now.gap.iter_mut().chain(&mut solver.now.force) {
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

/// A run keeps the worst condition number of all its factorisations, not that of the last one, also
/// when it is resumed from a checkpoint.
#[test]
fn the_condition_of_an_earlier_factorisation_is_not_forgotten() {
    let (model, system) = model();
    let backend = Backend::default();
    let elements = [0, model.mesh.n_elements() - 1];
    let bound = |within: usize| {
        let solver = Solver::new(&model, &system, backend, &[within], vec![within], &[false]);
        solver.expect("solver").structure.sub.condition()
    };
    // The two structures differ only in the freedoms that come last in the factor, and so in the
    // pivots.
    let mut ordered = elements.map(|element| (bound(element), element));
    ordered.sort_by(|a, b| b.0.total_cmp(&a.0));
    let [(worst, first), (least, last)] = ordered;
    assert!(worst > least, "{worst} {least}");
    let mut solver =
        Solver::new(&model, &system, backend, &[first], vec![first], &[false]).expect("solver");
    assert_eq!(solver.structure.condition, worst);
    solver.set_zone(vec![last], &[false]).expect("zone");
    assert_eq!(solver.cost.counts.factorizations, 2);
    assert_eq!(
        (solver.structure.sub.condition(), solver.structure.condition),
        (least, worst)
    );
    let record = SolverRecord::of(&solver, &[false], fingerprint(&solver));
    let (resumed, same) = record.recall(&model, &system, backend).expect("resumed");
    assert!(same);
    assert_eq!(
        (
            resumed.structure.sub.condition(),
            resumed.structure.condition
        ),
        (least, worst)
    );
}

/// A solver at the end of the load, with displacements that belong to its gaps and forces.
fn loaded<'m>(model: &'m Model, system: &'m System) -> Solver<'m> {
    let mut solver =
        Solver::new(model, system, Backend::default(), &[], Vec::new(), &[]).expect("solver");
    let end = solver.structure.point(1.0);
    let arrival = ElasticDrive::go(&mut solver, &end, None);
    assert_eq!(arrival.expect("drive"), Arrival::End);
    solver.refresh();
    solver
}

/// Checks that noise put in by hand shows with its own size, up to the error of the sound state.
#[track_caller]
fn shows(figure: f64, expected: f64, sound: f64) {
    let off = (figure - expected).abs();
    assert!(expected > 100.0 * sound, "too little noise: {expected:e}");
    assert!(
        off <= sound + 1e-9 * expected,
        "{figure:e}, put in {expected:e}"
    );
}

fn move_by(u: &mut Displacements, freedom: usize, shift: f64) {
    u.total[freedom] += shift;
    u.deformation.as_mut().expect("a body floats")[freedom] += shift;
}

fn entry(system: &System, i: usize, j: usize) -> f64 {
    let at = system
        .stiffness
        .whole()
        .expect("here")
        .get(i.min(j), i.max(j));
    at.copied().unwrap_or(0.0)
}

/// A displaced node leaves forces out of balance according to its column of the stiffness.
#[test]
fn noise_in_a_displacement_shows_in_the_balance_of_forces() {
    let (model, system) = model();
    let mut solver = loaded(&model, &system);
    let sound = Reading::of(&mut solver)
        .quality_here()
        .expect("quality")
        .equilibrium;
    let of_contact = solver.structure.sub.partition.contact[0];
    for freedom in [of_contact, model.freedoms.n / 3, model.freedoms.n - 1] {
        let column = (0..model.freedoms.n).map(|i| entry(&system, i, freedom).abs());
        let stiffest = column.fold(0.0, f64::max);
        for share in [1e-6, 1e-3, 1.0] {
            let mut u = Reading::of(&mut solver)
                .displacements()
                .expect("displacements");
            move_by(&mut u, freedom, share * solver.scales.force / stiffest);
            let q = Reading::of(&mut solver).quality_of(&u).unwrap();
            shows(q.equilibrium, share, sound);
        }
    }
}

/// An error in a contact force leaves the same force out of balance on its two nodes, both in the
/// balance of stresses and in the residual of the full solve.
#[test]
fn noise_in_a_contact_force_shows_in_balance_and_backward_errors() {
    let (model, system) = model();
    let mut solver = loaded(&model, &system);
    let sound = Reading::of(&mut solver).quality_here().expect("quality");
    let n = model.pairs.len();
    for pair in [0, n - 1] {
        for share in [1e-6, 1e-3] {
            let noise = share * solver.scales.force;
            solver.now.force[pair] += noise;
            let u = Reading::of(&mut solver)
                .displacements()
                .expect("displacements");
            let load = solver.total_load();
            let q = Reading::of(&mut solver).quality_of(&u).unwrap();
            solver.now.force[pair] -= noise;
            shows(
                q.equilibrium,
                noise / solver.scales.force,
                sound.equilibrium,
            );
            let scale = system.norm * solver.scales.deformation + solver.scales.force;
            shows(q.backward_error, noise / scale, sound.backward_error);
            let contact = &solver.structure.sub.partition.contact;
            let of_row = [contact[pair], contact[n + pair]].map(|i| {
                let terms =
                    (0..model.freedoms.n).map(|j| entry(&system, i, j) * u.deformation()[j]);
                noise / (terms.map(f64::abs).sum::<f64>() + load[i].abs())
            });
            let componentwise = q.componentwise_error.expect("stated");
            let sound = sound.componentwise_error.expect("stated");
            shows(componentwise, of_row[0].max(of_row[1]), sound);
        }
    }
}

/// The surface of an open pair is pulled: its stresses then hold bodies together that nothing
/// glues.
#[test]
fn tension_shows_as_adhesion() {
    let (model, system) = model();
    let mut solver = loaded(&model, &system);
    // Round-off that presses the surfaces together does not show as adhesion.
    let sound = Reading::of(&mut solver)
        .quality_here()
        .expect("quality")
        .adhesion;
    let sound = sound.max(16.0 * f64::EPSILON);
    let n = model.pairs.len();
    assert!(solver.tableau.open()[..2].iter().all(|open| *open));
    let contact = solver.structure.sub.partition.contact.clone();
    for (place, towards) in [(0, -1.0), (n, 1.0)] {
        let freedom = contact[place];
        for share in [1e-6, 1e-2] {
            let pull = share * solver.scales.force / entry(&system, freedom, freedom);
            let mut u = Reading::of(&mut solver)
                .displacements()
                .expect("displacements");
            move_by(&mut u, freedom, towards * pull);
            let tension = (0..2 * n).map(|i| {
                let side = if i < n { 1.0 } else { -1.0 };
                let changed = side * towards * pull * entry(&system, contact[i], freedom);
                -(solver.now.force[i % n] + changed)
            });
            let expected = tension.fold(0.0, f64::max) / solver.scales.force;
            assert!(expected >= share * (1.0 - 1e-12));
            shows(
                Reading::of(&mut solver).quality_of(&u).unwrap().adhesion,
                expected,
                sound,
            );
        }
    }
}

/// The surfaces of a closed pair are moved apart or into each other: the figures show it whatever
/// the solver's own gaps are.
#[test]
fn a_wrong_gap_shows_in_complementarity_and_as_penetration() {
    let (model, system) = model();
    let mut solver = loaded(&model, &system);
    let sound = Reading::of(&mut solver).quality_here().expect("quality");
    let n = model.pairs.len();
    let pole = n - 1;
    let contact = solver.structure.sub.partition.contact.clone();
    let share_of_force = solver.now.force[pole] / solver.scales.force;
    let widest = (solver.structure.delta(&solver.at).iter()).fold(0.0f64, |m, d| m.max(d.abs()));
    for shift in [1e-6, 1e-3, -1e-6, -1e-3] {
        let apart = shift * solver.scales.displacement;
        // Either the first node moves up by `apart`, or the second node moves down by it.
        for (place, by) in [(pole, apart), (n + pole, -apart)] {
            let mut u = Reading::of(&mut solver)
                .displacements()
                .expect("displacements");
            u.total[contact[place]] += by;
            let q = Reading::of(&mut solver).quality_of(&u).unwrap();
            let scale = solver.scales.displacement.max(widest);
            let product = apart.abs() / scale * share_of_force;
            shows(q.complementarity, product, sound.complementarity);
            if apart < 0.0 {
                shows(
                    q.penetration,
                    -apart / solver.scales.displacement,
                    sound.penetration,
                );
            }
        }
    }
}

/// A pair has the wrong status, and its gap or force is clipped as if it were sound: stresses and
/// displacements show the clipped value.
#[test]
fn a_wrong_status_shows_with_its_tension_or_penetration() {
    let (model, system) = model();
    for closed in [true, false] {
        let mut solver = loaded(&model, &system);
        let sound = Reading::of(&mut solver).quality_here().expect("quality");
        let open = solver.tableau.open().to_vec();
        // The outermost pair is open, the pole is closed.
        let wrong = if closed { 0 } else { open.len() - 1 };
        assert_eq!(open[wrong], closed);
        assert!(solver.tableau.flip(wrong));
        solver.fresh = false;
        solver.refresh();
        let worst = |values: &[f64]| values.iter().fold(0.0f64, |m, v| m.max(-v));
        let (tension, overlap) = (worst(&solver.now.force), worst(&solver.now.gap));
        let u = Reading::of(&mut solver)
            .displacements()
            .expect("displacements");
        for value in solver.now.gap.iter_mut().chain(&mut solver.now.force) {
            *value = value.max(0.0);
        }
        let q = Reading::of(&mut solver).quality_of(&u).unwrap();
        if closed {
            shows(q.adhesion, tension / solver.scales.force, sound.adhesion);
        } else {
            let expected = overlap / solver.scales.displacement;
            shows(q.penetration, expected, sound.penetration);
        }
    }
}

/// Nearly incompressible bodies lose digits of their stresses to their stiffness against a change
/// of volume. The loss is within the round-off that the state reports; larger errors are not
/// accepted.
#[test]
fn the_bound_of_forces_follows_the_round_off_of_the_mesh() {
    let text = SCENE.replace("poissons_ratio = 0.3", "poissons_ratio = 0.499999998");
    let model = Model::new(&Scene::parse(&text, "test").expect("scene")).expect("model");
    let system = assemble(&model, Backend::default()).expect("system");
    let mut solver = loaded(&model, &system);
    let sound = Reading::of(&mut solver).quality_here().expect("quality");
    let tolerances = tolerances(&model);
    assert!(sound.equilibrium > tolerances.equilibrium, "{sound:?}");
    assert_eq!(sound.misses(&tolerances), []);
    // Displacements are accurate to half a rounding error; an error a thousand times larger is a
    // fault.
    for (size, accepted) in [(0.5, true), (500.0, false)] {
        let mut u = Reading::of(&mut solver)
            .displacements()
            .expect("displacements");
        for (i, value) in u.deformation.iter_mut().flatten().enumerate() {
            let random = ((i * 7919) % 1013) as f64 / 506.0 - 1.0;
            *value += size * f64::EPSILON * random * *value;
        }
        let q = Reading::of(&mut solver).quality_of(&u).unwrap();
        let bound = q.round_off.expect("stated");
        assert_eq!(q.equilibrium <= bound, accepted, "{q:?}");
        assert_eq!(q.misses(&tolerances).is_empty(), accepted, "{q:?}");
    }
}

/// NaN never ends in an endless loop: with a NaN among forces, gaps or initial loads, every figure
/// of a state is found, and the state is not reported as sound.
#[test]
fn what_is_not_a_number_ends_in_no_loop_and_is_caught() {
    type Spoil = fn(&mut Solver, usize, f64);
    let spoils: [Spoil; 3] = [
        |solver, k, value| solver.now.force[k] = value,
        |solver, k, value| solver.now.gap[k] = value,
        |solver, k, value| solver.now.initial.load.contact[k] = value,
    ];
    for kind in ["plane_strain", "axisymmetric", "solid"] {
        let solid = "[mesh.extrude]\ndepth = 1.0\nelements = 1\n\
                     [[support]]\non = \"half_plane.front\"\nfix = [\"z\"]\n\
                     [[support]]\non = \"cylinder.front\"\nfix = [\"z\"]\n";
        let mut text = SCENE.replace("plane_strain", kind);
        text += if kind == "solid" { solid } else { "" };
        let scene = Scene::parse(&text, "test").expect("scene");
        let model = Model::new(&scene).expect("model");
        let system = assemble(&model, Backend::default()).expect("system");
        let mut solver =
            Solver::new(&model, &system, Backend::default(), &[], Vec::new(), &[]).expect("solver");
        let end = solver.structure.point(1.0);
        assert_eq!(
            ElasticDrive::go(&mut solver, &end, None).expect("drive"),
            Arrival::End
        );
        solver.refresh();
        let (sound, scales) = (solver.now.clone(), solver.scales);
        let n = model.pairs.len();
        for (i, spoil) in spoils.iter().enumerate() {
            for k in [0, n / 2] {
                for value in [f64::NAN, f64::NEG_INFINITY, 1e300] {
                    solver.now = sound.clone();
                    solver.scales = scales;
                    spoil(&mut solver, k, value);
                    let Ok(figures) = Reading::of(&mut solver).figures("end", true) else {
                        continue;
                    };
                    let misses = figures.state.quality.misses(&tolerances(&model));
                    assert!(!misses.is_empty(), "{kind}: {i}, pair {k}, {value}");
                }
            }
        }
    }
}
