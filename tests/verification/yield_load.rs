//! The paper's secant for the yield load against the exact event path.
//!
//! Source: N. Endahl, section 3, equation 3.14.

use crate::support::{load, yield_load};
use crate::verification::close;
#[test]
fn secant_and_path_agree() {
    for (name, overrides) in [
        (
            "cylinder_on_half_plane",
            vec!["mesh.cylinder_on_half_plane.resolution=8"],
        ),
        ("disc_in_plate", vec!["mesh.disc_in_plate.resolution=60"]),
        (
            "ball_on_half_space",
            vec!["mesh.cylinder_on_half_plane.resolution=8"],
        ),
        ("thick_cylinder", vec![]),
    ] {
        let exact = yield_load(&load(name, &overrides)).first_yield.unwrap();
        let mut secant = overrides.clone();
        secant.push("analysis.yield_load=\"secant\"");
        let secant = yield_load(&load(name, &secant)).first_yield.unwrap();
        close(secant.alpha, exact.alpha, 1e-9);
        close(secant.load, exact.load, 1e-9);
    }
}
