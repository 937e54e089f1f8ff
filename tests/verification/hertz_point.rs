//! A ball on a half space at first yield.
//!
//! Source: K. L. Johnson, Contact Mechanics (1985), sections 3.4 and 6.1; Code_Aster SSNV104 lies in the same theory.

use crate::run::{scene, yield_load};

#[test]
fn first_yield_converges_to_the_exact_values() {
    let (r, y, e) = (10.0, 500.0, 210000.0 / (2.0 * 0.91));
    let errors = |n: usize| {
        let resolution = format!("mesh.cylinder_on_half_plane.resolution={n}");
        let point = yield_load(&scene("ball_on_half_space", &[&resolution]))
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
        // Of order 1.5, as the contact ends inside an element, or higher; the place, between elements of 1/16, of order 2. The pressure, where errors cancel, is right to
        // 0.1 % from the start.
        assert!(fine[k] <= 2.0 / 256.0, "{k}: {coarse:?} {fine:?}");
        let pressure = k == 1;
        assert!(
            fine[k] <= coarse[k] / 2f64.powf(1.4) || (pressure && coarse[k] <= 1e-3),
            "{k}: {coarse:?} {fine:?}"
        );
    }
}
