//! Tests of runs whose result is known in closed form, on unusual paths: no target that asks for
//! first yield, loads that fall or turn, yielding far from the contact.

use super::assembled::Analysis;
use super::position::{Purpose, Start, TargetSearch};
use super::run::Run;
use crate::analysis::increments::tangent::solve_tangent;
use crate::analysis::structure::record::knows;
use crate::analysis::structure::solver::Solver;
use crate::error::{Error, ErrorKind};
use crate::linalg::Backend;
use crate::model::Model;
use crate::progress::Silent;
use crate::results::Results;
use crate::scene::Scene;
use std::cell::Cell;
use std::error::Error as _;
use std::rc::Rc;

fn run(text: &str) -> Results {
    let scene = Scene::parse(text, "test").expect("scene");
    let mut analysis =
        Analysis::new(Model::new(&scene).expect("model"), Backend::Dense).expect("analysis");
    analysis.run(&mut Silent).expect("run")
}

const E: f64 = 1000.0;
const Y: f64 = 10.0;

/// A unit square in plane stress, held so that the stress is uniaxial.
fn bar(material: &str, load: &str, rest: &str) -> String {
    format!(
        r#"
kind = "plane_stress"
[[mesh.parts]]
body = "bar"
block = {{ x = [0.0, 1.0], y = [0.0, 1.0], elements = [2, 2] }}
[materials.metal]
youngs_modulus = {E}
poissons_ratio = 0.3
yield_stress = {Y}
{material}
[bodies.bar]
material = "metal"
[[support]]
on = "bar.left"
fix = ["x"]
[[support]]
on = "bar.bottom"
fix = ["y"]
[[load]]
on = "bar.right"
{load}
{rest}
"#
    )
}

/// Plastic strain of the bar in the last state; the equilibrium of all states is checked.
fn plastic_strain(text: &str) -> f64 {
    let results = run(text);
    assert!(results.incomplete.is_none(), "{:?}", results.incomplete);
    for state in &results.states {
        assert!(
            state.quality.equilibrium <= 1e-8,
            "{}: {:e}",
            state.name,
            state.quality.equilibrium
        );
    }
    results.states[results.states.len() - 1].max_equivalent_plastic_strain
}

/// A perfectly plastic bar pulled to 1.5 times the yield strain: half of the yield strain is
/// plastic.
const PULLED: &str = "displacement = { x = 0.015 }";

fn assert_half_of_yield_strain(strain: f64) {
    assert!(
        (strain / (0.5 * Y / E) - 1.0).abs() < 1e-8,
        "plastic strain {strain}"
    );
}

#[test]
fn yields_on_the_way_to_a_displacement() {
    let target = r#"[program]
targets = [{ displacement = { on = "bar.right", direction = "x", value = 0.015 } }]"#;
    assert_half_of_yield_strain(plastic_strain(&bar("", PULLED, target)));
}

#[test]
fn yields_where_the_secant_was_not_asked_for_the_yield_load() {
    let rest = "[analysis]\nyield_load = \"secant\"\n[program]\ntargets = [{ load_factor = 1.0 }]";
    assert_half_of_yield_strain(plastic_strain(&bar("", PULLED, rest)));
}

#[test]
fn yields_under_a_negative_load_factor() {
    let rest = "[program]\ntargets = [{ load_factor = -1.0 }]";
    assert_half_of_yield_strain(plastic_strain(&bar("", PULLED, rest)));
}

#[test]
fn yields_under_a_load_that_turns() {
    let load = format!("{PULLED}\nhistory = [[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]]");
    let rest = "[program]\ntargets = [{ load_factor = 2.0 }]";
    assert_half_of_yield_strain(plastic_strain(&bar("", &load, rest)));
}

#[test]
fn first_plastic_increment_is_in_equilibrium() {
    let strain = plastic_strain(&bar(
        "plastic_modulus = 100.0",
        "traction = [12.0, 0.0]",
        "[program]\ntargets = [{ load_factor = 1.0 }]",
    ));
    assert!(
        (strain / (2.0 / 100.0) - 1.0).abs() < 1e-8,
        "plastic strain {strain}"
    );
}

#[test]
fn yield_target_in_units_of_the_load() {
    let results = run(&bar(
        "plastic_modulus = 100.0",
        "traction = [5.0, 0.0]",
        "[program]\ntargets = [{ yield = true }]",
    ));
    assert!((results.states[0].alpha - 2.0).abs() < 1e-10);
}

#[test]
fn tiny_displacement_targets_are_hit_as_accurately_as_large_ones() {
    for value in [1e-13, 1e-4] {
        let rest = format!(
            "[program]\ntargets = [{{ displacement = {{ on = \"bar.right\", direction = \"x\", \
             value = {value:e} }} }}]"
        );
        let results = run(&bar("", "traction = [1.0, 0.0]", &rest));
        assert!(
            (results.states[0].approach / value - 1.0).abs() < 1e-9,
            "{}",
            results.states[0].approach
        );
    }
}

/// Two blocks in contact, so large that the zone is only a part of them, and a softer block far
/// away that yields first.
fn blocks_and_a_soft_one(targets: &str) -> String {
    format!(
        r#"
kind = "plane_stress"
[[mesh.parts]]
body = "upper"
block = {{ x = [0.0, 1.0], y = [0.0, 1.0], elements = [12, 12] }}
[[mesh.parts]]
body = "lower"
block = {{ x = [0.0, 1.0], y = [-1.0, 0.0], elements = [12, 12] }}
[[mesh.parts]]
body = "soft"
block = {{ x = [20.0, 21.0], y = [0.0, 1.0], elements = [4, 4] }}
[materials.metal]
youngs_modulus = {E}
poissons_ratio = 0.3
yield_stress = {Y}
plastic_modulus = 100.0
[materials.softer]
youngs_modulus = {E}
poissons_ratio = 0.3
yield_stress = 1.0
plastic_modulus = 100.0
[bodies.upper]
material = "metal"
[bodies.lower]
material = "metal"
[bodies.soft]
material = "softer"
[[contact]]
first = "upper.bottom"
second = "lower.top"
[[support]]
on = "upper.left"
fix = ["x"]
[[support]]
on = "lower.left"
fix = ["x"]
[[support]]
on = "lower.bottom"
fix = ["y"]
[[support]]
on = "soft.left"
fix = ["x"]
[[support]]
on = "soft.bottom"
fix = ["y"]
[[load]]
on = "upper.top"
pressure = 1.0
[[load]]
on = "soft.top"
pressure = 1.0
[program]
{targets}
"#
    )
}

fn sparse(text: &str) -> Results {
    let scene = Scene::parse(text, "test").expect("scene");
    let model = Model::new(&scene).expect("model");
    let mut analysis = Analysis::new(model, Backend::default()).expect("analysis");
    analysis.run(&mut Silent).expect("run")
}

#[test]
fn first_yield_far_from_the_contact_is_found() {
    let results = sparse(&blocks_and_a_soft_one(
        "unit = \"yield\"\ntargets = [{ yield = true }, { load_factor = 2.0 }]",
    ));
    let first = results.first_yield.expect("yield");
    assert!((first.alpha - 1.0).abs() < 1e-9, "{}", first.alpha);
    assert_eq!(first.body, 2);
    // The stress is twice the yield stress of 1: its excess of 1 over the plastic modulus of 100.
    let strain = results.states[1].max_equivalent_plastic_strain;
    assert!((strain - 0.01).abs() < 1e-9, "{strain}");
}

#[test]
fn yielding_far_from_the_contact_is_noticed_without_a_yield_load() {
    // Two blocks of height 1 are compressed by 0.004: the stress is 2, twice the yield stress of
    // the soft block under the same pressure.
    let target =
        r#"targets = [{ displacement = { on = "upper.top", direction = "y", value = -0.004 } }]"#;
    let state = &sparse(&blocks_and_a_soft_one(target)).states[0];
    assert!((state.load - 2.0).abs() < 1e-8, "{}", state.load);
    assert!(
        (state.max_equivalent_plastic_strain - 0.01).abs() < 1e-9,
        "{}",
        state.max_equivalent_plastic_strain
    );
}

/// A solve that a search needs may fail: the search then ends with the error of the solve and its
/// cause, wherever on the way that happens.
#[test]
fn a_search_ends_with_the_error_of_what_it_looks_at() {
    let text = bar("", PULLED, "[program]\ntargets = [{ load_factor = 0.3 }]");
    let model = Model::new(&Scene::parse(&text, "test").unwrap()).unwrap();
    let analysis = Analysis::new(model, Backend::Dense).unwrap();
    let search = |fails_at: usize| {
        let mut observer = Silent;
        let mut run = Run::new(&analysis, Purpose::Program, None, &mut observer).unwrap();
        run.execute().unwrap();
        let calls = Rc::new(Cell::new(0));
        let counted = Rc::clone(&calls);
        let monitor = move |solver: &mut Solver| {
            counted.set(counted.get() + 1);
            if counted.get() == fails_at {
                let cause = std::io::Error::other("no memory");
                return Err(Error::internal("a solve failed").because(cause));
            }
            Ok(solver.at.alpha - 0.9)
        };
        run.monitor = Some(Box::new(monitor));
        let alpha = run.solver.at.alpha;
        run.position.search = Some(TargetSearch::new(alpha, 0.6, true, 1.0));
        while run.position.search.is_some() {
            run.next()?;
        }
        let yielded = run.position.first_yield.is_behind;
        Ok::<_, Error>((run.solver.at.alpha, yielded, calls.get()))
    };
    let (alpha, plastic, calls) = search(usize::MAX).unwrap();
    assert!((alpha - 0.9).abs() < 1e-9 && plastic, "{alpha}");
    assert!(calls > 3, "elastic, plastic and at the end: {calls}");
    for fails_at in 1..=calls {
        let error = search(fails_at).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Internal, "call {fails_at}");
        assert_eq!(error.in_full(), "a solve failed: no memory");
        assert!(error.source().is_some());
    }
}

/// Progress covers the whole program, and each leg roughly in proportion to its time: when a ball
/// is unloaded, its pairs open one after the other down to the smallest loads.
#[test]
#[cfg_attr(
    not(any(feature = "cholmod", feature = "faer")),
    ignore = "needs a sparse backend"
)]
fn progress_is_done_with_the_last_increment_only() {
    struct Fractions(Vec<f64>);
    impl crate::progress::Observer for Fractions {
        fn increment(
            &mut self,
            _: &crate::results::HistoryRow,
            fraction: f64,
        ) -> crate::progress::Flow {
            self.0.push(fraction);
            crate::progress::Flow::Continue
        }
    }
    let root = env!("CARGO_MANIFEST_DIR");
    let path = format!("{root}/data/scenes/ball_on_half_space.toml");
    let changes = [
        "program.targets=[{ yield = true }, { load_factor = 8.0 }, { load_factor = 0.0 }]",
        "mesh.cylinder_on_half_plane.resolution=5",
    ];
    let scene = Scene::load_with(path, &changes.map(str::to_string)).unwrap();
    let mut analysis = Analysis::new(Model::new(&scene).unwrap(), Backend::default()).unwrap();
    let mut seen = Fractions(Vec::new());
    let results = analysis.run(&mut seen).unwrap();
    let [before, last] = seen.0[seen.0.len() - 2..] else {
        panic!("{:?}", seen.0)
    };
    assert!(before < 0.995 && last == 1.0, "{:?}", seen.0);
    assert!(seen.0.is_sorted());
    // When half of the increments of the last leg are done, about half of its share is done.
    let top = results
        .history
        .iter()
        .rposition(|row| row.alpha == 8.0)
        .unwrap();
    let half = seen.0[(top + results.history.len()) / 2];
    assert!((0.72..0.95).contains(&half), "{half}");
}

/// The start of the way to a target passes through a checkpoint with everything that is restored
/// when the way is repeated with a wider zone.
#[test]
fn the_start_of_a_way_keeps_the_first_yield_that_was_known() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/data/scenes/hard/unload_reload.toml"
    );
    let coarse = [
        "mesh.cylinder_on_half_plane.resolution=2".to_string(),
        "mesh.cylinder_on_half_plane.far_size=10".to_string(),
    ];
    let model = Model::new(&Scene::load_with(path, &coarse).unwrap()).unwrap();
    let analysis = Analysis::new(model, Backend::default()).unwrap();
    let mut observer = Silent;
    let mut run = Run::new(&analysis, Purpose::Program, None, &mut observer).unwrap();
    run.execute().unwrap();
    let known = run.position.first_yield;
    assert!(known.point.is_some() && known.alpha.is_some() && known.is_behind);
    run.set_start();
    let bytes = postcard::to_stdvec(run.start.as_ref().unwrap()).unwrap();
    let start: Start = postcard::from_bytes(&bytes).unwrap();
    assert_eq!(start.first_yield.point, known.point);
    assert_eq!(start.first_yield.alpha, known.alpha);
    assert!(start.first_yield.is_behind);
    assert_eq!(start.rows, run.results.history.len());
    assert!(knows(&run.solver, &start.state));
    assert_eq!(start.state.at, run.solver.at);
    assert_eq!(start.state.history, run.solver.zone.history());
    assert_eq!(start.state.open, run.solver.tableau.open());
}

/// Fading back stresses make the tangent unsymmetric if flow turns. Newton's direction still solves
/// it, and its products agree with differences of the forces.
#[test]
fn a_tangent_that_is_not_symmetric_is_solved() {
    let rest = r#"
[[load]]
on = "bar.top"
traction = [14.0, 3.0]
history = [[1.0, 0.0], [2.0, 1.0]]
[program]
targets = [{ load_factor = 1.0 }, { load_factor = 1.3 }]
"#;
    let material = "plastic_modulus = 20.0\nback_stresses = [[400.0, 30.0], [300.0, 200.0]]";
    let text = bar(
        material,
        "traction = [14.0, 0.0]\nhistory = [[0.0, 0.0], [1.0, 1.0]]",
        rest,
    );
    let model = Model::new(&Scene::parse(&text, "test").unwrap()).unwrap();
    let analysis = Analysis::new(model, Backend::Dense).unwrap();
    let mut observer = Silent;
    let mut run = Run::new(&analysis, Purpose::Program, None, &mut observer).unwrap();
    run.execute().unwrap();
    let solver = &mut run.solver;
    assert!(!solver.zone.is_symmetric());
    // The path continues from here under more of the second load.
    let mut u = solver.now.u.clone();
    let mut seed = 1u64;
    u.zone.iter_mut().for_each(|u| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        *u += 2e-3 * ((seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5);
    });
    let zeros = solver.structure.sub.zeros();
    let (mut load, mut taken) = (zeros.clone(), zeros.clone());
    let evaluation = solver.zone.evaluate(&u, &mut load);
    assert!(evaluation.yielding > 4, "{evaluation:?}");
    // The residual has no particular direction.
    let mut residual = zeros.clone();
    let values = residual.zone.iter_mut().enumerate();
    values.for_each(|(i, r)| *r = ((i * i) as f64).sin());
    let direction = solve_tangent(solver, &residual, 1e-10, 1.0);
    solver.zone.softening_times(&direction.u, &mut taken);
    let mut left = direction.initial.load.clone();
    left.add(-1.0, &taken);
    left.add(-1.0, &residual);
    assert!(
        left.largest() < 1e-8 * residual.largest(),
        "{:e}",
        left.largest()
    );
    // Products of the tangent, forwards and in the transposed order: `v' K w` and `w' K v`.
    let w = solver.direction(residual.clone()).u;
    let v = direction.u.clone();
    let mut of_w = zeros.clone();
    solver.zone.softening_times(&w, &mut of_w);
    let [there, back] = [v.dot(&of_w), w.dot(&taken)];
    assert!((there - back).abs() > 1e-4 * there.abs(), "{there} {back}");
    // The product is compared with differences of the initial loads.
    let step = 1e-5 * u.largest() / v.largest();
    let [mut ahead, mut behind] = [u.clone(), u.clone()];
    ahead.add(step, &v);
    behind.add(-step, &v);
    let (mut change, mut other) = (zeros.clone(), zeros);
    solver.zone.evaluate(&ahead, &mut change);
    solver.zone.evaluate(&behind, &mut other);
    change.add(-1.0, &other);
    change.add(-2.0 * step, &taken);
    assert!(
        change.largest() < 1e-5 * 2.0 * step * taken.largest(),
        "{:e} {:e}",
        change.largest(),
        step * taken.largest()
    );
}
