//! How often a solid is factored.

use crate::support::{close, healthy, load, run, yield_load};

/// Once: a coarser mesh has shown where yielding will spread. What it shows decides where yielding
/// is looked for and nothing else: the load at first yield alone, for which no coarser mesh is run,
/// is the same up to where its search ends.
#[test]
fn a_ball_is_factored_once() {
    let scene = load(
        "ball_on_flat_3d",
        &[
            "mesh.curved_bodies.resolution=5",
            "program.targets=[{ yield = true }, { load_factor = 3.0 }]",
        ],
    );
    let results = run(&scene);
    healthy(&results);
    assert_eq!(results.counts.factorizations, 1);
    // Only a part of what may yield is zone.
    assert!(results.sizes.zone_elements < results.sizes.elements / 4);
    let alone = yield_load(&scene).first_yield.unwrap();
    let together = results.first_yield.unwrap();
    for (a, b) in [
        (alone.load, together.load),
        (alone.max_pressure, together.max_pressure),
    ] {
        close("first yield", a, b, b, 1e-7);
    }
}
