//! Increments that cannot be as asked: more than the run may take, and a path error that a limit
//! load or the increments themselves keep out of reach. Each run ends by name and with what was
//! reached.

use crate::support::{close, load, run, run_as_far_as_it_goes};
use brinell::ErrorKind;
use brinell::accuracy::{Effort, Extent, estimate};
use brinell::linalg::Backend;
use brinell::progress::Silent;
use brinell::scene::Scene;

/// A tube of few elements, to the given load factors.
fn tube(targets: &str, overrides: &[&str]) -> Scene {
    let targets = format!("program.targets={targets}");
    let few = "mesh.parts.0.ring.elements=[4, 4]";
    load("thick_cylinder", &[&[few, &targets], overrides].concat())
}

const TWO: &str = "[{ load_factor = 150 }, { load_factor = 180 }]";

/// A bound on the increments changes none of them: the run ends at its place, with the states
/// before it.
#[test]
fn a_run_ends_at_its_bound_on_increments() {
    for stepping in ["auto", "events", "steps"] {
        let chosen = format!("program.stepping=\"{stepping}\"");
        let whole = run(&tube(TWO, &[&chosen]));
        let rows = whole.history.len();
        for most in 1..=rows {
            let bound = format!("program.max_increments={most}");
            let found = run_as_far_as_it_goes(&tube(TWO, &[&chosen, &bound]), Backend::default());
            assert_eq!(found.history[..], whole.history[..most], "{stepping}");
            if most == rows {
                assert!(found.incomplete.is_none(), "{:?}", found.incomplete);
                continue;
            }
            let end = found.incomplete.expect("an end");
            assert_eq!(end.kind, ErrorKind::Analysis);
            let reached = found.states.len();
            let last = whole.history[most - 1].alpha;
            for words in [
                format!("has taken program.max_increments = {most}: "),
                format!("load factor {last:.6}, {reached} of 2 targets"),
                "Raise program.max_increments".to_string(),
            ] {
                assert!(end.why.contains(&words), "{}", end.why);
            }
        }
    }
}

/// Beyond the limit load no increment is short enough, however small the path error: the limit load
/// is what is reported, and it hardly depends on the increments.
#[test]
fn a_limit_load_ends_increments_of_any_path_error() {
    let limit = |path_error: f64| {
        let asked = format!("program.path_error={path_error}");
        let found = run_as_far_as_it_goes(
            &tube("[{ load_factor = 250 }]", &[&asked]),
            Backend::default(),
        );
        let end = found.incomplete.expect("an end");
        assert_eq!(end.kind, ErrorKind::Collapse, "{}", end.why);
        assert!(end.why.contains("is the last that was held"), "{}", end.why);
        (found.history.last().unwrap().alpha, found.history.len())
    };
    let (usual, few) = limit(1e-3);
    let (exact, many) = limit(1e-6);
    assert!(many > 5 * few, "{many} increments, {few} before");
    close("limit load", usual, exact, exact, 1e-4);
}

/// A path error that the increments leave in spite of `path_error` is named with its figure; the
/// estimate is above what shorter increments show to be left.
#[test]
fn a_path_error_that_was_not_reached_is_named() {
    let asked = |path_error: f64| {
        let path_error = format!("program.path_error={path_error}");
        let scene = load("three_bodies", &[&path_error]);
        let results = run(&scene);
        let (backend, extent) = (Backend::default(), Extent::Program);
        let found = estimate(
            &scene,
            backend,
            &results,
            extent,
            Effort::Quick,
            &mut Silent,
        );
        let pressure = "states.unloaded.max_pressure";
        let of_pressure = found.quantities.iter().find(|q| q.quantity == pressure);
        let of_pressure = of_pressure.expect(pressure);
        let notes = found.notes.join("; ");
        (of_pressure.value, of_pressure.path.unwrap(), notes)
    };
    let (value, left, named) = asked(1e-3);
    assert!(
        named.contains("program.path_error = 1e-3 is probably not reached"),
        "{named}"
    );
    assert!(named.contains("states.unloaded.max_pressure"), "{named}");
    let (exact, _, _) = asked(1e-5);
    assert!(
        (value - exact).abs() < left,
        "{value} for {exact}, {left} stated"
    );
    let (_, _, silent) = asked(1e-2);
    assert!(!silent.contains("program.path_error"), "{silent}");
}
