//! Algebraic quality of every state of every scene in `data/scenes`.
//!
//! Source: N. J. Higham, Accuracy and Stability of Numerical Algorithms (2002), section 7.1
//! (backward error).

use crate::support::scenes;
use crate::verification::run::{run_as_far_as_it_goes, scene};

#[test]
fn every_state_of_every_scene_is_in_balance() {
    let mut count = 0;
    for name in scenes::all() {
        let results = run_as_far_as_it_goes(&scene(&name, scenes::smaller(&name)));
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
            count += 1;
        }
    }
    assert!(count > 60, "{count}");
}
