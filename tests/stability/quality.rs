//! Loss of accuracy is noticed: figures of quality mean something in every state.

use crate::running::{run_file, state};

/// Relative to what little is left after unloading, round-off looks like an error of 100 %, and users learn to overlook the
/// figure. Relative to the largest load and displacement of the run, an unloaded state is as good as a loaded one.
#[test]
fn an_unloaded_floating_state_is_as_good_as_a_loaded_one() {
    for (name, last) in [
        ("hard/all_closed", "unloaded"),
        ("hard/separation", "unloaded"),
    ] {
        let results = run_file(name, &[]);
        let q = state(&results, last).quality;
        // Gaps are hit within gamma = 1e-8, forces balance to 1e-10 (analysis.tolerance).
        for (figure, value, bound) in [
            ("backward error", q.backward_error, 1e-14),
            ("equilibrium", q.equilibrium, 1e-9),
            ("complementarity", q.complementarity, 1e-9),
            ("penetration", q.penetration, 1e-8),
            ("adhesion", q.adhesion, 1e-9),
        ] {
            assert!(value <= bound, "{name}, {figure}: {value:e} > {bound:e}");
        }
    }
}
