//! A pin that fits its hole neatly, pushed into the side of it.
//!
//! Source: B. G. A. Persson, On the stress distribution of cylindrical elastic bodies in contact
//! (1964) (`data/reference/persson`).

use crate::support::{run_file, state};
use crate::verification::close;
use brinell::analytical::PinInHole;

#[test]
fn contact_angle_and_pressure_are_perssons_at_any_load() {
    // Of no clearance the modulus has no part in it.
    let exact = PinInHole::new(10.0, 0.0, 1.0).unwrap();
    let (angle, pressure) = (
        PinInHole::neat_half_angle(),
        exact.max_pressure(1e3).unwrap(),
    );
    close(angle.to_degrees(), 84.828, 1e-5);
    close(pressure, 59.963, 1e-4);
    let errors = |n: usize| {
        let pin = format!("mesh.parts.0.disc.elements={n}");
        let plate = format!("mesh.parts.1.ring.elements=[40,{}]", 2 * n);
        let results = run_file("pin_in_hole", &[&pin, &plate]);
        let (pushed, hardly) = (state(&results, "pushed"), state(&results, "hardly"));
        // Receding contact is proportional; two solves of n pairs, each off by eps n times a
        // condition of n.
        let pairs = pushed.pairs.len() as f64;
        let round_off = 2.0 * pairs * pairs * f64::EPSILON;
        close(hardly.max_pressure * 1e6, pushed.max_pressure, round_off);
        assert_eq!(
            pushed.pairs.iter().map(|p| p.status).collect::<Vec<_>>(),
            hardly.pairs.iter().map(|p| p.status).collect::<Vec<_>>()
        );
        [
            pushed.max_pressure / pressure - 1.0,
            pushed.half_width / (10.0 * angle) - 1.0,
        ]
        .map(f64::abs)
    };
    let (coarse, fine) = (errors(16), errors(32));
    // The end of the contact is known to an element, a share of 90/84.8 of 1/n; the pressure at the
    // pole, far from it, to the square of that, and the plate's rim is a hundred radii away:
    // (R/W)^2 = 1e-4.
    for (found, n) in [(coarse, 16.0f64), (fine, 32.0)] {
        assert!(found[0] <= 1e-4 + 1.0 / (n * n), "{coarse:?} {fine:?}");
        assert!(found[1] <= 1.06 / n, "{coarse:?} {fine:?}");
    }
    // Of first order at least.
    assert!(
        fine[0] <= coarse[0] / 2.0 && fine[1] <= coarse[1] / 2.0,
        "{coarse:?} {fine:?}"
    );
}
