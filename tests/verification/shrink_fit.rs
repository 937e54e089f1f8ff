//! Shrink fit of a solid shaft in a ring, plane stress: `p = E d (b^2 - a^2)/(2 a b^2)`.
//!
//! Source: S. Timoshenko, Strength of Materials, part II (1956), art. 42; Lame.

use crate::support::run_file;
#[test]
fn pressure_converges_to_lame() {
    let error = |n: usize| {
        let (shaft, ring) = (
            format!("mesh.parts.0.disc.elements={n}"),
            format!("mesh.parts.1.ring.elements=[{n},{n}]"),
        );
        let results = run_file("shrink_fit", &[&shaft, &ring]);
        let pairs = &results.states[0].pairs;
        let force: f64 = pairs.iter().map(|p| p.force).sum();
        let area: f64 = pairs.iter().map(|p| p.area).sum();
        (force / area / 78.75 - 1.0).abs()
    };
    let (coarse, fine) = (error(8), error(16));
    // Bilinear elements: order h^2, and C from (h/a)^2 = (pi/32)^2 at 16.
    assert!(
        fine <= 0.1 * (std::f64::consts::PI / 32.0).powi(2),
        "{fine:.2e}"
    );
    assert!(fine <= coarse / 3.0, "{coarse:.2e} {fine:.2e}");
}
