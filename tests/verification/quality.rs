//! Algebraic quality of every state of every scene in `data/scenes`, and of all sparse solvers the
//! same figures.
//!
//! Source: N. J. Higham, Accuracy and Stability of Numerical Algorithms (2002), section 7.1
//! (backward error).

use crate::support::{either, load, run_as_far_as_it_goes, scenes, sparse};
use brinell::ErrorKind;
use brinell::output::{RunHeader, summary};
use brinell::results::Results;

/// Two scenes are there for their limit load; all others run to their end.
fn ends_as_it_should(name: &str, results: &Results) {
    let limits = ["hard/limit_load", "hard/nearly_incompressible"];
    let expected = limits.contains(&name).then_some(ErrorKind::Collapse);
    assert_eq!(
        results.ending().kind(),
        expected,
        "{name}: {:?}",
        results.incomplete
    );
}

#[test]
fn every_state_of_every_scene_is_in_balance_whichever_solver_found_it() {
    are_in_balance(|name| !name.starts_with("hard/"), 35);
}

#[test]
fn every_state_of_every_hard_scene_is_in_balance_whichever_solver_found_it() {
    are_in_balance(|name| name.starts_with("hard/"), 35);
}

/// All states of the scenes that are chosen, `at_least` so many by each solver; by the second and
/// further solvers every other scene, unless the run is to be thorough.
fn are_in_balance(chosen: impl Fn(&str) -> bool, at_least: usize) {
    let mut states = 0;
    let chosen = scenes::all().into_iter().filter(|name| chosen(name));
    for (k, name) in chosen.enumerate() {
        let overrides = either(scenes::smaller(&name), &[]);
        let mut first = None;
        let solvers = if k % either(2, 1) == 0 { usize::MAX } else { 1 };
        for solver in sparse().into_iter().take(solvers) {
            let results = run_as_far_as_it_goes(&load(&name, overrides), solver);
            ends_as_it_should(&name, &results);
            states += in_balance(&name, &results);
            let figures = summary(&RunHeader::default(), &results);
            let first = first.get_or_insert_with(|| figures.clone());
            let off = scenes::difference(&figures, first);
            assert!(
                off <= scenes::agreement(&name),
                "{name}, {solver:?}: {off:e}"
            );
        }
    }
    assert!(states >= at_least, "{states}");
}

/// The number of states, all of which are in balance.
fn in_balance(name: &str, results: &Results) -> usize {
    // N. J. Higham, theorem 10.4: of the order of the unknowns times the unit round-off.
    let backward_error = f64::EPSILON * results.sizes.freedoms as f64;
    for state in &results.states {
        let (q, at) = (
            state.quality,
            format!("{name}, {}: {:?}", state.name, state.quality),
        );
        assert!(q.backward_error <= backward_error, "{at}");
        assert!(q.equilibrium <= 1e-8, "{at}");
        // Round-off of a solve with the condensed matrix, times its condition: 1e4 where one
        // pair alone is in contact.
        assert!(q.penetration <= 1e-11, "{at}");
        // Forces are those that the stresses leave over: as good as equilibrium.
        assert!(q.complementarity <= 1e-8, "{at}");
        assert!(q.adhesion <= 1e-8, "{at}");
    }
    results.states.len()
}
