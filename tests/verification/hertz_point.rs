//! A ball on a half space at first yield.
//!
//! Source: K. L. Johnson, Contact Mechanics (1985), sections 3.4 and 6.1; Code_Aster SSNV104 lies
//! in the same theory.

use crate::support::{load, yield_load};
#[test]
fn first_yield_converges_to_the_exact_values() {
    let (r, y, e) = (10.0, 500.0, 210000.0 / (2.0 * 0.91));
    let errors = |n: usize| {
        let resolution = format!("mesh.cylinder_on_half_plane.resolution={n}");
        let point = yield_load(&load("ball_on_half_space", &[&resolution]))
            .first_yield
            .unwrap();
        let a = std::f64::consts::FRAC_PI_2 * 1.6128 * y * r / e;
        [
            point.load / (21.68 * r * r * y * y * y / (e * e)) - 1.0,
            point.max_pressure / (1.6128 * y) - 1.0,
            point.half_width / a - 1.0,
            -point.location[1] / (0.4809 * a) - 1.0,
        ]
        .map(f64::abs)
    };
    let (coarse, fine) = (errors(8), errors(16));
    for k in 0..4 {
        // The place of first yield lies between elements of 1/16: of order h^2, C below 2. Load,
        // pressure and radius are right to 0.2 % from 8 elements on.
        assert!(fine[k] <= 2.0 / 256.0, "{k}: {coarse:?} {fine:?}");
        assert!(k == 3 || coarse[k] <= 2e-3, "{k}: {coarse:?} {fine:?}");
        assert!(
            fine[k] <= coarse[k] / 1.4 || fine[k] <= 2e-3,
            "{k}: {coarse:?} {fine:?}"
        );
    }
}
