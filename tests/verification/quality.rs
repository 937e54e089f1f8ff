//! Algebraic quality of every state of every scene in `data/scenes`.
//!
//! Source: N. J. Higham, Accuracy and Stability of Numerical Algorithms (2002), section 7.1 (backward error).

use crate::run::{run, scene};

#[test]
fn every_state_of_every_scene_is_in_balance() {
    let folder = format!("{}/data/scenes", env!("CARGO_MANIFEST_DIR"));
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "toml") {
            continue;
        }
        let name = path.file_stem().unwrap().to_str().unwrap().to_string();
        for state in &run(&scene(&name, &[])).states {
            let (q, at) = (
                state.quality,
                format!("{name}, {}: {:?}", state.name, state.quality),
            );
            assert!(q.backward_error <= 1e-13, "{at}");
            assert!(q.equilibrium <= 1e-8, "{at}");
            // Round-off of a solve with the condensed matrix, some 1e3 units in the last place.
            assert!(q.penetration <= 1e-12, "{at}");
            // Forces are those that the stresses leave over: as good as equilibrium.
            assert!(q.complementarity <= 1e-8, "{at}");
            assert!(q.adhesion <= 1e-8, "{at}");
            count += 1;
        }
    }
    assert!(count > 30);
}
